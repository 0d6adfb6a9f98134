#include "report/shell/strength.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>
#include <system_error>

#include "core/child_program.h"
#include "core/error.h"
#include "core/files/write_file.h"
#include "report/shell/decks.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "ccx";
constexpr const char* kCase = "strength";

constexpr int kStressColumns = 6;  // xx yy zz xy xz yz

// A line of the result: element, point, six stresses, name of the axes.
struct StressRow {
    std::size_t triangle = 0, ply = 0;  // from 0
    PlyStress stress;
};

std::string_view next_word(std::string_view& line) {
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t end = std::min(line.find(' ', begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

template <typename Number>
bool reads(std::string_view text, Number& number) {
    const char* const end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, number);
    return read.ec == std::errc() && read.ptr == end;
}

// False for lines that are none, and for plies without axes: films, sheets.
bool read_row(std::string_view line, StressRow& row) {
    std::size_t element = 0;
    std::size_t point = 0;
    if (!reads(next_word(line), element) || !reads(next_word(line), point)) {
        return false;
    }
    std::array<double, kStressColumns> value{};
    for (double& one : value) {
        if (!reads(next_word(line), one)) {
            return false;
        }
    }
    const std::string_view axes = next_word(line);
    const std::string before = ply_name(element, 0);
    const std::string_view stem = std::string_view(before).substr(0, before.size() - 1);
    if (element == 0 || !axes.starts_with(stem)) {
        return false;
    }
    std::size_t ply = 0;
    const std::string_view number =
        axes.substr(stem.size(), axes.find_first_not_of("0123456789", stem.size()) - stem.size());
    if (!reads(number, ply) || ply == 0) {
        return false;
    }
    row = {element - 1, ply - 1, {value[0], value[1], value[3]}};
    return true;
}

}  // namespace

// F1 s1 + F2 s2 + F11 s1^2 + F22 s2^2 + F66 s12^2 + 2 F12 s1 s2 = 1 at the stress times the
// reserve.
double tsai_wu_reserve(const PlyStrength& strength, const PlyStress& stress) {
    const double f1 = 1.0 / strength.tension_1_mpa - 1.0 / strength.compression_1_mpa;
    const double f2 = 1.0 / strength.tension_2_mpa - 1.0 / strength.compression_2_mpa;
    const double f11 = 1.0 / (strength.tension_1_mpa * strength.compression_1_mpa);
    const double f22 = 1.0 / (strength.tension_2_mpa * strength.compression_2_mpa);
    const double f66 = 1.0 / (strength.shear_12_mpa * strength.shear_12_mpa);
    const double f12 = strength.interaction * std::sqrt(f11 * f22);
    const double square = f11 * stress.along * stress.along + f22 * stress.across * stress.across +
                          f66 * stress.shear * stress.shear +
                          2.0 * f12 * stress.along * stress.across;
    const double linear = f1 * stress.along + f2 * stress.across;
    const double root = std::sqrt(linear * linear + 4.0 * square);
    // As the larger root of square R^2 + linear R = 1, without the difference of near numbers.
    return linear > 0.0 ? 2.0 / (linear + root)
                        : (square > 0.0 ? (root - linear) / (2.0 * square)
                                        : std::numeric_limits<double>::infinity());
}

Strength read_strength(const fs::path& dat, const ShellModel& model) {
    const std::vector<ShellTriangle>& triangles = model.mesh->triangle;
    const PlyStrength& strength = *model.material->strength;
    Strength result;
    result.reserve.assign(triangles.size(), std::numeric_limits<double>::infinity());
    result.stress.resize(triangles.size());
    std::vector<std::vector<int>> points(triangles.size());
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        result.stress[f].resize(triangles[f].plies.size());
        points[f].resize(triangles[f].plies.size());
    }
    std::ifstream file(dat);
    StressRow row;
    for (std::string line; std::getline(file, line);) {
        if (!read_row(line, row) || row.triangle >= triangles.size() ||
            row.ply >= triangles[row.triangle].plies.size()) {
            continue;
        }
        PlyStress& sum = result.stress[row.triangle][row.ply];
        sum = {sum.along + row.stress.along, sum.across + row.stress.across,
               sum.shear + row.stress.shear};
        ++points[row.triangle][row.ply];
        const PlyState state{row.triangle, row.ply, tsai_wu_reserve(strength, row.stress),
                             row.stress};
        result.reserve[row.triangle] = std::min(result.reserve[row.triangle], state.reserve);
        const std::size_t layer = triangles[row.triangle].plies[row.ply].layer;
        result.layers.resize(std::max(result.layers.size(), layer + 1));
        for (PlyState* const worst : {&result.layers[layer], &result.first}) {
            if (state.reserve < worst->reserve) {
                *worst = state;
            }
        }
    }
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        for (std::size_t k = 0; k < triangles[f].plies.size(); ++k) {
            if (points[f][k] == 0) {
                throw InputError("strength.no_result", dat.string(),
                                 "has no stress of ply " + std::to_string(k + 1) + " of element " +
                                     std::to_string(f + 1) + "; CalculiX 2.20 writes them");
            }
            PlyStress& mean = result.stress[f][k];
            mean = {mean.along / points[f][k], mean.across / points[f][k],
                    mean.shear / points[f][k]};
        }
    }
    return result;
}

Strength compute_strength(const ShellModel& model, const fs::path& folder) {
    write_file(folder / (std::string(kCase) + ".inp"), calculix_deck(model));
    const fs::path dat = folder / (std::string(kCase) + ".dat");
    fs::remove(dat);
    ProgramEnd end;
    try {
        end = run_program(kProgram, {kCase}, folder);
    } catch (const std::system_error&) {
        throw InputError("strength.no_program", kProgram,
                         "is not there; install CalculiX: apt-get install calculix-ccx");
    }
    std::error_code ignored;
    if (end.exit_code != 0 || end.signal != 0 || fs::file_size(dat, ignored) == 0 || ignored) {
        std::istringstream lines(end.output);
        std::string error;
        for (std::string line; error.empty() && std::getline(lines, line);) {
            error = line.find("*ERROR") == std::string::npos ? "" : line;
        }
        throw InputError("strength.failed", (folder / kCase).string() + ".inp",
                         "CalculiX ends without stresses (exit code " +
                             std::to_string(end.signal != 0 ? 128 + end.signal : end.exit_code) +
                             ")" + (error.empty() ? "" : ":" + error));
    }
    return read_strength(dat, model);
}

}  // namespace meshwind
