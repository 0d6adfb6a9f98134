#include "postproc/robot/robot_axes.h"

#include <algorithm>
#include <vector>

#include "core/error.h"

namespace meshwind {
namespace {

[[noreturn]] void refuse(const Machine& machine, const std::string& words) {
    throw InputError("dialect.robot_axes", machine.name, words);
}

// All axes that are not the arm's, in their order.
void number_others(const Machine& machine, std::vector<bool>& numbered, RobotAxes& axes) {
    if (machine.axis_count() > kArmAxes + kMaxExternalAxes) {
        refuse(machine, "it has " + std::to_string(machine.axis_count() - kArmAxes) +
                            " axes beside the robot's six; a robot's program has at most six "
                            "external axes");
    }
    std::size_t number = 0;
    for (std::size_t joint = 0; joint < numbered.size(); ++joint) {
        if (!numbered[joint]) {
            axes.external[number++] = joint;
            numbered[joint] = true;
        }
    }
}

}  // namespace

RobotAxes robot_axes(const Machine& machine) {
    const Controller& controller = machine.controller;
    RobotAxes axes;
    std::vector<bool> numbered(machine.axis_count(), false);
    if (controller.robot_axes.empty() && machine.eye_chain.size() < kArmAxes) {
        refuse(machine, "its eye chain has " + std::to_string(machine.eye_chain.size()) +
                            " axes; a robot's program needs the six of an arm there");
    }
    for (std::size_t i = 0; i < kArmAxes; ++i) {
        axes.arm[i] = controller.robot_axes.empty() ? machine.axis_count() - kArmAxes + i
                                                    : *machine.joint_of(controller.robot_axes[i]);
        numbered[axes.arm[i]] = true;
        const Axis& axis = machine.axis(axes.arm[i]);
        if (axis.type != AxisType::Rotary) {
            refuse(machine, std::string("axis ") + axis.letter + " would be axis " +
                                std::to_string(i + 1) +
                                " of the robot and is linear; name the arm's six under "
                                "\"robot_axes\"");
        }
    }
    if (controller.external_axes.empty()) {
        number_others(machine, numbered, axes);
    }
    for (std::size_t i = 0; i < controller.external_axes.size(); ++i) {
        if (controller.external_axes[i] != '-') {
            axes.external[i] = *machine.joint_of(controller.external_axes[i]);
            if (numbered[*axes.external[i]]) {
                refuse(machine, std::string("axis ") + controller.external_axes[i] +
                                    " is one of the robot's six and cannot be external as well");
            }
            numbered[*axes.external[i]] = true;
        }
    }
    const auto left = std::find(numbered.begin(), numbered.end(), false);
    if (left != numbered.end()) {
        const auto joint = static_cast<std::size_t>(left - numbered.begin());
        refuse(machine, std::string("axis ") + machine.axis(joint).letter +
                            " has no number at the robot; name it under \"external_axes\"");
    }
    return axes;
}

std::string robot_axes_words(const RobotAxes& axes, const Machine& machine,
                             const std::array<const char*, kMaxExternalAxes>& names) {
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

}  // namespace meshwind
