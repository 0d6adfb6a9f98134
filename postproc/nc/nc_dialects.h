/// The G-code dialects: one writer, one reader, and the peculiarities of each.
#pragma once

#include <string>
#include <string_view>

#include "postproc/nc/dialect.h"
#include "postproc/nc/nc_flavour.h"

namespace meshwind {

/// A dialect that is a flavour of G-code. All have in common: a head of comments, the modes and the
/// controller's header lines, the start position in rapid moves (rotary axes first, then the linear
/// ones together), the stop M0 for the tie-on, then one line of increments a block, the footer
/// lines and the end; nothing homes. `course 3` in a comment marks where piece 3 begins. ASCII, no
/// exponents; F has six digits and is never 0.
///
/// The reader takes G0 G1 G90 G91 (G93 G94), F, N, M0 M1, the ends and codes that change nothing.
/// Everything else is refused, and also: a rapid move after the first feed move (it would tear the
/// fibre), a position finer than the axis' resolution, an axis that no absolute word has placed
/// before the first feed move, a comment that begins with "tie on" but has another form or stands
/// twice, and a program without its end.
class NcDialect : public Dialect {
public:
    explicit NcDialect(const NcFlavour& flavour) : flavour_(flavour) {}

    [[nodiscard]] std::string name() const override { return std::string(flavour_.dialect); }
    [[nodiscard]] std::string extension() const override { return std::string(flavour_.extension); }
    [[nodiscard]] PathMode path_mode(const Machine& machine) const override;
    [[nodiscard]] bool has_junction_deviation() const override {
        return flavour_.junction_deviation_mm > 0.0;
    }
    [[nodiscard]] std::vector<double> run_times_s(const Machine& machine,
                                                  const BlockList& list) const override;
    [[nodiscard]] BlockList prepare(BlockList list) const override;
    [[nodiscard]] FoldedProgram fold(BlockList list) const override;
    using Dialect::write;
    [[nodiscard]] std::string write(const Machine& machine, const BlockList& list,
                                    const ProgramLayout& layout,
                                    const ProgramHeader& header) const override;
    [[nodiscard]] BlockList read(std::string_view text, const std::string& file,
                                 const Machine& machine) const override;
    [[nodiscard]] std::string code_of(std::string_view text,
                                      const std::string& file) const override;

private:
    const NcFlavour& flavour_;
};

/// Fanuc and the like, also two-axis winders with a rotary X (andrianov_2022_machine_path, Table
/// A2): `%`, `O0001 (TITLE)`, a point in every number (an integer may mean thousandths), G93 with F
/// on each line, M30, subprograms `O1001` .. `M99` behind it, called by `M98 P1001 L20`, `%`.
/// Letters X Y Z A B C U V W, each linear or rotary. G08 P and G05.1 Q may stand in the header.
class Fanuc final : public NcDialect {
public:
    Fanuc() : NcDialect(fanuc_flavour()) {}
};

/// Sinumerik 840D: `;` comments, G71, G93 with F on each line, M30. Repeated circuits stand once in
/// their place between labels and are run again by `REPEAT CIRCUIT_1 CIRCUIT_1_END P=19`, 19 times
/// more. The rotary axes must not be modulo axes, for the start is absolute and beyond 360 degrees.
/// SOFT, BRISK, DRIVE, FFWON, FFWOF, COMPOF, ADIS=, ADISPOS=, G60, G64 and G641 to G645 may stand
/// in the header.
class Siemens final : public NcDialect {
public:
    Siemens() : NcDialect(siemens_flavour()) {}
};

/// GRBL 1.1, grblHAL and their kin, letters X Y Z A B C, each linear or rotary: at most 79
/// characters a line, blanks and comments not counted, and eight digits a number, leading zeros
/// counted; F on each line, G93 or, with `per-minute`, G94 where F counts all axes, a degree as a
/// millimetre; M2; no subprograms. Lines behind the end would be run and are refused.
///
/// The controller adds increments up in 32-bit floats. `prepare` gives axes that this would take
/// off by more than half a step, mainly the mandrel, steps of 1/64 deg (float32_steps.h), whose
/// sums are exact up to 262 144 deg; 1/32 and 1/16 further on; beyond 1 048 576 deg it refuses.
/// Where the coarser step would be worse than the sums, the steps stay, and the head of the program
/// states the loss. Where a block turns 100 deg or more, eight digits leave 1/32, from 1000 on
/// 1/16; longer blocks are split.
class Grbl final : public NcDialect {
public:
    Grbl() : NcDialect(grbl_flavour()) {}
};

/// Marlin: one command a line, upper case, `;` comments, no feed modes, so `per-minute`: F is the
/// way of X Y Z (of U V W when they rest) in mm over the time, and deg/min where only A B C turn. A
/// B C are rotary, U V W linear, X Y Z either. A tiny linear move beside a turn would be run at the
/// axes' limits or hardly at all; `prepare` splits such blocks as for LinuxCNC. There is no end of
/// program; the comment `; end of program` closes the text, so that a truncated one is detected.
/// Sums of floats as with GRBL, with steps down to 1/256; a line has at most 95 characters. G21 and
/// M0 are unknown to some builds, which then answer `ok` and go on: try M0 before the fibre is tied
/// on. M17 M82 M83 M201 M203 M204 M205 M400 may stand in the header.
class Marlin final : public NcDialect {
public:
    Marlin() : NcDialect(marlin_flavour()) {}
};

}  // namespace meshwind
