#include "winding/plan/details.h"

namespace meshwind {

const char* name_of(Planner planner) {
    switch (planner) {
        case Planner::None:
            return "";
        case Planner::Cover:
            return "cover";
        case Planner::Pattern:
            return "pattern";
        case Planner::Elbow:
            return "elbow";
        case Planner::Imported:
            return "imported";
    }
    return "";
}

}  // namespace meshwind
