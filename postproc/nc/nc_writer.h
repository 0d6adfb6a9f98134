/// Writes blocks as G-code of any flavour.
#pragma once

#include <string>
#include <vector>

#include "machines/machine.h"
#include "postproc/motion/block.h"
#include "postproc/nc/dialect.h"
#include "postproc/nc/header_lines.h"
#include "postproc/nc/nc_flavour.h"

namespace meshwind {

/// The program of prepared blocks, by the layout.
/// \pre list has the axes of the machine and at least one block
/// \throws InputError dialect.axis_letter, dialect.feed, dialect.header_line, dialect.placeholder,
/// dialect.duration, dialect.digits, dialect.long_line
[[nodiscard]] std::string write_nc(const NcFlavour& flavour, const Machine& machine,
                                   const BlockList& list, const ProgramLayout& layout,
                                   const ProgramHeader& header);

/// Dialect::run_times_s of the flavour.
[[nodiscard]] std::vector<double> nc_run_times_s(const NcFlavour& flavour, const Machine& machine,
                                                 const BlockList& list);

/// Their sum.
[[nodiscard]] double nc_run_time_s(const NcFlavour& flavour, const Machine& machine,
                                   const BlockList& list);

/// The head's comments, one entry each and of any length: who made the program, of what, how long
/// it takes, where the fibre is tied on, the needs of float sums, notes.
/// \param time_s nc_run_time_s, which takes longer than the rest
[[nodiscard]] std::vector<std::string> head_comments(const NcFlavour& flavour,
                                                     const Machine& machine, const BlockList& list,
                                                     const ProgramHeader& header, double time_s);

/// Values of the placeholders in header and footer lines, fit for a comment of the flavour.
/// \param time_s as for the head
[[nodiscard]] LineValues line_values(const NcFlavour& flavour, const Machine& machine,
                                     const BlockList& list, const ProgramHeader& header,
                                     double time_s);

/// Words as comments of the flavour, in as many lines as they need.
[[nodiscard]] std::string comment_lines(const NcFlavour& flavour, std::string words);

}  // namespace meshwind
