#include "report/picture/preview_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/parallel.h"
#include "core/small_linear.h"
#include "core/units.h"
#include "mesh/ray_query.h"
#include "report/picture/preview_bands.h"
#include "report/picture/preview_colours.h"

namespace meshwind {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

// A band is told from what it lies on by this share of its width and a few thicknesses.
constexpr double kDepthShare = 0.3;
constexpr double kDepthThicknesses = 2.0;

// Rays to the sky from each vertex: so many together, within bounds; how far, as a share of the
// part's size; how far off the wall they begin.
constexpr double kRays = 2e6;
constexpr double kMinRays = 24.0;
constexpr double kMaxRays = 96.0;
constexpr double kSkyAt = 0.5;
constexpr double kOffWall = 2e-3;

// Moments that differ by less than this are alike: the part has no such axis of its own.
constexpr double kAlike = 0.02;

// Of a skewed distribution, third moment over the 3/2 power of the second.
constexpr double kSkewed = 0.05;

// The end of an extension beyond the fibre on it, as a share of the band's width.
constexpr double kBeyondFibre = 0.5;

constexpr int kEndSegments = 96;

const Vector3f& wall_colour() {
    static const Vector3f kColour = linear_colour(0xE4E1DA);
    return kColour;
}
const Vector3f& extension_colour() {
    static const Vector3f kColour = linear_colour(0xA3A8B0);
    return kColour;
}
const Vector3f& other_colour() {
    static const Vector3f kColour = linear_colour(0x8C8880);
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

// The winding surface continued by extensions, whose faces follow its own.
struct ExtendedWall {
    const Surface& surface;
    std::size_t own_faces = 0;
};

Vector3d middle_of(const ExtendedWall& wall, std::size_t face) {
    return middle_mm(wall.surface.position_mm, wall.surface.face[face]);
}

double area_of(const ExtendedWall& wall, std::size_t face) {
    return area_mm2(wall.surface.position_mm, wall.surface.face[face]);
}

// The rim on whose extension a point lies.
std::size_t rim_of(const std::vector<Rim>& rims, const Vector3d& p) {
    std::size_t best = 0;
    double off = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < rims.size(); ++i) {
        const Rim& rim = rims[i];
        const auto [height, radius] = about(rim, p);
        const double here = std::hypot(radius - rim.radius_mm, std::min(0.0, height));
        if (here < off) {
            off = here;
            best = i;
        }
    }
    return best;
}

// Per rim, how far its extension is drawn: as far as fibre lies on it.
std::vector<double> drawn_extensions_mm(std::span<const WoundLayer> layers,
                                        const ExtendedWall& wall) {
    const Setup& setup = layers.front().setup;
    const std::vector<Rim>& rims = setup.mandrel.rims;
    const double beyond_mm = (0.5 + kBeyondFibre) * setup.job.tow.width_mm;
    std::vector<double> reach_mm(rims.size(), 0.0);
    if (reach_mm.empty()) {
        return reach_mm;
    }
    for (const WoundLayer& layer : layers) {
        for (const Piece& piece : layer.plan.pieces) {
            for (const PathPoint& station : piece.path) {
                if (at(station.at.face) >= wall.own_faces) {
                    const std::size_t rim = rim_of(rims, station.position_mm);
                    const double height = about(rims[rim], station.position_mm).height_mm;
                    reach_mm[rim] = std::max(reach_mm[rim], height + beyond_mm);
                }
            }
        }
    }
    for (double& reach : reach_mm) {
        reach = std::min(reach, setup.job.mandrel.extension_mm);
    }
    return reach_mm;
}

// Layers of fibre on the faces of the wall.
struct LayerCount {
    std::vector<double> of_face;  // empty: they are not shown
    double most = 1.0;
};

// Of all layers together.
LayerCount count_layers(std::span<const WoundLayer> layers, std::size_t faces) {
    LayerCount count;
    count.of_face.assign(faces, 0.0);
    for (const WoundLayer& layer : layers) {
        const std::vector<double>& counted = layer.plan.face_layers;
        for (std::size_t f = 0; f < std::min(faces, counted.size()); ++f) {
            count.of_face[f] += counted[f];
            count.most = std::max(count.most, count.of_face[f]);
        }
    }
    return count;
}

Vector3f colour_of_wall(const LayerCount& count, std::size_t face) {
    if (count.of_face.empty() || count.of_face[face] == 0.0) {
        return wall_colour();
    }
    return scale_colour(count.of_face[face] / count.most);
}

// A point of an extension, no further out than that is drawn.
Vector3d cut(const std::vector<Rim>& rims, std::span<const double> reach_mm, const Vector3d& p) {
    const std::size_t i = rim_of(rims, p);
    const Rim& rim = rims[i];
    const double over = about(rim, p).height_mm - reach_mm[i];
    return over > 0.0 ? Vector3d(p - over * rim.axis) : p;
}

// The wall with its extensions, which are cut where no more fibre lies on them.
PreviewMesh wall_mesh(const ExtendedWall& wall, const std::vector<Rim>& rims,
                      std::span<const double> reach_mm, const LayerCount& count) {
    PreviewMesh body;
    const Surface& surface = wall.surface;
    const std::size_t corners = surface.normal.size();
    body.position_mm.assign(corners, Vector3f::Zero());
    body.normal.resize(corners);
    body.colour.assign(corners, Vector3f::Zero());
    std::vector<float> weight(corners, 0.0F);
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        const bool extension = f >= wall.own_faces;
        if (extension && reach_mm[rim_of(rims, middle_of(wall, f))] == 0.0) {
            continue;
        }
        const Vector3f colour = extension ? extension_colour() : colour_of_wall(count, f);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t corner = at(surface.corner[f][i]);
            const Vector3d& p = surface.position_mm[at(surface.face[f][i])];
            body.position_mm[corner] = (extension ? cut(rims, reach_mm, p) : p).cast<float>();
            body.normal[corner] = surface.normal[corner].cast<float>();
            body.colour[corner] += colour;
            weight[corner] += 1.0F;
        }
        body.face.push_back(surface.corner[f]);
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
    return body;
}

