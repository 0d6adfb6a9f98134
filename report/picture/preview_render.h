/// Renders shaded triangles without a display, by a z-buffer with several samples a pixel.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace meshwind {

/// Triangles with values to interpolate over them; all but `face` per vertex. Mandrel frame.
struct PreviewMesh {
    std::vector<Eigen::Vector3f> position_mm;
    std::vector<Eigen::Vector3f> normal;  ///< unit, outward
    std::vector<Eigen::Vector3f> colour;  ///< linear red, green, blue, 0..1
    std::vector<float> open;              ///< body: share of the sky that is seen, 0..1
    std::vector<float> across;            ///< bands: -1 at one edge, 1 at the other
    std::vector<std::array<std::int32_t, 3>> face;
};

/// A body, and bands painted on it.
struct PreviewScene {
    PreviewMesh body;
    /// Each band is drawn over those before it, wherever it is not behind the body: bands on the
    /// body are not compared by depth, so the winding order is kept exactly. It is lit as the body
    /// under it.
    PreviewMesh bands;
    float depth_mm =
        0.0F;  ///< a band this far above the body is free of it, this far below it hidden
    Eigen::Vector3d toward = Eigen::Vector3d::UnitZ();  ///< to the viewer, unit
    Eigen::Vector3d up = Eigen::Vector3d::UnitY();      ///< not along `toward`
};

struct PreviewSize {
    int width_px = 1600;
    int height_px = 1000;
};

/// Parallel projection that fits a scene into a picture.
struct PreviewView {
    PreviewSize size;
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();   ///< rows: right, up, toward the viewer
    Eigen::Vector2d centre_mm = Eigen::Vector2d::Zero();  ///< right and up, in the picture's middle
    double px_per_mm = 1.0;
};

/// Rows from the top, four bytes a pixel: red, green and blue in sRGB, not multiplied by alpha;
/// alpha, 0 where nothing is.
struct PreviewImage {
    PreviewSize size;
    std::vector<std::uint8_t> rgba;
};

/// The view along `toward` that shows body and bands with a margin. \pre a body of >= 1 triangle
[[nodiscard]] PreviewView view_of(const PreviewScene& scene, const PreviewSize& size);

/// The picture; the same bytes for any number of threads. Edges are smoothed by 9 samples a pixel.
/// Accuracy: areas of silhouettes, tests/report/picture/preview_test.cpp.
[[nodiscard]] PreviewImage render(const PreviewScene& scene, const PreviewView& view);

}  // namespace meshwind
