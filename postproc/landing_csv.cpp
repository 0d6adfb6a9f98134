#include "postproc/landing_csv.h"

#include "postproc/csv_table.h"

namespace meshwind {
namespace {

constexpr CsvErrors kErrors{
    .column = "import.column",
    .number = "import.number",
    .column_mend =
        "its first line names the columns: x_mm,y_mm,z_mm or x,y,z, and perhaps course "
        "and nx,ny,nz"};

using Columns = std::array<std::size_t, 3>;

std::optional<Columns> normal_columns(const CsvTable& table) {
    if (!table.find("nx") && !table.find("ny") && !table.find("nz")) {
        return std::nullopt;
    }
    return Columns{table.column("nx"), table.column("ny"), table.column("nz")};
}

LandingRow row_of(const CsvTable& table, const Columns& position,
                  const std::optional<Columns>& normal) {
    LandingRow row{table.line(), table.vector(position), {}};
    if (normal) {
        row.normal = table.vector(*normal);
        if (row.normal->isZero(0.0)) {
            table.fail("import.number", "the normal is 0,0,0; leave nx,ny,nz out if not known");
        }
    }
    return row;
}

}  // namespace

LandingTable read_landing_csv(std::string_view text, const std::string& file) {
    CsvTable table(text, file, kErrors);
    LandingTable landing;
    landing.in_mm = table.find("x_mm").has_value();
    const std::string unit = landing.in_mm ? "_mm" : "";
    const Columns position{table.column("x" + unit), table.column("y" + unit),
                           table.column("z" + unit)};
    const std::optional<Columns> normal = normal_columns(table);
    const std::optional<std::size_t> course = table.find("course");
    const std::optional<std::size_t> kind = table.find("kind");
    std::vector<LandingCourse>& courses = landing.courses;
    const auto check_last = [&] {
        if (courses.empty() || courses.back().rows.size() < 2) {
            table.fail("import.empty",
                       courses.empty() ? "has no landing points; give two at least"
                                       : "course " + courses.back().name +
                                             " has one landing point before this line; give two "
                                             "at least");
        }
    };
    while (table.next()) {
        const std::string name(course ? table.cell(*course) : "1");
        if (courses.empty() || courses.back().name != name) {
            if (!courses.empty()) {
                check_last();
            }
            courses.push_back({name, kind && table.cell(*kind) == "transition", {}});
        }
        courses.back().rows.push_back(row_of(table, position, normal));
    }
    check_last();
    return landing;
}

}  // namespace meshwind
