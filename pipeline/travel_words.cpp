#include "pipeline/travel_words.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/text/text_number.h"

namespace meshwind {
namespace {

// "axis Z", "axes A B C"
std::string axes_words(const std::string& letters) {
    std::string words = letters.size() == 1 ? "axis" : "axes";
    for (const char letter : letters) {
        (words += ' ') += letter;
    }
    return words;
}

double finite(double end) {
    return std::isfinite(end) ? end : 0.0;
}

std::string end_words(double end, const std::string& text) {
    return std::isfinite(end) ? text : "any";
}

}  // namespace

std::string along_words(const EyeRange& eye, double low_mm, double high_mm) {
    if (eye.along.empty()) {
        return "no axis moves the eye along the spindle, and the part needs it from " +
               fixed(low_mm, 1) + " to " + fixed(high_mm, 1) + " mm";
    }
    const bool one = eye.along.size() == 1;
    const auto shown = [&](double z_mm) {
        return one ? eye.along_zero_mm + eye.along_scale * z_mm : z_mm;
    };
    std::array<double, 2> needs = {shown(low_mm), shown(high_mm)};
    std::array<double, 2> has = {shown(eye.low_mm), shown(eye.high_mm)};
    std::sort(needs.begin(), needs.end());
    std::sort(has.begin(), has.end());
    const FixedPair low = fixed_apart(needs[0], finite(has[0]), 1);
    const FixedPair high = fixed_apart(needs[1], finite(has[1]), 1);
    return axes_words(eye.along) + (one ? " needs " : " need ") + low.value + " to " + high.value +
           " mm for the turns at the part's ends, " + (one ? "has " : "have ") +
           end_words(has[0], low.limit) + " to " + end_words(has[1], high.limit) + " mm";
}

std::string across_words(const EyeRange& eye, double needed_mm, double longest_fibre_mm) {
    if (needed_mm <= eye.farthest_mm) {
        return nearest_words(eye, longest_fibre_mm);
    }
    const FixedPair shown = fixed_apart(needed_mm, eye.farthest_mm, 1);
    const char* brings = eye.across.size() == 1 ? " brings it to " : " bring it to ";
    return "there the eye needs to be " + shown.value + " mm from the spindle axis; " +
           (eye.across.empty() ? "it stands at " : axes_words(eye.across) + brings) + shown.limit +
           " mm";
}

std::string nearest_words(const EyeRange& eye, double longest_fibre_mm) {
    return "the eye comes no nearer to the spindle axis than " + fixed(eye.nearest_mm, 1) + " mm" +
           (eye.across.empty() ? "" : " (" + axes_words(eye.across) + ")") +
           ", and the longest free fibre is " + fixed(longest_fibre_mm, 1) + " mm";
}

}  // namespace meshwind
