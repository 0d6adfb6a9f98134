#include "postproc/robot/float32_positions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/error.h"
#include "core/text/text_number.h"
#include "postproc/nc/float32_steps.h"

namespace meshwind {
namespace {

// Half the coarsest step, mm or deg.
constexpr double kMaxRounding = 0.5 / (1 << kCoarsestBinary);

// Largest distance of an axis' positions from what the controller holds, mm or deg.
double rounding(const BlockList& list, std::size_t axis) {
    double worst = 0.0;
    for (std::size_t b = 0; b < list.blocks.size(); ++b) {
        const double value = list.value(b, axis);
        worst = std::max(worst, std::abs(static_cast<double>(static_cast<float>(value)) - value));
    }
    return worst;
}

}  // namespace

void check_float32(const BlockList& list, const std::string& controller) {
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        if (const double off = rounding(list, a); off > kMaxRounding) {
            throw InputError(
                "dialect.float32", std::string("axis ") + list.axes[a].letter,
                "goes so far that " + controller +
                    ", which keeps positions in 32-bit floats, would be off by up to " +
                    fixed(off, 3) + " mm or deg; wind layer by layer, homing between");
        }
    }
}

std::vector<std::string> float32_notes(const BlockList& list) {
    std::vector<std::string> notes;
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        const double step =
            static_cast<double>(list.axes[a].resolution_nano) / static_cast<double>(kNanoPerUnit);
        if (const double off = rounding(list, a); off > 0.5 * step) {
            notes.push_back(std::string("axis ") + list.axes[a].letter + " is off by up to " +
                            fixed(off, 4) + " at the controller, which keeps 32-bit floats");
        }
    }
    return notes;
}

}  // namespace meshwind
