#include "cli/report_study.h"

#include <nlohmann/json.hpp>

#include "cli/report_checks.h"
#include "cli/study_advice.h"
#include "cli/study_files.h"
#include "version.h"

namespace meshwind {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const MeshSizeLine& line) {
    Json json{{"mandrel", line.mandrel},
              {"method", line.method},
              {"lambda", line.slip_ratio},
              {"quantity", name_of(line.quantity)},
              {"unit", unit_of(line.quantity)}};
    if (line.rule) {
        json["tangent_rule"] = name_of(*line.rule);
    }
    const auto order = fitted_order(line);
    json["order"] = order ? Json(*order) : Json();
    json["points"] = Json::array();
    for (const MeshSizePoint& point : line.points) {
        json["points"].push_back({{"edge_mm", point.edge_mm},
                                  {"mean_edge_mm", point.mean_edge_mm},
                                  {"triangles", point.triangles},
                                  {"rms", shown_error(line.quantity, point.rms)},
                                  {"worst", shown_error(line.quantity, point.worst)},
                                  {"order", point.order ? Json(*point.order) : Json()}});
    }
    return json;
}

}  // namespace

std::string study_json(const StudyOutcome& outcome) {
    const MeshSizeOptions& options = outcome.options;
    Json json{{"meshwind", kVersion},
              {"study", "mesh-size"},
              {"options",
               {{"edges_mm", options.edges_mm},
                {"lambda", options.slip_ratios},
                {"paths", options.paths},
                {"length_mm", options.length_mm},
                {"free_length_mm", options.free_length_mm},
                {"irregular", options.irregular},
                {"seed", options.seed}}}};
    json["references"] = Json::object();
    for (const auto& [mandrel, words] : outcome.references) {
        json["references"][mandrel] = words;
    }
    json["lines"] = Json::array();
    for (const MeshSizeLine& line : outcome.study.lines) {
        json["lines"].push_back(json_of(line));
    }
    json["remarks"] = outcome.study.remarks;
    json["advice"] = Json::array();
    for (const Advice& advice : judged_advice(outcome)) {
        json["advice"].push_back(
            {{"claim", advice.claim}, {"holds", advice.holds}, {"because", advice.because}});
    }
    return json_text(json);
}

}  // namespace meshwind
