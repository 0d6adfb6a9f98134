#include "mesh/brep/occt/occt_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Sphere.hxx>
#include <gp_Torus.hxx>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/units.h"
#include "mesh/nearest.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Newton's way to the nearest point ends when it moves by less, mm, or has made so many steps.
constexpr double kFound_mm = 1e-10;
constexpr int kMaxSteps = 30;

// Edges are looked along at so many places for the nearest point.
constexpr int kEdgePlaces = 64;

// Rings and spokes of the places about a point at which its surface is evaluated.
constexpr int kJetRings = 3;
constexpr int kJetSpokes = 12;
constexpr double kJetReach = 1.0;          // of the longest edge there,
constexpr double kJetNearest = 0.15;       // of that, places that are taken
constexpr double kJetMostTurn_rad = 0.35;  // but so that the surface turns by no more

constexpr double kFlat_per_mm = 1e-9;

// The tangents of a place span less of a square than this share where it is a pole.
constexpr double kPole = 1e-7;

struct SurfacePlace {
    Vector3d at, by_u, by_v, by_uu, by_vv, by_uv;
};

SurfacePlace evaluate(const BRepAdaptor_Surface& surface, const Vector2d& uv) {
    gp_Pnt p;
    gp_Vec u, v, uu, vv, uv_second;
    surface.D2(uv.x(), uv.y(), p, u, v, uu, vv, uv_second);
    return {vector_of(p),  vector_of(u),  vector_of(v),
            vector_of(uu), vector_of(vv), vector_of(uv_second)};
}

std::string kind_of(GeomAbs_SurfaceType type) {
    switch (type) {
        case GeomAbs_Plane:
            return "plane";
        case GeomAbs_Cylinder:
            return "cylinder";
        case GeomAbs_Cone:
            return "cone";
        case GeomAbs_Sphere:
            return "sphere";
        case GeomAbs_Torus:
            return "torus";
        case GeomAbs_BezierSurface:
        case GeomAbs_BSplineSurface:
            return "spline";
        default:
            return "other";
    }
}

void take_axis(const gp_Ax1& axis, CadFace& face) {
    face.axis_point_mm = vector_of(axis.Location());
    face.axis_direction = vector_of(axis.Direction());
}

}  // namespace

struct OcctFaces::Face {
    TopoDS_Face face;
    BRepAdaptor_Surface surface;  // without its borders
    bool reversed = false;
    std::vector<Vector2d> uv;  // where points are looked for from, those of `known`
    NearestPoints known{{}};

    explicit Face(const TopoDS_Face& of)
        : face(of), surface(of, Standard_False), reversed(of.Orientation() == TopAbs_REVERSED) {}

    [[nodiscard]] Vector2d clamped(Vector2d uv_wanted) const {
        if (!surface.IsUPeriodic()) {
            uv_wanted.x() =
                std::clamp(uv_wanted.x(), surface.FirstUParameter(), surface.LastUParameter());
        }
        if (!surface.IsVPeriodic()) {
            uv_wanted.y() =
                std::clamp(uv_wanted.y(), surface.FirstVParameter(), surface.LastVParameter());
        }
        return uv_wanted;
    }

    // Newton's steps from the nearest known place; where the distance's second derivative is not
    // positive, those of Gauss.
    [[nodiscard]] std::optional<Vector2d> nearest(const Vector3d& p) const {
        if (uv.empty()) {
            return {};
        }
        Vector2d place = uv[static_cast<std::size_t>(known.nearest(p))];
        for (int step = 0; step < kMaxSteps; ++step) {
            const SurfacePlace s = evaluate(surface, place);
            const Vector3d off = s.at - p;
            Eigen::Matrix2d metric;
            metric << s.by_u.squaredNorm(), s.by_u.dot(s.by_v), s.by_u.dot(s.by_v),
                s.by_v.squaredNorm();
            Eigen::Matrix2d bent;
            bent << s.by_uu.dot(off), s.by_uv.dot(off), s.by_uv.dot(off), s.by_vv.dot(off);
            const Eigen::Matrix2d whole = metric + bent;
            const Eigen::Matrix2d& used =
                whole.determinant() > 0.0 && whole.trace() > 0.0 ? whole : metric;
            if (!(used.determinant() > 0.0)) {
                return {};
            }
            const Vector2d slope(s.by_u.dot(off), s.by_v.dot(off));
            const Vector2d next = clamped(place - used.inverse() * slope);
            const Vector2d moved = next - place;
            place = next;
            if ((moved.x() * s.by_u + moved.y() * s.by_v).norm() < kFound_mm) {
                return place;
            }
        }
        return {};
    }

