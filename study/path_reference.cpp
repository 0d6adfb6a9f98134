#include "study/path_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include "mesh/smooth/patch.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Distance of the stored points in mm, each one step of the solver. A cubic between them is off by
// station^4 / 384 / radius^3: 2e-12 mm on a radius of 50 mm. Where the curvature jumps (tee), the
// step across is off by the square of it.
constexpr double kStationMm = 0.1;

// Half distance in mm over which normals are compared for their curvature: the nearest points are
// good to 1e-9 mm, which leaves 1e-8 of a curvature of 1 / 15 mm; the cut-off error is smaller.
constexpr double kDifferenceMm = 0.01;

// Reach of searches for the nearest point of a mesh, mm: beyond any part.
constexpr double kSearchMm = 1e5;

// Sine of the winding angle below which a path on a cylinder is taken as straight along it: the
// cotangent of the closed form would cancel.
constexpr double kAxialSine = 1e-9;

std::vector<double> even_stations(double length_mm, double station_mm) {
    const auto steps = static_cast<std::size_t>(std::max(1.0, std::ceil(length_mm / station_mm)));
    std::vector<double> s_mm(steps + 1);
    for (std::size_t i = 0; i <= steps; ++i) {
        s_mm[i] = length_mm * static_cast<double>(i) / static_cast<double>(steps);
    }
    return s_mm;
}

// Steps to the start of a path on patches: the miss falls at least tenfold with each.
constexpr int kStartSteps = 6;

class CylinderReference : public PathReference {
public:
    explicit CylinderReference(double radius_mm) : radius_mm_(radius_mm) {}

    SurfaceFoot foot(const Vector3d& near_mm) const override {
        const Vector3d out = Vector3d(near_mm.x(), near_mm.y(), 0.0).normalized();
        return {radius_mm_ * out + Vector3d(0.0, 0.0, near_mm.z()), out};
    }

    ReferencePath follow(const CurveState& start, double slip_ratio,
                         double length_mm) const override {
        const Vector3d out = foot(start.position_mm).normal;
        const Vector3d around(-out.y(), out.x(), 0.0);
        const double sine = start.tangent.dot(around);
        ReferencePath path{even_stations(length_mm, kStationMm), {}};
        for (const double s : path.s_mm) {
            const Unrolled at =
                std::abs(sine) < kAxialSine
                    ? Unrolled{sine * s, start.tangent.z() * s, sine, start.tangent.z()}
                    : unrolled(sine, start.tangent.z(), slip_ratio, s);
            const double turn = at.around_mm / radius_mm_;
            const Vector3d radial = std::cos(turn) * out + std::sin(turn) * around;
            const Vector3d hoop = std::cos(turn) * around - std::sin(turn) * out;
            CurveState state{radius_mm_ * radial, at.sine * hoop};
            state.position_mm.z() = start.position_mm.z() + at.along_mm;
            state.tangent.z() = at.cosine;
            path.states.push_back(state);
        }
        return path;
    }

private:
    struct Unrolled {
        double around_mm, along_mm, sine, cosine;
    };

    // With b = n x t to the left, kg > 0 turns the fibre from hoop towards the axis for sine > 0
    // and from it for sine < 0: d cot / ds = slip / R in the sense of travel around the cylinder.
    [[nodiscard]] Unrolled unrolled(double sine, double cosine, double slip_ratio, double s) const {
        const double side = sine < 0.0 ? -1.0 : 1.0;
        const double cot0 = cosine / std::abs(sine);
        const double rate = side * slip_ratio / radius_mm_;
        const double cot = cot0 + rate * s;
        const double secant = std::hypot(1.0, cot);  // 1 / sin
        Unrolled at{side * s * std::abs(sine), s * cosine, side / secant, cot / secant};
        if (rate != 0.0) {
            at.along_mm = (secant - std::hypot(1.0, cot0)) / rate;
            at.around_mm = side * (std::asinh(cot) - std::asinh(cot0)) / rate;
        }
        return at;
    }

    double radius_mm_;
};

struct ExactTorus {
    TorusShape shape;

