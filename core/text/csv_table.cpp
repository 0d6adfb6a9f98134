#include "core/text/csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace meshwind {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string_view trimmed(std::string_view cell) {
    constexpr std::string_view kBlanks = " \t\r";
    const std::size_t first = cell.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) {
        return {};
    }
    return cell.substr(first, cell.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace

CsvTable::CsvTable(std::string_view text, const std::string& file, const CsvErrors& errors)
    : rest_(text), file_(file), errors_(errors) {
    if (rest_.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
        rest_.remove_prefix(kByteOrderMark.size());
    }
    next();
    names_ = cells_;
}

bool CsvTable::next() {
    std::string_view line;
    while (line.empty()) {
        if (rest_.empty()) {
            return false;
        }
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        line = trimmed(rest_.substr(0, end));
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        ++line_;
    }
    cells_.clear();
    for (;;) {
        const std::size_t comma = line.find(',');
        cells_.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) {
            break;
        }
        line.remove_prefix(comma + 1);
    }
    if (!names_.empty() && cells_.size() != names_.size()) {
        fail(errors_.number, "has " + std::to_string(cells_.size()) + " cells, its first line " +
                                 std::to_string(names_.size()) + "; write the table again");
    }
    return true;
}

std::optional<std::size_t> CsvTable::find(std::string_view name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) {
        return std::nullopt;
    }
    return static_cast<std::size_t>(found - names_.begin());
}

std::size_t CsvTable::column(std::string_view name) const {
    const auto found = find(name);
    if (!found) {
        fail(errors_.column,
             "has no column '" + std::string(name) + "'; " + std::string(errors_.column_mend));
    }
    return *found;
}

double CsvTable::number(std::size_t column) const {
    const std::string_view cell = cells_[column];
    double value = 0.0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value)) {
        fail(errors_.number, "'" + std::string(cell) + "' in column " +
                                 std::string(names_[column]) + " is not a number");
    }
    return value;
}

std::int32_t CsvTable::whole_number(std::size_t column) const {
    constexpr double kMost = std::numeric_limits<std::int32_t>::max();
    const double value = number(column);
    if (std::abs(value) > kMost) {
        fail(errors_.number, "'" + std::string(cells_[column]) + "' in column " +
                                 std::string(names_[column]) +
                                 " is no number of a course or point");
    }
    return static_cast<std::int32_t>(value);
}

Eigen::Vector3d CsvTable::vector(const std::array<std::size_t, 3>& columns) const {
    return {number(columns[0]), number(columns[1]), number(columns[2])};
}

void CsvTable::fail(const char* code, const std::string& words) const {
    // Lines count from 1, those of an empty text as well.
    throw InputError(code, file_ + ":" + std::to_string(std::max(1, line_)), words);
}

}  // namespace meshwind
