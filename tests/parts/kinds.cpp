#include <algorithm>
#include <cmath>

#include "part.h"

namespace cad_part {
namespace {

constexpr double kDegree = M_PI / 180.0;

double pipe_radius(Random& random) {
    return random.logarithmic(12.0, 60.0);
}

// Not above the other radius; as large in one of five.
double branch_radius(Random& random, double run_mm) {
    return random.chance(0.2) ? run_mm : std::max(10.0, run_mm * random.uniform(0.4, 0.95));
}

double leg_length(Random& random, double radius_mm, double free_from_mm) {
    return std::max(2.0 * radius_mm * random.uniform(1.0, 4.0),
                    free_from_mm + 2.0 * radius_mm * random.uniform(0.35, 0.6));
}

// How far along a leg another one reaches whose direction is at the angle.
double reach(double radius_mm, double other_mm, double angle_rad) {
    const double far = (other_mm + radius_mm * std::cos(angle_rad)) / std::sin(angle_rad);
    return std::max(far, 0.3 * radius_mm);
}

// In the plane of X and Z, at the angle from X to Z.
gp_Dir planar(double angle_rad) {
    return gp_Dir(std::cos(angle_rad), 0.0, std::sin(angle_rad));
}

Leg leg_to(const gp_Pnt& root, const gp_Dir& direction, const gp_Dir& free_side, double radius_mm) {
    Leg leg;
    leg.frame = gp_Ax2(root, direction, free_side);
    leg.radius_mm = radius_mm;
    return leg;
}

// A pipe along X and a branch at an angle from it, perhaps with a second one opposite.
Part run_with_branches(Random& random, const std::string& kind, double angle_rad) {
    Part part{.kind = kind};
    part.coaxial = true;
    const double run_mm = pipe_radius(random);
    const double branch_mm = branch_radius(random, run_mm);
    const bool cross = kind == "cross";
    const double other_mm = random.chance(0.6) ? branch_mm : branch_radius(random, run_mm);
    const double widest_mm = cross ? std::max(branch_mm, other_mm) : branch_mm;
    const gp_Pnt node(0.0, 0.0, 0.0);
    // Letters on the run stand opposite the branch; on that of a cross, between both.
    const gp_Dir free_side = cross ? gp_Dir(0.0, 1.0, 0.0) : gp_Dir(0.0, 0.0, -1.0);
    part.legs.push_back(leg_to(node, gp_Dir(-1.0, 0.0, 0.0), free_side, run_mm));
    part.legs.push_back(leg_to(node, gp_Dir(1.0, 0.0, 0.0), free_side, run_mm));
    part.legs.push_back(leg_to(node, planar(angle_rad), gp_Dir(0.0, 1.0, 0.0), branch_mm));
    part.legs[0].free_from_mm = reach(run_mm, widest_mm, M_PI - angle_rad);
    part.legs[1].free_from_mm = reach(run_mm, widest_mm, angle_rad);
    part.legs[2].free_from_mm = reach(branch_mm, run_mm, angle_rad);
    if (cross) {
        part.legs.push_back(
            leg_to(node, planar(angle_rad + M_PI), gp_Dir(0.0, 1.0, 0.0), other_mm));
        part.legs[3].free_from_mm = reach(other_mm, run_mm, angle_rad);
    }
    for (std::size_t i = 0; i < part.legs.size(); ++i) {
        Leg& leg = part.legs[i];
        leg.length_mm = leg_length(random, leg.radius_mm, leg.free_from_mm);
        leg.letter_turn_deg = i < 2 ? 40.0 : 180.0;
    }
    const double run_length_mm = part.legs[0].length_mm + part.legs[1].length_mm;
    if (!cross || run_length_mm > 1.2 * (part.legs[2].length_mm + part.legs[3].length_mm)) {
        part.axis = gp_Ax1(node, gp_Dir(1.0, 0.0, 0.0));
    }
    return part;
}

// Legs that meet at a ball, all in one plane.
Part node_with_legs(Random& random, const std::string& kind, const std::vector<double>& angles_rad,
                    double longest_d) {
    Part part{.kind = kind};
    const double widest_mm = pipe_radius(random);
    part.ball_mm = widest_mm * random.uniform(1.03, 1.15);
    for (std::size_t i = 0; i < angles_rad.size(); ++i) {
        const double share = i == 0 || random.chance(0.4) ? 1.0 : random.uniform(0.7, 0.97);
        part.legs.push_back(leg_to(gp_Pnt(0.0, 0.0, 0.0), planar(angles_rad[i]),
                                   gp_Dir(0.0, 1.0, 0.0), widest_mm * share));
    }
    for (std::size_t i = 0; i < part.legs.size(); ++i) {
        Leg& leg = part.legs[i];
        leg.free_from_mm = 1.1 * *part.ball_mm;
        for (std::size_t j = 0; j < part.legs.size(); ++j) {
            const double between = leg.frame.Direction().Angle(part.legs[j].frame.Direction());
            if (i != j && between < M_PI - 1e-6) {
                leg.free_from_mm = std::max(leg.free_from_mm,
                                            reach(leg.radius_mm, part.legs[j].radius_mm, between));
            }
        }
        leg.length_mm = leg.free_from_mm + 2.0 * leg.radius_mm * random.uniform(0.4, longest_d);
    }
    return part;
}

Part tee(Random& random) {
    return run_with_branches(random, "tee", 0.5 * M_PI);
}

Part wye(Random& random) {
    if (random.chance(0.65)) {
        return run_with_branches(random, "wye", random.uniform(35.0, 70.0) * kDegree);
    }
    const double half = 0.5 * random.uniform(35.0, 70.0) * kDegree;
    return node_with_legs(random, "wye", {M_PI, half, -half}, 2.5);
}

Part lug(Random& random) {
    const double first = random.uniform(60.0, 120.0) * kDegree;
    if (random.chance(0.4)) {
        return node_with_legs(random, "lug", {0.0, first}, 1.5);
    }
    const double second = random.uniform(60.0, 120.0) * kDegree;
    return node_with_legs(random, "lug", {0.0, first, first + second}, 1.5);
}

Part elbow(Random& random) {
    Part part{.kind = "elbow"};
    const double radius_mm = pipe_radius(random);
    const double bend_mm = 2.0 * radius_mm * random.uniform(1.0, 3.0);
    const double angle = random.chance(0.4) ? 0.5 * M_PI : random.uniform(30.0, 90.0) * kDegree;
    part.bend =
        Bend{.axis = gp_Ax1(gp_Pnt(0.0, 0.0, bend_mm), gp_Dir(0.0, -1.0, 0.0)), .angle_rad = angle};
    const gp_Pnt other(bend_mm * std::sin(angle), 0.0, bend_mm * (1.0 - std::cos(angle)));
    const gp_Dir side(0.0, 1.0, 0.0);
    part.legs.push_back(leg_to(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(-1.0, 0.0, 0.0), side, radius_mm));
    part.legs.push_back(leg_to(other, planar(angle), side, radius_mm));
    for (Leg& leg : part.legs) {
        leg.length_mm = 2.0 * radius_mm * random.uniform(0.3, 3.0);
    }
    return part;
}

Part reducer(Random& random) {
    Part part{.kind = "reducer"};
    part.coaxial = true;
    double radius_mm = pipe_radius(random) + 5.0;
    const bool sharp = random.chance(0.5);
    const int steps = random.whole(1, 3);
    std::vector<Corner> corners{{.radius_mm = radius_mm}};
    double along_mm = 0.0;
    for (int i = 0; i < steps && radius_mm > 11.5; ++i) {
        const double next_mm = std::max(10.0, radius_mm * random.uniform(0.6, 0.9));
        const double round_mm = sharp ? 0.0 : random.pick({1.0, 1.0, 3.0, 5.0});
        const double slope = std::tan(random.uniform(8.0, 45.0) * kDegree);
        if (i > 0) {
            along_mm += 2.0 * radius_mm * random.uniform(0.3, 1.5);
        }
        corners.push_back(
            {.radius_mm = radius_mm, .along_mm = along_mm, .round_mm = i > 0 ? round_mm : 0.0});
        corners.front().round_mm = round_mm;
        along_mm += (radius_mm - next_mm) / slope;
        corners.push_back({.radius_mm = next_mm, .along_mm = along_mm, .round_mm = round_mm});
        radius_mm = next_mm;
    }
    part.middle = [corners](double inwards_mm) {
        std::vector<Corner> inner = corners;
        for (Corner& corner : inner) {
            corner.radius_mm -= inwards_mm;
        }
        return inner;
    };
    const gp_Dir side(1.0, 0.0, 0.0);
    part.legs.push_back(
        leg_to(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, -1.0), side, corners.front().radius_mm));
    part.legs.push_back(leg_to(gp_Pnt(0.0, 0.0, along_mm), gp_Dir(0.0, 0.0, 1.0), side, radius_mm));
    for (Leg& leg : part.legs) {
        leg.free_from_mm = 4.0;
        leg.length_mm = leg_length(random, leg.radius_mm, 4.0);
    }
    part.axis = gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0));
    return part;
}

