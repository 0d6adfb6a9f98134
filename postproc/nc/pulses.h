/// Dialect of whole pulses per tick, for step drivers that take nothing else.
#pragma once

#include <string>
#include <string_view>

#include "postproc/nc/dialect.h"

namespace meshwind {

/// Duration of a tick: a usual cycle of interface cards that generate pulses (10 ms).
inline constexpr double kPulseTick_s = 0.01;

/// A table of text with a line for each tick: the pulses of each axis, of one step of its
/// resolution each. `;` begins a comment; course and tie-on are marked in comments as in G-code.
/// Header and footer lines of the controller must be comments.
///
///     axes C Z X
///     step 0.001 0.001 0.001
///     tick_s 0.01
///     start -63.666 141.421 157.797
///     ; course 0
///     block 3
///     -965 1179 0
///     -964 1178 0
///     -965 1179 0
///     end
///
/// `start` is the position of the machine before the first tick; getting there and tying the fibre
/// on is up to the operator. The rounding remainder of a tick is carried into the next, so the
/// running sum is within half a step of the straight line from each block's start to its end, and
/// exact at its end. `prepare` makes blocks last whole ticks, never shorter than planned; a time
/// law with tick_s() leaves it nothing to do. A driver that runs ticks as they are has no ramps
/// between blocks: where the time law leaves room for a ramp, velocity then jumps.
///
/// The reader takes this form alone, and each block only when its ticks are even in this sense; the
/// feed mode of the machine file has no effect.
/// \throws InputError nc.pulses for a line of another form, besides nc.number, nc.resolution,
/// nc.tie_on, nc.no_end, nc.no_motion, nc.too_many_lines; dialect.duration when a program would
/// have more ticks than are read back
class Pulses final : public Dialect {
public:
    [[nodiscard]] std::string name() const override { return "pulses"; }
    [[nodiscard]] std::string extension() const override { return ".pulses"; }
    [[nodiscard]] double tick_s() const override { return kPulseTick_s; }
    [[nodiscard]] std::vector<double> run_times_s(const Machine& machine,
                                                  const BlockList& list) const override;
    [[nodiscard]] BlockList prepare(BlockList list) const override;
    using Dialect::write;
    [[nodiscard]] std::string write(const Machine& machine, const BlockList& list,
                                    const ProgramLayout& layout,
                                    const ProgramHeader& header) const override;
    [[nodiscard]] BlockList read(std::string_view text, const std::string& file,
                                 const Machine& machine) const override;
    [[nodiscard]] std::string code_of(std::string_view text,
                                      const std::string& file) const override;
};

}  // namespace meshwind
