#include "winding/plan/course_fault.h"

namespace meshwind {

const char* name_of(CandidateFault refusal) {
    switch (refusal) {
        case CandidateFault::None:
            return "admissible";
        case CandidateFault::NoRim:
            return "reaches no rim";
        case CandidateFault::NotTurnable:
            return "too steep at a rim to be turned by friction on the extension";
        case CandidateFault::TouchesPins:
            return "too flat at a rim to pass between two pins";
        case CandidateFault::MissesPins:
            return "cannot be moved to where pins take hold of both its ends";
        case CandidateFault::Bridging:
            return "bridges more than the tolerance";
        case CandidateFault::Slips:
            return "would slip: its measured slip exceeds the friction";
        case CandidateFault::NotWindable:
            return "free fibre or eye would hit the mandrel both ways";
    }
    return "";
}

const char* name_of(CourseFault rejection) {
    switch (rejection) {
        case CourseFault::None:
            return "accepted";
        case CourseFault::Path:
            return "followed accurately the course bridges or cannot be turned";
        case CourseFault::Slip:
            return "the slip measured on the finished course exceeds the friction";
        case CourseFault::FreeLength:
            return "no free length of the fibre is clear all along the course";
        case CourseFault::AxisTravel:
            return "an axis of the machine would pass its end";
        case CourseFault::FibreHit:
            return "the free fibre would hit something";
        case CourseFault::HeadHit:
            return "the head would come too near";
        case CourseFault::Laydown:
            return "wound again, its program does not lay the course as planned";
        case CourseFault::InItsPlace:
            return "the machine refuses the course or a turn next to it";
        case CourseFault::Apart:
            return "one fibre cannot join the course to the others";
        case CourseFault::NotPlanned:
            return "nothing is planned where so little of the wall is in reach";
    }
    return "";
}

}  // namespace meshwind
