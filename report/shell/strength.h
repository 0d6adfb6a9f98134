/// Where a wound wall fails first: ply stresses by CalculiX, judged by Tsai and Wu.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "report/shell/shell_model.h"

namespace meshwind {

/// Stress in a ply's axes, MPa.
struct PlyStress {
    double along = 0.0;   ///< the fibre
    double across = 0.0;  ///< in the wall
    double shear = 0.0;   ///< between both
};

/// Reserve factor: multiple of the stress, all components scaled alike, at which Tsai and Wu's
/// criterion tsai_1971_strength is met; infinite without stress.
[[nodiscard]] double tsai_wu_reserve(const PlyStrength& strength, const PlyStress& stress);

/// A ply at its point that fails first.
struct PlyState {
    std::size_t triangle = 0, ply = 0;  ///< from 0
    double reserve = std::numeric_limits<double>::infinity();
    PlyStress stress;
};

struct Strength {
    std::vector<double> reserve;   ///< per triangle: of its weakest ply; infinite without plies
    std::vector<PlyState> layers;  ///< per layer of the job: its weakest ply
    PlyState first;                ///< of all
    std::vector<std::vector<PlyStress>> stress;  ///< per triangle and ply: mean over its points
};

/// Stresses of a CalculiX result, `.dat`, of the deck of `model`.
/// \throws InputError strength.no_result where a ply has none
/// \pre the material has strengths
[[nodiscard]] Strength read_strength(const std::filesystem::path& dat, const ShellModel& model);

/// Runs `ccx` on the deck and reads its results. \param folder for its files, which stay there:
/// `strength.inp`, `strength.dat`
/// \throws InputError strength.no_program, strength.failed with the program's message
[[nodiscard]] Strength compute_strength(const ShellModel& model,
                                        const std::filesystem::path& folder);

}  // namespace meshwind
