#include "cli/run_files.h"

#include <regex>

namespace meshwind {

std::string fibre_suffix(std::size_t fibre) {
    return fibre == 0 ? "" : "-" + std::to_string(fibre + 1);
}

std::string layer_suffix(std::size_t layer) {
    return layer == 0 ? "" : "-layer-" + std::to_string(layer + 1);
}

std::string suffix_of(const std::filesystem::path& program) {
    static const std::regex kSuffix("(-layer-[0-9]+)?(-[0-9]+)?$");
    const std::string stem = program.stem().string();
    std::smatch found;
    return std::regex_search(stem, found, kSuffix) ? found.str() : "";
}

bool is_run_file(const std::filesystem::path& name, std::string_view program_extension) {
    static const std::regex kTable("(path|motion)(-layer-[0-9]+)?(-[0-9]+)?\\.csv");
    static const std::regex kFibre("fibre(-layer-[0-9]+)?(-[0-9]+)?\\.(obj|step)");
    static const std::regex kProgram("program(-layer-[0-9]+)?(-[0-9]+)?");
    static const std::regex kMandrel("mandrel-layer-[0-9]+\\.obj");
    const std::string text = name.filename().string();
    return text == "layup.vtu" || text == "layup.json" || text == "report.html" ||
           std::regex_match(text, kTable) || std::regex_match(text, kFibre) ||
           std::regex_match(text, kMandrel) ||
           (name.extension() == program_extension &&
            std::regex_match(name.stem().string(), kProgram));
}

}  // namespace meshwind
