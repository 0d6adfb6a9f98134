/// Zero of a function that is known at single places only, by the secant method.
#pragma once

#include <algorithm>
#include <cmath>

namespace meshwind {

/// Secant method from 0 on, for functions that move a state along: the last call of `excess` is at
/// the zero.
/// \param first > 0: step from 0, downwards where the excess there is above 0
/// \param most > 0: `excess` is called no farther from 0
/// \return whether it came within `within` of 0
template <class Excess>
[[nodiscard]] bool secant_root(const Excess& excess, double first, double most, double within) {
    constexpr int kSteps = 60;
    double a = 0.0;
    double fa = excess(a);
    double b = fa > 0.0 ? -first : first;
    double fb = excess(b);
    for (int i = 0; i < kSteps && std::abs(fb) > within && fb != fa; ++i) {
        const double c = std::clamp(b - fb * (b - a) / (fb - fa), -most, most);
        a = b;
        fa = fb;
        b = c;
        fb = excess(b);
    }
    return std::abs(fb) <= within;
}

}  // namespace meshwind
