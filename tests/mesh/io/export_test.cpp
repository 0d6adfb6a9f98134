#include "mesh/io/export.h"

#include <cstring>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "core/error.h"

namespace meshwind {
namespace {

TriangleSoup corner() {
    TriangleSoup soup;
    soup.points_mm = {{-0.0, 0, 0}, {0.1, 0, 0}, {0, 1.0 / 3.0, 0}, {0, 0, 1e-7}};
    soup.faces = {{0, 2, 1}, {0, 1, 3}};
    return soup;
}

float float_at(const std::string& bytes, std::size_t offset) {
    float value = 0.0F;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

TEST(MeshFileBytes, WritesBinaryStl) {
    const std::string bytes = mesh_file_bytes(corner(), MeshFormat::Stl);
    ASSERT_EQ(bytes.size(), 84U + 2U * 50U);
    EXPECT_NE(bytes.substr(0, 5), "solid");
    EXPECT_EQ(bytes.substr(80, 4), std::string("\2\0\0\0", 4));
    EXPECT_EQ(float_at(bytes, 84 + 8), -1.0F);  // normal of the first triangle
    EXPECT_EQ(float_at(bytes, 84 + 12 + 12 + 4), static_cast<float>(1.0 / 3.0));
}

TEST(MeshFileBytes, WritesTextThatReadsBackExactly) {
    for (const MeshFormat format : {MeshFormat::Obj, MeshFormat::Ply, MeshFormat::Off}) {
        const std::string text = mesh_file_bytes(corner(), format);
        EXPECT_NE(text.find("0 0.3333333333333333 0\n"), std::string::npos);
        EXPECT_NE(text.find("0 0 1e-07\n"), std::string::npos);
        EXPECT_EQ(text.find("-0"), text.find("-07"));
    }
}

TEST(MeshFileBytes, CountsFacesFromOneInObjOnly) {
    EXPECT_NE(mesh_file_bytes(corner(), MeshFormat::Obj).find("f 1 3 2\n"), std::string::npos);
    EXPECT_NE(mesh_file_bytes(corner(), MeshFormat::Off).find("3 0 2 1\n"), std::string::npos);
    EXPECT_NE(mesh_file_bytes(corner(), MeshFormat::Ply).find("3 0 2 1\n"), std::string::npos);
    EXPECT_EQ(mesh_file_bytes(corner(), MeshFormat::Off).substr(0, 10), "OFF\n4 2 0\n");
}

TEST(MeshFormatOf, KnowsTheExtensionInEitherCase) {
    EXPECT_EQ(mesh_format_of("a/tee.STL"), MeshFormat::Stl);
    EXPECT_EQ(mesh_format_of("tee.obj"), MeshFormat::Obj);
    EXPECT_EQ(mesh_format_of("tee.ply"), MeshFormat::Ply);
    EXPECT_EQ(mesh_format_of("tee.off"), MeshFormat::Off);
    EXPECT_THROW((void)mesh_format_of("tee.step"), InputError);
    EXPECT_THROW((void)mesh_format_of("tee"), InputError);
}

TEST(WriteMeshFile, LeavesTheWholeFileOrNone) {
    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / "meshwind_export_test";
    std::filesystem::create_directories(folder);
    write_mesh_file(corner(), folder / "corner.off");
    std::ifstream file(folder / "corner.off", std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    EXPECT_EQ(text, mesh_file_bytes(corner(), MeshFormat::Off));
    EXPECT_FALSE(std::filesystem::exists(folder / "corner.off.part"));
    EXPECT_THROW(write_mesh_file(corner(), folder / "missing" / "corner.off"), IoError);
    // A folder in the file's place: the rename fails and the part is taken away.
    std::filesystem::create_directories(folder / "taken.off" / "inside");
    EXPECT_THROW(write_mesh_file(corner(), folder / "taken.off"), IoError);
    EXPECT_FALSE(std::filesystem::exists(folder / "taken.off.part"));
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace meshwind
