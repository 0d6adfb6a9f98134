/// Header and footer lines of the machine file, with placeholders that are filled in.
#pragma once

#include <string>
#include <vector>

#include "machines/machine.h"

namespace meshwind {

/// Values of the placeholders in braces, as text.
struct LineValues {
    std::string program{};  ///< number
    std::string mandrel{};  ///< file name
    std::string machine{};
    std::string time_s{};   ///< one decimal
    std::string fibre_m{};  ///< three decimals
    std::string blocks{};   ///< count
    std::string version{};  ///< of meshwind
};

/// The lines with `{program}`, `{mandrel}`, `{machine}`, `{time_s}`, `{fibre_m}`, `{blocks}` and
/// `{version}` filled in. There is no date: the same input gives the same bytes.
/// \param place the machine's name, for messages
/// \throws InputError dialect.placeholder for another name, with those that exist, and for an open
/// brace
[[nodiscard]] std::vector<std::string> filled_lines(const std::vector<std::string>& lines,
                                                    const LineValues& values,
                                                    const std::string& place);

}  // namespace meshwind
