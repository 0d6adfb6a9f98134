#include "report/write_run.h"

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "mesh/io/export.h"
#include "pipeline/run_names.h"
#include "postproc/tables/motion_csv.h"
#include "postproc/tables/path_csv.h"
#include "report/inspection.h"
#include "report/layup.h"
#include "report/layup_files.h"
#include "report/page/packed_page.h"
#include "report/page_data.h"
#include "report/report.h"
#include "report/report_checks.h"

namespace meshwind {
namespace {

void add_layer(const Run& run, std::size_t number, OutputFolder& folder) {
    const WoundLayer& layer = run.layers[number];
    const auto fibres = fibres_of(layer.plan.pieces);
    for (std::size_t fibre = 0; fibre < fibres.size(); ++fibre) {
        const FibreProgram& program = layer.programs[fibre];
        const std::string suffix = layer_suffix(number) + fibre_suffix(fibre);
        folder.add("path" + suffix + ".csv", [&](const auto& write) {
            write_path_csv(fibres[fibre], program.made.eyes.path, write);
        });
        folder.add("motion" + suffix + ".csv",
                   motion_csv(layer.setup.machine, program.made.blocks));
        if (run.usable) {
            folder.add(program.file, program.text);
        }
    }
    if (number > 0) {
        folder.add(grown_mandrel_name(number),
                   mesh_file_bytes(layer.setup.mandrel.whole, MeshFormat::Obj));
    }
}

// What was not planned is shown as the part that it is, with the reason.
std::string page_of_part(const Run& run) {
    const WoundLayer& layer = run.layers.front();
    Inspection found = inspect(layer.setup.mandrel, layer.setup.job.tow.width_mm);
    for (const WoundLayer& planned : run.layers) {
        if (found.refused.empty()) {
            found.refused = planned.plan.failure;
        }
    }
    return part_page(found);
}

// \param layup of what was planned
std::string page_of(const Run& run, const std::optional<Layup>& layup, nlohmann::json report) {
    return layup ? packed_page(report_page_template(), page_data(run, *layup, std::move(report)))
                 : page_of_part(run);
}

}  // namespace

bool has_page(const Run& run) {
    return !(run.planned() ? report_page_template() : part_page_template()).empty();
}

std::string run_page(const Run& run) {
    if (!has_page(run)) {
        return {};
    }
    std::optional<Layup> layup;
    if (run.planned()) {
        layup.emplace(run);
    }
    return page_of(run, layup, report_of(run, run.timing_s));
}

std::string write_run(const Run& run, OutputFolder& folder) {
    const auto begun = std::chrono::steady_clock::now();
    folder.withdraw_earlier_run();
    std::optional<Layup> layup;
    if (run.planned()) {
        for (std::size_t i = 0; i < run.layers.size(); ++i) {
            add_layer(run, i, folder);
        }
        layup.emplace(run);
        for (const MadeFile& file : layup_files(run, *layup)) {
            folder.add(file.name, file.bytes);
        }
    }
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begun;
    std::map<std::string, double> timing_s = run.timing_s;
    timing_s["write"] += spent.count();
    timing_s["total"] += spent.count();
    nlohmann::json report = report_of(run, timing_s);
    std::string text = json_text(report);
    folder.add("report.json", text);
    if (has_page(run)) {
        folder.add("report.html", page_of(run, layup, std::move(report)));
    }
    folder.publish();
    return text;
}

std::string write_run(const Run& run, const std::filesystem::path& folder) {
    OutputFolder output(folder);
    return write_run(run, output);
}

}  // namespace meshwind
