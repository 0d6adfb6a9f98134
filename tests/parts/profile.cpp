#include "profile.h"

#include <algorithm>
#include <cmath>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <GC_MakeArcOfEllipse.hxx>
#include <gp_Ax1.hxx>
#include <gp_Elips.hxx>
#include <gp_Vec.hxx>

namespace cad_part {
namespace {

constexpr double kSame = 1e-7;  // mm, the kernel's own tolerance

// Outline in the half plane of the frame's X (radius) and direction (along).
class Outline {
public:
    explicit Outline(const gp_Ax2& frame) : frame_(frame) {}

    void go_to(const gp_Pnt& to) {
        if (last_ && last_->Distance(to) > kSame) {
            wire_.Add(BRepBuilderAPI_MakeEdge(*last_, to).Edge());
        }
        last_ = to;
    }

    void round_to(const gp_Pnt& by, const gp_Pnt& to) {
        const GC_MakeArcOfCircle arc(*last_, by, to);
        wire_.Add(BRepBuilderAPI_MakeEdge(arc.Value()).Edge());
        last_ = to;
    }

    void dome_to(const Dome& dome, const gp_Pnt& to) {
        // The kernel turns arcs against the ellipse's sense round, so the ellipse is turned.
        const gp_Dir across = frame_.YDirection();
        const gp_Dir normal = leads_on(*last_, to, dome) ? across : across.Reversed();
        const gp_Ax2 axes(at(0.0, dome.centre_mm), normal, frame_.XDirection());
        const gp_Elips ellipse(axes, dome.radius_mm, std::abs(dome.height_mm));
        const GC_MakeArcOfEllipse arc(ellipse, *last_, to, Standard_True);
        wire_.Add(BRepBuilderAPI_MakeEdge(arc.Value()).Edge());
        last_ = to;
    }

    [[nodiscard]] gp_Pnt at(double radius_mm, double along_mm) const {
        return frame_.Location()
            .Translated(gp_Vec(frame_.XDirection()) * radius_mm)
            .Translated(gp_Vec(frame_.Direction()) * along_mm);
    }

    [[nodiscard]] TopoDS_Shape solid() {
        const BRepBuilderAPI_MakeFace face(wire_.Wire(), Standard_True);
        return BRepPrimAPI_MakeRevol(face.Face(), gp_Ax1(frame_.Location(), frame_.Direction()))
            .Shape();
    }

private:
    // Whether an ellipse about the frame's Y runs from one to the other by the short way.
    [[nodiscard]] bool leads_on(const gp_Pnt& from, const gp_Pnt& to, const Dome& dome) const {
        const auto angle = [&](const gp_Pnt& p) {
            const gp_Vec v(at(0.0, dome.centre_mm), p);
            const gp_Vec minor = gp_Vec(frame_.YDirection()).Crossed(frame_.XDirection());
            return std::atan2(v.Dot(minor) / std::abs(dome.height_mm),
                              v.Dot(frame_.XDirection()) / dome.radius_mm);
        };
        return angle(to) > angle(from);
    }

    gp_Ax2 frame_;
    std::optional<gp_Pnt> last_;
    BRepBuilderAPI_MakeWire wire_;
};

// Towards the neighbour, of unit length.
gp_Vec way(const gp_Pnt& from, const gp_Pnt& to) {
    return gp_Vec(from, to).Normalized();
}

}  // namespace

std::vector<Corner> mirrored(const std::vector<Corner>& corners) {
    std::vector<Corner> other(corners.rbegin(), corners.rend());
    for (Corner& corner : other) {
        corner.along_mm = -corner.along_mm;
    }
    return other;
}

std::vector<Corner> shifted(const std::vector<Corner>& corners, double along_mm) {
    std::vector<Corner> other = corners;
    for (Corner& corner : other) {
        corner.along_mm += along_mm;
    }
    return other;
}

TopoDS_Shape revolved(const gp_Ax2& frame, const std::vector<Corner>& given) {
    std::vector<Corner> corners;
    corners.push_back({.radius_mm = 0.0, .along_mm = given.front().along_mm});
    for (const Corner& corner : given) {
        if (std::hypot(corner.radius_mm - corners.back().radius_mm,
                       corner.along_mm - corners.back().along_mm) > kSame) {
            corners.push_back(corner);
        }
    }
    corners.push_back({.radius_mm = 0.0, .along_mm = given.back().along_mm});

    Outline outline(frame);
    const auto point = [&](std::size_t i) {
        return outline.at(corners[i].radius_mm, corners[i].along_mm);
    };
    outline.go_to(point(0));
    for (std::size_t i = 1; i < corners.size(); ++i) {
        const Corner& corner = corners[i];
        if (corner.dome) {
            outline.dome_to(*corner.dome, point(i));
        } else if (corner.round_mm > 0.0 && i + 1 < corners.size()) {
            const gp_Vec back = way(point(i), point(i - 1));
            const gp_Vec on = way(point(i), point(i + 1));
            const double half_turn = 0.5 * (M_PI - back.Angle(on));
            const double reach = corner.round_mm * std::tan(half_turn);
            const double rise = corner.round_mm / std::cos(half_turn) - corner.round_mm;
            outline.go_to(point(i).Translated(back * reach));
            outline.round_to(point(i).Translated((back + on).Normalized() * rise),
                             point(i).Translated(on * reach));
        } else {
            outline.go_to(point(i));
        }
    }
    outline.go_to(point(0));
    return outline.solid();
}

}  // namespace cad_part
