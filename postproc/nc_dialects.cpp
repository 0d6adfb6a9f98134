#include "postproc/nc_dialects.h"

#include <limits>
#include <utility>

#include "postproc/float32_steps.h"
#include "postproc/linuxcnc.h"
#include "postproc/linuxcnc_words.h"
#include "postproc/nc_reader.h"
#include "postproc/nc_writer.h"

namespace meshwind {
namespace {

// Numbers of subprograms have four digits.
constexpr std::size_t kMostSubprograms = 8000;

}  // namespace

BlockList NcDialect::prepare(BlockList list) const {
    if (flavour_.float32 != Float32Text::None) {
        list =
            split_long_numbers(with_binary_steps(std::move(list), flavour_), flavour_.most_digits);
    }
    return split_slow_linear(std::move(list), flavour_.slow_linear);
}

FoldedProgram NcDialect::fold(BlockList list) const {
    if (flavour_.repeats == NcRepeats::None) {
        return {std::move(list), {}};
    }
    FoldedProgram folded = fold_repeats(list);
    // A corrected block might have become one that the controller runs too fast.
    if (has_slow_linear(folded.list, flavour_.slow_linear) ||
        folded.layout.subprograms.size() > kMostSubprograms) {
        return {std::move(list), {}};
    }
    return folded;
}

std::string NcDialect::write(const Machine& machine, const BlockList& list,
                             const ProgramLayout& layout, const ProgramHeader& header) const {
    return write_nc(flavour_, machine, list, layout, header);
}

BlockList NcDialect::read(std::string_view text, const std::string& file,
                          const Machine& machine) const {
    return read_nc(flavour_, text, file, machine);
}

double LinuxCnc::corner_tolerance_mm(const Machine& machine) const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    double tolerance_mm = kNone;
    for (const std::string& text : machine.controller.header) {
        NcLine line;
        line.file = &machine.name;
        line.split(text);
        bool blends = false;
        std::int64_t nano = 0;
        for (const NcWord& word : line.words) {
            blends = blends || (word.letter == 'G' && line.code(word) == 640);
            nano = word.letter == 'P' ? line.nano(word) : nano;
        }
        if (blends) {
            tolerance_mm =
                nano > 0 ? static_cast<double>(nano) / static_cast<double>(kNanoPerUnit) : kNone;
        }
    }
    return tolerance_mm;
}

}  // namespace meshwind