void add_triangle(const std::array<Vector3d, 3>& p, const Vector3d& normal, const Vector3f& colour,
                  PreviewMesh& body) {
    const auto first = static_cast<std::int32_t>(body.position_mm.size());
    for (const Vector3d& corner : p) {
        body.position_mm.emplace_back(corner.cast<float>());
        body.normal.emplace_back(normal.cast<float>());
        body.colour.push_back(colour);
    }
    body.face.push_back({first, first + 1, first + 2});
}

// What is not wound: flanges, bores.
void add_other_regions(const Mandrel& mandrel, PreviewMesh& body) {
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
        add_triangle(p, normal, other_colour(), body);
    }
}

// Discs where extensions end.
void add_ends(const std::vector<Rim>& rims, std::span<const double> reach_mm, PreviewMesh& body) {
    for (std::size_t i = 0; i < reach_mm.size(); ++i) {
        if (reach_mm[i] == 0.0) {
            continue;
        }
        const Rim& rim = rims[i];
        const Vector3d centre = rim.centre_mm + reach_mm[i] * rim.axis;
        const Vector3d x = rim.axis.unitOrthogonal();
        const Vector3d y = rim.axis.cross(x);
        const auto point = [&](int k) -> Vector3d {
            const double turn = 2.0 * kPi * k / kEndSegments;
            return centre + rim.radius_mm * (std::cos(turn) * x + std::sin(turn) * y);
        };
        for (int k = 0; k < kEndSegments; ++k) {
            add_triangle({centre, point(k), point(k + 1)}, rim.axis, extension_colour(), body);
        }
    }
}

// Per vertex of the body, the share of the sky that it sees.
std::vector<float> open_sky(const PreviewMesh& body) {
    TriangleSoup soup;
    for (const Vector3f& p : body.position_mm) {
        soup.points_mm.emplace_back(p.cast<double>());
    }
    soup.faces = body.face;
    const RayQuery rays({&soup, 1});
    const double size_mm = diagonal_mm(soup);
    const int count = static_cast<int>(
        std::clamp(kRays / static_cast<double>(body.position_mm.size()), kMinRays, kMaxRays));
    std::vector<float> open(body.position_mm.size(), 1.0F);
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
                const Vector3d way = std::sqrt(share) * (std::cos(turn) * x + std::sin(turn) * y) +
                                     std::sqrt(1.0 - share) * normal;
                free += rays.occluded(from, from + kSkyAt * size_mm * way) ? 0 : 1;
            }
            open[v] = static_cast<float>(free) / static_cast<float>(count);
        }
    });
    return open;
}

struct Look {
    Vector3d toward;  // the viewer, unit
    Vector3d up;
};

Vector3d square_to(const Vector3d& wish, const Vector3d& other, const Vector3d& axis) {
    const Vector3d v = wish - wish.dot(axis) * axis;
    return v.norm() > 0.1 ? Vector3d(v.normalized())
                          : Vector3d((other - other.dot(axis) * axis).normalized());
}

Vector3d pointed(const Vector3d& axis, const Vector3d& along) {
    return axis.dot(along) < 0.0 ? Vector3d(-axis) : axis;
}

// Where the wall reaches further along an axis; `otherwise` where it is even.
Vector3d heavy_tail(const ExtendedWall& wall, const Vector3d& centre, const Vector3d& axis,
                    const Vector3d& otherwise) {
    double squares = 0.0;
    double cubes = 0.0;
    double area = 0.0;
    for (std::size_t f = 0; f < wall.own_faces; ++f) {
        const double h = (middle_of(wall, f) - centre).dot(axis);
        const double a = area_of(wall, f);
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

// By the principal axes of the wall; where it has none, by those of the mandrel.
Look look_at(const ExtendedWall& wall) {
    double area = 0.0;
    Vector3d centre = Vector3d::Zero();
    Matrix3d second = Matrix3d::Zero();
    for (std::size_t f = 0; f < wall.own_faces; ++f) {
        const Vector3d p = middle_of(wall, f);
        const double a = area_of(wall, f);
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
    up = pointed(up, heavy_tail(wall, centre, up, Vector3d(1e-3, 1.0, 1e-3)));
    return {(0.55 * longest + 0.55 * up + longest.cross(up)).normalized(), up};
}

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
    const Setup& setup = layers.front().setup;
    const Mandrel& mandrel = setup.mandrel;
    const ExtendedWall wall{setup.wall->surface(), mandrel.surface.face.size()};
    PreviewScene scene;
    const double stack_mm = setup.job.tow.thickness_mm * static_cast<double>(layers.size());
    scene.depth_mm =
        static_cast<float>(kDepthShare * setup.job.tow.width_mm + kDepthThicknesses * stack_mm);
    LayerCount count;
    if (colour == PreviewColour::Layers) {
        count = count_layers(layers, wall.own_faces);
    } else {
        scene.bands = preview_bands(layers, colour);
    }
    const std::vector<double> reach_mm = drawn_extensions_mm(layers, wall);
    scene.body = wall_mesh(wall, mandrel.rims, reach_mm, count);
    add_other_regions(mandrel, scene.body);
    add_ends(mandrel.rims, reach_mm, scene.body);
    scene.body.open = open_sky(scene.body);
    const Look look = look_at(wall);
    scene.toward = look.toward;
    scene.up = look.up;
    return scene;
}

}  // namespace meshwind
