/// Where a condition changes, and zeros of functions of one number. Halving and TOMS 748 are
/// Boost.Math's.
#pragma once

#include <functional>

namespace meshwind {

/// Two places, either of them the lower: a condition holds at one and fails at the other.
struct Changeover {
    double holds = 0.0;
    double fails = 0.0;

    [[nodiscard]] double middle() const { return 0.5 * (holds + fails); }
};

/// Halves `times` times, each time to the half in which the condition changes. Done sooner where no
/// number lies between the two, as halving would then change nothing.
/// \param ends taken at their word: `holds` is not asked there, so that a condition which is the
///     same at both is narrowed to one of them. The same place twice is given back.
/// \param times >= 0
/// \param holds asked at each middle in turn. It may keep what it found: the result is where it was
///     true last and where it was false last.
Changeover halve(const Changeover& ends, int times, const std::function<bool(double)>& holds);

/// A function's values at two places, one of them at most and one at least 0.
struct SignChange {
    double low = 0.0;
    double high = 0.0;  ///< > low
    double at_low = 0.0;
    double at_high = 0.0;
};

/// When a search for a zero ends: whichever comes first, or at a value of just 0.
struct ZeroSearch {
    /// > 0: the bracket is narrower than 2^(1 - bits) of its nearer end to 0; more than 51 are as
    /// 51, four units of rounding.
    int bits = 51;
    int most_evaluations = 100;  ///< > 0; smooth functions take about 10
};

/// low <= high, with the zero between them; both are the zero where the value there is just 0.
struct ZeroBracket {
    double low = 0.0;
    double high = 0.0;

    [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

/// Zero of a continuous function by TOMS 748; where there are several, any of them.
[[nodiscard]] ZeroBracket zero_between(const SignChange& ends,
                                       const std::function<double(double)>& function,
                                       const ZeroSearch& search = {});

/// Secant method from 0 on, for functions that move a state along: the last call of `excess` is at
/// the zero.
/// \param first > 0: step from 0, downwards where the excess there is above 0
/// \param most > 0: `excess` is called no farther from 0
/// \return whether it came within `within` of 0
[[nodiscard]] bool secant_root(const std::function<double(double)>& excess, double first,
                               double most, double within);

}  // namespace meshwind
