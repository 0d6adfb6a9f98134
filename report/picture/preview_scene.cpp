#include "report/picture/preview_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/parallel.h"
#include "core/small_linear.h"
#include "core/units.h"
#include "mesh/mandrel/extension.h"
#include "mesh/ray_query.h"

namespace meshwind {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

// Bands are drawn with so many stretches across, and stations at least this share of a width apart.
constexpr int kAcross = 4;
constexpr double kAlong = 0.2;

// A band is told from what it lies on by this share of its width and a few thicknesses.
constexpr double kDepthShare = 0.3;
constexpr double kDepthThicknesses = 2.0;

// Rays to the sky from each vertex: so many together, within bounds; how far, as a share of the
// part's size; how far off the wall they begin.
constexpr double kRays = 2e6;
constexpr double kLeastRays = 24.0;
constexpr double kMostRays = 96.0;
constexpr double kSkyAt = 0.5;
constexpr double kOffWall = 2e-3;

// Moments that differ by less than this are alike: the part has no such axis of its own.
constexpr double kAlike = 0.02;

// Of a skewed distribution, third moment over the 3/2 power of the second.
constexpr double kSkewed = 0.05;

// The end of an extension beyond the fibre on it, as a share of the band's width.
constexpr double kBeyondFibre = 0.5;

constexpr int kEndSegments = 96;

// sRGB, 0xRRGGBB, as light.
Vector3f linear(std::uint32_t rgb) {
    Vector3f colour;
    for (int i = 0; i < 3; ++i) {
        const float c = static_cast<float>((rgb >> (16 - 8 * i)) & 0xFFU) / 255.0F;
        colour[i] = c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
    }
    return colour;
}

// Told apart with any of the common kinds of colour blindness. Source: okabe_ito_2008_colour, its
// seven colours beside black.
Vector3f course_colour(std::size_t course) {
    constexpr std::array<std::uint32_t, 7> kColours = {0xE69F00, 0x56B4E9, 0x009E73, 0xF0E442,
                                                       0x0072B2, 0xD55E00, 0xCC79A7};
    return linear(kColours[course % kColours.size()]);
}

// From dark to light, evenly bright steps: five colours of matplotlib's viridis.
Vector3f scale_colour(double share) {
    constexpr std::array<std::uint32_t, 5> kStops = {0x440154, 0x3B528B, 0x21918C, 0x5EC962,
                                                     0xFDE725};
    const double place = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
    const auto rest = static_cast<float>(place - static_cast<double>(below));
    return (1.0F - rest) * linear(kStops[below]) + rest * linear(kStops[below + 1]);
}

const Vector3f& wall_colour() {
    static const Vector3f kColour = linear(0xE4E1DA);
    return kColour;
}
const Vector3f& extension_colour() {
    static const Vector3f kColour = linear(0xA3A8B0);
    return kColour;
}
const Vector3f& other_colour() {
    static const Vector3f kColour = linear(0x8C8880);
    return kColour;
}

// Height over a rim and distance from its axis.
struct Cylindrical {
    double height_mm;
    double radius_mm;
};
Cylindrical about(const Rim& rim, const Vector3d& p) {
    const double height = (p - rim.centre_mm).dot(rim.axis);
    return {height, (p - rim.centre_mm - height * rim.axis).norm()};
}

class Builder {
public:
    Builder(std::span<const WoundLayer> layers, PreviewColour colour)
        : layers_(layers),
          colour_(colour),
          setup_(layers.front().setup),
          wall_(setup_.wall->surface()),
          wall_faces_(setup_.mandrel.surface.face.size()),
          width_mm_(setup_.job.tow.width_mm) {}

