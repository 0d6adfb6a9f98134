#include "report/part_data.h"

#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "report/page/page_arrays.h"

namespace meshwind {
namespace {

using nlohmann::json;

// Of the winding surface to the whole part, whose kept faces it has in their order.
std::vector<char> sharp_of_part(const Inspection& found) {
    const Mandrel& mandrel = found.mandrel;
    std::vector<char> sharp(mandrel.whole.faces.size(), 0);
    std::size_t wall = 0;
    for (std::size_t f = 0; f < sharp.size() && wall < found.sharp.size(); ++f) {
        if (mandrel.regions[static_cast<std::size_t>(mandrel.whole_region[f])].kept) {
            sharp[f] = found.sharp[wall++];
        }
    }
    return sharp;
}

}  // namespace

std::string part_data(const Inspection& found) {
    const Mandrel& mandrel = found.mandrel;
    PageArrays arrays;
    arrays.add_points("part/points", mandrel.whole.points_mm);
    arrays.add_faces("part/faces", mandrel.whole.faces);
    arrays.add<std::int32_t>("part/region", 1, mandrel.whole_region);
    arrays.add<char>("part/sharp", 1, sharp_of_part(found));
    arrays.add_points("details/points", mandrel.details.points_mm);
    arrays.add_faces("details/faces", mandrel.details.faces);
    for (const Rim& rim : mandrel.rims) {
        std::vector<Eigen::Vector3d> loop;
        for (const std::int32_t v : rim.vertices) {
            loop.push_back(mandrel.surface.position_mm[static_cast<std::size_t>(v)]);
        }
        arrays.add_points("rim" + std::to_string(rim.id) + "/loop", loop);
    }
    std::ostringstream text;
    print_inspection(text, found);
    return arrays.behind({{"format", "meshwind-part-1"},
                          {"inspection", inspection_report(found)},
                          {"text", text.str()},
                          {"refused", found.refused.empty() ? json(nullptr) : json(found.refused)},
                          {"tow_width_mm", found.tow_width_mm},
                          {"details_mm", mandrel.winding_mesh.details_mm}});
}

}  // namespace meshwind
