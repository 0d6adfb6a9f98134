/// The controller of a machine file.
#pragma once

#include "core/text/key_table.h"
#include "core/text/strict_json.h"
#include "machines/machine.h"

namespace meshwind {

[[nodiscard]] const KeyTable<Controller>& controller_keys();

/// Checks that the letters of a robot's axes are those of the machine's axes, and each has one
/// number. \param value of the file's "controller" \throws InputError machine.robot_axes
void check_robot_letters(const JsonValue& value, const Machine& machine);

}  // namespace meshwind
