/// Turns and moves the frame of a machine file so that the spindle is its Z axis.
#pragma once

#include "machines/machine.h"

namespace meshwind {

/// The machine in the frame of its spindle. The closed forms of the inverse hold there:
/// - Z lies along the spindle: towards the mandrel's z where the machine has a mount, else along
/// the
///   direction of its axis;
/// - X points from the spindle to the head: against the exit; of an arm, to its first rotary axis;
/// - the origin is the point of the spindle nearest to the origin of the file.
///
/// In pictures the Z of a file whose spindle is not along Z is up.
///
/// Axes keep letters, signs and zeros, so a joint vector means the same in both frames. Without a
/// mount the mandrel frame at zero is the frame of the spindle. A machine whose spindle is the Z
/// axis of its file stays as it is, and so does one that has no spindle, or for whose X the file
/// gives no direction at a right angle to it.
[[nodiscard]] Machine in_spindle_frame(Machine machine);

}  // namespace meshwind
