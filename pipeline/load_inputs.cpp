#include "pipeline/load_inputs.h"

#include <utility>
#include <variant>

#include "core/text/digest.h"
#include "core/text/text_file.h"
#include "machines/machine_json.h"
#include "mesh/io/import.h"
#include "mesh/mandrel/load_mandrel.h"
#include "pipeline/run_names.h"
#include "pipeline/setup.h"

namespace meshwind {
namespace {

void read_mesh(std::variant<Capsule, EnvelopeMesh>& shape) {
    if (auto* const mesh = std::get_if<EnvelopeMesh>(&shape)) {
        mesh->triangles = read_triangles(mesh->file);
    }
}

}  // namespace

Machine load_machine(const std::filesystem::path& file) {
    Machine machine = read_machine(file.string());
    for (EnvelopePart& part : machine.eye.envelope) {
        read_mesh(part.shape);
    }
    for (MachineBody& body : machine.bodies) {
        read_mesh(body.shape);
    }
    return machine;
}

Job load_job(const std::filesystem::path& file, std::span<const JobSetting> settings) {
    return file.empty()
               ? job_of_text("{}", "job", {}, settings)
               : job_of_text(read_text_file(file), file.string(), file.parent_path(), settings);
}

Job job_of_text(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                std::span<const JobSetting> settings) {
    Job job = parse_job(text, name, settings);
    for (LayerJob& layer : job.layers) {
        if (layer.kind == LayerKind::Imported) {
            layer.points = read_landing_points(folder / layer.file);
        }
    }
    return job;
}

MandrelOf mandrel_reader(std::filesystem::path file, double unit_mm, std::string& digest) {
    return [file = std::move(file), unit_mm, &digest](const Job& job) {
        Mandrel mandrel = load_mandrel(file, mandrel_options(job, unit_mm));
        digest = "sha256 " + sha256_hex(read_text_file(file));
        return mandrel;
    };
}

NamedText plan_table(const std::filesystem::path& plan, const std::filesystem::path& program,
                     const std::string& name) {
    const std::filesystem::path numbered = plan / (name + suffix_of(program) + ".csv");
    const std::filesystem::path file =
        std::filesystem::exists(numbered) ? numbered : plan / (name + ".csv");
    return {file.string(), read_text_file(file)};
}

LandingText read_landing_points(const std::filesystem::path& file) {
    return {file, read_text_file(file)};
}

}  // namespace meshwind