    [[nodiscard]] Vector3d centre(const Vector3d& p) const {
        return shape.ring_radius_mm * Vector3d(p.x(), p.y(), 0.0).normalized();
    }
    [[nodiscard]] Vector3d normal(const Vector3d& p) const { return (p - centre(p)).normalized(); }
    [[nodiscard]] double normal_curvature(const Vector3d& p, const Vector3d& n,
                                          const Vector3d& t) const {
        const double rho = std::hypot(p.x(), p.y());
        const double hoop = (p.x() * t.y() - p.y() * t.x()) / rho;
        const double out = (p.x() * n.x() + p.y() * n.y()) / rho;
        return out / rho * hoop * hoop + (t.squaredNorm() - hoop * hoop) / shape.tube_radius_mm;
    }
    [[nodiscard]] Vector3d on_surface(const Vector3d& p) const {
        return centre(p) + shape.tube_radius_mm * normal(p);
    }
    [[nodiscard]] ShapeFoot foot(const Vector3d& p) const { return torus_foot(shape, p); }
};

struct ExactEllipsoid {
    EllipsoidShape shape;

    [[nodiscard]] Vector3d weights() const {
        const double equator = 1.0 / (shape.equator_radius_mm * shape.equator_radius_mm);
        return {equator, equator, 1.0 / (shape.pole_radius_mm * shape.pole_radius_mm)};
    }
    [[nodiscard]] Vector3d normal(const Vector3d& p) const {
        return weights().cwiseProduct(p).normalized();
    }
    [[nodiscard]] double normal_curvature(const Vector3d& p, const Vector3d& /*n*/,
                                          const Vector3d& t) const {
        return weights().cwiseProduct(t).dot(t) / weights().cwiseProduct(p).norm();
    }
    // Along the ray from the centre: the points handed over are on the surface but for rounding.
    [[nodiscard]] Vector3d on_surface(const Vector3d& p) const {
        return p / std::sqrt(weights().cwiseProduct(p).dot(p));
    }
    [[nodiscard]] ShapeFoot foot(const Vector3d& p) const { return ellipsoid_foot(shape, p); }
};

struct MadeSurface {
    std::string kind;
    MakeValues values;

    [[nodiscard]] Vector3d normal(const Vector3d& p) const { return foot(p).normal; }
    [[nodiscard]] double normal_curvature(const Vector3d& p, const Vector3d& /*n*/,
                                          const Vector3d& t) const {
        const Vector3d turn = normal(p + kDifferenceMm * t) - normal(p - kDifferenceMm * t);
        return t.dot(turn) / (2.0 * kDifferenceMm);
    }
    [[nodiscard]] Vector3d on_surface(const Vector3d& p) const { return foot(p).point_mm; }
    [[nodiscard]] ShapeFoot foot(const Vector3d& p) const { return mandrel_foot(kind, values, p); }
};

using State = std::array<double, 6>;  // position, tangent

// p' = t, t' = kg b - kn n; put back onto the surface at every stored point.
template <class Shape>
class SolvedReference : public PathReference {
public:
    explicit SolvedReference(Shape shape) : shape_(std::move(shape)) {}

    SurfaceFoot foot(const Vector3d& near_mm) const override {
        const ShapeFoot found = shape_.foot(near_mm);
        return {found.point_mm, found.normal};
    }

    ReferencePath follow(const CurveState& start, double slip_ratio,
                         double length_mm) const override {
        const auto rates = [&](const State& x, State& rate, double /*s*/) {
            const Vector3d p(x[0], x[1], x[2]);
            const Vector3d t(x[3], x[4], x[5]);
            const Vector3d n = shape_.normal(p);
            const double kn = shape_.normal_curvature(p, n, t);
            const Vector3d bend = kn * (slip_ratio * n.cross(t) - n);
            rate = {t.x(), t.y(), t.z(), bend.x(), bend.y(), bend.z()};
        };
        ReferencePath path{even_stations(length_mm, kStationMm), {}};
        path.states.push_back(on_surface(start));
        boost::numeric::odeint::runge_kutta_fehlberg78<State> solver;
        for (std::size_t i = 1; i < path.s_mm.size(); ++i) {
            const CurveState& from = path.states.back();
            State x{from.position_mm.x(), from.position_mm.y(), from.position_mm.z(),
                    from.tangent.x(),     from.tangent.y(),     from.tangent.z()};
            solver.do_step(rates, x, path.s_mm[i - 1], path.s_mm[i] - path.s_mm[i - 1]);
            path.states.push_back(
                on_surface({Vector3d(x[0], x[1], x[2]), Vector3d(x[3], x[4], x[5])}));
        }
        return path;
    }

private:
    [[nodiscard]] CurveState on_surface(const CurveState& state) const {
        const Vector3d p = shape_.on_surface(state.position_mm);
        const Vector3d n = shape_.normal(p);
        return {p, (state.tangent - n * n.dot(state.tangent)).normalized()};
    }

