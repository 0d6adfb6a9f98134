/// Programs for LinuxCNC (RS274/NGC): incremental, inverse-time feed.
#pragma once

#include "postproc/nc/nc_dialects.h"

namespace meshwind {

/// Form of a program: header comments, G21 G90 and the controller's header lines, the start
/// position in rapid moves (rotary axes first, then the linear ones together), the stop M0 for the
/// tie-on, then G91 G93 and one line per block: `G1`, the increments of the axes that move, and F =
/// 60 / duration.
/// `(course 3)` marks where piece 3 begins, `(tie on at X70.000 Y0.000 Z-1.500 on the mandrel)` in
/// the head is where the fibre starts (mm in the mandrel frame). The footer lines and M2 close it;
/// nothing homes.
///
/// Repeated circuits stand behind M2 as `O1001` .. `M99` and are called by `M98 P1001 L20`. They
/// carry no course marks; the mark before a call is that of its first block.
///
/// Limits of the interpreter that are kept: lines of at most 252 characters, ASCII without nested
/// brackets in comments, no exponents, F with six digits on every G1 line and never 0.
/// Interpreters before May 2023 run a G93 line of linear length l at a feed of at least 0.1 mm/min
/// (l * F), so a tiny linear move beside a long turn makes the turn far too fast; `prepare` splits
/// such blocks into a short one with the whole linear move and one that only turns.
///
/// The reader takes G0 G1 G21 G90 G91 G93 G94, F, N, M0 M1 M2 M30, comments, `%`, subprograms and
/// repeats (postproc/nc/linuxcnc_flow.h), which it follows as the interpreter does, and skips G17
/// G40 G49 G54 G61 G61.1 G64 (with P and Q) G80. Everything else is refused, and also: a rapid move
/// after the first feed move (it would tear the fibre), a position finer than the axis' resolution,
/// an axis that no absolute word has placed before the first feed move, a comment that begins with
/// "tie on" but has another form or stands twice, and a file without M2, M30 or a closing `%`.
/// Source: linuxcnc_g_code, g-code.adoc (G93, G64), machining-center.adoc (feed rate).
class LinuxCnc final : public NcDialect {
public:
    LinuxCnc() : NcDialect(linuxcnc_flavour()) {}
};

/// Characters of a line that the interpreter still reads, comments included.
inline constexpr std::size_t kLinuxCncLineLength = 252;

}  // namespace meshwind
