/// Dialect of ABB's robot controllers (IRC5 and OmniCore).
#pragma once

#include <string>
#include <string_view>

#include "postproc/robot/robot_dialect.h"

namespace meshwind {

inline constexpr RobotLanguage kRapidLanguage = {
    .name = "rapid",
    .extension = ".mod",
    .title = "RAPID",
    .comments = NcComments::Exclamation,
    .external = {"eax_a", "eax_b", "eax_c", "eax_d", "eax_e", "eax_f"}};  // as jointtarget has them

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
/// 9E9. Header and footer lines stand in `main`, before the first move and behind the last:
/// comments, and instructions that move nothing (kIdle in rapid_reader.cpp).
///
/// The reader takes this form, wherever lines end. A move without `\T` before the first block leads
/// to the start; a block that is not the last and ends at a fine point is refused, for the fibre
/// would stop there and its time would be another.
/// \throws InputError nc.stop_point, nc.not_understood, nc.number, nc.no_axis, nc.feed, nc.rapid,
/// nc.resolution, nc.too_far, nc.unknown_start, nc.no_end, nc.no_motion, nc.too_many_lines when
/// reading
class Rapid final : public RobotDialect {
public:
    Rapid() : RobotDialect(kRapidLanguage) {}

    [[nodiscard]] BlockList read(std::string_view text, const std::string& file,
                                 const Machine& machine) const override;
    /// Statements, a line each, of tokens with a blank between; numbers as short as they can be.
    [[nodiscard]] std::string code_of(std::string_view text,
                                      const std::string& file) const override;

private:
    [[nodiscard]] std::string text_of(const RobotSource& source) const override;
};

}  // namespace meshwind
