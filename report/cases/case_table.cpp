#include "report/cases/case_table.h"

#include <algorithm>
#include <cctype>
#include <map>

#include "core/error.h"
#include "core/text/csv_table.h"

namespace meshwind {
namespace {

constexpr CsvErrors kErrors = {"case.column", "case.cell",
                               "write a first line with columns id and mandrel"};

bool names_a_folder(std::string_view id) {
    return !id.empty() && id.front() != '.' && id.front() != '-' &&
           std::all_of(id.begin(), id.end(), [](unsigned char c) {
               return std::isalnum(c) != 0 || c == '.' || c == '_' || c == '-';
           });
}

}  // namespace

std::vector<Case> read_cases(std::string_view text, const std::string& file) {
    CsvTable table(text, file, kErrors);
    const std::size_t id = table.column("id");
    const std::size_t mandrel = table.column("mandrel");
    const auto machine = table.find("machine");
    const auto job = table.find("job");
    std::vector<Case> cases;
    std::map<std::string, int> line_of;
    while (table.next()) {
        Case& row = cases.emplace_back();
        row.line = table.line();
        row.id = table.cell(id);
        row.mandrel = table.cell(mandrel);
        if (!names_a_folder(row.id)) {
            table.fail("case.id", "has the id '" + row.id +
                                      "', which becomes a folder's name; write letters, digits, "
                                      "'_', '-' and '.'");
        }
        const auto [first, is_new] = line_of.try_emplace(row.id, row.line);
        if (!is_new) {
            table.fail("case.id", "has the id '" + row.id + "' of line " +
                                      std::to_string(first->second) + "; give it another");
        }
        if (row.mandrel.empty()) {
            table.fail("case.cell", "names no mandrel; write its file");
        }
        if (machine && !table.cell(*machine).empty()) {
            row.machine = table.cell(*machine);
        }
        if (job) {
            row.job = table.cell(*job);
        }
        for (std::size_t c = 0; c < table.columns(); ++c) {
            if (c != id && c != mandrel && c != machine && c != job && !table.cell(c).empty()) {
                row.settings.push_back(std::string(table.name(c)) + "=" +
                                       std::string(table.cell(c)));
            }
        }
    }
    if (cases.empty()) {
        throw InputError("case.none", file, "has no row below its first line; write a case a line");
    }
    return cases;
}

}  // namespace meshwind
