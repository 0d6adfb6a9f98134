/// Reads tables of comma-separated values (CSV) with a first line of names.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace meshwind {

/// Codes and remedy for errors in a table.
struct CsvErrors {
    const char* column;       ///< code where a column is missing
    const char* number;       ///< code where a cell or the number of cells is wrong
    const char* column_mend;  ///< remedy where a column is missing
};

/// Reads a table line by line. Blanks around cells, empty lines and a byte order mark are passed
/// over. All errors are InputError at "file:line".
class CsvTable {
public:
    /// Reads the line of names. \param text outlives the table
    CsvTable(std::string_view text, const std::string& file, const CsvErrors& errors);

    /// Goes to the next line; false at the end.
    bool next();

    [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
    [[nodiscard]] std::size_t column(std::string_view name) const;
    [[nodiscard]] std::size_t columns() const { return names_.size(); }
    [[nodiscard]] std::string_view name(std::size_t column) const { return names_[column]; }

    /// Cells of the line.
    [[nodiscard]] std::string_view cell(std::size_t column) const { return cells_[column]; }
    [[nodiscard]] double number(std::size_t column) const;
    /// A whole number of 32 bits; its fraction is cut off.
    [[nodiscard]] std::int32_t whole_number(std::size_t column) const;
    [[nodiscard]] Eigen::Vector3d vector(const std::array<std::size_t, 3>& columns) const;

    [[nodiscard]] int line() const { return line_; }  ///< counted from 1

    /// \throws InputError always, at the line
    [[noreturn]] void fail(const char* code, const std::string& words) const;

private:
    std::string_view rest_;
    std::string file_;
    CsvErrors errors_;
    int line_ = 0;
    std::vector<std::string_view> names_;
    std::vector<std::string_view> cells_;
};

}  // namespace meshwind
