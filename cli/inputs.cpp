#include "cli/inputs.h"

#include <array>
#include <cstdio>
#include <iostream>
#include <sstream>

#include <unistd.h>

#include "cli/streams.h"
#include "core/error.h"
#include "core/files/project_files.h"
#include "pipeline/load_inputs.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

std::vector<JobSetting> settings_of(const std::vector<std::string>& texts) {
    std::vector<JobSetting> settings;
    for (const std::string& text : texts) {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0) {
            throw InputError("cli.usage", "--set " + text,
                             "is no setting; write a job's key and value, --set tow.width=8");
        }
        settings.push_back({text.substr(0, equals), text.substr(equals + 1)});
    }
    return settings;
}

}  // namespace

double unit_mm(const std::string& name) {
    return name.empty() ? 0.0 : mm_per(name).value();
}

Eigen::Vector3d vector_of(const std::string& option, const std::string& text) {
    Eigen::Vector3d v;
    std::istringstream in(text);
    std::array<char, 2> comma{};
    std::string rest;
    if (!(in >> v.x() >> comma[0] >> v.y() >> comma[1] >> v.z()) || comma[0] != ',' ||
        comma[1] != ',' || in >> rest || !v.allFinite()) {
        throw InputError("cli.vector", option,
                         "'" + text + "' is not three numbers; write them as X,Y,Z without blanks");
    }
    return v;
}

fs::path found_or_none(const std::string& name) {
    return name.empty() ? fs::path() : find_input(name);
}

Job job_of(const JobArguments& arguments, const fs::path& file, bool points) {
    const std::vector<JobSetting> settings = settings_of(arguments.settings);
    Job base;
    for (const std::string& profile : arguments.profiles) {
        base = load_profile(find_input(profile), base);
    }
    if (file.empty() && !arguments.text.empty()) {
        return points ? job_of_text(arguments.text, arguments.program, {}, settings, base)
                      : parse_job(arguments.text, arguments.program, settings, base);
    }
    if (points) {
        return load_job(file, settings, base);
    }
    return file.empty() ? parse_job("{}", "job", settings, base) : read_job(file, settings, base);
}

RunContext context_of(const Common& common, Progress& progress) {
    RunContext context;
    context.seed = common.seed;
    context.progress = [&](const std::string& step, double share) { progress.show(step, share); };
    return context;
}

bool shows_bar(const Common& common) {
    return !common.quiet && ::isatty(STDERR_FILENO) != 0;
}

double seconds_since(std::chrono::steady_clock::time_point begun) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

int exit_code(const std::string& file, const std::vector<Check>& checks, const Common& common) {
    const bool told = !common.json && !common.quiet && ::isatty(STDOUT_FILENO) != 0 &&
                      ::isatty(STDERR_FILENO) != 0;
    int code = kDone;
    for (const Check& check : checks) {
        if (!check.ok) {
            code = kCheckFailed;
        }
        if (!check.ok && !told) {
            std::cerr << one_line("meshwind: " + file + ": check failed: " + check.name + ": " +
                                  check.words)
                      << '\n';
        }
    }
    return code;
}

}  // namespace meshwind
