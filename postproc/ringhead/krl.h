/// Programs for KUKA robots: linear moves through absolute frames, written and read back.
///
/// A program is
///     &ACCESS RVP
///     DEF name( )
///     ; comments
///     BAS(#INITMOV,0)
///     $BASE={X 0.0000,Y 0.0000,Z 0.0000,A 0.00000,B 0.00000,C 0.00000}
///     $TOOL={..}
///     $ADVANCE=3
///     $ORI_TYPE=#VAR
///     $APO.CDIS=0.5000
///     PTP {A1 0.00000,..,A6 0.00000}       all six, so that the block coincidence is defined
///     $VEL.CP=0.020000                     m/s; only where it changes, as the next two, in deg/s
///     $VEL.ORI1=400.0000
///     $VEL.ORI2=400.0000
///     LIN {X ..,Y ..,Z ..,A ..,B ..,C ..}           exact stop at the start
///     HALT                                 tie the fibre on
///     LIN {..} C_DIS                       and so on; the last without C_DIS
///     END
/// All points are absolute, so that nothing adds up.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "machines/machine.h"

namespace meshwind {

/// The dialect of machines that carry; its programs are no lists of axis blocks (dialect.h).
inline constexpr const char* kCarryDialect = "krl";

/// Whether a machine's programs are those for carrying: in the dialect, and its eye stands still.
[[nodiscard]] bool carries_frames(const Machine& machine);

/// Extension of the program's file, with the point.
inline constexpr const char* kKrlExtension = ".src";

/// Decimals of a program: 0.05 um, and 9e-8 rad, which is 0.1 um at a metre.
inline constexpr int kKrlLengthDecimals = 4;
inline constexpr int kKrlAngleDecimals = 5;

/// X, Y, Z in 1e-9 mm and A, B, C in 1e-9 deg, multiples of a program's last digit.
struct KrlFrame {
    std::array<std::int64_t, 6> nano{};

    friend bool operator==(const KrlFrame&, const KrlFrame&) = default;
};

/// Rounded to the decimals of a program; the angles of euler_zyx without previous ones.
/// \throws InputError krl.too_far beyond +-1e6 mm
[[nodiscard]] KrlFrame krl_frame(const Eigen::Isometry3d& pose);

[[nodiscard]] Eigen::Isometry3d pose_of(const KrlFrame& frame);

/// A linear move to a frame; the slowest of way, swivel and spin (ring_head.h) sets its time.
struct KrlMove {
    KrlFrame to;
    std::int64_t path_nano_m_s = 0;  ///< $VEL.CP, 1e-9 m/s, a multiple of 1e-6 m/s, > 0
    std::int64_t turn_nano_deg_s =
        0;                  ///< $VEL.ORI1 and 2, 1e-9 deg/s, a multiple of 1e-4 deg/s, > 0
    std::int32_t line = 0;  ///< of the file it was read from; 0 when planned

    friend bool operator==(const KrlMove& a, const KrlMove& b) {
        return a.to == b.to && a.path_nano_m_s == b.path_nano_m_s &&
               a.turn_nano_deg_s == b.turn_nano_deg_s;
    }
};

/// Speeds in whole steps of a program's last digit, rounded up and at least one: never slower than
/// asked.
[[nodiscard]] std::int64_t krl_path_speed(double m_s);
[[nodiscard]] std::int64_t krl_turn_speed(double deg_s);

struct KrlProgram {
    std::string
        name;       ///< of the DEF and of the file: a letter, then letters, digits, _; 24 at most
    KrlFrame base;  ///< the frames below count in it
    KrlFrame tool;  ///< TCP on the flange
    std::array<std::int64_t, 6> start_nano{};  ///< A1 .. A6 of the first move, 1e-9 deg
    std::vector<KrlMove> moves;  ///< the first: to the start, before the fibre is tied on

    friend bool operator==(const KrlProgram&, const KrlProgram&) = default;
};

/// Approximation distance for rounding corners ($APO.CDIS). C_DIS begins this far before a point,
/// or half a move where that is shorter.
inline constexpr double kKrlApproximation_mm = 0.5;

/// \param comments a line each behind DEF; characters other than printable ASCII are written as "?"
/// \param header lines of the machine file, put before the first move as they are
/// \throws InputError krl.name, krl.header_line; \pre two moves or more
[[nodiscard]] std::string write_krl(const KrlProgram& program,
                                    const std::vector<std::string>& comments,
                                    const std::vector<std::string>& header = {});

/// Reads what write_krl writes: frames and speeds to the last digit. \param file name in messages
/// \throws InputError krl.not_understood, krl.number, krl.no_end, krl.no_motion, with file:line
[[nodiscard]] KrlProgram read_krl(std::string_view text, const std::string& file);

/// Seconds that each move takes at its speeds; the first takes none.
[[nodiscard]] std::vector<double> durations_s(const KrlProgram& program);

/// Name of the program that winds on the way back, for that of the way forth; both without
/// extension.
[[nodiscard]] std::string carried_back(const std::string& program);

}  // namespace meshwind
