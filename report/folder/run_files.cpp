#include "report/folder/run_files.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <system_error>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/disk_file.h"
#include "postproc/ringhead/krl.h"
#include "postproc/robot/dialects.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string>& program_extensions() {
    static const std::vector<std::string> kAll = [] {
        std::vector<std::string> all{kKrlExtension};
        for (const std::string& name : dialect_names()) {
            all.push_back(make_dialect(name)->extension());
        }
        return all;
    }();
    return kAll;
}

bool has_program_extension(const fs::path& name) {
    const std::vector<std::string>& all = program_extensions();
    return std::find(all.begin(), all.end(), name.extension().string()) != all.end();
}

// Names of the files that a report of `carry` tells of, but for those that each run has; none where
// it is the report of something else.
std::vector<std::string> files_of_carry(const std::filesystem::path& report) {
    std::ifstream stream(report, std::ios::binary);
    const nlohmann::json read = nlohmann::json::parse(stream, nullptr, false);
    // The main job writes KRL, too; its report tells of a plan.
    if (!read.is_object() || !read.contains("program") || !read["program"].is_object() ||
        read.contains("plan") ||
        read["program"].value("dialect", nlohmann::json()) != kCarryDialect) {
        return {};
    }
    std::vector<std::string> names = {"rings.csv", "fibre.csv"};
    const nlohmann::json file = read["program"].value("file", nlohmann::json());
    if (file.is_string()) {
        const std::filesystem::path name = file.get<std::string>();
        if (name.extension() == kKrlExtension && name.filename() == name) {
            names.push_back(name.string());
            names.push_back(carried_back(name.stem().string()) + kKrlExtension);
        }
    }
    return names;
}

}  // namespace

FileRole role_of(const fs::path& name) {
    if (name == "report.json" || name == "report.html" || name == "verify.json" ||
        name == "verify.html") {
        return FileRole::Report;
    }
    return has_program_extension(name) ? FileRole::Program : FileRole::Table;
}

bool is_run_file(const fs::path& name) {
    static const std::regex kTable("(path|motion)(-layer-[0-9]+)?(-[0-9]+)?\\.csv");
    static const std::regex kFibre("fibre(-layer-[0-9]+)?(-[0-9]+)?\\.(obj|step)");
    static const std::regex kProgram("program(-layer-[0-9]+)?(-[0-9]+)?");
    static const std::regex kMandrel("mandrel-layer-[0-9]+\\.obj");
    const std::string text = name.filename().string();
    return text == "layup.vtu" || text == "layup.json" || text == "report.html" ||
           text == "report.json" || std::regex_match(text, kTable) ||
           std::regex_match(text, kFibre) || std::regex_match(text, kMandrel) ||
           (has_program_extension(name) && std::regex_match(name.stem().string(), kProgram));
}

std::vector<std::string> files_of_earlier_run(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code error;
    const auto add_if_there = [&](const std::string& name) {
        if (fs::is_regular_file(folder / name, error)) {
            names.push_back(name);
        }
    };
    const std::vector<std::string> carried = files_of_carry(folder / "report.json");
    std::for_each(carried.begin(), carried.end(), add_if_there);
    add_if_there("verify.json");
    add_if_there("verify.html");
    add_if_there("laid.csv");
    fs::directory_iterator entries(folder, error);
    if (error) {
        throw_unwritable(folder, error.message());
    }
    for (const fs::directory_entry& entry : entries) {
        if (is_run_file(entry.path()) && entry.is_regular_file(error)) {
            names.push_back(entry.path().filename().string());
        }
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

void spare_inputs(const fs::path& folder, const std::vector<fs::path>& inputs) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) {
        return;
    }
    for (const std::string& name : files_of_earlier_run(folder)) {
        for (const fs::path& input : inputs) {
            if (!input.empty() && fs::equivalent(input, folder / name, error)) {
                throw InputError("output.holds_input", input.string(),
                                 "this run would replace the file that it reads; write into "
                                 "another folder with -o, or move the file out of this one");
            }
        }
    }
}

}  // namespace meshwind
