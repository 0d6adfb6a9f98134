#include "winding/plan/rejection.h"

namespace meshwind {

const char* name_of(Refusal refusal) {
    switch (refusal) {
        case Refusal::None:
            return "admissible";
        case Refusal::NoRim:
            return "reaches no rim";
        case Refusal::NotTurnable:
            return "too steep at a rim to be turned by friction on the extension";
        case Refusal::TouchesPins:
            return "too flat at a rim to pass between two pins";
        case Refusal::MissesPins:
            return "cannot be moved to where pins take hold of both its ends";
        case Refusal::Bridging:
            return "bridges more than the tolerance";
        case Refusal::Slips:
            return "would slip: its measured slip exceeds the friction";
        case Refusal::NotWindable:
            return "free fibre or eye would hit the mandrel both ways";
    }
    return "";
}

const char* name_of(Rejection rejection) {
    switch (rejection) {
        case Rejection::None:
            return "accepted";
        case Rejection::Path:
            return "followed accurately the course bridges or cannot be turned";
        case Rejection::Slip:
            return "the slip measured on the finished course exceeds the friction";
        case Rejection::FreeLength:
            return "no free length of the fibre is clear all along the course";
        case Rejection::AxisTravel:
            return "an axis of the machine would pass its end";
        case Rejection::FibreHit:
            return "the free fibre would hit something";
        case Rejection::HeadHit:
            return "the head would come too near";
        case Rejection::Laydown:
            return "wound again, its program does not lay the course as planned";
        case Rejection::InItsPlace:
            return "the machine refuses the course or a turn next to it";
        case Rejection::Apart:
            return "one fibre cannot join the course to the others";
        case Rejection::NotPlanned:
            return "nothing is planned where so little of the wall is in reach";
    }
    return "";
}

}  // namespace meshwind
