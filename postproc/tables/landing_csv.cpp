#include "postproc/tables/landing_csv.h"

#include "core/text/csv_table.h"

namespace meshwind {
namespace {

constexpr CsvErrors kErrors{
    .column = "import.column",
    .number = "import.number",
    .column_mend =
        "its first line names the columns, commas between: x_mm,y_mm,z_mm or x,y,z, and "
        "perhaps course, nx,ny,nz and tx,ty,tz"};

using Columns = std::array<std::size_t, 3>;

// Columns "nx", "ny", "nz" for "n", if there is any of them.
std::optional<Columns> vector_columns(const CsvTable& table, const std::string& letter) {
    if (!table.find(letter + "x") && !table.find(letter + "y") && !table.find(letter + "z")) {
        return std::nullopt;
    }
    return Columns{table.column(letter + "x"), table.column(letter + "y"),
                   table.column(letter + "z")};
}

std::optional<Eigen::Vector3d> direction(const CsvTable& table,
                                         const std::optional<Columns>& columns) {
    if (!columns) {
        return std::nullopt;
    }
    const Eigen::Vector3d vector = table.vector(*columns);
    if (vector.isZero(0.0)) {
        table.fail("import.number",
                   "a normal or tangent is 0,0,0; leave its columns out if it is not known");
    }
    return vector;
}

}  // namespace

LandingTable read_landing_csv(std::string_view text, const std::string& file) {
    CsvTable table(text, file, kErrors);
    LandingTable landing;
    landing.in_mm = table.find("x_mm").has_value();
    const std::string unit = landing.in_mm ? "_mm" : "";
    const Columns position{table.column("x" + unit), table.column("y" + unit),
                           table.column("z" + unit)};
    const std::optional<Columns> normal = vector_columns(table, "n");
    const std::optional<Columns> tangent = vector_columns(table, "t");
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
        courses.back().rows.push_back({table.line(), table.vector(position),
                                       direction(table, normal), direction(table, tangent)});
    }
    check_last();
    return landing;
}

}  // namespace meshwind
