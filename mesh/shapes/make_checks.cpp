#include "mesh/shapes/make_checks.h"

#include <cmath>
#include <string>

#include "core/error.h"
#include "core/text/text_number.h"

namespace meshwind {
namespace {

std::string text_of(double value) {
    if (!std::isfinite(value)) {
        return std::isnan(value) ? "not a number" : "infinity";
    }
    std::string text;
    append_shortest(text, value);
    return text;
}

}  // namespace

void require_positive(const char* name, double value) {
    if (!(value > 0.0) || std::isinf(value)) {
        throw InputError("make.not_positive", name,
                         text_of(value) + " must be a finite number > 0");
    }
}

void require_not_negative(const char* name, double value) {
    if (!(value >= 0.0) || std::isinf(value)) {
        throw InputError("make.negative", name, text_of(value) + " must be a finite number >= 0");
    }
}

void require(bool holds, const char* code, const char* name, double value, const char* rule,
             double limit) {
    if (!holds) {
        throw InputError(code, name, text_of(value) + " must be " + rule + " " + text_of(limit));
    }
}

}  // namespace meshwind
