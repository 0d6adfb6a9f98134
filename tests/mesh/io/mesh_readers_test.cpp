#include "mesh/io/mesh_readers.h"

#include <sys/stat.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/interrupt.h"
#include "mesh/io/import.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

// Code and place of the refusal; "none" if the bytes are read.
std::array<std::string, 2> refusal_of(const std::string& name, const std::string& bytes) {
    try {
        (void)parse_triangles(bytes, name);
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return {error.code(), error.place()};
    }
    return {"none", ""};
}

struct CandidateFault {
    const char* name;
    std::string bytes;
    const char* code;
    std::string place;
};

void expect_refusals(const std::vector<CandidateFault>& refusals) {
    for (const CandidateFault& wanted : refusals) {
        const auto [code, place] = refusal_of(wanted.name, wanted.bytes);
        EXPECT_EQ(code, wanted.code) << wanted.bytes.substr(0, 200);
        EXPECT_EQ(place, wanted.place) << wanted.bytes.substr(0, 200);
    }
}

std::string off_of(const std::vector<Eigen::Vector3d>& corners) {
    std::string text = "OFF\n" + std::to_string(corners.size()) + " 1 0\n";
    for (const Eigen::Vector3d& p : corners) {
        text += std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) +
                "\n";
    }
    text += std::to_string(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        text += " " + std::to_string(i);
    }
    return text + "\n";
}

// Twice the area over the xy plane, negative for triangles that are turned over.
double doubled_area(const TriangleSoup& soup) {
    double sum = 0.0;
    for (const auto& [a, b, c] : soup.faces) {
        const auto point = [&](std::int32_t v) {
            return soup.points_mm[static_cast<std::size_t>(v)];
        };
        sum += (point(b) - point(a)).cross(point(c) - point(a)).z();
    }
    return sum;
}

std::string bytes_of(float value, std::endian order) {
    auto raw = std::bit_cast<std::array<char, 4>>(value);
    if (order != std::endian::native) {
        std::reverse(raw.begin(), raw.end());
    }
    return {raw.begin(), raw.end()};
}

std::string binary_ply(std::endian order) {
    std::string bytes = "ply\nformat binary_";
    bytes += order == std::endian::little ? "little" : "big";
    bytes +=
        "_endian 1.0\ncomment two triangles\nelement vertex 4\nproperty float x\n"
        "property uchar red\nproperty float y\nproperty float z\nelement face 1\n"
        "property list uchar uchar other\nproperty list uchar uchar vertex_indices\n"
        "element edge 1\nproperty uchar vertex1\nend_header\n";
    for (const auto& [x, y] :
         {std::pair(0.0F, 0.0F), {20.0F, 0.0F}, {20.0F, 0.1F}, {0.0F, 20.0F}}) {
        bytes += bytes_of(x, order) + '\x0a' + bytes_of(y, order) + bytes_of(1.5F, order);
    }
    return bytes + std::string("\2\7\7\4\0\1\2\3\1", 9);
}

const char* const kTextPly =
    "ply\r\nformat ascii 1.0\r\nobj_info none\r\nelement vertex 4\r\nproperty double x\r\n"
    "property double y\r\nproperty double z\r\nelement face 2\r\n"
    "property list uchar int vertex_index\r\nend_header\r\n"
    "0 0 0\r\n0.1 0 0\r\n0 1e-3 0\r\n+5 5 -5\r\n\r\n3 0 1 2\r\n3 1 3 2\r\n";
const char* const kTextOff =
    "COFF # colours\n4 2 0\n0 0 0 1 0 0\n0.1 0 0\n0 1e-3 0\n5 5 -5\n3 0 1 2 255 0 0\n3 1 3 2\n";
const char* const kTextObj =
    "mtllib none.mtl\no part\nv 0 0 0\nv 0.1 0 0 1.0\nv 0 1e-3 0\nv 5 5 -5\nvn 0 0 1\nusemtl a\n"
    "f 1//1 2//1 \\\n 3//1\nf -3 4 3/1/1 # last\nl 1 2\n";