    Shape shape_;
};

class MeshReference : public PathReference {
public:
    MeshReference(const Surface& surface, const TraceOptions& options)
        : surface_(surface), options_(options), query_(query_of(surface)) {}

    SurfaceFoot foot(const Vector3d& near_mm) const override {
        const SurfacePoint point = nearest_point(query_, near_mm);
        if (options_.method == TraceMethod::Walk) {
            return {position_mm(surface_, point), smooth_normal(surface_, point)};
        }
        const PatchPlace place = on_patch(surface_, point.face, point.bary);
        return {place.position_mm, place.normal()};
    }

    ReferencePath follow(const CurveState& start, double slip_ratio,
                         double length_mm) const override {
        TraceOptions options = options_;
        options.max_length_mm = length_mm;
        const TraceResult traced =
            trace(surface_, start_at(surface_, query_, start.position_mm, options_.method),
                  start.tangent, {slip_ratio, slip_ratio}, options);
        ReferencePath path;
        for (const PathPoint& p : traced.path) {
            if (path.s_mm.empty() || p.s_mm > path.s_mm.back()) {
                path.s_mm.push_back(p.s_mm);
                path.states.push_back({p.position_mm, p.tangent});
            }
        }
        return path;
    }

private:
    const Surface& surface_;
    TraceOptions options_;
    RayQuery query_;
};

}  // namespace

CurveState ReferencePath::at(double s) const {
    if (states.size() < 2) {
        return states.front();
    }
    const auto after = std::upper_bound(s_mm.begin() + 1, s_mm.end() - 1, s);
    const auto i = static_cast<std::size_t>(after - s_mm.begin());
    const CurveState& a = states[i - 1];
    const CurveState& b = states[i];
    const double span = s_mm[i] - s_mm[i - 1];
    const double u = (s - s_mm[i - 1]) / span;
    const double v = 1.0 - u;
    const Vector3d chord = b.position_mm - a.position_mm;
    const Vector3d position =
        v * a.position_mm + u * b.position_mm +
        u * v * (v * (span * a.tangent - chord) - u * (span * b.tangent - chord));
    const Vector3d slope =
        chord / span +
        (1.0 - 2.0 * u) * (v * (a.tangent - chord / span) - u * (b.tangent - chord / span)) -
        u * v * (a.tangent + b.tangent - 2.0 * chord / span);
    return {position, slope.normalized()};
}

std::unique_ptr<PathReference> cylinder_reference(double radius_mm) {
    return std::make_unique<CylinderReference>(radius_mm);
}

std::unique_ptr<PathReference> torus_reference(const TorusShape& shape) {
    return std::make_unique<SolvedReference<ExactTorus>>(ExactTorus{shape});
}

std::unique_ptr<PathReference> ellipsoid_reference(const EllipsoidShape& shape) {
    return std::make_unique<SolvedReference<ExactEllipsoid>>(ExactEllipsoid{shape});
}

std::unique_ptr<PathReference> made_reference(std::string kind, MakeValues values) {
    return std::make_unique<SolvedReference<MadeSurface>>(
        MadeSurface{std::move(kind), std::move(values)});
}

std::unique_ptr<PathReference> mesh_reference(const Surface& surface, const TraceOptions& options) {
    return std::make_unique<MeshReference>(surface, options);
}

RayQuery query_of(const Surface& surface) {
    const TriangleSoup soup{surface.position_mm, surface.face};
    return RayQuery({&soup, 1});
}

SurfacePoint nearest_point(const RayQuery& query, const Vector3d& near_mm) {
    const ClosestPoint found = query.closest(near_mm, kSearchMm);
    return {found.face, found.bary};
}

SurfacePoint start_at(const Surface& surface, const RayQuery& query, const Vector3d& point_mm,
                      TraceMethod method) {
    SurfacePoint start = nearest_point(query, point_mm);
    if (method == TraceMethod::Walk) {
        return start;
    }
    // Each step leaves of the miss what facet and surface are inclined by.
    Vector3d aim_mm = point_mm;
    for (int i = 0; i < kStartSteps; ++i) {
        const PatchPlace place = on_patch(surface, start.face, start.bary);
        const Vector3d miss = place.position_mm - point_mm;
        const Vector3d normal = place.normal();
        aim_mm -= miss - normal * normal.dot(miss);
        start = nearest_point(query, aim_mm);
    }
    return start;
}

}  // namespace meshwind
