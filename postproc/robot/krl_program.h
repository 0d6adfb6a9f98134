/// Dialect of KUKA's robot controllers (KSS 8) for the main job.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "postproc/robot/robot_dialect.h"

namespace meshwind {

inline constexpr RobotLanguage kKrlLanguage = {
    .name = "krl",
    .extension = ".src",
    .title = "KRL",
    .comments = NcComments::Semicolon,
    .external = {"E1", "E2", "E3", "E4", "E5", "E6"}};  // as an E6AXIS has them

/// Most segments of a spline block. The controller plans a block as a whole before it moves, and
/// takes a limited number of time parts; 50 take 2 s or so to wind.
inline constexpr std::size_t kKrlSegments = 50;

/// KRL: a block is a segment of a PTP spline, the absolute positions of all axes and behind them
/// the share of the time of its spline block. Shares are seconds, and the time of the spline block
/// is their sum, to 1e-9 s. (Increments, SPTP_REL, would add up roundings of 32-bit floats.)
///
///     &ACCESS RVP
///     DEF program( )
///     ; meshwind 0.1.0
///     ; axes 1 to 6: A B C U V W; external: X is E1
///     BAS(#INITMOV,0)
///     $ADVANCE=3
///     $APO.CPTP=50
///     $APO.CDIS=5
///     BAS(#VEL_PTP,10)
///     BAS(#ACC_PTP,20)
///     PTP {A1 3.113,A2 -29.088,A3 84.988,A4 3.757,A5 -55.957,A6 43.004,E1 -5.015}
///     ; tie the fibre on at the landing point, then start again
///     HALT
///     BAS(#VEL_PTP,100)
///     BAS(#ACC_PTP,100)
///     PTP_SPLINE
///     TIME_BLOCK START
///     ; course 0
///     SPTP {A1 2.391,A2 -29.119,A3 85.073,A4 2.885,A5 -55.988,A6 43.495,E1 -26.711}
///     TIME_BLOCK PART=0.0865582
///     TIME_BLOCK END=0.0865582
///     ENDSPLINE
///     END
///
/// All spline blocks but the last flow into the next (C_SPL). The reader refuses one that does not,
/// for the fibre would stop there. Header and footer lines stand before the first move and behind
/// the last: comments, $TOOL, $BASE, $LOAD, $OUT[], $ANOUT[], BAS(#TOOL,..), BAS(#BASE,..).
///
/// The reader takes this form line by line, in small or capital letters.
/// \throws InputError nc.word_twice and those of Rapid when reading
class Krl final : public RobotDialect {
public:
    Krl() : RobotDialect(kKrlLanguage) {}

    [[nodiscard]] BlockList read(std::string_view text, const std::string& file,
                                 const Machine& machine) const override;
    [[nodiscard]] std::string code_of(std::string_view text,
                                      const std::string& file) const override;

private:
    [[nodiscard]] std::string text_of(const RobotSource& source) const override;
};

}  // namespace meshwind
