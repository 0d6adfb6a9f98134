/// Materials of a wound wall: the ply, the matrix between the tows, the liner under it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace meshwind {

/// Strengths of a ply, all positive.
struct PlyStrength {
    double tension_1_mpa = 0.0, compression_1_mpa = 0.0;  ///< along the fibre
    double tension_2_mpa = 0.0, compression_2_mpa = 0.0;  ///< across it
    double shear_12_mpa = 0.0;
    /// Interaction of both directions, normalised: F12 over the root of F11 F22.
    double interaction = -0.5;
};

struct Isotropic {
    double modulus_mpa = 0.0;
    double poisson = 0.0;
};

/// Transversely isotropic ply, fibre along 1.
struct WallMaterial {
    std::string name;
    double modulus_1_mpa = 0.0, modulus_2_mpa = 0.0;
    double poisson_12 = 0.0, poisson_23 = 0.0;
    double shear_12_mpa = 0.0, shear_23_mpa = 0.0;
    double density_g_per_cm3 = 0.0;
    std::optional<PlyStrength> strength;
    Isotropic matrix;
    std::optional<Isotropic> liner;
    double liner_mm = 0.0;  ///< thickness; 0 without a liner
};

/// \throws IoError io.cannot_read; InputError json.* for keys and values, material.unstable for
/// Poisson's ratios that no elastic body has
[[nodiscard]] WallMaterial read_wall_material(const std::filesystem::path& file);

}  // namespace meshwind
