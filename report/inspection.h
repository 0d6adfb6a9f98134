/// Inspection of a part for `inspect`: in words, as JSON, and as a page.
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "geodesic/path_accuracy.h"
#include "mesh/mandrel.h"
#include "mesh/revolution/revolution.h"
#include "mesh/segment/axis_candidates.h"
#include "mesh/tube/tube.h"

namespace meshwind {

/// A finer mesh of the wall that was written (`--refine`).
struct RefinedFile {
    std::string file;
    double longest_edge_mm = 0.0;
    std::size_t triangles = 0;
};

struct Inspection {
    Mandrel mandrel;  ///< with the remarks that the main job would add for its wall
    PathAccuracy accuracy;
    RevolutionFinding revolution;
    TubeFinding tube;
    std::vector<AxisCandidate> axes;  ///< of the spindle, the chosen one first
    double tow_width_mm = 0.0;
    /// Per face of the winding surface 1 where a ball as wide as the tow cannot touch its middle;
    /// empty where hardly any is so
    std::vector<char> sharp;
    std::string refused;  ///< why the main job would refuse it, in words; empty: it would try
    std::optional<RefinedFile> refined;
    std::string page;  ///< file of the page that was written; empty: none
};

/// \param mandrel as it was loaded
[[nodiscard]] Inspection inspect(Mandrel mandrel, double tow_width_mm);

/// "meshwind" (version), "mandrel" (mandrel_report with "revolution", "tube", "accuracy", "places",
/// and "candidates" of its "axis"), and "refined" and "page" of the written files.
[[nodiscard]] nlohmann::json inspection_report(const Inspection& found);

/// The same in words.
void print_inspection(std::ostream& out, const Inspection& found);

/// Checks the name before any work, so that writing does not fail after it; an empty name asks for
/// no page.
/// \throws InputError cli.page, cli.page_name
void check_part_page(const std::string& file);

/// Text of the page; empty where the program was built without its pages.
[[nodiscard]] std::string part_page(const Inspection& found);

/// The page of the part in one file: its triangles by region, rims, spindle, places of the remarks
/// and all that is printed. \pre check_part_page \throws IoError output.unwritable
void write_part_page(const Inspection& found, const std::filesystem::path& file);

}  // namespace meshwind
