#include "winding/cover/library.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "core/margins.h"
#include "core/parallel.h"
#include "core/units.h"
#include "geodesic/bridge.h"
#include "winding/cover/fit_course.h"
#include "winding/laminate/wound_angle.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Distance of the stations at which a course's free fibre is tried: in between the head comes
// nearer by some tenths of a mm at most. With 5 mm it was .7 mm on a branch that leans.
constexpr double kWindableStep_mm = 2.0;

// Stations that a seed is moved beyond a bridge.
constexpr std::size_t kStationsBeyond = 3;

// A sketch comes to pins by so many moves, and ends as near to where they take hold of it: the
// course itself is moved once more when it is proven.
constexpr int kSketchMoves = 3;
constexpr double kSketchAtPin_mm = 0.2;

// So many seeds are tried for a course; the last is kept.
constexpr int kMaxMoves = 3;

constexpr std::size_t kCandidateChunk = 64;

// A candidate whose half is longer than this many bounding boxes circles.
constexpr double kMaxHalfLengthBoxes = 8.0;

// Of the directions drawn, those at the wanted winding angle.
constexpr double kWantedShare = 2.0 / 3.0;

// Half a candidate: from its seed ahead, or behind (`side` -1) where the same curve is steered to
// the other side of travel.
TraceResult trace_half(const CourseRules& rules, const Candidate& candidate, double side,
                       TraceMethod method) {
    const Surface& surface = rules.mandrel.surface;
    const Vector3d direction = side * direction_of(surface, candidate);
    const double slip_ratio = candidate.slip_ratio + (side < 0.0 ? candidate.more_behind : 0.0);
    const Steering steering{side * slip_ratio, 0.0};
    const TraceOptions options{.max_length_mm = rules.max_half_length_mm, .method = method};
    return method == TraceMethod::Walk
               ? trace(surface, candidate.seed, direction, steering, options)
               : trace_taut(surface, candidate.seed, direction, steering, options, rules.lifted);
}

SurfacePath join_halves(const SurfacePath& behind, const SurfacePath& ahead) {
    SurfacePath path = reversed(behind);
    const double offset = path.back().s_mm;
    path.pop_back();
    path.reserve(path.size() + ahead.size());
    for (PathPoint point : ahead) {
        point.s_mm += offset;
        path.push_back(point);
    }
    return path;
}

// A candidate's path from rim to rim and the string over it.
struct Run {
    SurfacePath path;
    TautString string;
    std::size_t seed = 0;  // station of the candidate's seed
};

// Largest height of the straight fibre over the wall, from where it leaves the wall to where it
// meets it again. The string over the path is a little off it (geodesic/slip_and_bridging.h).
double worst_bridge_mm(const Run& run) {
    const std::vector<double>& gap = run.string.gap_mm;
    double worst = run.string.worst_gap_mm;
    for (std::size_t first = 1; first + 1 < gap.size(); ++first) {
        if (gap[first] <= 0.0) {
            continue;
        }
        std::size_t end = first;
        while (end + 1 < gap.size() && gap[end] > 0.0) {
            ++end;
        }
        const Vector3d& from = run.path[first - 1].position_mm;
        const Vector3d chord = run.path[end].position_mm - from;
        for (std::size_t i = first; i < end; ++i) {
            const Vector3d rise = run.path[i].position_mm - from;
            const double share = rise.dot(chord) / chord.squaredNorm();
            worst = std::max(worst, run.path[i].normal.dot(share * chord - rise));
        }
        first = end;
    }
    return worst;
}

// Traces a member's candidate, notes where it crosses the rims, and judges what the path alone
// tells.
CandidateFault follow(const CourseRules& rules, TraceMethod method, LibraryCourse& course,
                      Run& run) {
    std::array<TraceResult, 2> half;
    for (std::size_t e = 0; e < 2; ++e) {  // judged one by one: most candidates fail at one end
        half[e] = trace_half(rules, course.candidate, e == 0 ? -1.0 : 1.0, method);
        if (half[e].stop != TraceStop::Rim || half[e].rim < 0) {
            return CandidateFault::NoRim;
        }
        const Rim& rim = rules.mandrel.rims[static_cast<std::size_t>(half[e].rim)];
        const PathPoint& last = half[e].path.back();
        course.end[e] = crossing_at(rim, last.position_mm, last.tangent);
        if (!can_turn(rim, course.end[e], rules.turns)) {
            return rules.turns.pins.empty() ? CandidateFault::NotTurnable
                                            : CandidateFault::TouchesPins;
        }
    }
    run.seed = half[0].path.size() - 1;
    run.path = join_halves(half[0].path, half[1].path);
    run.string = taut_string(run.path);
    return worst_bridge_mm(run) > margin::kCoverBridging * rules.tow.bridging_tolerance_mm
               ? CandidateFault::Bridging
               : CandidateFault::None;
}

void measure_length(const CourseRules& rules, const SurfacePath& path, LibraryCourse& course) {
    course.length_mm = path.back().s_mm;
    course.turn_mm = 0.0;
    for (const RimCrossing& end : course.end) {
        const Rim& rim = rules.mandrel.rims[static_cast<std::size_t>(end.rim)];
        course.turn_mm += half_turn_mm(rim, end, rules.turns);
    }
    course.off_angle_mm =
        rules.angle_rad ? angle_kept(rules.mandrel.surface, path, *rules.angle_rad).off_mm : 0.0;
}