    PreviewScene run() {
        const double stack_mm = setup_.job.tow.thickness_mm * static_cast<double>(layers_.size());
        scene_.depth_mm =
            static_cast<float>(kDepthShare * width_mm_ + kDepthThicknesses * stack_mm);
        if (colour_ == PreviewColour::Layers) {
            count_layers();
        } else {
            for (const WoundLayer& layer : layers_) {
                add_bands(layer);
            }
        }
        measure_extensions();
        add_wall();
        add_other_regions();
        add_ends();
        light();
        look();
        return std::move(scene_);
    }

private:
    // The rim on whose extension a point lies.
    [[nodiscard]] std::size_t rim_of(const Vector3d& p) const {
        std::size_t best = 0;
        double off = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < setup_.mandrel.rims.size(); ++i) {
            const Rim& rim = setup_.mandrel.rims[i];
            const auto [height, radius] = about(rim, p);
            const double here = std::hypot(radius - rim.radius_mm, std::min(0.0, height));
            if (here < off) {
                off = here;
                best = i;
            }
        }
        return best;
    }

    // How far fibre lies on each rim's extension.
    void measure_extensions() {
        reach_mm_.assign(setup_.mandrel.rims.size(), 0.0);
        if (reach_mm_.empty()) {
            return;
        }
        for (const WoundLayer& layer : layers_) {
            for (const Piece& piece : layer.plan.pieces) {
                for (const PathPoint& station : piece.path) {
                    if (at(station.at.face) >= wall_faces_) {
                        const std::size_t rim = rim_of(station.position_mm);
                        const double height =
                            about(setup_.mandrel.rims[rim], station.position_mm).height_mm;
                        reach_mm_[rim] =
                            std::max(reach_mm_[rim], height + (0.5 + kBeyondFibre) * width_mm_);
                    }
                }
            }
        }
        for (double& reach : reach_mm_) {
            reach = std::min(reach, setup_.job.mandrel.extension_mm);
        }
    }

    // Per face of the wall, of all layers together.
    void count_layers() {
        face_layers_.assign(wall_faces_, 0.0);
        for (const WoundLayer& layer : layers_) {
            const std::vector<double>& counted = layer.plan.face_layers;
            for (std::size_t f = 0; f < std::min(wall_faces_, counted.size()); ++f) {
                face_layers_[f] += counted[f];
                most_layers_ = std::max(most_layers_, face_layers_[f]);
            }
        }
    }

