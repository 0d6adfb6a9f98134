#include "winding/cover/lay_out_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/index.h"
#include "winding/plan/assemble.h"

namespace meshwind {
namespace {

// And in halves of turns that are only looked into: the turns themselves are checked in the end.
constexpr double kHalfTurnStation_mm = 10.0;

// But what is said to hide the free fibre is looked at on straight ways from station to station,
// and those lie under a round wall: by no more than this share of the height at which the fibre
// begins, or the wall itself would hide it.
constexpr double kMaxSag = 0.5;

// Distance of the stations of a plan, by its thinnest leg.
double plan_station_mm(const CourseRules& rules) {
    double radius_mm = std::numeric_limits<double>::infinity();
    for (const Rim& rim : rules.mandrel.rims) {
        radius_mm = std::min(radius_mm, rim.radius_mm);
    }
    return station_on_mm(radius_mm, rules.tow.width_mm);
}

double half_turn_station_mm(const CourseRules& rules, const Rim& rim) {
    const double sag_mm = kMaxSag * rules.free_fibre.stand_off_mm;
    return std::min(kHalfTurnStation_mm, std::sqrt(8.0 * rim.radius_mm * sag_mm));
}

}  // namespace

Piece piece_of(const CourseRules& rules, TracedCourse&& course, const LibraryCourse& member,
               bool backward) {
    Piece piece;
    piece.kind = PieceKind::Course;
    if (backward) {
        course.path = reversed(course.path);
        course.string = taut_string(course.path);
        std::reverse(course.slip.slip.begin(), course.slip.slip.end());
    }
    piece.path = std::move(course.path);
    piece.string = std::move(course.string);
    piece.slip = std::move(course.slip.slip);
    piece.worst_slip = course.slip.worst;
    piece.start_rim = start_of(member, backward).rim;
    piece.end_rim = end_of(member, backward).rim;
    thin_out(piece, plan_station_mm(rules));
    return piece;
}

Piece piece_of(const CourseRules& rules, const LibraryCourse& member, bool backward) {
    TracedCourse course;
    course.path = trace_both_ways(rules, member.candidate);
    course.string = taut_string(course.path);
    course.slip =
        measure_slip(rules.mandrel.surface, course.path, course.string,
                     {.friction = rules.tow.friction.holds(), .method = TraceMethod::Patches});
    return piece_of(rules, std::move(course), member, backward);
}

void add_half_turns(const CourseRules& rules, const LibraryCourse& member, bool backward,
                    std::vector<Piece>& pieces) {
    const RimCrossing& start = start_of(member, backward);
    const RimCrossing& end = end_of(member, backward);
    const Rim& first = rules.mandrel.rims[at(start.rim)];
    const Rim& last = rules.mandrel.rims[at(end.rim)];
    pieces.insert(pieces.begin(),
                  half_turn_to(first, start, rules.turns, half_turn_station_mm(rules, first)));
    pieces.push_back(half_turn_from(last, end, rules.turns, half_turn_station_mm(rules, last)));
}

void lay_out(const CourseRules& rules, std::span<const LibraryCourse> members,
             std::span<const OrderedCourse> order, Plan& plan) {
    plan.pieces.clear();
    plan.fibres = 0;
    plan.fibre_length_mm = 0.0;
    plan.worst_slip = 0.0;
    plan.worst_bridge_mm = 0.0;
    plan.worst_joint_mm = 0.0;
    plan.turns.assign(rules.mandrel.rims.size(), {});
    plan.pins = rings_of(rules.turns.pins);
    bool fresh = true;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const auto [member, backward] = order[i].course;
        const LibraryCourse& course = members[at(member)];
        Piece piece = piece_of(rules, course, backward);
        piece.starts_fibre = fresh;
        plan.fibres += fresh ? 1 : 0;
        add_piece(std::move(piece), plan);
        fresh = order[i].cut_after;
        if (!fresh) {
            const RimCrossing& from = end_of(course, backward);
            const DirectedCourse& next = order[i + 1].course;
            add_turn(turn_between(rules.mandrel.rims[at(from.rim)], from,
                                  start_of(members[at(next.member)], next.backward), rules.turns,
                                  plan_station_mm(rules)),
                     plan);
        }
    }
    plan.courses = static_cast<int>(order.size());
}

namespace {

// Of the courses before and behind a turn the one at which more turns are closed.
std::size_t harder_to_turn_at(std::span<const OrderedCourse> order, std::size_t before,
                              const ClosedTurns& closed) {
    const DirectedCourse& from = order[before].course;
    const DirectedCourse& to = order[before + 1].course;
    const auto count = [&closed](const auto& is) {
        return std::count_if(closed.begin(), closed.end(), is);
    };
    const auto behind = count([&](const auto& turn) { return turn.second == to; });
    return behind > count([&](const auto& turn) { return turn.first == from; }) ? before + 1
                                                                                : before;
}

}  // namespace

std::vector<std::pair<std::size_t, CourseFault>> refused_courses(
    const TrialWinding& trial, const Plan& plan, std::span<const OrderedCourse> order,
    const ClosedTurns& closed, std::size_t library_size) {
    std::vector<std::pair<std::size_t, CourseFault>> courses;
    const std::vector<std::size_t> course_of = courses_of(plan.pieces);
    for (const std::size_t piece : trial.refused) {
        std::size_t course = course_of[piece];
        if (plan.pieces[piece].kind == PieceKind::Transition && course + 1 < order.size()) {
            course = harder_to_turn_at(order, course, closed);
        }
        courses.emplace_back(at(order[course].course.member) - library_size,
                             CourseFault::InItsPlace);
    }
    std::sort(courses.begin(), courses.end());
    courses.erase(std::unique(courses.begin(), courses.end()), courses.end());
    return courses;
}

}  // namespace meshwind