const char* const kTextStl =
    "solid my part\nFACET NORMAL 0 0 nan\nouter loop\nvertex 0 0 0\nvertex 0.1 0 0\nvertex 0 1e-3 "
    "0\nendloop\nendfacet\nfacet\nouter loop\n vertex 0.1 0 0\nvertex 5 5 -5\nvertex 0 1e-3 0\n"
    "endloop\nendfacet\nendsolid my part\n";

TEST(MeshReaders, ReadTheSameTrianglesFromEachTextFormat) {
    for (const auto& [name, text] : {std::pair("a.ply", kTextPly),
                                     {"a.off", kTextOff},
                                     {"a.obj", kTextObj},
                                     {"a.stl", kTextStl}}) {
        const TriangleSoup soup = parse_triangles(text, name);
        ASSERT_EQ(soup.faces.size(), 2U) << name;
        const auto point = [&](std::size_t f, std::size_t c) {
            return soup.points_mm[static_cast<std::size_t>(soup.faces[f][c])];
        };
        EXPECT_EQ(point(0, 1), Eigen::Vector3d(0.1, 0, 0)) << name;  // doubles, to the last bit
        EXPECT_EQ(point(0, 2), Eigen::Vector3d(0, 1e-3, 0)) << name;
        EXPECT_EQ(point(1, 1), Eigen::Vector3d(5, 5, -5)) << name;
    }
}

TEST(MeshReaders, ReadBinaryPlyOfEitherOrderOfBytes) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        const TriangleSoup soup = parse_triangles(binary_ply(order), "a.ply");
        ASSERT_EQ(soup.points_mm.size(), 4U);
        EXPECT_EQ(soup.points_mm[2], Eigen::Vector3d(20.0, static_cast<double>(0.1F), 1.5));
        EXPECT_EQ(soup.faces.size(), 2U);
    }
}

TEST(MeshReaders, TurnEveryOtherTriangleOfAStripOver) {
    const TriangleSoup soup = parse_triangles(
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 -1 2 3 4 -1\n",
        "a.ply");
    ASSERT_EQ(soup.faces.size(), 3U);
    EXPECT_DOUBLE_EQ(doubled_area(soup), 3.0);  // three halves of squares, all turning left
}

TEST(MeshReaders, SplitPolygonsThatAreNotConvex) {
    const std::vector<Eigen::Vector3d> corner = {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {1, 1, 0},
                                                 {1, 4, 0}, {0, 4, 0}, {0, 2, 0}};
    for (std::size_t first = 0; first < corner.size(); ++first) {
        std::vector<Eigen::Vector3d> turned = corner;
        std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(first),
                    turned.end());
        const TriangleSoup soup = parse_triangles(off_of(turned), "a.off");
        EXPECT_EQ(soup.faces.size(), corner.size() - 2);
        EXPECT_DOUBLE_EQ(doubled_area(soup), 14.0);
        EXPECT_DOUBLE_EQ(2.0 * area_mm2(soup), 14.0) << "a triangle is turned over";
    }
}

// A star of random radii has every kind of ear there is; area by the corners alone (shoelace).
TEST(MeshReaders, SplitStarsOfUpToAThousandCorners) {
    std::mt19937 random(7);
    for (const std::size_t count : {4U, 5U, 9U, 60U, 999U, 1000U}) {
        std::vector<Eigen::Vector3d> corner;
        for (std::size_t i = 0; i < count; ++i) {
            const double angle = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(count);
            const double radius = 1.0 + static_cast<double>(random() % 1000) * 0.01;
            corner.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
        }
        const TriangleSoup soup = parse_triangles(off_of(corner), "a.off");
        double shoelace = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            shoelace += soup.points_mm[i].cross(soup.points_mm[(i + 1) % count]).z();
        }
        EXPECT_EQ(soup.faces.size(), count - 2);
        EXPECT_NEAR(doubled_area(soup), shoelace, 1e-12 * shoelace);
        EXPECT_NEAR(2.0 * area_mm2(soup), shoelace, 1e-12 * shoelace) << count;
    }
}

