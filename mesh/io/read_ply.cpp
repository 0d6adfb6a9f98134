#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "core/error.h"
#include "mesh/io/mesh_readers.h"
#include "mesh/io/ply_values.h"

namespace meshwind {
namespace {

constexpr std::array<std::string_view, 3> kCoordinates = {"x", "y", "z"};

bool names_corners(const PlyProperty& property) {
    return property.list && (property.name == "vertex_indices" || property.name == "vertex_index");
}

[[noreturn]] void refuse_header(const std::string& file, const std::string& message) {
    throw InputError("mesh.not_a_mesh", file, message + "; export the part again");
}

void check_coordinates(const PlyElement& element, const std::string& file) {
    for (const std::string_view name : kCoordinates) {
        const auto fits = [&](const PlyProperty& p) { return p.name == name && !p.list; };
        if (std::count_if(element.properties.begin(), element.properties.end(), fits) != 1) {
            refuse_header(file, "its vertices have no single property " + std::string(name));
        }
    }
    if (element.rows > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
        refuse_header(file, "has more than 2^31 vertices");
    }
}

void check_corners(const PlyElement& element, const std::string& file) {
    if (std::count_if(element.properties.begin(), element.properties.end(), names_corners) != 1) {
        refuse_header(file, "its element '" + element.name + "' has no single list vertex_indices");
    }
}

// Number of the vertices. \throws InputError mesh.not_a_mesh
std::size_t checked_points(const PlyHeader& header, const std::string& file) {
    std::size_t points = 0;
    for (const PlyElement& element : header.elements) {
        if (element.name == "vertex") {
            points = element.rows;
            check_coordinates(element, file);
        } else if (element.name == "face" || element.name == "tristrips") {
            check_corners(element, file);
        }
    }
    return points;
}

std::int64_t length_of(const PlyProperty& list, PlyValues& values) {
    const std::int64_t count = values.integer(list.count_type);
    if (count < 0) {
        values.refuse("mesh.bad_line",
                      "a list has the length " + std::to_string(count) + "; export the part again");
    }
    return count;
}

void pass(const PlyProperty& property, PlyValues& values) {
    for (std::int64_t left = property.list ? length_of(property, values) : 1; left > 0; --left) {
        (void)values.number(property.type);
    }
}

void pass_row(const PlyElement& element, PlyValues& values) {
    for (const PlyProperty& property : element.properties) {
        pass(property, values);
    }
}

Eigen::Vector3d read_point(const PlyElement& element, PlyValues& values) {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (const PlyProperty& property : element.properties) {
        const auto* const name = std::find(kCoordinates.begin(), kCoordinates.end(), property.name);
        if (name == kCoordinates.end() || property.list) {
            pass(property, values);
        } else {
            point[name - kCoordinates.begin()] = values.number(property.type);
        }
    }
    return point;
}

// \param points number of them
std::int32_t checked_corner(std::int64_t index, std::size_t points, const PlyValues& values) {
    if (index < 0 || index >= static_cast<std::int64_t>(points)) {
        values.refuse("mesh.bad_index", bad_index_words(index, 0, points));
    }
    return static_cast<std::int32_t>(index);
}

void read_polygon(const PlyProperty& property, std::size_t points, PlyValues& values,
                  PolygonSoup& soup) {
    const std::int64_t count = length_of(property, values);
    if (count > static_cast<std::int64_t>(kMaxCorners)) {
        values.refuse("mesh.large_polygon", large_polygon_words());
    }
    for (std::int64_t i = 0; i < count; ++i) {
        soup.corners.push_back(checked_corner(values.integer(property.type), points, values));
    }
    soup.ends.push_back(soup.corners.size());
}

// Each index makes a triangle with the two before it, every other one turned over; -1 begins a
// new strip.
void read_strip(const PlyProperty& property, std::size_t points, PlyValues& values,
                PolygonSoup& soup) {
    std::array<std::int32_t, 2> last{};
    std::int64_t in_strip = 0;
    for (std::int64_t left = length_of(property, values); left > 0; --left) {
        const std::int64_t index = values.integer(property.type);
        if (index == -1) {
            in_strip = 0;
            continue;
        }
        const std::int32_t corner = checked_corner(index, points, values);
        if (in_strip >= 2) {
            const bool over = in_strip % 2 == 1;
            for (const std::int32_t v : {last[over ? 1 : 0], last[over ? 0 : 1], corner}) {
                soup.corners.push_back(v);
            }
            soup.ends.push_back(soup.corners.size());
        }
        last = {last[1], corner};
        ++in_strip;
    }
}

// A row of polygons or strips.
void read_faces(const PlyElement& element, std::size_t points, PlyValues& values,
                PolygonSoup& soup) {
    const bool strips = element.name == "tristrips";
    for (const PlyProperty& property : element.properties) {
        if (!names_corners(property)) {
            pass(property, values);
        } else if (strips) {
            read_strip(property, points, values, soup);
        } else {
            read_polygon(property, points, values, soup);
        }
    }
}

void read_element(const PlyElement& element, std::size_t points, PlyValues& values,
                  PolygonSoup& soup) {
    const bool is_vertex = element.name == "vertex";
    const bool is_faces = element.name == "tristrips" || element.name == "face";
    for (std::size_t row = 0; row < element.rows; ++row) {
        values.begin_row();
        if (is_vertex) {
            soup.points.push_back(read_point(element, values));
        } else if (is_faces) {
            read_faces(element, points, values, soup);
        } else {
            pass_row(element, values);
        }
        values.end_row();
    }
}

}  // namespace

PolygonSoup read_ply(std::string_view bytes, const std::string& file) {
    const PlyHeader header = read_ply_header(bytes, file);
    const std::unique_ptr<PlyValues> values = ply_values(bytes, file, header);
    const std::size_t points = checked_points(header, file);
    PolygonSoup soup;
    soup.points.reserve(points);
    for (const PlyElement& element : header.elements) {
        read_element(element, points, *values, soup);
    }
    return soup;
}

}  // namespace meshwind
