#include <algorithm>
#include <cmath>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <gp_Vec.hxx>

#include "part.h"
#include "solids.h"

namespace cad_part {
namespace {

constexpr double kDegree = M_PI / 180.0;

double least_radius_mm(const Part& part) {
    double least = part.legs.front().radius_mm;
    for (const Leg& leg : part.legs) {
        least = std::min(least, leg.radius_mm);
    }
    return least;
}

void draw_wall(Part& part, Random& random) {
    part.wall_mm = std::min(random.uniform(2.0, 5.0), 0.4 * least_radius_mm(part));
}

// On some legs, one at least; each is made long enough.
void draw_sockets(Part& part, Random& random) {
    const double thickness_mm = random.uniform(1.0, 3.0);
    const double length_d = random.uniform(0.3, 0.8);
    const bool sharp = random.chance(0.5);
    const bool widened = random.chance(0.5);
    const int one = random.whole(0, static_cast<int>(part.legs.size()) - 1);
    for (int i = 0; i < static_cast<int>(part.legs.size()); ++i) {
        Leg& leg = part.legs[static_cast<std::size_t>(i)];
        if (i != one && !random.chance(0.7)) {
            continue;
        }
        const double slope_mm = sharp ? 0.0 : thickness_mm * random.uniform(0.6, 2.0);
        leg.socket = Socket{.thickness_mm = thickness_mm,
                            .length_mm = 2.0 * leg.radius_mm * length_d,
                            .slope_mm = slope_mm,
                            .widened = widened && thickness_mm > 1.5};
        leg.length_mm = std::max(leg.length_mm, leg.free_from_mm + 0.6 * leg.radius_mm +
                                                    leg.socket->length_mm + slope_mm);
    }
}

void draw_edges(Part& part, Random& random, EndEdge edge) {
    const double most_mm = part.wall_mm ? 0.6 * *part.wall_mm : 2.0;
    const double size_mm = std::min(random.uniform(0.5, 2.0), most_mm);
    for (Leg& leg : part.legs) {
        leg.edge = edge;
        leg.edge_mm = size_mm;
    }
}

// Half of the legs get another radius on their way, from the middle of what is free.
void draw_steps(Part& part, Random& random) {
    const int one = random.whole(0, static_cast<int>(part.legs.size()) - 1);
    for (int i = 0; i < static_cast<int>(part.legs.size()); ++i) {
        Leg& leg = part.legs[static_cast<std::size_t>(i)];
        const bool wanted = i == one || random.chance(0.4);
        const double change_mm = random.uniform(1.0, 3.0) * (random.chance(0.5) ? 1.0 : -1.0);
        const double slope_mm = random.chance(0.5) ? 0.0 : random.uniform(1.0, 4.0);
        if (!wanted) {
            continue;
        }
        leg.length_mm += 1.2 * leg.radius_mm;
        const double to_mm = leg.free_to_mm();
        leg.step =
            Step{.at_mm = leg.free_from_mm + random.uniform(0.4, 0.6) * (to_mm - leg.free_from_mm),
                 .change_mm = change_mm,
                 .slope_mm = slope_mm};
    }
}

void draw_tabs(Part& part, Random& random) {
    part.legs[static_cast<std::size_t>(random.whole(0, static_cast<int>(part.legs.size()) - 1))]
        .tabs = true;
    for (Leg& leg : part.legs) {
        leg.tabs = leg.tabs || random.chance(0.4);
    }
}

void draw_cause(Part& part, Random& random) {
    part.cause = random.pick<const char*>({"missing_face", "window", "two_pieces", "half_model",
                                           "closed", "oblique_end", "square_end"});
    part.victim = random.whole(0, static_cast<int>(part.legs.size()) - 1);
    Leg& leg = part.legs[static_cast<std::size_t>(part.victim)];
    leg.step.reset();
    leg.socket.reset();
    leg.edge = EndEdge::Sharp;
    leg.edge_mm = 0.0;
    leg.tabs = false;
    leg.length_mm = std::max(leg.length_mm, leg.free_from_mm + 4.0 * leg.radius_mm);
    if ((part.cause == "window" || part.cause == "missing_face") && !part.wall_mm) {
        draw_wall(part, random);
    }
    part.letters = false;
    part.skin = false;
    part.details.clear();
}

// Bars of a letter in a box of width 0.6 and height 1: x, y, width, height.
struct Bar {
    double x, y, width, height;
};

std::vector<Bar> letter(char name) {
    constexpr double w = 0.6;
    constexpr double s = 0.17;  // of a stroke
    const Bar left{0.0, 0.0, s, 1.0};
    const Bar right{w - s, 0.0, s, 1.0};
    const Bar top{0.0, 1.0 - s, w, s};
    const Bar middle{0.0, 0.5 - 0.5 * s, w, s};
    const Bar foot{0.0, 0.0, w, s};
    switch (name) {
        case 'E':
            return {left, top, middle, foot};
        case 'F':
            return {left, top, middle};
        case 'H':
            return {left, right, middle};
        case 'I':
            return {{0.5 * (w - s), 0.0, s, 1.0}};
        case 'L':
            return {left, foot};
        case 'O':
            return {left, right, top, foot};
        case 'U':
            return {left, right, foot};
        case 'C':
            return {left, top, foot};
        default:
            return {top, {0.5 * (w - s), 0.0, s, 1.0}};  // T
    }
}

// X along the letter's line (the leg), Y up the letter (around the leg), from the axis outwards.
TopoDS_Shape bar_block(const gp_Ax2& place, const Bar& bar, double size_mm, double from_mm,
                       double to_mm) {
    const gp_Pnt corner = place.Location()
                              .Translated(gp_Vec(place.XDirection()) * (bar.x * size_mm))
                              .Translated(gp_Vec(place.YDirection()) * ((bar.y - 0.5) * size_mm))
                              .Translated(gp_Vec(place.Direction()) * from_mm);
    return BRepPrimAPI_MakeBox(gp_Ax2(corner, place.Direction(), place.XDirection()),
                               bar.width * size_mm, bar.height * size_mm, to_mm - from_mm)
        .Shape();
}

}  // namespace

void drop_detail(Part& part, const std::string& detail) {
    std::erase(part.details, detail);
}

void draw_details(Part& part, Random& random) {
    std::vector<std::string> fitting{"bore", "lips", "chamfers", "letters", "tabs"};
    if (part.kind != "vessel") {
        fitting.insert(fitting.end(), {"sockets", "steps"});
    }
    if (part.legs.size() > 2 || part.kind == "vessel" || part.ball_mm) {
        fitting.emplace_back("fillet");
    }
    for (int count = random.whole(0, 4); count > 0 && !fitting.empty(); --count) {
        const auto chosen = fitting.begin() + random.whole(0, static_cast<int>(fitting.size()) - 1);
        const std::string detail = *chosen;
        part.details.push_back(detail);
        fitting.erase(chosen);
        if (detail == "lips" || detail == "chamfers") {
            std::erase(fitting, detail == "lips" ? "chamfers" : "lips");
        }
    }
    const auto has = [&](const char* detail) {
        return std::find(part.details.begin(), part.details.end(), detail) != part.details.end();
    };
    if (has("fillet")) {
        part.fillet_mm = std::min(random.uniform(2.0, 8.0), 0.35 * least_radius_mm(part));
        for (Leg& leg : part.legs) {
            leg.free_from_mm += 2.0 * *part.fillet_mm;
            leg.length_mm += 2.0 * *part.fillet_mm;
        }
    }
    if (has("bore")) {
        draw_wall(part, random);
    }
    if (has("lips") || has("chamfers")) {
        draw_edges(part, random, has("lips") ? EndEdge::Lip : EndEdge::Chamfer);
    }
    if (has("sockets")) {
        draw_sockets(part, random);
    }
    if (has("steps")) {
        draw_steps(part, random);
    }
    if (has("tabs")) {
        draw_tabs(part, random);
    }
    part.letters = has("letters");
    const bool cause = random.chance(0.1);
    part.skin = random.chance(0.12) && !part.wall_mm && !has("tabs") && !cause;
    if (part.skin) {
        part.details.emplace_back("skin");
    }
    if (cause) {
        draw_cause(part, random);
    }
}

std::optional<TopoDS_Shape> with_letters(const Part& part, const TopoDS_Shape& shape,
                                         Random& random) {
    const Leg* roomiest = &part.legs.front();
    for (const Leg& leg : part.legs) {
        if (leg.free_to_mm() - leg.free_from_mm > roomiest->free_to_mm() - roomiest->free_from_mm) {
            roomiest = &leg;
        }
    }
    const Leg& leg = *roomiest;
    const double radius_mm = leg.radius_mm;
    const double from_mm = leg.free_from_mm + 2.0;
    const double room_mm = leg.free_to_mm() - from_mm - 2.0;
    const double size_mm = std::min(random.uniform(5.0, 12.0), 0.9 * radius_mm);
    const int count = std::min(random.whole(2, 6), static_cast<int>(room_mm / (0.85 * size_mm)));
    if (count < 1) {
        return std::nullopt;
    }
    const double height_mm = random.uniform(0.3, 1.0);
    const double start_mm = from_mm + random.uniform(0.0, 1.0) * (room_mm - 0.85 * size_mm * count);
    const double turn = random.uniform(-1.0, 1.0) * leg.letter_turn_deg * kDegree;
    const gp_Ax1 axis(leg.frame.Location(), leg.frame.Direction());
    const TopoDS_Shape hull =
        BRepPrimAPI_MakeCylinder(leg.frame, radius_mm + height_mm, leg.free_to_mm()).Shape();
    std::vector<TopoDS_Shape> raised;
    for (int i = 0; i < count; ++i) {
        const gp_Vec along(leg.frame.Direction());
        gp_Ax2 place(leg.frame.Location().Translated(along * (start_mm + 0.85 * size_mm * i)),
                     leg.frame.XDirection(), leg.frame.Direction());
        place.Rotate(axis, turn);
        const char name = "EFHILOUCT"[random.whole(0, 8)];
        std::vector<TopoDS_Shape> bars;
        for (const Bar& bar : letter(name)) {
            bars.push_back(
                bar_block(place, bar, size_mm, 0.8 * radius_mm, radius_mm + 2.0 * height_mm));
        }
        TopoDS_Shape whole = bars.front();
        if (bars.size() > 1) {
            const auto joined = united(whole, {bars.begin() + 1, bars.end()});
            if (!joined) {
                return std::nullopt;
            }
            whole = joined->shape;
        }
        const auto trimmed = common_of(whole, hull);
        if (!trimmed) {
            return std::nullopt;
        }
        raised.push_back(*trimmed);
    }
    const auto result = united(shape, raised);
    return result ? std::optional(result->shape) : std::nullopt;
}

std::optional<TopoDS_Shape> with_tabs(const Part& part, const TopoDS_Shape& shape, Random& random) {
    std::vector<TopoDS_Shape> blocks;
    for (const Leg& leg : part.legs) {
        const int count = random.whole(1, 4);
        const double height_mm = random.uniform(2.0, 4.0);
        const double start = random.uniform(0.0, 360.0) * kDegree;
        const double radius_mm = leg.end_radius_mm() - leg.edge_mm;
        const double face_mm = leg.socket && leg.socket->widened ? leg.socket->thickness_mm
                                                                 : part.wall_mm.value_or(4.0);
        const double thick_mm =
            std::min(face_mm - (part.wall_mm ? leg.edge_mm : 0.0), 0.4 * radius_mm);
        const double wide_mm = std::min(random.uniform(4.0, 10.0), 0.7 * radius_mm);
        const bool flush = random.chance(0.5) && leg.edge == EndEdge::Sharp;
        if (!leg.tabs) {
            continue;
        }
        const gp_Ax1 axis(leg.frame.Location(), leg.frame.Direction());
        const TopoDS_Shape hull =
            BRepPrimAPI_MakeCylinder(leg.frame, radius_mm, leg.length_mm + height_mm).Shape();
        for (int i = 0; i < count; ++i) {
            // Its outer corners are inside the wall, or the wall itself bounds it.
            const double outer_mm =
                flush ? radius_mm + 1.0
                      : std::sqrt(radius_mm * radius_mm - 0.25 * wide_mm * wide_mm) - 0.1;
            const double inner_mm = radius_mm - 0.9 * thick_mm;
            if (outer_mm - inner_mm < 0.5) {
                return std::nullopt;
            }
            const gp_Pnt corner =
                leg.frame.Location()
                    .Translated(gp_Vec(leg.frame.Direction()) * (leg.length_mm - 1.0))
                    .Translated(gp_Vec(leg.frame.XDirection()) * inner_mm)
                    .Translated(gp_Vec(leg.frame.YDirection()) * (-0.5 * wide_mm));
            gp_Ax2 place(corner, leg.frame.Direction(), leg.frame.XDirection());
            place.Rotate(axis, start + 2.0 * M_PI * i / count);
            const TopoDS_Shape block =
                BRepPrimAPI_MakeBox(place, outer_mm - inner_mm, wide_mm, height_mm + 1.0).Shape();
            const auto trimmed = flush ? common_of(block, hull) : std::optional(block);
            if (!trimmed) {
                return std::nullopt;
            }
            blocks.push_back(*trimmed);
        }
    }
    const auto result = united(shape, blocks);
    return result ? std::optional(result->shape) : std::nullopt;
}

}  // namespace cad_part
