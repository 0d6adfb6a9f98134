#include "mesh/ray_query.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <embree3/rtcore.h>
#include <Eigen/Geometry>

#include "core/error.h"
#include "core/parallel.h"
#include "mesh/distance_table.h"
#include "mesh/radial_reach.h"

namespace meshwind {
namespace {

// Half length of a piece of a capsule that is not split further, as a share of its radius.
constexpr double kCapsuleResolution = 0.01;

// Without a table, distances are estimated up to here.
constexpr double kFarthest_mm = 1000.0;

// Nodes of a distance table: some 5 mm apart around a mandrel of half a metre, built in under a
// second.
constexpr double kTableNodes = 4e5;

// In such a table that far from the wall, in cells, no cell around a place is cut by the wall.
constexpr double kClearCells = 2.0;

// Keeps a bound a bound in spite of rounding: far more than that takes of lengths under a km.
constexpr double kBound_mm = 1e-6;

// Barycentric coordinates of the point of triangle abc nearest to p (by Voronoi regions of the
// triangle's features). Source: ericson_2004_collision, sec. 5.1.5.
Eigen::Vector3d closest_bary(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                             const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    const Eigen::Vector3d ab = b - a;
    const Eigen::Vector3d ac = c - a;
    const double d1 = ab.dot(p - a);
    const double d2 = ac.dot(p - a);
    if (d1 <= 0.0 && d2 <= 0.0) {
        return {1.0, 0.0, 0.0};
    }
    const double d3 = ab.dot(p - b);
    const double d4 = ac.dot(p - b);
    if (d3 >= 0.0 && d4 <= d3) {
        return {0.0, 1.0, 0.0};
    }
    const double d5 = ab.dot(p - c);
    const double d6 = ac.dot(p - c);
    if (d6 >= 0.0 && d5 <= d6) {
        return {0.0, 0.0, 1.0};
    }
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        const double v = d1 / (d1 - d3);
        return {1.0 - v, v, 0.0};
    }
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        const double w = d2 / (d2 - d6);
        return {1.0 - w, 0.0, w};
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0.0, 1.0 - w, w};
    }
    const double sum = va + vb + vc;
    return {va / sum, vb / sum, vc / sum};
}

// A disc that a triangle lies in.
struct Disc {
    Eigen::Vector3d centre_mm;
    Eigen::Vector3d normal;  // 0 where the triangle has none
    double radius_mm;

    // True where all of it is further than `distance_mm` from a place. The root of what the height
    // leaves of the distance, and the radius, are compared squared.
    [[nodiscard]] bool is_beyond(const Eigen::Vector3d& place_mm, double distance_mm) const {
        const Eigen::Vector3d off_mm = place_mm - centre_mm;
        const double over_mm = off_mm.dot(normal);
        const double reach_mm = distance_mm + kBound_mm;
        const double left_mm2 = reach_mm * reach_mm - over_mm * over_mm;
        const double more_mm2 =
            off_mm.squaredNorm() - over_mm * over_mm - radius_mm * radius_mm - left_mm2;
        return left_mm2 < 0.0 ||
               (more_mm2 > 0.0 && more_mm2 * more_mm2 > 4.0 * radius_mm * radius_mm * left_mm2);
    }
};

std::vector<Disc> discs_around(const TriangleSoup& soup) {
    std::vector<Disc> discs;
    discs.reserve(soup.faces.size());
    for (const auto& v : soup.faces) {
        const auto corner = [&](std::size_t i) -> const Eigen::Vector3d& {
            return soup.points_mm[static_cast<std::size_t>(v[i])];
        };
        const Eigen::Vector3d centre = (corner(0) + corner(1) + corner(2)) / 3.0;
        const double radius =
            kBound_mm + std::max({(corner(0) - centre).norm(), (corner(1) - centre).norm(),
                                  (corner(2) - centre).norm()});
        const Eigen::Vector3d across = (corner(1) - corner(0)).cross(corner(2) - corner(0));
        discs.push_back({centre, across.normalized(), radius});
    }
    return discs;
}