    // Places of the surface in rings about one of them, mm.
    // \param at_mm, uv_there that place \param to_uv from lengths along the surface
    [[nodiscard]] std::vector<Vector3d> places_around(const Vector2d& uv_there,
                                                      const Vector3d& at_mm,
                                                      const Eigen::Matrix2d& to_uv,
                                                      double reach_mm) const {
        std::vector<Vector3d> around;
        for (int ring = 1; ring <= kJetRings; ++ring) {
            for (int spoke = 0; spoke < kJetSpokes; ++spoke) {
                const double angle = 2.0 * kPi * (spoke + 0.5 * (ring % 2)) / kJetSpokes;
                const double far = reach_mm * ring / kJetRings;
                const Vector2d at = clamped(
                    uv_there + to_uv * Vector2d(far * std::cos(angle), far * std::sin(angle)));
                const Vector3d place = vector_of(surface.Value(at.x(), at.y()));
                // Where the surface ends beside the point, places fall onto it.
                if ((place - at_mm).norm() > kJetNearest * reach_mm) {
                    around.push_back(place);
                }
            }
        }
        return around;
    }
};

struct OcctFaces::Edge {
    BRepAdaptor_Curve curve;
    std::vector<double> t;
    std::vector<Vector3d> at_mm;

    explicit Edge(const TopoDS_Edge& edge) : curve(edge) {
        const double first = curve.FirstParameter();
        const double last = curve.LastParameter();
        for (int i = 0; i <= kEdgePlaces; ++i) {
            t.push_back(first + (last - first) * i / kEdgePlaces);
            at_mm.push_back(vector_of(curve.Value(t.back())));
        }
    }

    [[nodiscard]] Vector3d nearest(const Vector3d& p) const {
        std::size_t best = 0;
        for (std::size_t i = 1; i < at_mm.size(); ++i) {
            best = (at_mm[i] - p).squaredNorm() < (at_mm[best] - p).squaredNorm() ? i : best;
        }
        double place = t[best];
        Vector3d at = at_mm[best];
        for (int step = 0; step < kMaxSteps; ++step) {
            gp_Pnt point;
            gp_Vec first;
            gp_Vec second;
            curve.D2(place, point, first, second);
            const Vector3d off = vector_of(point) - p;
            const Vector3d along = vector_of(first);
            const double metric = along.squaredNorm();
            const double whole = metric + vector_of(second).dot(off);
            const double used = whole > 0.0 ? whole : metric;
            if (!(used > 0.0)) {
                break;
            }
            const double next = std::clamp(place - along.dot(off) / used, t.front(), t.back());
            const double moved = std::abs(next - place) * std::sqrt(metric);
            place = next;
            at = vector_of(curve.Value(place));
            if (moved < kFound_mm) {
                break;
            }
        }
        return at;
    }
};

OcctFaces::OcctFaces(const TopoDS_Shape& shape) : shape_(shape) {
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    for (int i = 1; i <= faces.Extent(); ++i) {
        faces_.emplace_back(TopoDS::Face(faces(i)));
    }
    TopTools_IndexedDataMapOfShapeListOfShape faces_of;
    TopExp::MapShapesAndUniqueAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces_of);
    for (int i = 1; i <= faces_of.Extent(); ++i) {
        const TopoDS_Edge& edge = TopoDS::Edge(faces_of.FindKey(i));
        if (BRep_Tool::Degenerated(edge) || faces_of(i).Extent() > 2 || faces_of(i).Extent() == 0) {
            continue;
        }
        std::int32_t a = faces.FindIndex(faces_of(i).First()) - 1;
        std::int32_t b = -1;
        if (faces_of(i).Extent() == 2) {
            b = faces.FindIndex(faces_of(i).Last()) - 1;
        } else if (BRep_Tool::IsClosed(edge, TopoDS::Face(faces_of(i).First()))) {
            continue;  // a seam, of no border
        }
        if (b >= 0 && b < a) {
            std::swap(a, b);
        }
        border_[{a, b}].push_back(edges_.size());
        edges_.emplace_back(edge);
    }
}

OcctFaces::~OcctFaces() = default;

OcctMesh OcctFaces::first_mesh() {
    tessellate(shape_);
    SharedMesh shared(shape_);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
        Face& face = faces_[f];
        const auto number = static_cast<std::int32_t>(f);
        const FaceTriangles triangles(face.face);
        if (triangles.none()) {
            shared.add_failed(number);
            continue;
        }
        shared.add(triangles, face.face, number);
        face.uv = triangles.uv();
        face.known = NearestPoints(triangles.nodes_mm());
    }
    return std::move(shared).mesh();
}

