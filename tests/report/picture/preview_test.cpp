#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <png.h>
#include <Eigen/Geometry>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "report/picture/preview.h"
#include "report/picture/preview_png.h"
#include "report/picture/preview_render.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

const Vector3f kWhite(1.0F, 1.0F, 1.0F);
const Vector3f kRed(1.0F, 0.0F, 0.0F);
const Vector3f kBlue(0.0F, 0.0F, 1.0F);

void add(PreviewMesh& mesh, const Vector3d& p, const Vector3d& normal, const Vector3f& colour) {
    mesh.position_mm.emplace_back(p.cast<float>());
    mesh.normal.emplace_back(normal.cast<float>());
    mesh.colour.push_back(colour);
    mesh.open.push_back(1.0F);
    mesh.across.push_back(0.0F);
}

// Closed cylinder along Z from 0; `segments` around.
PreviewMesh cylinder(double radius_mm, double length_mm, int segments) {
    PreviewMesh mesh;
    for (int k = 0; k < segments; ++k) {
        const auto first = static_cast<std::int32_t>(mesh.position_mm.size());
        const double a = 2.0 * kPi * k / segments;
        const double b = 2.0 * kPi * (k + 1) / segments;
        for (const double turn : {a, b}) {
            const Vector3d out(std::cos(turn), std::sin(turn), 0.0);
            for (const double z : {0.0, length_mm}) {
                add(mesh, radius_mm * out + z * Vector3d::UnitZ(), out, kWhite);
            }
        }
        for (const double z : {0.0, length_mm}) {
            add(mesh, z * Vector3d::UnitZ(), (z > 0.0 ? 1.0 : -1.0) * Vector3d::UnitZ(), kWhite);
        }
        mesh.face.push_back({first, first + 2, first + 3});
        mesh.face.push_back({first, first + 3, first + 1});
        mesh.face.push_back({first + 4, first + 2, first});
        mesh.face.push_back({first + 5, first + 1, first + 3});
    }
    return mesh;
}

