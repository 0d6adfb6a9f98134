#include "postproc/nc/nc_dialects.h"

#include <utility>

#include "postproc/nc/float32_steps.h"
#include "postproc/nc/nc_reader.h"
#include "postproc/nc/nc_writer.h"

namespace meshwind {
namespace {

// Numbers of subprograms have four digits.
constexpr std::size_t kMaxSubprograms = 8000;

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
        folded.layout.subprograms.size() > kMaxSubprograms) {
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

std::string NcDialect::code_of(std::string_view text, const std::string& file) const {
    return code_of_nc(flavour_.comments, text, file);
}

PathMode NcDialect::path_mode(const Machine& machine) const {
    return path_mode_of(flavour_, machine);
}

std::vector<double> NcDialect::run_times_s(const Machine& machine, const BlockList& list) const {
    return nc_run_times_s(flavour_, machine, list);
}

}  // namespace meshwind
