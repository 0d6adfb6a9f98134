#include <cmath>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <gp_Vec.hxx>

#include "part.h"
#include "solids.h"

namespace cad_part {
namespace {

constexpr double kHuge = 5000.0;  // mm, more than any part
constexpr double kDegree = M_PI / 180.0;

gp_Pnt on_leg(const Leg& leg, double along_mm) {
    return leg.frame.Location().Translated(gp_Vec(leg.frame.Direction()) * along_mm);
}

// Centred on the place in its X and Y, from it on along its direction.
TopoDS_Shape block(const gp_Ax2& place, double wide_mm, double high_mm) {
    const gp_Pnt corner = place.Location()
                              .Translated(gp_Vec(place.XDirection()) * (-0.5 * wide_mm))
                              .Translated(gp_Vec(place.YDirection()) * (-0.5 * wide_mm));
    return BRepPrimAPI_MakeBox(gp_Ax2(corner, place.Direction(), place.XDirection()), wide_mm,
                               wide_mm, high_mm)
        .Shape();
}

// A round hole through one side of the leg's wall.
std::optional<TopoDS_Shape> with_window(const Leg& leg, const TopoDS_Shape& shape, Random& random) {
    const double hole_mm = leg.radius_mm * random.uniform(0.35, 0.6);
    const double at_mm = leg.free_from_mm + 0.5 * (leg.length_mm - leg.free_from_mm);
    gp_Ax2 place(on_leg(leg, at_mm), leg.frame.XDirection());
    const double turn = random.uniform(-1.0, 1.0) * leg.letter_turn_deg * kDegree;
    place.Rotate(gp_Ax1(leg.frame.Location(), leg.frame.Direction()), turn);
    return without(shape, {BRepPrimAPI_MakeCylinder(place, hole_mm, 2.0 * leg.radius_mm).Shape()});
}

// Pulled apart: a slice of the leg is gone.
std::optional<TopoDS_Shape> in_two(const Leg& leg, const TopoDS_Shape& shape, Random& random) {
    const double gap_mm = random.uniform(1.0, 10.0);
    const double at_mm = leg.free_from_mm + 0.4 * (leg.length_mm - leg.free_from_mm);
    const gp_Ax2 place(on_leg(leg, at_mm), leg.frame.Direction(), leg.frame.XDirection());
    return without(shape, {block(place, 2.6 * leg.radius_mm, gap_mm)}, 2);
}

// All legs lie in the frame's plane of X and Z.
std::optional<TopoDS_Shape> half_of(const TopoDS_Shape& shape) {
    const gp_Ax2 place(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, -1.0, 0.0));
    return without(shape, {block(place, kHuge, kHuge)}, 0);
}

// The end is cut by a plane that leans.
std::optional<TopoDS_Shape> with_oblique_end(const Leg& leg, const TopoDS_Shape& shape,
                                             Random& random) {
    const double lean = random.uniform(30.0, 55.0) * kDegree;
    const double at_mm = leg.length_mm - leg.radius_mm * std::tan(lean) - 1.0;
    gp_Ax2 place(on_leg(leg, at_mm), leg.frame.Direction(), leg.frame.XDirection());
    place.Rotate(gp_Ax1(place.Location(), place.YDirection()), lean);
    return without(shape, {block(place, 5.0 * leg.radius_mm, 8.0 * leg.radius_mm)});
}

// The leg passes into a pipe of square section.
std::optional<TopoDS_Shape> with_square_end(const Part& part, const Leg& leg,
                                            const TopoDS_Shape& shape, Random& random) {
    const double side_mm = 2.0 * leg.radius_mm * random.uniform(0.9, 1.2);
    const double length_mm = leg.radius_mm * random.uniform(1.5, 2.5);
    const gp_Ax2 place(on_leg(leg, leg.length_mm - length_mm), leg.frame.Direction(),
                       leg.frame.XDirection());
    const double high_mm = length_mm + 2.0;
    const auto whole = united(shape, {block(place, side_mm, high_mm)});
    if (!whole || !part.wall_mm) {
        return whole ? std::optional(whole->shape) : std::nullopt;
    }
    return without(
        whole->shape,
        {BRepPrimAPI_MakeCylinder(place, leg.radius_mm - *part.wall_mm, 2.0 * high_mm).Shape()});
}

// A ball or a capsule, without any end.
TopoDS_Shape closed_shape(const Part& part, Random& random) {
    const gp_Ax2 frame(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0));
    const double radius_mm = part.legs.front().radius_mm;
    if (random.chance(0.4)) {
        return BRepPrimAPI_MakeSphere(frame, radius_mm).Shape();
    }
    const double height_mm = radius_mm * random.uniform(0.5, 1.0);
    const double top_mm = radius_mm * random.uniform(1.0, 4.0);
    return revolved(
        frame, {{.radius_mm = 0.0, .along_mm = -height_mm},
                {.radius_mm = radius_mm, .along_mm = 0.0, .dome = Dome{0.0, radius_mm, -height_mm}},
                {.radius_mm = radius_mm, .along_mm = top_mm},
                {.radius_mm = 0.0,
                 .along_mm = top_mm + height_mm,
                 .dome = Dome{top_mm, radius_mm, height_mm}}});
}

}  // namespace

std::optional<Built> spoilt(const Part& part, const TopoDS_Shape& shape, Random& random) {
    const Leg& leg = part.legs[static_cast<std::size_t>(part.victim)];
    if (part.cause == "missing_face") {
        // The wall of a run is one face from end to end.
        const bool run = part.coaxial && !part.middle && part.victim < 2;
        return Built{.shape = shape,
                     .missing = MissingFace{.frame = leg.frame,
                                            .radius_mm = leg.radius_mm,
                                            .from_mm = run ? -kHuge : -1.0,
                                            .to_mm = leg.length_mm + 1.0,
                                            .middle_rad = random.uniform(0.0, 2.0 * M_PI),
                                            .half_rad = random.uniform(25.0, 50.0) * kDegree}};
    }
    std::optional<TopoDS_Shape> result;
    if (part.cause == "closed") {
        result = closed_shape(part, random);
    } else if (part.cause == "window") {
        result = with_window(leg, shape, random);
    } else if (part.cause == "two_pieces") {
        result = in_two(leg, shape, random);
    } else if (part.cause == "half_model") {
        result = half_of(shape);
    } else if (part.cause == "oblique_end") {
        result = with_oblique_end(leg, shape, random);
    } else {
        result = with_square_end(part, leg, shape, random);
    }
    return result ? std::optional(Built{.shape = *result}) : std::nullopt;
}

}  // namespace cad_part
