#include "report/layup_vtu.h"

#include <cassert>
#include <cstddef>
#include <string_view>

#include "core/text/text_number.h"
#include "core/text/xml_text.h"

namespace meshwind {
namespace {

constexpr int kPositionDecimals = 6;   // a nanometre: below any use, above no file's noise
constexpr int kDirectionDecimals = 4;  // 0.006 deg: an arrow
constexpr int kVtkTriangle = 5;        // VTK's cell type number
constexpr std::size_t kNumbersPerLine = 12;

void append_number(std::string& text, double value) {
    append_shortest(text, value);
}

void append_number(std::string& text, std::int32_t value) {
    text += std::to_string(value);
}

template <typename Number>
constexpr std::string_view kVtkType = "Float64";
template <>
constexpr std::string_view kVtkType<std::int32_t> = "Int32";
template <>
constexpr std::string_view kVtkType<std::uint8_t> = "UInt8";

void open_array(std::string& text, std::string_view type, std::string_view name,
                int components = 1) {
    text += "<DataArray type=\"";
    text += type;
    text += "\" Name=\"";
    text += xml_text(name);
    if (components > 1) {
        text += "\" NumberOfComponents=\"";
        text += std::to_string(components);
    }
    text += "\" format=\"ascii\">\n";
}

void close_array(std::string& text) {
    text += "</DataArray>\n";
}

/// `count` numbers of a generator, a few to the line.
template <typename Generator>
void append_lines(std::string& text, std::size_t count, const Generator& number_at) {
    for (std::size_t i = 0; i < count; ++i) {
        append_number(text, number_at(i));
        text += (i + 1) % kNumbersPerLine == 0 || i + 1 == count ? '\n' : ' ';
    }
}

void append_vectors(std::string& text, std::string_view name,
                    std::span<const Eigen::Vector3d> vectors, int decimals) {
    open_array(text, kVtkType<double>, name, 3);
    for (const Eigen::Vector3d& vector : vectors) {
        for (int axis = 0; axis < 3; ++axis) {
            append_fixed(text, vector[axis], decimals);
            text += axis == 2 ? '\n' : ' ';
        }
    }
    close_array(text);
}

template <typename Number>
void append_cells(std::string& text, std::string_view name, std::span<const Number> values) {
    open_array(text, kVtkType<Number>, name);
    append_lines(text, values.size(), [&](std::size_t i) { return values[i]; });
    close_array(text);
}

void append_cells(std::string& text, std::string_view name,
                  std::span<const Eigen::Vector3d> values) {
    append_vectors(text, name, values, kDirectionDecimals);
}

void append_topology(std::string& text, std::span<const std::array<std::int32_t, 3>> triangles) {
    text += "<Cells>\n";
    open_array(text, kVtkType<std::int32_t>, "connectivity");
    append_lines(text, 3 * triangles.size(),
                 [&](std::size_t i) { return triangles[i / 3][i % 3]; });
    close_array(text);
    open_array(text, kVtkType<std::int32_t>, "offsets");
    append_lines(text, triangles.size(),
                 [](std::size_t i) { return static_cast<std::int32_t>(3 * (i + 1)); });
    close_array(text);
    open_array(text, kVtkType<std::uint8_t>, "types");
    append_lines(text, triangles.size(), [](std::size_t) { return std::int32_t{kVtkTriangle}; });
    close_array(text);
    text += "</Cells>\n";
}

}  // namespace

std::string layup_vtu(std::span<const Eigen::Vector3d> points_mm,
                      std::span<const std::array<std::int32_t, 3>> triangles,
                      std::span<const CellArray> cells) {
    std::string text =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
        "<UnstructuredGrid>\n";
    text += "<Piece NumberOfPoints=\"" + std::to_string(points_mm.size()) + "\" NumberOfCells=\"" +
            std::to_string(triangles.size()) + "\">\n";
    text += "<Points>\n";
    append_vectors(text, "Points", points_mm, kPositionDecimals);
    text += "</Points>\n";
    append_topology(text, triangles);
    text += "<CellData>\n";
    for (const CellArray& cell : cells) {
        std::visit(
            [&](auto values) {
                assert(values.size() == triangles.size());
                append_cells(text, cell.name, values);
            },
            cell.values);
    }
    text += "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
    return text;
}

}  // namespace meshwind
