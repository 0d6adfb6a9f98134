#include "postproc/robot/robot_axes.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/error.h"
#include "core/text/text_number.h"

namespace meshwind {
namespace {

double units(std::int64_t nano) {
    return static_cast<double>(nano) / static_cast<double>(kNanoPerUnit);
}

}  // namespace

RobotAxes robot_axes(const Machine& machine) {
    const std::size_t count = machine.axis_count();
    const auto refuse = [&](const std::string& words) {
        throw InputError("dialect.robot_axes", machine.name, words);
    };
    if (machine.eye_chain.size() < kArmAxes) {
        refuse("its eye chain has " + std::to_string(machine.eye_chain.size()) +
               " axes; a robot's program needs the six of an arm there");
    }
    if (count > kArmAxes + kMostExternalAxes) {
        refuse("it has " + std::to_string(count - kArmAxes) +
               " axes beside the robot's six; a robot's program has at most six external axes");
    }
    RobotAxes axes;
    for (std::size_t i = 0; i < kArmAxes; ++i) {
        axes.arm[i] = count - kArmAxes + i;
        const Axis& axis = machine.axis(axes.arm[i]);
        if (axis.type != AxisType::Rotary) {
            refuse(std::string("axis ") + axis.letter + " would be axis " + std::to_string(i + 1) +
                   " of the robot and is linear; the last six axes of the eye chain are the "
                   "robot's");
        }
    }
    for (std::size_t joint = 0; joint < count - kArmAxes; ++joint) {
        axes.external[joint] = joint;
    }
    return axes;
}

std::string robot_axes_words(const RobotAxes& axes, const Machine& machine,
                             const std::array<const char*, kMostExternalAxes>& names) {
    std::string words = "axes 1 to 6:";
    for (const std::size_t joint : axes.arm) {
        words += std::string(" ") + machine.axis(joint).letter;
    }
    const char* before = "; external: ";
    for (std::size_t i = 0; i < axes.external.size(); ++i) {
        if (axes.external[i]) {
            words += before;
            words += std::string(1, machine.axis(*axes.external[i]).letter) + " is " + names[i];
            before = ", ";
        }
    }
    return words;
}

double float32_rounding(const BlockList& list, std::size_t axis) {
    double worst = 0.0;
    for (std::size_t b = 0; b < list.blocks.size(); ++b) {
        const double value = list.value(b, axis);
        worst = std::max(worst, std::abs(static_cast<double>(static_cast<float>(value)) - value));
    }
    return worst;
}

void check_float32(const BlockList& list, const std::string& controller) {
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        if (float32_rounding(list, a) > kMostRounding) {
            throw InputError(
                "dialect.float32", std::string("axis ") + list.axes[a].letter,
                "goes so far that " + controller +
                    ", which keeps positions in 32-bit floats, would be off by up to " +
                    fixed(float32_rounding(list, a), 3) +
                    " mm or deg; wind layer by layer, homing between");
        }
    }
}

std::vector<std::string> float32_notes(const BlockList& list) {
    std::vector<std::string> notes;
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        const double off = float32_rounding(list, a);
        if (off > 0.5 * units(list.axes[a].resolution_nano)) {
            notes.push_back(std::string("axis ") + list.axes[a].letter + " is off by up to " +
                            fixed(off, 4) + " at the controller, which keeps 32-bit floats");
        }
    }
    return notes;
}

void check_moves(const BlockList& list) {
    for (std::size_t i = 1; i < list.blocks.size(); ++i) {
        const std::span<const std::int64_t> now = list.row(i);
        const bool rests = std::equal(now.begin(), now.end(), list.row(i - 1).begin());
        if (rests || !(list.blocks[i].duration_s > 0.0)) {
            throw InputError("dialect.duration", "block " + std::to_string(i),
                             rests ? "moves no axis, so that it would last no time; join it with "
                                     "the next one"
                                   : "takes no time; give every block a duration above 0");
        }
    }
}

}  // namespace meshwind
