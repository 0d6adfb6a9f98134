/// Parses G-code of any flavour into blocks.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "machines/machine.h"
#include "postproc/motion/block.h"
#include "postproc/nc/nc_flavour.h"

namespace meshwind {

/// The blocks that the controller would run. Taken are G0 G1 G90 G91 G93 G94, F, N, M0 M1, the ends
/// and the flavour's harmless codes; in programs that are not by meshwind more codes
/// (foreign_notes.h), with a remark in the list's head for each ambiguity.
/// \param file name used in messages
/// \throws InputError nc.* with the place "file:line" for anything else
[[nodiscard]] BlockList read_nc(const NcFlavour& flavour, std::string_view text,
                                const std::string& file, const Machine& machine);

/// Checks a header or footer line of the machine file: it must be one that the reader takes, and
/// must neither move nor end the program nor tie the fibre on.
/// \throws InputError dialect.header_line
void check_own_line(const NcFlavour& flavour, const Machine& machine, const std::string& line);

/// Path mode at corners that the machine's own header lines set. Lines that cannot be used
/// (check_own_line) set none. \throws InputError dialect.placeholder
[[nodiscard]] PathMode path_mode_of(const NcFlavour& flavour, const Machine& machine);

/// Dialect::code_of. \throws InputError nc.comment
[[nodiscard]] std::string code_of_nc(NcComments comments, std::string_view text,
                                     const std::string& file);

/// Whether a comment belongs to the code: where the fibre is tied on, where pins stand.
[[nodiscard]] bool is_code_comment(std::string_view comment);

/// Text as lines without their ends.
[[nodiscard]] std::vector<std::string_view> lines_of_text(std::string_view text);

/// An instruction in the text form of a TP program (FANUC's robots), which parts long remarks:
/// "12:  !words ;" and, behind "!+", what goes on from the remark before.
struct TpLine {
    std::string text{};     ///< without number and semicolon; a whole remark behind "! "
    std::int32_t line = 0;  ///< of the program, from 1
    bool is_whole = false;  ///< it has both; else the text is as it stands
};

/// What stands between /MN and /POS; nothing in programs of other languages.
[[nodiscard]] std::vector<TpLine> tp_lines(std::string_view program);

/// The texts of these, a line each.
[[nodiscard]] std::string tp_text(const std::vector<TpLine>& lines);

/// The comments with a meaning: "course 3", "tie on at X1.000 Y2.000 Z3.000 on the mandrel",
/// "code digest: 0f..".
class NcMarks {
public:
    /// \throws InputError nc.tie_on, nc.pins
    void read(const NcLine& line, BlockList& list);
    [[nodiscard]] std::int32_t piece() const { return piece_; }

private:
    static void tie_on(const NcLine& line, std::string_view comment, BlockList& list);
    static void pins(const NcLine& line, std::string_view comment, BlockList& list);
    static void head(std::string_view comment, BlockList& list);
    std::int32_t piece_ = -1;
};

}  // namespace meshwind