TEST(MeshReaders, RefuseWithTheLine) {
    std::string large = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
    for (int i = 0; i < 200000; ++i) {
        large += " 1 2 3";
    }
    expect_refusals({
        {"a.obj", large, "mesh.large_polygon", "a.obj:4"},
        {"a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 4\nv 0 1 0\n", "mesh.bad_index", "a.obj:3"},
        {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n", "mesh.bad_index", "a.obj:4"},
        {"a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 -3\nv 0 1 0\n", "mesh.bad_index", "a.obj:3"},
        {"a.obj", "v 0 0 0\nf 1 1 4294967297\n", "mesh.bad_index", "a.obj:2"},
        {"a.obj", "v 0 0 0\n\n\nv 0 0,5 0\n", "mesh.bad_line", "a.obj:4"},
        {"a.obj", "v 0 0\n", "mesh.bad_line", "a.obj:1"},
        {"a.obj", "v 0 0 0\nw 0 0 0\n", "mesh.bad_line", "a.obj:2"},
        {"a.obj", "v 0 0 0\nf 1 a 1\n", "mesh.bad_line", "a.obj:2"},
        {"a.off", "OFF\n1 1 0\n0 0 0\n3 0 0 99999999\n", "mesh.bad_index", "a.off:4"},
        {"a.off", "OFF\n1 1 0\n0 0 0\n3 0 0 -1\n", "mesh.bad_index", "a.off:4"},
        {"a.off", "OFF\n2 1 0\n0 0 0\n0 0\n3 0 0 1\n", "mesh.bad_line", "a.off:4"},
        {"a.off", "OFF\n1 1 0\n0 0 0\n3 0 0\n", "mesh.bad_line", "a.off:4"},
        {"a.off", "OFF\n1 1 0\n0 0 0\n1001 0\n", "mesh.large_polygon", "a.off:4"},
        {"a.off", "OFF\n1 1 0\n0 0 0\n", "mesh.truncated", "a.off:4"},
        {"a.off", "OFF BINARY\n1 1 0\n", "mesh.not_a_mesh", "a.off:1"},
        {"a.off", "OFF\nmany\n", "mesh.not_a_mesh", "a.off:2"},
        {"a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\nendfacet\n",
         "mesh.bad_line", "a.stl:4"},
        {"a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\nendfacet\n",
         "mesh.bad_line", "a.stl:5"},
        {"a.stl", "solid a\nfacet normal 0 0 1\nendsolid\n", "mesh.bad_line", "a.stl:3"},
    });
}

TEST(MeshReaders, RefusePlyHeadersAndRowsWithTheLineOrTheByte) {
    const std::string vertex =
        "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
    const std::string text = "ply\nformat ascii 1.0\n" + vertex + face + "end_header\n0 0 0\n";
    const std::string binary = "ply\nformat binary_little_endian 1.0\n" + vertex + face +
                               "end_header\n" + std::string(12, '\0');
    expect_refusals({
        {"a.ply", text + "3 0 0 1\n", "mesh.bad_index", "a.ply:11"},
        {"a.ply", text + "3 0 0 -5\n", "mesh.bad_index", "a.ply:11"},
        {"a.ply", text + "3 0 0 0 0\n", "mesh.bad_line", "a.ply:11"},
        {"a.ply", text + "-3 0 0 0\n", "mesh.bad_line", "a.ply:11"},
        {"a.ply", text + "2000000000 0 0 0\n", "mesh.large_polygon", "a.ply:11"},
        {"a.ply", text, "mesh.truncated", "a.ply:11"},
        {"a.ply", binary + std::string("\3\0\0\0\0\0\0\0\0\0\x94\x35\x77", 13), "mesh.bad_index",
         "a.ply, byte " + std::to_string(binary.size() + 13)},
        {"a.ply", binary + std::string("\3\0\0\0\0", 5), "mesh.truncated",
         "a.ply, byte " + std::to_string(binary.size() + 5)},
        {"a.ply", "ply\nformat ascii 1.0\n" + vertex + "elemnt face 1\nend_header\n",
         "mesh.not_a_mesh", "a.ply:7"},
        {"a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty flot x\nend_header\n",
         "mesh.not_a_mesh", "a.ply:4"},
        {"a.ply", "ply\nformat ascii 1.0\n" + vertex + vertex + "end_header\n", "mesh.not_a_mesh",
         "a.ply:7"},
        {"a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n",
         "mesh.not_a_mesh", "a.ply"},
        {"a.ply", "ply\nformat ascii 1.0\nelement marks 4000000000\nend_header\n",
         "mesh.not_a_mesh", "a.ply:4"},
        {"a.ply", "ply\nformat ascii 1.0\n" + vertex, "mesh.not_a_mesh", "a.ply:7"},
        {"a.ply", "ply\n" + vertex + "end_header\n", "mesh.not_a_mesh", "a.ply:6"},
        {"a.ply", "ply\nformat xml 1.0\n" + vertex + "end_header\n", "mesh.not_a_mesh", "a.ply:2"},
    });
}

// Whatever is cut off or changed, bytes are read or refused.
TEST(MeshReaders, ReadOrRefuseWhatIsCutOffOrChanged) {
    std::mt19937 random(11);
    const std::vector<std::pair<std::string, std::string>> files = {
        {"a.ply", kTextPly},
        {"a.ply", binary_ply(std::endian::little)},
        {"a.ply", binary_ply(std::endian::big)},
        {"a.off", kTextOff},
        {"a.obj", kTextObj},
        {"a.stl", kTextStl}};
    int refused = 0;
    for (const auto& [name, bytes] : files) {
        for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
            refused += refusal_of(name, bytes.substr(0, cut))[0] != "none" ? 1 : 0;
        }
        for (int i = 0; i < 2000; ++i) {
            std::string changed = bytes;
            for (auto n = random() % 3 + 1; n > 0; --n) {
                changed[random() % changed.size()] = static_cast<char>(random() % 256);
            }
            refused += refusal_of(name, changed)[0] != "none" ? 1 : 0;
        }
    }
    EXPECT_GT(refused, 5000);
}

TEST(MeshReaders, StopWhenTheyAreAskedTo) {
    std::string text = "OFF\n20000 0 0\n";
    for (int i = 0; i < 20000; ++i) {
        text += "0 0 0\n";
    }
    request_interrupt(15);
    EXPECT_THROW((void)parse_triangles(text, "a.off"), Interrupted);
    withdraw_interrupt();
}

// A material library that is a pipe without a writer would be waited for without end.
TEST(MeshReaders, OpenNoOtherFile) {
    const auto folder = std::filesystem::temp_directory_path() / "meshwind_readers";
    std::filesystem::create_directories(folder);
    std::filesystem::remove(folder / "pipe.mtl");
    ASSERT_EQ(::mkfifo((folder / "pipe.mtl").c_str(), 0600), 0);
    std::ofstream(folder / "a.obj") << "mtllib pipe.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    EXPECT_EQ(read_triangles(folder / "a.obj").faces.size(), 1U);
    std::filesystem::rename(folder / "pipe.mtl", folder / "pipe.stl");
    try {
        (void)read_triangles(folder / "pipe.stl");
        ADD_FAILURE() << "a pipe was read";
    } catch (const IoError& error) {
        EXPECT_EQ(error.code(), "mesh.unreadable");
    }
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace meshwind
