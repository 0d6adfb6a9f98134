#include "core/roots.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <boost/math/tools/roots.hpp>

namespace meshwind {

Changeover halve(const Changeover& ends, int times, const std::function<bool(double)>& holds) {
    if (ends.holds == ends.fails) {
        return ends;
    }
    // Boost looks for a change of sign, and asks for it at the ends too.
    const auto sign = [&](double x) {
        return x == ends.holds || (x != ends.fails && holds(x)) ? 1.0 : -1.0;
    };
    const auto is_done = [&times](double, double) { return times-- <= 0; };
    const auto [low, high] = boost::math::tools::bisect(sign, std::min(ends.holds, ends.fails),
                                                        std::max(ends.holds, ends.fails), is_done);
    return ends.holds < ends.fails ? Changeover{low, high} : Changeover{high, low};
}

ZeroBracket zero_between(const SignChange& ends, const std::function<double(double)>& function,
                         const ZeroSearch& search) {
    auto evaluations = static_cast<std::uintmax_t>(search.most_evaluations);
    const boost::math::tools::eps_tolerance<double> near(static_cast<unsigned>(search.bits));
    // Boost copies what it is given with each evaluation.
    const auto value = [&function](double x) { return function(x); };
    const auto [low, high] = boost::math::tools::toms748_solve(
        value, ends.low, ends.high, ends.at_low, ends.at_high, near, evaluations);
    return {low, high};
}

bool secant_root(const std::function<double(double)>& excess, double first, double most,
                 double within) {
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