// Where a seed lies under a bridge: one on the wall for the same course, as a taut fibre is traced
// from where it touches. Some stations beyond the bridge, whose ends are not known better.
std::optional<Candidate> seed_on_the_wall(const Run& run, const Candidate& candidate) {
    const std::vector<double>& gap = run.string.gap_mm;
    if (gap[run.seed] < kMinBridge_mm) {
        return std::nullopt;
    }
    std::size_t station = run.seed;
    while (station + 1 < gap.size() && gap[station] > 0.0) {
        ++station;
    }
    for (std::size_t i = 0; i < kStationsBeyond && station + 1 < gap.size(); ++i) {
        station += gap[station + 1] <= 0.0 ? 1 : 0;
    }
    const PathPoint& place = run.path[station];
    return Candidate{place.at, direction_angle(place.normal, place.tangent), candidate.slip_ratio,
                     candidate.more_behind};
}

// The walk tells most of what is not admissible, the patches then what is.
CandidateFault follow_taut(const CourseRules& rules, LibraryCourse& course, Run& run) {
    CandidateFault refusal = follow(rules, TraceMethod::Walk, course, run);
    for (int moved = 0; refusal == CandidateFault::None && moved < kMaxMoves; ++moved) {
        const auto seed = seed_on_the_wall(run, course.candidate);
        if (!seed && moved > 0) {
            break;
        }
        course.candidate = seed.value_or(course.candidate);
        refusal = follow(rules, TraceMethod::Patches, course, run);
    }
    return refusal;
}

}  // namespace

double max_half_length_mm(const Surface& surface) {
    return kMaxHalfLengthBoxes * diagonal_mm(surface.position_mm);
}

Vector3d direction_of(const Surface& surface, const Candidate& candidate) {
    const Vector3d n = smooth_normal(surface, candidate.seed);
    const Vector3d x = n.unitOrthogonal();
    return std::cos(candidate.angle_rad) * x + std::sin(candidate.angle_rad) * n.cross(x);
}

double direction_angle(const Vector3d& normal, const Vector3d& tangent) {
    const Vector3d x = normal.unitOrthogonal();
    return std::atan2(tangent.dot(normal.cross(x)), tangent.dot(x));
}

double draw_direction_rad(const CourseRules& rules, const SurfacePoint& place, double unit,
                          double choice) {
    if (rules.angle_rad && choice < kWantedShare) {
        if (const auto axial = axial_direction_rad(rules.mandrel.surface, place)) {
            return *axial + (unit < 0.5 ? 1.0 : -1.0) * *rules.angle_rad;
        }
    }
    return kPi * unit;
}

SurfacePath trace_both_ways(const CourseRules& rules, const Candidate& candidate,
                            TraceMethod method) {
    return join_halves(trace_half(rules, candidate, -1.0, method).path,
                       trace_half(rules, candidate, 1.0, method).path);
}

bool is_windable(const CourseRules& rules, const SurfacePath& path, const TautString& string,
                 double step_mm) {
    const FreeFibreRule& rule = rules.free_fibre;
    std::vector<std::size_t> stations;
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (stations.empty() || i + 1 == path.size() ||
            path[i].s_mm >= path[stations.back()].s_mm + step_mm) {
            stations.push_back(i);
        }
    }
    const auto fibre_at = [&](std::size_t i) {
        return string_point(path[i], string.gap_mm[i], string.slope[i]);
    };
    const bool at_preferred = std::all_of(stations.begin(), stations.end(), [&](std::size_t i) {
        const StringPoint fibre = fibre_at(i);
        return is_free_length(rules.obstacles, fibre.position_mm, path[i].normal, fibre.tangent,
                              rule, rule.preferred_mm);
    });
    if (at_preferred) {
        return true;
    }
    std::vector<double> s_mm;
    std::vector<std::vector<FreeFibreWindow>> windows;
    for (const std::size_t i : stations) {
        const StringPoint fibre = fibre_at(i);
        s_mm.push_back(path[i].s_mm);
        windows.push_back(free_fibre_windows(rules.obstacles, fibre.position_mm, path[i].normal,
                                             fibre.tangent, rule));
        if (windows.back().empty()) {
            return false;
        }
    }
    return choose_free_lengths(s_mm, windows, rule.preferred_mm).blocked.empty();
}

CandidateFault follow_course(const CourseRules& rules, const Candidate& candidate,
                             LibraryCourse& member, TracedCourse& followed) {
    LibraryCourse course;
    course.candidate = candidate;
    Run run;
    const CandidateFault refusal = follow_taut(rules, course, run);
    if (refusal != CandidateFault::None) {
        return refusal;
    }
    measure_length(rules, run.path, course);
    SlipMeasure slip =
        measure_slip(rules.mandrel.surface, run.path, run.string,
                     {.friction = rules.tow.friction.holds(), .method = TraceMethod::Patches});
    if (slip.worst > rules.tow.friction.holds()) {
        return CandidateFault::Slips;
    }
    member = std::move(course);
    followed = {std::move(run.path), std::move(run.string), std::move(slip)};
    return CandidateFault::None;
}