// Square in the plane z, facing +Z.
void add_square(PreviewMesh& mesh, double half_mm, double z_mm, const Vector3f& colour) {
    const auto first = static_cast<std::int32_t>(mesh.position_mm.size());
    for (const auto& [x, y] : {std::pair(-1.0, -1.0), {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
        add(mesh, {half_mm * x, half_mm * y, z_mm}, Vector3d::UnitZ(), colour);
    }
    mesh.face.push_back({first, first + 1, first + 2});
    mesh.face.push_back({first, first + 2, first + 3});
}

double area_mm2(const PreviewImage& image, double px_per_mm) {
    double alpha = 0.0;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
        alpha += image.rgba[i] / 255.0;
    }
    return alpha / (px_per_mm * px_per_mm);
}

std::array<int, 4> middle_of(const PreviewImage& image) {
    const auto pixel = static_cast<std::size_t>(image.size.height_px / 2 * image.size.width_px +
                                                image.size.width_px / 2);
    std::array<int, 4> rgba{};
    for (std::size_t i = 0; i < 4; ++i) {
        rgba[i] = image.rgba[4 * pixel + i];
    }
    return rgba;
}

// What is in the middle when squares are painted on one of 10 mm at height 0.
std::array<int, 4> middle_with(const std::vector<std::pair<double, Vector3f>>& bands) {
    PreviewScene scene;
    add_square(scene.body, 10.0, 0.0, kWhite);
    for (const auto& [z_mm, colour] : bands) {
        add_square(scene.bands, 5.0, z_mm, colour);
    }
    scene.depth_mm = 1.0F;
    return middle_of(render(scene, view_of(scene, {40, 40})));
}

// A cylinder of radius R and length L whose axis is at t to the view shows a rectangle and two
// halves of an ellipse: 2 R L sin t + pi R^2 |cos t|. The 256-gon is too small by 2e-4; a pixel in
// doubt all along the outline of 1100 would be 1 %, the samples' middles are even about it.
TEST(PreviewRender, SilhouetteOfCylinderHasItsArea) {
    for (const double angle_deg : {0.0, 20.0, 57.0, 90.0, 140.0}) {
        PreviewScene scene;
        scene.body = cylinder(40.0, 150.0, 256);
        const double angle = rad_from_deg(angle_deg);
        scene.toward = {std::sin(angle), 0.0, std::cos(angle)};
        const PreviewView view = view_of(scene, {400, 250});
        const double expected =
            2.0 * 40.0 * 150.0 * std::sin(angle) + kPi * 40.0 * 40.0 * std::abs(std::cos(angle));
        EXPECT_NEAR(area_mm2(render(scene, view), view.px_per_mm), expected, 0.005 * expected)
            << angle_deg;
    }
}

TEST(PreviewRender, SceneFitsIntoThePictureWithAMargin) {
    PreviewScene scene;
    add_square(scene.body, 10.0, 0.0, kWhite);
    for (const PreviewSize size : {PreviewSize{100, 60}, {60, 100}, {17, 33}}) {
        const PreviewView view = view_of(scene, size);
        const int shorter = std::min(size.width_px, size.height_px);
        EXPECT_NEAR(view.px_per_mm * 20.0, 0.92 * shorter, 1e-6);
        const PreviewImage image = render(scene, view);
        ASSERT_EQ(image.rgba.size(), 4U * static_cast<unsigned>(size.width_px * size.height_px));
        EXPECT_EQ(image.rgba[3], 0);
        EXPECT_EQ(middle_of(image)[3], 255);
        EXPECT_NEAR(area_mm2(image, view.px_per_mm), 400.0, 400.0 * 4.0 / (0.92 * shorter) / 3.0);
    }
}

TEST(PreviewRender, BandsLieInTheOrderOfWindingWhateverTheirDepth) {
    const auto red = middle_with({{0.3, kBlue}, {-0.2, kRed}});
    const auto blue = middle_with({{-0.2, kRed}, {0.3, kBlue}});
    EXPECT_GT(red[0], 100);
    EXPECT_EQ(red[2], middle_with({{0.0, kRed}})[2]);
    EXPECT_GT(blue[2], 100);
    EXPECT_LT(blue[0], red[0]);
}

TEST(PreviewRender, BandsBehindTheBodyAreHidden) {
    EXPECT_EQ(middle_with({{-1.5, kRed}}), middle_with({}));
    EXPECT_NE(middle_with({{-0.5, kRed}}), middle_with({}));
}

TEST(PreviewRender, FreeFibreHidesBandsUnderIt) {
    EXPECT_EQ(middle_with({{5.0, kRed}, {0.0, kBlue}}), middle_with({{5.0, kRed}}));
}

TEST(PreviewRender, SameBytesForAnyNumberOfThreads) {
    PreviewScene scene;
    scene.body = cylinder(40.0, 150.0, 64);
    scene.toward = Vector3d(1.0, 0.4, 0.7).normalized();
    add_square(scene.bands, 60.0, 151.0, kRed);
    scene.depth_mm = 0.5F;
    const PreviewView view = view_of(scene, {160, 100});
    set_thread_count(1);
    const std::string one = png_bytes(render(scene, view));
    set_thread_count(2);
    const std::string two = png_bytes(render(scene, view));
    set_thread_count(0);
    EXPECT_EQ(one, two);
}

TEST(PreviewPng, LibraryReadsBackWhatWasWritten) {
    PreviewImage image{{5, 3}, std::vector<std::uint8_t>(60)};
    for (std::size_t i = 0; i < image.rgba.size(); ++i) {
        image.rgba[i] = static_cast<std::uint8_t>(37 * i);
    }
    const std::string bytes = png_bytes(image);
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()), 0);
    EXPECT_EQ(header.width, 5U);
    EXPECT_EQ(header.height, 3U);
    EXPECT_EQ(header.format, static_cast<png_uint_32>(PNG_FORMAT_RGBA));
    std::vector<std::uint8_t> read(image.rgba.size());
    ASSERT_NE(png_image_finish_read(&header, nullptr, read.data(), 0, nullptr), 0);
    EXPECT_EQ(read, image.rgba);
}

TEST(Preview, RefusesSizesThatAreNone) {
    for (const char* size : {"", "x", "100", "100x", "x100", "100x100x", "15x100", "100x16385",
                             "-100x100", "1e3x100", "100 x100", "99999999999x100"}) {
        try {
            check_preview({.file = "a.png", .size = size});
            ADD_FAILURE() << size;
        } catch (const InputError& error) {
            EXPECT_EQ(error.code(), "cli.png_size");
        }
    }
    EXPECT_NO_THROW(check_preview({.file = "a.png", .size = "16x16384"}));
    EXPECT_NO_THROW(check_preview({.file = "", .size = "none"}));
}

TEST(Preview, RefusesPlacesThatCannotBeWritten) {
    EXPECT_THROW(check_preview({.file = testing::TempDir()}), IoError);
    EXPECT_THROW(check_preview({.file = "no/such/folder/a.png"}), IoError);
}

}  // namespace
}  // namespace meshwind
