#include "report/layup_vtu.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace meshwind {
namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++count;
    }
    return count;
}

/// The numbers of the array called `name`.
std::vector<double> numbers_of(const std::string& text, const std::string& name) {
    const std::size_t head = text.find("Name=\"" + name + "\"");
    const std::size_t begin = text.find('>', head) + 1;
    std::istringstream stream(text.substr(begin, text.find('<', begin) - begin));
    std::vector<double> numbers;
    for (double number = 0; stream >> number;) {
        numbers.push_back(number);
    }
    return numbers;
}

const std::vector<Eigen::Vector3d> kSquare = {{0, 0, 0}, {2.5, 0, 0}, {2.5, 1, 0}, {0, 1, -1e-9}};
const std::vector<std::array<std::int32_t, 3>> kFaces = {{0, 1, 2}, {0, 2, 3}};

TEST(LayupVtu, HoldsPointsTrianglesAndValues) {
    const std::vector<double> thickness = {0.25, 1.0 / 3.0};
    const std::vector<std::int32_t> region = {7, -1};
    const std::vector<CellArray> cells = {{"thickness_mm", std::span(thickness)},
                                          {"region", std::span(region)}};
    const std::string text = layup_vtu(kSquare, kFaces, cells);
    EXPECT_NE(text.find("NumberOfPoints=\"4\" NumberOfCells=\"2\""), std::string::npos);
    EXPECT_EQ(numbers_of(text, "Points"),
              (std::vector<double>{0, 0, 0, 2.5, 0, 0, 2.5, 1, 0, 0, 1, 0}));
    EXPECT_EQ(numbers_of(text, "connectivity"), (std::vector<double>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(numbers_of(text, "offsets"), (std::vector<double>{3, 6}));
    EXPECT_EQ(numbers_of(text, "types"), (std::vector<double>{5, 5}));
    EXPECT_EQ(numbers_of(text, "thickness_mm"), thickness);
    EXPECT_EQ(numbers_of(text, "region"), (std::vector<double>{7, -1}));
    EXPECT_NE(text.find("type=\"Int32\" Name=\"region\""), std::string::npos);
}

TEST(LayupVtu, DirectionsHaveThreeComponents) {
    const std::vector<Eigen::Vector3d> axis = {{0.6, -0.8, 0.0}, {0.0, 0.0, 1.0}};
    const std::vector<CellArray> cells = {{"axis_1", std::span<const Eigen::Vector3d>(axis)}};
    const std::string text = layup_vtu(kSquare, kFaces, cells);
    EXPECT_EQ(numbers_of(text, "axis_1"), (std::vector<double>{0.6, -0.8, 0, 0, 0, 1}));
    EXPECT_NE(text.find("Name=\"axis_1\" NumberOfComponents=\"3\""), std::string::npos);
}

TEST(LayupVtu, ClosesEveryElement) {
    const std::vector<double> values = {1, 2};
    const std::vector<CellArray> cells = {{"a < \"b\" & c", std::span(values)}};
    const std::string text = layup_vtu(kSquare, kFaces, cells);
    for (const std::string element :
         {"VTKFile", "UnstructuredGrid", "Piece", "Points", "Cells", "CellData", "DataArray"}) {
        EXPECT_EQ(count_of(text, "<" + element + ">") + count_of(text, "<" + element + " "),
                  count_of(text, "</" + element + ">"))
            << element;
    }
    EXPECT_NE(text.find("Name=\"a &lt; &quot;b&quot; &amp; c\""), std::string::npos);
}

TEST(LayupVtu, EmptySurfaceIsAFileToo) {
    const std::string text = layup_vtu({}, {}, {});
    EXPECT_NE(text.find("NumberOfPoints=\"0\" NumberOfCells=\"0\""), std::string::npos);
    EXPECT_EQ(count_of(text, "<DataArray"), 4U);
}

}  // namespace
}  // namespace meshwind