std::vector<CadFace> OcctFaces::describe(const FaceColours& colours) const {
    TopTools_IndexedDataMapOfShapeListOfShape solids_of;
    TopTools_IndexedMapOfShape solids;
    TopExp::MapShapes(shape_, TopAbs_SOLID, solids);
    TopExp::MapShapesAndAncestors(shape_, TopAbs_FACE, TopAbs_SOLID, solids_of);
    std::vector<CadFace> faces;
    for (const Face& of : faces_) {
        CadFace& face = faces.emplace_back();
        const BRepAdaptor_Surface& surface = of.surface;
        face.kind = kind_of(surface.GetType());
        switch (surface.GetType()) {
            case GeomAbs_Plane:
                take_axis(surface.Plane().Axis(), face);
                break;
            case GeomAbs_Cylinder:
                face.radius_mm = surface.Cylinder().Radius();
                take_axis(surface.Cylinder().Axis(), face);
                break;
            case GeomAbs_Cone:
                take_axis(surface.Cone().Axis(), face);
                break;
            case GeomAbs_Sphere:
                face.radius_mm = surface.Sphere().Radius();
                face.axis_point_mm = vector_of(surface.Sphere().Location());
                break;
            case GeomAbs_Torus:
                face.radius_mm = surface.Torus().MinorRadius();
                take_axis(surface.Torus().Axis(), face);
                break;
            default:
                break;
        }
        if (solids_of.Contains(of.face) && !solids_of.FindFromKey(of.face).IsEmpty()) {
            face.solid = solids.FindIndex(solids_of.FindFromKey(of.face).First()) - 1;
        }
        const auto colour = colours.find(of.face.TShape().get());
        face.colour = colour == colours.end() ? std::string() : colour->second;
    }
    return faces;
}

std::optional<Vector3d> OcctFaces::on_face(std::int32_t face, const Vector3d& p) {
    const Face& of = faces_[static_cast<std::size_t>(face)];
    const std::optional<Vector2d> uv = of.nearest(p);
    return uv ? std::optional(vector_of(of.surface.Value(uv->x(), uv->y()))) : std::nullopt;
}

std::optional<Vector3d> OcctFaces::on_border(std::int32_t face, std::int32_t other,
                                             const Vector3d& p) {
    const auto key = other >= 0 && other < face ? std::pair(other, face) : std::pair(face, other);
    const auto found = border_.find(key);
    if (found == border_.end()) {
        return {};
    }
    std::optional<Vector3d> best;
    for (const std::size_t edge : found->second) {
        const Vector3d at = edges_[edge].nearest(p);
        if (!best || (at - p).norm() < (*best - p).norm()) {
            best = at;
        }
    }
    return best;
}

std::optional<Jet> OcctFaces::jet(std::int32_t face, const Vector3d& p, double reach_mm) {
    const Face& of = faces_[static_cast<std::size_t>(face)];
    const std::optional<Vector2d> uv = of.nearest(p);
    if (!uv) {
        return {};
    }
    const SurfacePlace s = evaluate(of.surface, *uv);
    const Vector3d cross = s.by_u.cross(s.by_v);
    if (!(cross.norm() > kPole * s.by_u.norm() * s.by_v.norm()) ||
        !(s.by_u.norm() > 0.0 && s.by_v.norm() > 0.0)) {
        return {};
    }
    const Vector3d normal = (of.reversed ? -1.0 : 1.0) * cross.normalized();
    // Directions along the surface whose rates of u and v are known: an orthonormal frame.
    const Vector3d x = s.by_u.normalized();
    const Vector3d y = cross.normalized().cross(x);
    Eigen::Matrix2d rates;  // columns: of u and v by the frame
    rates << s.by_u.dot(x), s.by_v.dot(x), s.by_u.dot(y), s.by_v.dot(y);
    const Eigen::Matrix2d to_uv = rates.inverse();
    // Exact: how the normal changes along the surface.
    const Vector3d n = cross.normalized();
    Eigen::Matrix2d second;
    second << s.by_uu.dot(n), s.by_uv.dot(n), s.by_uv.dot(n), s.by_vv.dot(n);
    const Eigen::Matrix2d bent = -to_uv.transpose() * second * to_uv;
    Jet jet;
    jet.height.frame << x, y, normal;
    jet.normal = normal;
    const double side = of.reversed ? -1.0 : 1.0;
    jet.shape_operator_per_mm =
        side * (jet.height.frame.leftCols<2>() * bent * jet.height.frame.leftCols<2>().transpose());
    if (reach_mm > 0.0) {
        const double most_turn_mm = kJetMostTurn_rad / std::max(bent.norm(), kFlat_per_mm);
        const double reach = std::min(kJetReach * reach_mm, most_turn_mm);
        if (const std::optional<Jet> fit =
                fit_jet(s.at, normal, of.places_around(*uv, s.at, to_uv, reach))) {
            jet.height = fit->height;
            jet.terms = fit->terms;
            return jet;
        }
    }
    jet.height.frame.col(1) *= side;  // right-handed
    jet.height.coefficient[kJetX2] = -0.5 * side * bent(0, 0);
    jet.height.coefficient[kJetX2 + 1] = -bent(0, 1);
    jet.height.coefficient[kJetX2 + 2] = -0.5 * side * bent(1, 1);
    jet.terms = JetTerms::Quadratic;
    return jet;
}

}  // namespace meshwind
