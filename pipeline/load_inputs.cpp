#include "pipeline/load_inputs.h"

#include <algorithm>
#include <utility>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/files/project_files.h"
#include "core/text/digest.h"
#include "core/text/text_file.h"
#include "machines/machine_json.h"
#include "machines/spindle_frame.h"
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

std::string file_digest(const std::filesystem::path& file) {
    return short_digest(read_text_file(file));
}

// The files of a name that a program may mean, the nearest first.
std::vector<std::filesystem::path> named_by(const std::filesystem::path& program,
                                            const std::string& name, const std::string& what) {
    if (name.empty()) {
        throw InputError("origin.not_named", program.string(),
                         "its head names no " + what + " file; give it with --" + what);
    }
    const std::filesystem::path beside = std::filesystem::absolute(program).parent_path();
    std::vector<std::filesystem::path> found;
    for (const std::filesystem::path& file :
         {program.parent_path() / name, beside.parent_path() / name, find_input(name)}) {
        if (std::filesystem::is_regular_file(file)) {
            found.push_back(file);
        }
    }
    if (found.empty()) {
        throw InputError("origin.no_file", program.string(),
                         "its head names the " + what + " " + name +
                             ", which is neither beside it, nor in the folder above, nor in this "
                             "one; give it with --" +
                             what);
    }
    return found;
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
    return in_spindle_frame(std::move(machine));
}

Job load_job(const std::filesystem::path& file, std::span<const JobSetting> settings,
             const Job& base) {
    return file.empty() ? job_of_text("{}", "job", {}, settings, base)
                        : job_of_text(read_text_file(file), file.string(), file.parent_path(),
                                      settings, base);
}

Job job_of_text(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                std::span<const JobSetting> settings, const Job& base) {
    Job job = parse_job(text, name, settings, base);
    for (LayerJob& layer : job.layers) {
        if (layer.kind == LayerKind::Imported) {
            layer.points = read_landing_points(folder / layer.file);
        }
    }
    return job;
}

Job load_profile(const std::filesystem::path& file, const Job& base) {
    require_profile_file(file);
    return read_job(file, {}, base);
}

MandrelOf mandrel_reader(std::filesystem::path file, double unit_mm, std::string& digest) {
    return [file = std::move(file), unit_mm, &digest](const Job& job) {
        Mandrel mandrel = load_mandrel(file, mandrel_options(job, unit_mm));
        digest = file_digest(file);
        return mandrel;
    };
}

std::filesystem::path mandrel_named_by(const std::filesystem::path& program,
                                       const std::string& name, const std::string& digest) {
    const std::vector<std::filesystem::path> files = named_by(program, name, "mandrel");
    const auto same = std::find_if(files.begin(), files.end(), [&](const auto& file) {
        return digest.empty() || file_digest(file) == digest;
    });
    if (same == files.end()) {
        throw InputError("origin.other_mandrel", program.string(),
                         "it was made for another " + name + " than " + files.front().string() +
                             ", whose digest its head does not have; to take it all the same give "
                             "it with --mandrel");
    }
    return *same;
}

std::filesystem::path machine_named_by(const std::filesystem::path& program,
                                       const std::string& name) {
    return named_by(program, name, "machine").front();
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
