#include "report/picture/preview_render.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/parallel.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int kSamples = 3;       // a pixel's, in either direction
constexpr int kTileRows_px = 16;  // some megabytes of samples at a time
constexpr double kMargin = 0.04;  // of the picture, on each side

// Light, in the viewer's axes: one lamp over the left shoulder, the sky, and what the ground sends
// back.
constexpr float kLamp = 0.62F;
constexpr float kSky = 0.60F;
constexpr float kGround = 0.32F;
constexpr float kGloss = 0.10F;
constexpr float kInside = 0.35F;  // of all of it: seen through an open end

// A band darkens toward its edges, so that bands of one colour are told apart.
constexpr float kEdgeFrom = 0.80F;  // of its half width
constexpr float kEdgeShade = 0.45F;
constexpr float kCrown = 0.12F;

constexpr float kNothing = -std::numeric_limits<float>::infinity();

struct Sample {
    float depth_mm = kNothing;  // toward the viewer
    Vector3f normal = Vector3f::Zero();
    Vector3f colour = Vector3f::Zero();
    float open = 1.0F;
};

// A mesh as the viewer sees it: x and y in samples from the top left, z toward the viewer.
struct Seen {
    const PreviewMesh* mesh;
    std::vector<Vector3d> position;
    std::vector<Vector3f> normal;
    std::vector<std::vector<std::int32_t>> of_tile;  // faces, in order
};

Seen seen(const PreviewMesh& mesh, const PreviewView& view, std::size_t tiles) {
    Seen result{&mesh, {}, {}, std::vector<std::vector<std::int32_t>>(tiles)};
    const double scale = kSamples * view.px_per_mm;
    const Vector2d middle = 0.5 * kSamples * Vector2d(view.size.width_px, view.size.height_px);
    result.position.reserve(mesh.position_mm.size());
    result.normal.reserve(mesh.normal.size());
    for (const Vector3f& p : mesh.position_mm) {
        const Vector3d v = view.axes * p.cast<double>();
        result.position.emplace_back(middle.x() + scale * (v.x() - view.centre_mm.x()),
                                     middle.y() - scale * (v.y() - view.centre_mm.y()), v.z());
    }
    const Eigen::Matrix3f axes = view.axes.cast<float>();
    for (const Vector3f& n : mesh.normal) {
        result.normal.emplace_back(axes * n);
    }
    constexpr double kTile = kTileRows_px * kSamples;
    for (std::size_t f = 0; f < mesh.face.size(); ++f) {
        const auto& [a, b, c] = mesh.face[f];
        const auto [low, high] = std::minmax(
            {result.position[at(a)].y(), result.position[at(b)].y(), result.position[at(c)].y()});
        const double last = std::min(std::floor(high / kTile), static_cast<double>(tiles) - 1.0);
        for (double tile = std::max(0.0, std::floor(low / kTile)); tile <= last; ++tile) {
            result.of_tile[static_cast<std::size_t>(tile)].push_back(static_cast<std::int32_t>(f));
        }
    }
    return result;
}

// The samples of some rows of the picture.
class Tile {
public:
    Tile(const PreviewView& view, int first_row_px)
        : width_(kSamples * view.size.width_px),
          first_(kSamples * first_row_px),
          rows_(kSamples * std::min(kTileRows_px, view.size.height_px - first_row_px)),
          samples_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(rows_)) {}

    // Nearest wins.
    void draw_body(const Seen& body, std::int32_t face) {
        visit(body, face, [&](Sample& sample, const Vector3f& bary, float depth_mm) {
            if (depth_mm > sample.depth_mm) {
                sample.depth_mm = depth_mm;
                sample.normal = blend(body.normal, body.mesh->face[at(face)], bary);
                sample.colour = blend(body.mesh->colour, body.mesh->face[at(face)], bary);
                sample.open = blend(body.mesh->open, body.mesh->face[at(face)], bary);
            }
        });
    }

    // The last wins, unless it is behind the body.
    void draw_band(const Seen& bands, std::int32_t face, float limit_mm) {
        const auto& corners = bands.mesh->face[at(face)];
        visit(bands, face, [&](Sample& sample, const Vector3f& bary, float depth_mm) {
            const Vector3f normal = blend(bands.normal, corners, bary);
            if (normal.z() <= 0.0F || depth_mm < sample.depth_mm - limit_mm) {
                return;
            }
            if (depth_mm > sample.depth_mm + limit_mm) {
                sample.depth_mm = depth_mm;
                sample.normal = normal;
                sample.open = 1.0F;
            }
            const float across = std::abs(blend(bands.mesh->across, corners, bary));
            const float edge = std::max(0.0F, across - kEdgeFrom) / (1.0F - kEdgeFrom);
            sample.colour = (1.0F - kCrown * across * across - kEdgeShade * edge * edge) *
                            blend(bands.mesh->colour, corners, bary);
        });
    }

    // A pixel of the picture, row counted from the tile's first.
    void resolve(int column_px, int row_px, std::uint8_t* rgba) const {
        Vector3f sum = Vector3f::Zero();
        int covered = 0;
        for (int y = 0; y < kSamples; ++y) {
            for (int x = 0; x < kSamples; ++x) {
                const Sample& sample =
                    samples_[index(kSamples * column_px + x, kSamples * row_px + y)];
                if (sample.depth_mm != kNothing) {
                    sum += lit(sample);
                    ++covered;
                }
            }
        }
        for (int i = 0; i < 3; ++i) {
            rgba[i] = covered == 0 ? std::uint8_t{0} : srgb(sum[i] / static_cast<float>(covered));
        }
        constexpr int kAll = kSamples * kSamples;
        rgba[3] = static_cast<std::uint8_t>((255 * covered + kAll / 2) / kAll);
    }

