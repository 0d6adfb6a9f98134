/// Dialect of ABB's robot controllers (IRC5 and OmniCore).
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "postproc/nc/dialect.h"
#include "postproc/robot/robot_axes.h"

namespace meshwind {

/// Names of the external axes, as jointtarget has them.
inline constexpr std::array<const char*, kMaxExternalAxes> kRapidExternal = {
    "eax_a", "eax_b", "eax_c", "eax_d", "eax_e", "eax_f"};

/// RAPID: a module with one procedure `main`, in which a line is a block: the absolute positions of
/// all axes, and the block's time under `\T`, which replaces the speed (RAPID has no increments of
/// joints).
///
///     MODULE meshwind
///     ! meshwind 0.1.0
///     ! axes 1 to 6: A B C U V W; external: X is eax_a
///     CONST speeddata approach:=[50,20,50,30];
///     CONST zonedata corner:=[FALSE,10,15,15,15,15,45];
///     PROC main()
///     MoveAbsJ [[..],[0.000,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,approach,fine,tool0;
///     TPWrite "tie the fibre on at the landing point, then start again";
///     Stop;
///     ! course 0
///     MoveAbsJ [[..],[11.250,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v1000\T:=0.12,corner,tool0;
///     ENDPROC
///     ENDMODULE
///
/// The last block ends at a fine point; all others are flown by within the zone `corner`, of
/// which the controller takes at most half of a block's way. Axes that the robot does not have get
/// 9E9. The controller reads a number into a 32-bit float; positions are absolute, so that nothing
/// adds up, and `float32_notes` stand in the head. Header and footer lines stand in `main`, before
/// the first move and behind the last: comments, and instructions that move nothing (kIdle in
/// rapid_reader.cpp).
///
/// The reader takes this form, wherever lines end. A move without `\T` before the first block leads
/// to the start; a block that is not the last and ends at a fine point is refused, for the fibre
/// would stop there and its time would be another.
/// \throws InputError dialect.robot_axes besides what a dialect throws; nc.stop_point,
/// nc.not_understood, nc.number, nc.no_axis, nc.feed, nc.rapid, nc.resolution, nc.too_far,
/// nc.unknown_start, nc.no_end, nc.no_motion, nc.too_many_lines when reading
class Rapid final : public Dialect {
public:
    [[nodiscard]] std::string name() const override { return "rapid"; }
    [[nodiscard]] std::string extension() const override { return ".mod"; }
    [[nodiscard]] std::vector<double> run_times_s(const Machine& machine,
                                                  const BlockList& list) const override;
    [[nodiscard]] BlockList prepare(BlockList list) const override;
    using Dialect::write;
    [[nodiscard]] std::string write(const Machine& machine, const BlockList& list,
                                    const ProgramLayout& layout,
                                    const ProgramHeader& header) const override;
    [[nodiscard]] BlockList read(std::string_view text, const std::string& file,
                                 const Machine& machine) const override;
    /// Statements, a line each, of tokens with a blank between; numbers as short as they can be.
    [[nodiscard]] std::string code_of(std::string_view text,
                                      const std::string& file) const override;
};

}  // namespace meshwind
