#include "mesh/io/import.h"

#include <cstring>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/error.h"
#include "mesh/mandrel/load_mandrel.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

class Import : public testing::Test {
protected:
    std::filesystem::path write(const std::string& name, const std::string& bytes) {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() / "meshwind_import" / test->name();
        std::filesystem::create_directories(folder_);
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return folder_ / name;
    }
    void TearDown() override {
        if (!folder_.empty()) {
            std::filesystem::remove_all(folder_);
        }
    }
    static std::string code_of(const std::filesystem::path& file) {
        try {
            (void)load_mandrel(file);
        } catch (const Error& error) {
            const std::string what = error.what();
            EXPECT_EQ(what.find('\n'), std::string::npos);
            EXPECT_NE(what.find(file.filename().string()), std::string::npos);
            return error.code();
        }
        return "none";
    }

private:
    std::filesystem::path folder_;
};

std::string binary_stl(const TriangleSoup& soup, std::string header) {
    header.resize(80, ' ');
    const auto count = static_cast<std::uint32_t>(soup.faces.size());
    std::string bytes = header;
    bytes.append(reinterpret_cast<const char*>(&count), 4);
    for (const auto& face : soup.faces) {
        std::array<float, 12> values{};
        for (std::size_t i = 0; i < 3; ++i) {
            for (int k = 0; k < 3; ++k) {
                values[3 * (i + 1) + static_cast<std::size_t>(k)] =
                    static_cast<float>(soup.points_mm[static_cast<std::size_t>(face[i])][k]);
            }
        }
        bytes.append(reinterpret_cast<const char*>(values.data()), 48);
        bytes.append(2, '\0');
    }
    return bytes;
}

std::string ascii_stl(const TriangleSoup& soup) {
    std::string text = "solid part\n";
    for (const auto& face : soup.faces) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const std::int32_t v : face) {
            const Eigen::Vector3d& p = soup.points_mm[static_cast<std::size_t>(v)];
            text += "vertex " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
                    std::to_string(p.z()) + "\n";
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid part\n";
}

const TriangleSoup kBox = test::box({0, 0, 0}, {20, 20, 20});

TEST_F(Import, ReadsBinaryStlWhoseHeaderStartsWithSolid) {
    EXPECT_EQ(read_triangles(write("a.stl", binary_stl(kBox, "solid part"))).faces.size(), 12U);
}

TEST_F(Import, ReadsBinaryStlWithPadding) {
    const std::string bytes = binary_stl(kBox, "part") + std::string(7, '\0');
    EXPECT_EQ(read_triangles(write("a.stl", bytes)).faces.size(), 12U);
}

TEST_F(Import, ReadsAsciiStlOfSeveralSolids) {
    EXPECT_EQ(read_triangles(write("a.STL", ascii_stl(kBox) + ascii_stl(kBox))).faces.size(), 24U);
}

TEST_F(Import, ReadsObjWithQuads) {
    const std::string text =
        "v 0 0 0\nv 20 0 0\nv 20 20 0\nv 0 20 0\nf 1 2 3 4\n# comment\nl 1 2\n";
    EXPECT_EQ(read_triangles(write("a.obj", text)).faces.size(), 2U);
}

TEST_F(Import, ReadsPlyAndOff) {
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n20 0 0\n0 20 0\n3 0 1 2\n";
    EXPECT_EQ(read_triangles(write("a.ply", ply)).faces.size(), 1U);
    const std::string off = "OFF\n3 1 0\n0 0 0\n20 0 0\n0 20 0\n3 0 1 2\n";
    EXPECT_EQ(read_triangles(write("a.off", off)).faces.size(), 1U);
}

TEST_F(Import, NamesWhatIsWrongWithBadFiles) {
    EXPECT_EQ(code_of("no_such_file.stl"), "mesh.missing_file");
    EXPECT_EQ(code_of(write("a.stl", "")), "mesh.empty_file");
    EXPECT_EQ(code_of(write("b.stl", "Dear reader, this is a letter.\n")), "mesh.not_a_mesh");
    EXPECT_EQ(code_of(write("b.ply", "Dear reader\n")), "mesh.not_a_mesh");
    EXPECT_EQ(code_of(write("b.off", "Dear reader\n")), "mesh.not_a_mesh");
    EXPECT_EQ(code_of(write("c.xyz", "1 2 3\n")), "mesh.unknown_format");
    EXPECT_EQ(code_of(write("b.obj", "Dear reader\n")), "mesh.bad_line");
}

TEST_F(Import, FindsTruncation) {
    for (const char* header : {"part", "solid part"}) {
        const std::string bytes = binary_stl(kBox, header);
        EXPECT_EQ(code_of(write("a.stl", bytes.substr(0, bytes.size() - 30))), "mesh.truncated");
        EXPECT_EQ(code_of(write("b.stl", bytes.substr(0, 84))), "mesh.truncated");
    }
    std::string huge = binary_stl(kBox, "part");
    std::memset(huge.data() + 80, 0xff, 4);
    EXPECT_EQ(code_of(write("c.stl", huge)), "mesh.truncated");
    const std::string text = ascii_stl(kBox);
    EXPECT_EQ(code_of(write("d.stl", text.substr(0, text.size() / 2))), "mesh.truncated");
    EXPECT_EQ(code_of(write("e.off", "OFF\n2000000000 2000000000 0\n0 0 0\n")), "mesh.truncated");
    EXPECT_EQ(code_of(write("f.ply",
                            "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\n"
                            "property float x\nend_header\n")),
              "mesh.truncated");
}

TEST_F(Import, RefusesCoordinatesThatAreNoNumbers) {
    TriangleSoup soup = kBox;
    soup.points_mm[3].y() = std::nan("");
    EXPECT_EQ(code_of(write("a.stl", binary_stl(soup, "part"))), "mesh.not_finite");
    soup.points_mm[3].y() = HUGE_VAL;
    EXPECT_EQ(code_of(write("b.stl", binary_stl(soup, "part"))), "mesh.not_finite");
}

TEST_F(Import, ReadsTheUnitThatTheHeaderStates) {
    EXPECT_EQ(stated_unit_mm(write("a.stl", binary_stl(kBox, "part UNITS=cm "))), 10.0);
    EXPECT_EQ(stated_unit_mm(write("b.obj", "# unit: inch\nv 0 0 0\n")), 25.4);
    EXPECT_EQ(stated_unit_mm(write("c.obj", "# United parts\nv 0 0 0\n")), 0.0);
}

}  // namespace
}  // namespace meshwind
