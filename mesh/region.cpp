#include "mesh/region.h"

namespace meshwind {

std::string_view name_of(RegionKind kind) {
    switch (kind) {
        case RegionKind::OuterWall:
            return "outer-wall";
        case RegionKind::EndCap:
            return "end-cap";
        case RegionKind::Bore:
            return "bore";
        case RegionKind::Other:
            break;
    }
    return "other";
}

}  // namespace meshwind