struct Search {
    const std::vector<TriangleSoup>* parts;
    const std::vector<std::vector<Disc>>* discs;
    Eigen::Vector3d query;
    ClosestPoint best;
};

ClosestPoint closest_of_triangle(const std::vector<TriangleSoup>& parts, std::int32_t part,
                                 std::int32_t face, const Eigen::Vector3d& query) {
    const TriangleSoup& soup = parts[static_cast<std::size_t>(part)];
    const auto& v = soup.faces[static_cast<std::size_t>(face)];
    const Eigen::Vector3d& a = soup.points_mm[static_cast<std::size_t>(v[0])];
    const Eigen::Vector3d& b = soup.points_mm[static_cast<std::size_t>(v[1])];
    const Eigen::Vector3d& c = soup.points_mm[static_cast<std::size_t>(v[2])];
    const Eigen::Vector3d bary = closest_bary(query, a, b, c);
    const Eigen::Vector3d point = bary[0] * a + bary[1] * b + bary[2] * c;
    return {part, face, bary, point, (point - query).norm()};
}

bool visit_triangle(RTCPointQueryFunctionArguments* args) {
    auto& search = *static_cast<Search*>(args->userPtr);
    ClosestPoint& best = search.best;
    // Most triangles whose boxes are near enough are not.
    if ((*search.discs)[args->geomID][args->primID].is_beyond(search.query, best.distance_mm)) {
        return false;
    }
    const auto part = static_cast<std::int32_t>(args->geomID);
    const auto face = static_cast<std::int32_t>(args->primID);
    const ClosestPoint here = closest_of_triangle(*search.parts, part, face, search.query);
    // The lowest part and face among equals, so that the answer does not depend on traversal order.
    const bool nearer =
        here.distance_mm < best.distance_mm ||
        (here.distance_mm == best.distance_mm &&
         (best.part < 0 || part < best.part || (part == best.part && face < best.face)));
    if (!nearer) {
        return false;
    }
    best = here;
    args->query->radius = std::nextafter(static_cast<float>(here.distance_mm), INFINITY);
    return true;
}

RTCRay ray_of(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double max) {
    RTCRay ray{};
    ray.org_x = static_cast<float>(origin.x());
    ray.org_y = static_cast<float>(origin.y());
    ray.org_z = static_cast<float>(origin.z());
    ray.dir_x = static_cast<float>(direction.x());
    ray.dir_y = static_cast<float>(direction.y());
    ray.dir_z = static_cast<float>(direction.z());
    ray.tfar = static_cast<float>(max);
    ray.mask = ~0U;
    return ray;
}

// The one device of the process: each takes half a MB of address space and threads of its own, and
// a CAD part of a thousand faces has as many queries at once.
RTCDevice shared_device() {
    static const std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> kDevice(
        rtcNewDevice(nullptr), rtcReleaseDevice);
    if (kDevice == nullptr) {
        throw NumericalError("mesh.ray_device", "",
                             "the ray tracing library Embree does not start");
    }
    return kDevice.get();
}

}  // namespace

struct RayQuery::Impl {
    DistanceTable table;
    RadialReach reach;

    std::vector<TriangleSoup> parts;
    std::vector<std::vector<Disc>> discs;  // per part and face
    RTCScene scene = nullptr;

    // Nearer than `best`, which may be none; else that.
    [[nodiscard]] ClosestPoint closer_than(const ClosestPoint& best,
                                           const Eigen::Vector3d& query) const {
        Search search{&parts, &discs, query, best};
        RTCPointQuery point{};
        point.x = static_cast<float>(query.x());
        point.y = static_cast<float>(query.y());
        point.z = static_cast<float>(query.z());
        point.radius = std::nextafter(static_cast<float>(best.distance_mm), INFINITY);
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(scene, &point, &context, visit_triangle, &search);
        return search.best;
    }

    ~Impl() {
        if (scene != nullptr) {
            rtcReleaseScene(scene);
        }
    }

