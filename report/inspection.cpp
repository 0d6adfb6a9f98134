#include "report/inspection.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/files/write_file.h"
#include "core/text/text_number.h"
#include "core/version.h"
#include "mesh/even/blend.h"
#include "mesh/mandrel/remarks.h"
#include "pipeline/part_words.h"
#include "report/page/packed_page.h"
#include "report/part_data.h"
#include "report/print_mandrel.h"
#include "report/report_mandrel.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

// What the main job would say of the wall before it plans.
void add_wall_remarks(Inspection& found) {
    Mandrel& mandrel = found.mandrel;
    if (mandrel.pieces.size() > 1) {
        std::vector<Vector3d> middles_mm;
        for (const WallPiece& piece : mandrel.pieces) {
            middles_mm.push_back(piece.middle_mm);
        }
        add_remark(mandrel, pieces_words(mandrel.pieces) + "; the main job refuses it", middles_mm);
    }
    if (mandrel.winding_mesh.blend_mm > 0.0) {
        return;
    }
    const Surface& wall = mandrel.surface;
    found.sharp = out_of_reach(wall, found.tow_width_mm);
    double area = 0.0;
    std::vector<Vector3d> sharp_mm;
    for (std::size_t f = 0; f < found.sharp.size(); ++f) {
        if (found.sharp[f] != 0) {
            area += area_mm2(wall.position_mm, wall.face[f]);
            sharp_mm.push_back(middle_mm(wall.position_mm, wall.face[f]));
        }
    }
    const std::string words = sharp_words(mandrel, area, found.tow_width_mm);
    if (words.empty()) {
        found.sharp.clear();
    } else {
        add_remark(mandrel, words, sharp_mm);
    }
}

}  // namespace

Inspection inspect(Mandrel mandrel, double tow_width_mm) {
    Inspection found;
    found.mandrel = std::move(mandrel);
    found.tow_width_mm = tow_width_mm;
    found.accuracy = estimate_path_accuracy(found.mandrel.surface);
    found.revolution = find_revolution(found.mandrel);
    found.tube = find_tube(found.mandrel);
    found.axes = axis_candidates(found.mandrel);
    add_wall_remarks(found);
    try {
        require_sound_wall(found.mandrel, true);
    } catch (const InputError& error) {
        found.refused = error.words();
    }
    return found;
}

json inspection_report(const Inspection& found) {
    json report{{"meshwind", kVersion}, {"mandrel", mandrel_report(found.mandrel)}};
    json& mandrel = report["mandrel"];
    mandrel["revolution"] = revolution_report(found.revolution);
    mandrel["tube"] = tube_report(found.tube);
    mandrel["accuracy"] = accuracy_report(found.accuracy);
    mandrel["axis"]["candidates"] = axes_report(found.axes);
    mandrel["places"] = places_report(found.mandrel.places);
    if (found.refined) {
        report["refined"] = {{"file", found.refined->file},
                             {"longest_edge_mm", found.refined->longest_edge_mm},
                             {"triangles", found.refined->triangles}};
    }
    if (!found.page.empty()) {
        report["page"] = found.page;
    }
    return report;
}

void print_inspection(std::ostream& out, const Inspection& found) {
    print_mandrel(out, found);
    if (found.refined) {
        out << "refined       " << found.refined->file << ": " << found.refined->triangles
            << " triangles, edges of at most " << fixed(found.refined->longest_edge_mm, 3)
            << " mm\n";
    }
    if (!found.page.empty()) {
        out << "page          " << found.page << "\n";
    }
}

void check_part_page(const std::string& file) {
    if (file.empty()) {
        return;
    }
    if (part_page_template().empty()) {
        throw InputError("cli.page", "--page",
                         "this program was built without its pages; build it where npm is");
    }
    constexpr std::string_view kEnding = ".html";
    if (!file.ends_with(kEnding)) {
        throw InputError("cli.page_name", file, "is no name of a page; end it in .html");
    }
}

std::string part_page(const Inspection& found) {
    const std::string_view page = part_page_template();
    return page.empty() ? std::string() : packed_page(page, part_data(found));
}

void write_part_page(const Inspection& found, const std::filesystem::path& file) {
    write_file(file, part_page(found));
}

}  // namespace meshwind