bool is_windable(const CourseRules& rules, const TracedCourse& course, bool backward) {
    if (!backward) {
        return is_windable(rules, course.path, course.string, kWindableStep_mm);
    }
    const SurfacePath back = reversed(course.path);
    return is_windable(rules, back, taut_string(back), kWindableStep_mm);
}

CandidateFault judge(const CourseRules& rules, const Candidate& candidate,
                     FootprintFinder::Scratch& scratch, LibraryCourse& member) {
    LibraryCourse course;
    TracedCourse followed;
    const CandidateFault refusal = follow_course(rules, candidate, course, followed);
    if (refusal != CandidateFault::None) {
        return refusal;
    }
    course.windable_forward = is_windable(rules, followed, false);
    course.windable_backward = is_windable(rules, followed, true);
    if (!is_windable(course)) {
        return CandidateFault::NotWindable;
    }
    course.footprint = rules.footprints.footprint(followed.path, scratch);
    member = std::move(course);
    return CandidateFault::None;
}

namespace {

// As draw_path(), wherever it ends.
CandidateFault draw_where_it_is(const CourseRules& rules, const Candidate& candidate,
                                DraftCourse& sketch) {
    LibraryCourse& course = sketch.course;
    course.candidate = candidate;
    course.windable_forward = false;
    course.windable_backward = false;
    Run run;
    const CandidateFault refusal = follow(rules, TraceMethod::Walk, course, run);
    if (refusal == CandidateFault::None) {
        measure_length(rules, run.path, course);
        sketch.path = std::move(run.path);
    }
    return refusal;
}

}  // namespace

CandidateFault draw_path(const CourseRules& rules, const Candidate& candidate,
                         DraftCourse& sketch) {
    CandidateFault refusal = draw_where_it_is(rules, candidate, sketch);
    for (int moves = 0; refusal == CandidateFault::None; ++moves) {
        if (ends_at_pins(rules, sketch.course, kSketchAtPin_mm)) {
            break;
        }
        const PlacedCourse placed{sketch.course, std::move(sketch.path)};
        const auto move = move_to_pins(rules, placed);
        if (!move || moves == kSketchMoves) {
            return CandidateFault::MissesPins;
        }
        refusal =
            draw_where_it_is(rules, moved(rules, placed, seed_station(placed), *move), sketch);
    }
    return refusal;
}

namespace {

CandidateFault sketch_windable(const CourseRules& rules, const Candidate& candidate,
                               FootprintFinder::Scratch& scratch, LibraryCourse& member) {
    DraftCourse sketch;
    const CandidateFault refusal = draw_path(rules, candidate, sketch);
    if (refusal != CandidateFault::None) {
        return refusal;
    }
    LibraryCourse& course = sketch.course;
    const SurfacePath back = reversed(sketch.path);
    course.windable_forward =
        is_windable(rules, sketch.path, taut_string(sketch.path), kSketchStep_mm);
    course.windable_backward = is_windable(rules, back, taut_string(back), kSketchStep_mm);
    if (!is_windable(course)) {
        return CandidateFault::NotWindable;
    }
    course.footprint = rules.footprints.footprint(sketch.path, scratch);
    member = std::move(course);
    return CandidateFault::None;
}

}  // namespace

CandidateFault draw_sketch(const CourseRules& rules, const Candidate& candidate,
                           FootprintFinder::Scratch& scratch, DraftCourse& sketch) {
    const CandidateFault refusal = draw_path(rules, candidate, sketch);
    if (refusal == CandidateFault::None) {
        sketch.course.footprint = rules.footprints.footprint(sketch.path, scratch);
    }
    return refusal;
}

LibraryPart build_library(const CourseRules& rules, std::span<const Candidate> candidates,
                          Judging judging) {
    const std::size_t chunks = (candidates.size() + kCandidateChunk - 1) / kCandidateChunk;
    std::vector<LibraryPart> parts(chunks);
    parallel_for(candidates.size(), kCandidateChunk, [&](std::size_t begin, std::size_t end) {
        LibraryPart& part = parts[begin / kCandidateChunk];
        FootprintFinder::Scratch scratch = rules.footprints.make_scratch();
        for (std::size_t i = begin; i < end; ++i) {
            LibraryCourse member;
            CandidateFault refusal = sketch_windable(rules, candidates[i], scratch, member);
            if (refusal == CandidateFault::None && judging == Judging::Courses) {
                refusal = judge(rules, candidates[i], scratch, member);
            }
            part.outcome.push_back(refusal);
            if (refusal == CandidateFault::None) {
                part.members.push_back(std::move(member));
            }
        }
    });
    LibraryPart library;
    for (LibraryPart& part : parts) {
        std::move(part.members.begin(), part.members.end(), std::back_inserter(library.members));
        library.outcome.insert(library.outcome.end(), part.outcome.begin(), part.outcome.end());
    }
    return library;
}

}  // namespace meshwind