    void add(unsigned id, const TriangleSoup& soup) const {
        if (soup.faces.empty()) {
            return;
        }
        RTCGeometry geometry = rtcNewGeometry(shared_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertex = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    3 * sizeof(float), soup.points_mm.size()));
        for (const Eigen::Vector3d& p : soup.points_mm) {
            for (const double x : p) {
                *vertex++ = static_cast<float>(x);
            }
        }
        auto* index = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), soup.faces.size()));
        for (const auto& face : soup.faces) {
            for (const std::int32_t v : face) {
                *index++ = static_cast<std::uint32_t>(v);
            }
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, id);
        rtcReleaseGeometry(geometry);
    }
};

RayQuery::RayQuery(std::span<const TriangleSoup> parts, double field_reach_mm)
    : impl_(std::make_unique<Impl>()) {
    impl_->parts.assign(parts.begin(), parts.end());
    impl_->scene = rtcNewScene(shared_device());
    rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
    for (std::size_t i = 0; i < impl_->parts.size(); ++i) {
        impl_->add(static_cast<unsigned>(i), impl_->parts[i]);
        impl_->discs.push_back(discs_around(impl_->parts[i]));
    }
    rtcCommitScene(impl_->scene);
    impl_->reach = RadialReach(impl_->parts);
    if (field_reach_mm > 0.0) {
        tabulate(field_reach_mm);
    }
}

void RayQuery::tabulate(double reach_mm) {
    DistanceTable& table = impl_->table;
    for (const TriangleSoup& part : impl_->parts) {
        for (const Eigen::Vector3d& point : part.points_mm) {
            table.parts.extend(point);
        }
    }
    if (table.parts.isEmpty()) {
        return;
    }
    const Eigen::Vector3d size = table.parts.sizes() + Eigen::Vector3d::Constant(2.0 * reach_mm);
    table.origin = table.parts.min() - Eigen::Vector3d::Constant(reach_mm);
    table.cell_mm = std::cbrt(size.prod() / kTableNodes);
    table.nodes = (size / table.cell_mm).array().ceil().cast<int>() + 1;
    table.cap_mm = std::nextafter(static_cast<float>(2.0 * reach_mm), 0.0F);
    table.distance_mm.resize(table.index(table.nodes - 1) + 1);
    parallel_for(static_cast<std::size_t>(table.nodes.z()), 1, [&](std::size_t layer, std::size_t) {
        // What is nearest to a node is near to the next one: nothing that is further is looked at.
        ClosestPoint nearest;
        for (Eigen::Array3i node(0, 0, static_cast<int>(layer)); node.y() < table.nodes.y();
             ++node.y()) {
            for (node.x() = 0; node.x() < table.nodes.x(); ++node.x()) {
                const Eigen::Vector3d point =
                    table.origin + table.cell_mm * node.cast<double>().matrix();
                ClosestPoint known{.distance_mm = 2.0 * reach_mm};
                if (nearest.part >= 0) {
                    const ClosestPoint again =
                        closest_of_triangle(impl_->parts, nearest.part, nearest.face, point);
                    known = again.distance_mm < known.distance_mm ? again : known;
                }
                nearest = impl_->closer_than(known, point);
                // One step down: single precision must not promise more than there is.
                table.distance_mm[table.index(node)] =
                    std::nextafter(static_cast<float>(nearest.distance_mm), 0.0F);
            }
        }
    });
    table.complete = true;
    table.find_room(reach_mm);
}

double RayQuery::distance_at_least_mm(const Eigen::Vector3d& query) const {
    const DistanceTable& table = impl_->table;
    if (table.distance_mm.empty()) {
        return 0.0;
    }
    const auto near = table.nearest_node(query);
    return near ? std::max(0.0, near->there_mm - near->off_mm)
                : table.parts.exteriorDistance(query);
}

RayQuery::~RayQuery() = default;
RayQuery::RayQuery(RayQuery&&) noexcept = default;
RayQuery& RayQuery::operator=(RayQuery&&) noexcept = default;

