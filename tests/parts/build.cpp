#include <algorithm>
#include <cmath>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <GeomAbs_CurveType.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <gp_Circ.hxx>

#include "part.h"
#include "solids.h"

namespace cad_part {
namespace {

constexpr double kBeyond = 6.0;  // mm, how far a bore's tool goes on behind the end, tabs included

// Outline of a leg behind its root.
std::vector<Corner> outer_corners(const Leg& leg) {
    std::vector<Corner> corners;
    double radius_mm = leg.radius_mm;
    const auto change = [&](double at_mm, double slope_mm, double next_mm) {
        corners.push_back({.radius_mm = radius_mm, .along_mm = at_mm});
        corners.push_back({.radius_mm = next_mm, .along_mm = at_mm + slope_mm});
        radius_mm = next_mm;
    };
    if (leg.step) {
        change(leg.step->at_mm, leg.step->slope_mm, leg.behind_socket_mm());
    }
    if (leg.socket) {
        change(leg.length_mm - leg.socket->length_mm - leg.socket->slope_mm, leg.socket->slope_mm,
               leg.end_radius_mm());
    }
    if (leg.edge == EndEdge::Chamfer) {
        change(leg.length_mm - leg.edge_mm, leg.edge_mm, radius_mm - leg.edge_mm);
    } else {
        corners.push_back({.radius_mm = radius_mm,
                           .along_mm = leg.length_mm,
                           .round_mm = leg.edge == EndEdge::Lip ? leg.edge_mm : 0.0});
    }
    return corners;
}

double bore_radius_mm(const Leg& leg, double wall_mm) {
    return std::min(leg.radius_mm, leg.behind_socket_mm()) - wall_mm;
}

// Outline of a leg's bore from the root on, through the end.
std::vector<Corner> bore_corners(const Leg& leg, double wall_mm) {
    const double radius_mm = bore_radius_mm(leg, wall_mm);
    std::vector<Corner> corners{{.radius_mm = radius_mm}};
    double last_mm = radius_mm;
    if (leg.socket && leg.socket->widened) {
        const double from_mm = leg.length_mm - 0.8 * leg.socket->length_mm;
        last_mm = leg.behind_socket_mm();
        corners.push_back({.radius_mm = radius_mm, .along_mm = from_mm});
        corners.push_back({.radius_mm = last_mm, .along_mm = from_mm});
    }
    corners.push_back({.radius_mm = last_mm, .along_mm = leg.length_mm + kBeyond});
    return corners;
}

std::vector<Corner> closed_at_root(std::vector<Corner> corners, double radius_mm) {
    corners.insert(corners.begin(), Corner{.radius_mm = radius_mm});
    return corners;
}

// Legs 0 and 1 with what is between them.
TopoDS_Shape through(const Part& part, const std::vector<Corner>& first,
                     const std::vector<Corner>& middle, const std::vector<Corner>& second) {
    const gp_Ax2& one = part.legs[1].frame;
    const gp_Pnt root = part.legs[0].frame.Location();
    std::vector<Corner> corners = mirrored(first);
    corners.insert(corners.end(), middle.begin(), middle.end());
    const std::vector<Corner> rest = shifted(second, root.Distance(one.Location()));
    corners.insert(corners.end(), rest.begin(), rest.end());
    return revolved(gp_Ax2(root, one.Direction(), one.XDirection()), corners);
}

TopoDS_Shape bend_of(const Part& part, double radius_mm) {
    const gp_Circ circle(part.legs[0].frame, radius_mm);
    BRepBuilderAPI_MakeWire wire(BRepBuilderAPI_MakeEdge(circle).Edge());
    BRepBuilderAPI_MakeFace face(wire.Wire(), Standard_True);
    return BRepPrimAPI_MakeRevol(face.Face(), part.bend->axis, part.bend->angle_rad).Shape();
}

// Circles where a body of revolution passes into its legs.
std::vector<TopoDS_Edge> root_circles(const Part& part, const TopoDS_Shape& shape) {
    std::vector<TopoDS_Edge> found;
    for (TopExp_Explorer it(shape, TopAbs_EDGE); it.More(); it.Next()) {
        const TopoDS_Edge edge = TopoDS::Edge(it.Current());
        const BRepAdaptor_Curve curve(edge);
        if (curve.GetType() != GeomAbs_Circle || edge.Orientation() != TopAbs_FORWARD) {
            continue;
        }
        for (std::size_t i = 0; i < 2; ++i) {
            const Leg& leg = part.legs[i];
            if (curve.Circle().Location().Distance(leg.frame.Location()) < 1e-3 &&
                std::abs(curve.Circle().Radius() - leg.radius_mm) < 1e-3) {
                found.push_back(edge);
            }
        }
    }
    return found;
}

std::optional<TopoDS_Shape> outer_shape(Part& part) {
    TopoDS_Shape shape;
    std::size_t next = 0;
    std::vector<TopoDS_Edge> corners;
    if (part.coaxial) {
        shape = through(part, outer_corners(part.legs[0]),
                        part.middle ? part.middle(0.0) : std::vector<Corner>{},
                        outer_corners(part.legs[1]));
        if (part.kind == "vessel" && part.fillet_mm) {
            const auto blended = filleted(shape, root_circles(part, shape), *part.fillet_mm);
            if (!blended) {
                return std::nullopt;
            }
            shape = *blended;
        }
        next = 2;
    } else if (part.bend) {
        shape = bend_of(part, part.legs[0].radius_mm);
    } else {
        shape = BRepPrimAPI_MakeSphere(part.legs[0].frame, *part.ball_mm).Shape();
    }
    std::vector<TopoDS_Shape> legs;
    for (; next < part.legs.size(); ++next) {
        const Leg& leg = part.legs[next];
        legs.push_back(revolved(leg.frame, closed_at_root(outer_corners(leg), leg.radius_mm)));
    }
    if (legs.empty()) {
        return shape;
    }
    const auto whole = united(shape, legs);
    if (!whole) {
        return std::nullopt;
    }
    if (part.fillet_mm && !part.bend) {
        if (const auto blended = filleted(whole->shape, whole->crossings, *part.fillet_mm)) {
            return blended;
        }
        part.fillet_mm.reset();
        drop_detail(part, "fillet");
    }
    return whole->shape;
}

std::vector<TopoDS_Shape> bore_tools(const Part& part) {
    const double wall_mm = *part.wall_mm;
    std::vector<TopoDS_Shape> tools;
    std::size_t next = 0;
    if (part.coaxial) {
        tools.push_back(through(part, bore_corners(part.legs[0], wall_mm),
                                part.middle ? part.middle(wall_mm) : std::vector<Corner>{},
                                bore_corners(part.legs[1], wall_mm)));
        next = 2;
    } else if (part.bend) {
        tools.push_back(bend_of(part, part.legs[0].radius_mm - wall_mm));
    } else {
        tools.push_back(
            BRepPrimAPI_MakeSphere(part.legs[0].frame, *part.ball_mm - wall_mm).Shape());
    }
    for (; next < part.legs.size(); ++next) {
        tools.push_back(revolved(part.legs[next].frame, bore_corners(part.legs[next], wall_mm)));
    }
    return tools;
}

std::optional<TopoDS_Shape> shape_of(Part& part, Random& random) {
    const auto outer = outer_shape(part);
    if (!outer) {
        return std::nullopt;
    }
    TopoDS_Shape shape = *outer;
    if (part.letters) {
        if (const auto lettered = with_letters(part, shape, random)) {
            shape = *lettered;
        } else {
            drop_detail(part, "letters");
        }
    }
    if (part.wall_mm) {
        const auto hollow = without(shape, bore_tools(part));
        if (!hollow) {
            return std::nullopt;
        }
        shape = *hollow;
    }
    if (std::any_of(part.legs.begin(), part.legs.end(), [](const Leg& l) { return l.tabs; })) {
        if (const auto tabbed = with_tabs(part, shape, random)) {
            shape = *tabbed;
        } else {
            drop_detail(part, "tabs");
        }
    }
    return shape;
}

}  // namespace

std::optional<Built> build(Part& part, Random& random) {
    try {
        if (part.cause == "closed") {
            return spoilt(part, TopoDS_Shape(), random);
        }
        const auto shape = shape_of(part, random);
        if (!shape) {
            return std::nullopt;
        }
        if (!part.cause.empty()) {
            return spoilt(part, *shape, random);
        }
        return Built{.shape = *shape};
    } catch (const Standard_Failure& e) {
        return std::nullopt;
    }
}

}  // namespace cad_part
