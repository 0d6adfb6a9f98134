#include "postproc/nc/header_lines.h"

#include <array>
#include <string_view>
#include <utility>

#include "core/error.h"

namespace meshwind {
namespace {

using Field = std::pair<std::string_view, std::string LineValues::*>;

constexpr std::array<Field, 7> kFields = {{{"program", &LineValues::program},
                                           {"mandrel", &LineValues::mandrel},
                                           {"machine", &LineValues::machine},
                                           {"time_s", &LineValues::time_s},
                                           {"fibre_m", &LineValues::fibre_m},
                                           {"blocks", &LineValues::blocks},
                                           {"version", &LineValues::version}}};

[[noreturn]] void unknown(const std::string& line, const std::string& place) {
    std::string known;
    for (const Field& field : kFields) {
        known.append(known.empty() ? "{" : ", {").append(field.first).append("}");
    }
    throw InputError("dialect.placeholder", place,
                     std::string("controller line \"")
                             .append(line)
                             .append("\" has a place that cannot be filled in; there are ") +
                         known);
}

std::string filled(const std::string& line, const LineValues& values, const std::string& place) {
    std::string text;
    std::size_t at = 0;
    while (at < line.size()) {
        const std::size_t open = line.find('{', at);
        text += line.substr(at, open - at);
        if (open == std::string::npos) {
            break;
        }
        const std::size_t close = line.find('}', open);
        const std::string name =
            close == std::string::npos ? "" : line.substr(open + 1, close - open - 1);
        const Field* found = nullptr;
        for (const Field& field : kFields) {
            found = field.first == name ? &field : found;
        }
        if (found == nullptr) {
            unknown(line, place);
        }
        text += values.*(found->second);
        at = close + 1;
    }
    return text;
}

}  // namespace

std::vector<std::string> filled_lines(const std::vector<std::string>& lines,
                                      const LineValues& values, const std::string& place) {
    std::vector<std::string> result;
    result.reserve(lines.size());
    for (const std::string& line : lines) {
        result.push_back(filled(line, values, place));
    }
    return result;
}

}  // namespace meshwind
