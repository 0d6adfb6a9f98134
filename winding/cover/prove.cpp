#include "winding/cover/prove.h"

#include <utility>

#include "winding/cover/balance.h"
#include "winding/cover/lay_out.h"

namespace meshwind {

Rejection prove_course(const CourseRules& rules, const Windability* machine, PlacedCourse& course) {
    const bool backward = course.backward;
    Member exact;
    FollowedCourse followed;
    switch (follow_course(rules, course.member.candidate, exact, followed)) {
        case Refusal::None:
            break;
        case Refusal::Slips:
            return Rejection::Slip;
        default:
            return Rejection::Path;
    }
    if (nodes_of(exact, backward) != nodes_of(course.member, backward)) {
        return Rejection::Path;
    }
    if (machine == nullptr && !is_windable(rules, followed, backward)) {
        return Rejection::FreeLength;
    }
    SurfacePath path = followed.path;
    std::vector<Piece> pieces;
    pieces.push_back(piece_of(rules, std::move(followed), exact, backward));
    add_half_turns(rules, exact, backward, pieces);
    if (const Rejection rejection = machine != nullptr ? machine->follow(pieces) : Rejection::None;
        rejection != Rejection::None) {
        return rejection;
    }
    FootprintFinder::Scratch scratch = rules.footprints.make_scratch();
    exact.footprint = rules.footprints.footprint(path, scratch);
    exact.windable_forward = !backward;
    exact.windable_backward = backward;
    course.member = std::move(exact);
    course.path = std::move(path);
    return Rejection::None;
}

}  // namespace meshwind