    // The wall with its extensions, which are cut where no more fibre lies on them.
    void add_wall() {
        PreviewMesh& body = scene_.body;
        const std::size_t corners = wall_.normal.size();
        body.position_mm.assign(corners, Vector3f::Zero());
        body.normal.resize(corners);
        body.colour.assign(corners, Vector3f::Zero());
        std::vector<float> weight(corners, 0.0F);
        for (std::size_t f = 0; f < wall_.face.size(); ++f) {
            const bool extension = f >= wall_faces_;
            if (extension && reach_mm_[rim_of(middle_of(f))] == 0.0) {
                continue;
            }
            const Vector3f colour = extension ? extension_colour() : colour_of_wall(f);
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t corner = at(wall_.corner[f][i]);
                const Vector3d& p = wall_.position_mm[at(wall_.face[f][i])];
                body.position_mm[corner] = (extension ? cut(p) : p).cast<float>();
                body.normal[corner] = wall_.normal[corner].cast<float>();
                body.colour[corner] += colour;
                weight[corner] += 1.0F;
            }
            body.face.push_back(wall_.corner[f]);
        }
        for (std::size_t i = 0; i < corners; ++i) {
            body.colour[i] /= std::max(1.0F, weight[i]);
        }
        // Corners that nothing uses lie where others do, so that they do not count in the view.
        for (std::size_t i = 0; i < corners; ++i) {
            if (weight[i] == 0.0F) {
                body.position_mm[i] = body.position_mm[at(body.face.front()[0])];
                body.normal[i] = Vector3f::UnitZ();
            }
        }
    }

    [[nodiscard]] Vector3d middle_of(std::size_t face) const {
        const auto& [a, b, c] = wall_.face[face];
        return (wall_.position_mm[at(a)] + wall_.position_mm[at(b)] + wall_.position_mm[at(c)]) /
               3.0;
    }

    [[nodiscard]] Vector3d cut(const Vector3d& p) const {
        const std::size_t i = rim_of(p);
        const Rim& rim = setup_.mandrel.rims[i];
        const double over = about(rim, p).height_mm - reach_mm_[i];
        return over > 0.0 ? Vector3d(p - over * rim.axis) : p;
    }

    [[nodiscard]] Vector3f colour_of_wall(std::size_t face) const {
        if (colour_ != PreviewColour::Layers || face_layers_[face] == 0.0) {
            return wall_colour();
        }
        return scale_colour(face_layers_[face] / most_layers_);
    }

    // What is not wound: flanges, bores.
    void add_other_regions() {
        const Mandrel& mandrel = setup_.mandrel;
        std::map<std::int32_t, bool> kept;
        for (const Region& region : mandrel.regions) {
            kept[region.id] = region.kept;
        }
        for (std::size_t f = 0; f < mandrel.whole.faces.size(); ++f) {
            if (kept[mandrel.whole_region[f]]) {
                continue;
            }
            std::array<Vector3d, 3> p;
            for (std::size_t i = 0; i < 3; ++i) {
                p[i] = mandrel.whole.points_mm[at(mandrel.whole.faces[f][i])];
            }
            const Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
            add_triangle(p, normal, other_colour());
        }
    }

    void add_triangle(const std::array<Vector3d, 3>& p, const Vector3d& normal,
                      const Vector3f& colour) {
        PreviewMesh& body = scene_.body;
        const auto first = static_cast<std::int32_t>(body.position_mm.size());
        for (const Vector3d& corner : p) {
            body.position_mm.emplace_back(corner.cast<float>());
            body.normal.emplace_back(normal.cast<float>());
            body.colour.push_back(colour);
        }
        body.face.push_back({first, first + 1, first + 2});
    }

    // Discs where extensions end.
    void add_ends() {
        for (std::size_t i = 0; i < reach_mm_.size(); ++i) {
            if (reach_mm_[i] == 0.0) {
                continue;
            }
            const Rim& rim = setup_.mandrel.rims[i];
            const Vector3d centre = rim.centre_mm + reach_mm_[i] * rim.axis;
            const Vector3d x = rim.axis.unitOrthogonal();
            const Vector3d y = rim.axis.cross(x);
            const auto point = [&](int k) -> Vector3d {
                const double turn = 2.0 * kPi * k / kEndSegments;
                return centre + rim.radius_mm * (std::cos(turn) * x + std::sin(turn) * y);
            };
            for (int k = 0; k < kEndSegments; ++k) {
                add_triangle({centre, point(k), point(k + 1)}, rim.axis, extension_colour());
            }
        }
    }

    void add_bands(const WoundLayer& layer) {
        const std::vector<std::size_t> course = courses_of(layer.plan.pieces);
        for (std::size_t i = 0; i < layer.plan.pieces.size(); ++i) {
            const Piece& piece = layer.plan.pieces[i];
            // Turns are paler.
            Vector3f colour = course_colour(course[i]);
            if (piece.kind == PieceKind::Transition) {
                colour = 0.55F * colour + 0.45F * linear(0xC8C8C8);
            }
            add_band(layer, piece, colour);
        }
    }

    void add_band(const WoundLayer& layer, const Piece& piece, const Vector3f& colour) {
        std::size_t before = 0;
        bool begun = false;
        for (std::size_t i = 0; i < piece.path.size(); ++i) {
            const PathPoint& station = piece.path[i];
            const bool last = i + 1 == piece.path.size();
            if (begun && !last && station.s_mm - piece.path[before].s_mm < kAlong * width_mm_) {
                continue;
            }
            add_station(layer.setup.wall->surface(), station, piece.string.gap_mm[i],
                        colour_ == PreviewColour::Course ? colour : colour_of(layer, piece, i));
            if (begun) {
                join_stations();
            }
            before = i;
            begun = true;
        }
    }

    [[nodiscard]] Vector3f colour_of(const WoundLayer& layer, const Piece& piece,
                                     std::size_t i) const {
        if (colour_ == PreviewColour::Slip) {
            return scale_colour(piece.slip[i] / std::max(1e-9, layer.setup.friction.holds()));
        }
        const double axial = std::min(1.0, std::abs(piece.path[i].tangent.z()));
        return scale_colour(std::acos(axial) / (0.5 * kPi));
    }

    // A row of vertices across the band, on the circle that the wall curves in there.
    void add_station(const Surface& surface, const PathPoint& station, double gap_mm,
                     const Vector3f& colour) {
        const Vector3d side = station.normal.cross(station.tangent);
        const double curvature = gap_mm > 0.0 ? 0.0 : curvature_per_mm(surface, station, side);
        for (int k = 0; k <= kAcross; ++k) {
            const double across = 2.0 * k / kAcross - 1.0;
            const double u = 0.5 * width_mm_ * across;
            const double turn = curvature * u;
            // (sin, 1 - cos) / curvature, also where it is 0.
            const double half = 0.5 * turn;
            const double sinc = std::abs(half) > 1e-6 ? std::sin(half) / half : 1.0;
            const double out = u * sinc * std::cos(half);
            const double down = u * sinc * std::sin(half);
            scene_.bands.position_mm.emplace_back(
                (station.position_mm + (gap_mm - down) * station.normal + out * side)
                    .cast<float>());
            scene_.bands.normal.emplace_back(
                (std::cos(turn) * station.normal + std::sin(turn) * side).cast<float>());
            scene_.bands.colour.push_back(colour);
            scene_.bands.across.push_back(static_cast<float>(across));
        }
    }

    // Of the wall across the fibre, > 0 convex; no band is bent by more than a right angle.
    [[nodiscard]] double curvature_per_mm(const Surface& surface, const PathPoint& station,
                                          const Vector3d& side) const {
        const std::size_t face = at(station.at.face);
        if (face >= surface.face.size()) {
            return 0.0;
        }
        double curvature = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const Matrix3d& shape = surface.shape_operator_per_mm[at(surface.corner[face][i])];
            curvature += station.at.bary[static_cast<Eigen::Index>(i)] * side.dot(shape * side);
        }
        const double most = kPi / width_mm_;
        return std::clamp(curvature, -most, most);
    }

    void join_stations() {
        constexpr std::int32_t kRow = kAcross + 1;
        const auto end = static_cast<std::int32_t>(scene_.bands.position_mm.size());
        for (std::int32_t k = 0; k < kAcross; ++k) {
            const std::int32_t here = end - kRow + k;
            const std::int32_t there = here - kRow;
            scene_.bands.face.push_back({there, here, here + 1});
            scene_.bands.face.push_back({there, here + 1, there + 1});
        }
    }

    // How much of the sky each vertex of the body sees.
    void light() {
        PreviewMesh& body = scene_.body;
        TriangleSoup soup;
        for (const Vector3f& p : body.position_mm) {
            soup.points_mm.emplace_back(p.cast<double>());
        }
        soup.faces = body.face;
        const RayQuery rays({&soup, 1});
        const double size_mm = diagonal_mm(soup);
        const int count = static_cast<int>(std::clamp(
            kRays / static_cast<double>(body.position_mm.size()), kLeastRays, kMostRays));
        body.open.assign(body.position_mm.size(), 1.0F);
        parallel_for(body.position_mm.size(), 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                const Vector3d normal = body.normal[v].cast<double>();
                const Vector3d from = soup.points_mm[v] + kOffWall * size_mm * normal;
                const Vector3d x = normal.unitOrthogonal();
                const Vector3d y = normal.cross(x);
                int free = 0;
                for (int k = 0; k < count; ++k) {
                    // Evenly over the hemisphere as the normal's cosine weighs it: a sunflower.
                    const double share = (k + 0.5) / count;
                    const double turn = k * kPi * (3.0 - std::sqrt(5.0));
                    const Vector3d way =
                        std::sqrt(share) * (std::cos(turn) * x + std::sin(turn) * y) +
                        std::sqrt(1.0 - share) * normal;
                    free += rays.occluded(from, from + kSkyAt * size_mm * way) ? 0 : 1;
                }
                body.open[v] = static_cast<float>(free) / static_cast<float>(count);
            }
        });
    }

    // Principal axes of the wall; where it has none, those of the mandrel.
    void look() {
        double area = 0.0;
        Vector3d centre = Vector3d::Zero();
        Matrix3d second = Matrix3d::Zero();
        for (std::size_t f = 0; f < wall_faces_; ++f) {
            const Vector3d p = middle_of(f);
            const double a = area_of(f);
            area += a;
            centre += a * p;
            second += a * p * p.transpose();
        }
        centre /= area;
        second = second / area - centre * centre.transpose();
        const auto [moment, axes] = principal_axes(second);  // rising
        const double alike = kAlike * moment[2];
        const bool first_alike = moment[2] - moment[1] < alike;
        const bool last_alike = moment[1] - moment[0] < alike;
        Vector3d longest = axes.col(2);
        if (first_alike) {
            const Vector3d off = last_alike ? Vector3d(Vector3d::Zero()) : Vector3d(axes.col(0));
            longest = square_to(Vector3d::UnitZ(), Vector3d::UnitX(), off);
        }
        Vector3d up = axes.col(1);
        if (last_alike) {
            up = square_to(Vector3d::UnitY(), Vector3d::UnitX(), longest);
        } else if (first_alike) {
            up = Vector3d(axes.col(0)).cross(longest);
        }
        longest = pointed(longest, Vector3d(0.0, 1e-3, 1.0));
        up = pointed(up, heavy_tail(centre, up, Vector3d(1e-3, 1.0, 1e-3)));
        scene_.up = up;
        scene_.toward = (0.55 * longest + 0.55 * up + longest.cross(up)).normalized();
    }

    [[nodiscard]] double area_of(std::size_t face) const {
        const auto& [a, b, c] = wall_.face[face];
        return 0.5 * (wall_.position_mm[at(b)] - wall_.position_mm[at(a)])
                         .cross(wall_.position_mm[at(c)] - wall_.position_mm[at(a)])
                         .norm();
    }

    static Vector3d square_to(const Vector3d& wish, const Vector3d& other, const Vector3d& axis) {
        const Vector3d v = wish - wish.dot(axis) * axis;
        return v.norm() > 0.1 ? Vector3d(v.normalized())
                              : Vector3d((other - other.dot(axis) * axis).normalized());
    }

    static Vector3d pointed(const Vector3d& axis, const Vector3d& along) {
        return axis.dot(along) < 0.0 ? Vector3d(-axis) : axis;
    }

    // Where the wall reaches further along an axis; `otherwise` where it is even.
    [[nodiscard]] Vector3d heavy_tail(const Vector3d& centre, const Vector3d& axis,
                                      const Vector3d& otherwise) const {
        double squares = 0.0;
        double cubes = 0.0;
        double area = 0.0;
        for (std::size_t f = 0; f < wall_faces_; ++f) {
            const double h = (middle_of(f) - centre).dot(axis);
            const double a = area_of(f);
            area += a;
            squares += a * h * h;
            cubes += a * h * h * h;
        }
        const double skew = cubes / area / std::pow(squares / area, 1.5);
        if (std::abs(skew) < kSkewed) {
            return otherwise;
        }
        return skew > 0.0 ? axis : Vector3d(-axis);
    }

    std::span<const WoundLayer> layers_;
    PreviewColour colour_;
    const Setup& setup_;
    const Surface& wall_;  // with extensions
    std::size_t wall_faces_;
    double width_mm_;
    std::vector<double> reach_mm_;  // per rim
    std::vector<double> face_layers_;
    double most_layers_ = 1.0;
    PreviewScene scene_;
};

}  // namespace

PreviewColour preview_colour(std::string_view name) {
    static const std::map<std::string_view, PreviewColour> kNames = {
        {"course", PreviewColour::Course},
        {"layers", PreviewColour::Layers},
        {"slip", PreviewColour::Slip},
        {"angle", PreviewColour::Angle}};
    return kNames.at(name);
}

PreviewScene preview_scene(std::span<const WoundLayer> layers, PreviewColour colour) {
    return Builder(layers, colour).run();
}

}  // namespace meshwind
