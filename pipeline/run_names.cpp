#include "pipeline/run_names.h"

#include <charconv>
#include <regex>

namespace meshwind {

namespace fs = std::filesystem;

std::string fibre_suffix(std::size_t fibre) {
    return fibre == 0 ? "" : "-" + std::to_string(fibre + 1);
}

std::string layer_suffix(std::size_t layer) {
    return layer == 0 ? "" : "-layer-" + std::to_string(layer + 1);
}

std::string suffix_of(const fs::path& program) {
    static const std::regex kSuffix("(-layer-[0-9]+)?(-[0-9]+)?$");
    const std::string stem = program.stem().string();
    std::smatch found;
    return std::regex_search(stem, found, kSuffix) ? found.str() : "";
}

std::size_t layer_of(const fs::path& program) {
    static const std::string kBefore = "-layer-";
    const std::string suffix = suffix_of(program);
    std::size_t number = 0;
    if (suffix.rfind(kBefore, 0) == 0) {
        std::from_chars(suffix.data() + kBefore.size(), suffix.data() + suffix.size(), number);
    }
    return number > 0 ? number - 1 : 0;
}

std::string grown_mandrel_name(std::size_t layer) {
    return "mandrel" + layer_suffix(layer) + ".obj";
}

}  // namespace meshwind