private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }

    template <typename Value>
    static Value blend(const std::vector<Value>& of, const std::array<std::int32_t, 3>& corners,
                       const Vector3f& bary) {
        return bary[0] * of[at(corners[0])] + bary[1] * of[at(corners[1])] +
               bary[2] * of[at(corners[2])];
    }

    // Calls `found(sample, bary, depth_mm)` for each sample whose middle the triangle covers.
    template <typename Found>
    void visit(const Seen& mesh, std::int32_t face, const Found& found) {
        const auto& corners = mesh.mesh->face[at(face)];
        const Vector3d& a = mesh.position[at(corners[0])];
        const Vector3d& b = mesh.position[at(corners[1])];
        const Vector3d& c = mesh.position[at(corners[2])];
        const double area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
        if (area == 0.0) {
            return;
        }
        const auto [left, right] = std::minmax({a.x(), b.x(), c.x()});
        const auto [top, bottom] = std::minmax({a.y(), b.y(), c.y()});
        const int x1 = std::min(width_ - 1, static_cast<int>(std::floor(right - 0.5)));
        const int y1 = std::min(first_ + rows_ - 1, static_cast<int>(std::floor(bottom - 0.5)));
        const int x0 = std::max(0, static_cast<int>(std::ceil(left - 0.5)));
        for (int y = std::max(first_, static_cast<int>(std::ceil(top - 0.5))); y <= y1; ++y) {
            const double py = y + 0.5;
            for (int x = x0; x <= x1; ++x) {
                const double px = x + 0.5;
                const double wb =
                    ((px - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (py - a.y())) / area;
                const double wc =
                    ((b.x() - a.x()) * (py - a.y()) - (px - a.x()) * (b.y() - a.y())) / area;
                const double wa = 1.0 - wb - wc;
                if (wa >= 0.0 && wb >= 0.0 && wc >= 0.0) {
                    found(samples_[index(x, y - first_)], Vector3d(wa, wb, wc).cast<float>(),
                          static_cast<float>(wa * a.z() + wb * b.z() + wc * c.z()));
                }
            }
        }
    }

    static Vector3f lit(const Sample& sample) {
        static const Vector3f kTowardLamp = Vector3f(-0.30F, 0.58F, 0.76F).normalized();
        static const Vector3f kHalfWay = (kTowardLamp + Vector3f::UnitZ()).normalized();
        const bool inside = sample.normal.z() < 0.0F;
        const Vector3f normal = (inside ? Vector3f(-sample.normal) : sample.normal).normalized();
        const float lamp = std::max(0.0F, normal.dot(kTowardLamp));
        const float height = 0.5F + 0.5F * normal.y();
        const float around = (kGround + (kSky - kGround) * height) * sample.open;
        float gloss = std::max(0.0F, normal.dot(kHalfWay));
        for (int i = 0; i < 5; ++i) {
            gloss *= gloss;
        }
        const Vector3f light =
            (kLamp * lamp * (0.5F + 0.5F * sample.open) + around) * sample.colour +
            Vector3f::Constant(kGloss * gloss * sample.open);
        return inside ? Vector3f(kInside * light) : light;
    }

    static std::uint8_t srgb(float linear) {
        const float c = std::clamp(linear, 0.0F, 1.0F);
        const float s = c <= 0.0031308F ? 12.92F * c : 1.055F * std::pow(c, 1.0F / 2.4F) - 0.055F;
        return static_cast<std::uint8_t>(std::lround(255.0F * s));
    }

    int width_;
    int first_;
    int rows_;
    std::vector<Sample> samples_;
};

}  // namespace

PreviewView view_of(const PreviewScene& scene, const PreviewSize& size) {
    PreviewView view;
    view.size = size;
    const Vector3d right = scene.up.cross(scene.toward).normalized();
    view.axes.row(0) = right;
    view.axes.row(1) = scene.toward.cross(right);
    view.axes.row(2) = scene.toward;
    Eigen::AlignedBox2d box;
    for (const PreviewMesh* mesh : {&scene.body, &scene.bands}) {
        for (const Vector3f& p : mesh->position_mm) {
            box.extend((view.axes * p.cast<double>()).head<2>());
        }
    }
    view.centre_mm = box.center();
    const double room = 1.0 - 2.0 * kMargin;
    view.px_per_mm =
        std::min(room * size.width_px / box.sizes().x(), room * size.height_px / box.sizes().y());
    return view;
}

PreviewImage render(const PreviewScene& scene, const PreviewView& view) {
    const auto width = static_cast<std::size_t>(view.size.width_px);
    const auto height = static_cast<std::size_t>(view.size.height_px);
    PreviewImage image{view.size, std::vector<std::uint8_t>(4 * width * height)};
    const std::size_t tiles = (height + kTileRows_px - 1) / kTileRows_px;
    const Seen body = seen(scene.body, view, tiles);
    const Seen bands = seen(scene.bands, view, tiles);
    parallel_for(tiles, 1, [&](std::size_t t, std::size_t) {
        const int first = static_cast<int>(t) * kTileRows_px;
        Tile tile(view, first);
        for (const std::int32_t face : body.of_tile[t]) {
            tile.draw_body(body, face);
        }
        for (const std::int32_t face : bands.of_tile[t]) {
            tile.draw_band(bands, face, scene.depth_mm);
        }
        for (int y = first; y < std::min(first + kTileRows_px, view.size.height_px); ++y) {
            for (int x = 0; x < view.size.width_px; ++x) {
                tile.resolve(x, y - first,
                             &image.rgba[4 * (static_cast<std::size_t>(y) * width +
                                              static_cast<std::size_t>(x))]);
            }
        }
    });
    return image;
}

}  // namespace meshwind