double RayQuery::first_hit_mm(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                              double max_mm) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = ray_of(origin, direction, max_mm);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(impl_->scene, &context, &query);
    return query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? max_mm
                                                       : static_cast<double>(query.ray.tfar);
}

bool RayQuery::occluded(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = ray_of(from, to - from, 1.0);
    rtcOccluded1(impl_->scene, &context, &ray);
    return ray.tfar < 0.0F;
}

ClosestPoint RayQuery::closest(const Eigen::Vector3d& query, double radius_mm) const {
    const double within_mm = std::min(radius_mm, impl_->table.at_most_mm(query));
    return impl_->closer_than({.distance_mm = within_mm}, query);
}

bool RayQuery::is_beyond(const Eigen::Vector3d& query, double distance_mm) const {
    return distance_at_least_mm(query) >= distance_mm ||
           impl_->reach.is_beyond(query, distance_mm) || impl_->table.is_beyond(query, distance_mm);
}

bool RayQuery::has_table() const {
    return !impl_->table.distance_mm.empty();
}

double RayQuery::room_from_mm(double z_mm, double need_mm) const {
    return impl_->table.room_beyond_mm(z_mm, need_mm);
}

bool RayQuery::capsule_clear(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                             double radius_mm) const {
    const Eigen::Vector3d centre = 0.5 * (from + to);
    const double reach = 0.5 * (to - from).norm();
    if (is_beyond(centre, reach + radius_mm)) {
        return true;
    }
    if (!impl_->table.distance_mm.empty() && reach > impl_->table.cell_mm) {
        // The table settles most of a long capsule piece by piece.
        return capsule_clear(from, centre, radius_mm) && capsule_clear(centre, to, radius_mm);
    }
    const double distance = closest(centre, reach + radius_mm).distance_mm;
    if (distance >= reach + radius_mm) {
        return true;
    }
    if (distance < radius_mm || reach < kCapsuleResolution * radius_mm) {
        return false;
    }
    return capsule_clear(from, centre, radius_mm) && capsule_clear(centre, to, radius_mm);
}

double RayQuery::distance_estimate_mm(const Eigen::Vector3d& query) const {
    const DistanceTable& table = impl_->table;
    if (table.distance_mm.empty()) {
        return closest(query, kFarthest_mm).distance_mm;
    }
    const double x = (query.x() - table.origin.x()) / table.cell_mm;
    const double y = (query.y() - table.origin.y()) / table.cell_mm;
    const double z = (query.z() - table.origin.z()) / table.cell_mm;
    // The cast cuts towards 0, so what is below it is looked for by itself.
    const bool within = x >= 0.0 && y >= 0.0 && z >= 0.0 && x < table.nodes.x() - 1 &&
                        y < table.nodes.y() - 1 && z < table.nodes.z() - 1;
    if (!within) {
        return table.parts.exteriorDistance(query);
    }
    const Eigen::Array3i node(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z));
    const Eigen::Array3d t(x - node.x(), y - node.y(), z - node.z());
    const auto nx = static_cast<std::size_t>(table.nodes.x());
    const std::size_t nxy = nx * static_cast<std::size_t>(table.nodes.y());
    const float* d = table.distance_mm.data() + table.index(node);
    const auto along_x = [&](const float* row) {
        return (1.0 - t.x()) * static_cast<double>(row[0]) + t.x() * static_cast<double>(row[1]);
    };
    const double bottom = (1.0 - t.y()) * along_x(d) + t.y() * along_x(d + nx);
    const double top = (1.0 - t.y()) * along_x(d + nxy) + t.y() * along_x(d + nxy + nx);
    const double estimate = (1.0 - t.z()) * bottom + t.z() * top;
    const double clear_mm = kClearCells * table.cell_mm;
    return table.is_coarse() && estimate < clear_mm ? closest(query, clear_mm).distance_mm
                                                    : estimate;
}

}  // namespace meshwind
