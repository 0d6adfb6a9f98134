/// Dialect of FANUC's robot controllers: TP programs in their text form.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "postproc/robot/robot_dialect.h"

namespace meshwind {

/// External axes 1 to 3 belong to the robot's group, 4 to 6 are the axes of a positioner.
inline constexpr RobotLanguage kTpLanguage = {
    .name = "tp",
    .extension = ".ls",
    .title = "FANUC's TP",
    .comments = NcComments::Exclamation,
    .external = {"E1", "E2", "E3", "J1 of GP2", "J2 of GP2", "J3 of GP2"},
    .not_in_comments = ";",
    .stand_in = ','};

/// External axes of group 1.
inline constexpr std::size_t kTpExtended = 3;

/// Instructions before the first move, in this order. Positions are of this frame and tool.
inline constexpr std::array<std::string_view, 2> kTpFirstLines = {"UFRAME_NUM=0", "UTOOL_NUM=1"};

/// Most that a block may take in whole milliseconds, and in tenths of a second, s.
inline constexpr double kTpMostFine_s = 32.0;
inline constexpr double kTpMost_s = 3200.0;

/// Most instructions of a program; the number of a line has 16 bits at the controller.
inline constexpr std::size_t kTpMostLines = 32'000;

/// TP: a block is a joint move to a position, which stands behind all moves, and its time: whole
/// milliseconds up to 32 s, whole tenths of a second up to 3200 s.
///
///     /PROG  WINDING
///     /ATTR
///     ..
///     DEFAULT_GROUP	= 1,*,*,*,*;
///     /MN
///        1:  !meshwind 0.1.0 ;
///        2:  !axes 1 to 6: A B C U V W, ;
///        3:  !J3 is C + B ;
///        4:  UFRAME_NUM=0 ;
///        5:  UTOOL_NUM=1 ;
///        6:J P[1] 10% FINE    ;
///        7:  PAUSE ;
///        8:  !course 0 ;
///        9:J P[2] 87msec CNT100    ;
///       10:J P[3] 120msec FINE    ;
///     /POS
///     P[1]{
///        GP1:
///     	UF : 0, UT : 1,
///     	J1=     3.113 deg,	J2=   -29.088 deg,	J3=    55.900 deg,
///     	J4=     3.757 deg,	J5=   -55.957 deg,	J6=    43.004 deg,
///     	E1=    -5.015 deg
///     };
///     ..
///     /END
///
/// A remark has 32 characters; one that is longer goes on behind "!+". All blocks but the last are
/// flown by (CNT100). Header and footer lines stand before the first move and behind the last, each
/// without number and semicolon: remarks and what moves nothing (kIdle in tp_reader.cpp).
///
/// The reader takes this form, the instructions line by line, positions wherever lines end.
/// \throws InputError nc.no_position and those of Krl when reading; dialect.too_many_lines when
/// writing
class Tp final : public RobotDialect {
public:
    Tp() : RobotDialect(kTpLanguage) {}

    [[nodiscard]] double tick_s() const override;
    [[nodiscard]] BlockList read(std::string_view text, const std::string& file,
                                 const Machine& machine) const override;
    /// Without the program's attributes but its groups, which a controller writes anew.
    [[nodiscard]] std::string code_of(std::string_view text,
                                      const std::string& file) const override;

private:
    [[nodiscard]] double sayable_s(double duration_s) const override;
    [[nodiscard]] std::string text_of(const RobotSource& source) const override;
};

/// A component of a position.
struct TpAxis {
    std::string name;       ///< "J1", "E1"
    std::size_t joint = 0;  ///< of the machine
};

/// The components of a group of axes.
struct TpGroup {
    std::string name;  ///< "GP1"
    std::vector<TpAxis> axes;
};

/// The robot with the axes that extend it, then the positioner where there is one.
[[nodiscard]] std::vector<TpGroup> tp_groups(const RobotAxes& axes);

/// FANUC counts axis 3 from the ground: J3 is the joint's angle plus this times that of axis 2.
/// \return 1 or -1, by whether the axes turn the same way; 0 unless they are parallel
[[nodiscard]] int tp_coupling(const Machine& machine, const RobotAxes& axes);

/// The attribute that says which groups move: "1,*,*,*,*", with a positioner "1,1,*,*,*".
[[nodiscard]] std::string tp_default_group(const RobotAxes& axes);

}  // namespace meshwind