// Height over the equator at which a dome has a radius.
double height_at(double equator_mm, double height_mm, double radius_mm) {
    const double share = radius_mm / equator_mm;
    return height_mm * std::sqrt(std::max(0.0, 1.0 - share * share));
}

Part vessel(Random& random) {
    Part part{.kind = "vessel"};
    part.coaxial = true;
    const double radius_mm = random.logarithmic(30.0, 60.0);
    const double height_mm = radius_mm * (random.chance(0.4) ? 1.0 : random.uniform(0.5, 0.8));
    const double cylinder_mm = 2.0 * radius_mm * random.uniform(0.5, 3.0);
    const double lower_mm = std::max(10.0, radius_mm * random.uniform(0.25, 0.5));
    const double upper_mm =
        random.chance(0.5) ? lower_mm : std::max(10.0, radius_mm * random.uniform(0.25, 0.5));
    const double equator_mm = height_at(radius_mm, height_mm, lower_mm);
    part.middle = [=](double in_mm) {
        const double r = radius_mm - in_mm;
        const double h = height_mm - in_mm;
        const double top = equator_mm + cylinder_mm;
        return std::vector<Corner>{
            {.radius_mm = lower_mm - in_mm,
             .along_mm = equator_mm - height_at(r, h, lower_mm - in_mm)},
            {.radius_mm = r, .along_mm = equator_mm, .dome = Dome{equator_mm, r, -h}},
            {.radius_mm = r, .along_mm = top},
            {.radius_mm = upper_mm - in_mm,
             .along_mm = top + height_at(r, h, upper_mm - in_mm),
             .dome = Dome{top, r, h}}};
    };
    const double end_mm = part.middle(0.0).back().along_mm;
    const gp_Dir side(1.0, 0.0, 0.0);
    part.legs.push_back(leg_to(gp_Pnt(), gp_Dir(0.0, 0.0, -1.0), side, lower_mm));
    part.legs.push_back(leg_to(gp_Pnt(0.0, 0.0, end_mm), gp_Dir(0.0, 0.0, 1.0), side, upper_mm));
    for (Leg& leg : part.legs) {
        leg.length_mm = std::max(8.0, 2.0 * leg.radius_mm * random.uniform(0.3, 1.2));
        leg.free_from_mm = 2.0;
    }
    if (random.chance(0.35)) {
        const double nozzle_mm = std::max(10.0, radius_mm * random.uniform(0.25, 0.4));
        const double room_mm = 0.5 * cylinder_mm - 1.2 * nozzle_mm;
        const double at_mm =
            equator_mm + 0.5 * cylinder_mm + std::max(0.0, room_mm) * random.uniform(-1.0, 1.0);
        Leg nozzle = leg_to(gp_Pnt(0.0, 0.0, at_mm), gp_Dir(1.0, 0.0, 0.0), gp_Dir(0.0, 1.0, 0.0),
                            nozzle_mm);
        nozzle.free_from_mm = radius_mm + 2.0;
        nozzle.length_mm = nozzle.free_from_mm + 2.0 * nozzle_mm * random.uniform(0.5, 1.2);
        part.legs.push_back(nozzle);
    }
    part.axis = gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0));
    return part;
}

}  // namespace

Part draw_kind(Random& random) {
    switch (random.whole(0, 6)) {
        case 0:
            return tee(random);
        case 1:
            return wye(random);
        case 2:
            return run_with_branches(random, "cross", 0.5 * M_PI);
        case 3:
            return elbow(random);
        case 4:
            return reducer(random);
        case 5:
            return vessel(random);
        default:
            return lug(random);
    }
}

}  // namespace cad_part
