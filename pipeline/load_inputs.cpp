#include "pipeline/load_inputs.h"

#include <variant>

#include "core/text/text_file.h"
#include "machines/machine_json.h"
#include "mesh/io/import.h"

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

LandingText read_landing_points(const std::filesystem::path& file) {
    return {file, read_text_file(file)};
}

}  // namespace meshwind
