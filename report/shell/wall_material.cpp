#include "report/shell/wall_material.h"

#include <cmath>

#include "core/error.h"
#include "core/text/strict_json.h"

namespace meshwind {
namespace {

constexpr JsonRange kAboveZero{.min = 0.0, .above_min = true};
constexpr JsonRange kPoisson{.min = 0.0, .max = 0.49};
constexpr JsonRange kInteraction{.min = -1.0, .max = 1.0};

double positive(const JsonObject& object, std::string_view key) {
    return object.required(key).number(kAboveZero);
}

PlyStrength read_strength(const JsonValue& value) {
    const JsonObject of = value.object({"tension_1_MPa", "compression_1_MPa", "tension_2_MPa",
                                        "compression_2_MPa", "shear_12_MPa", "interaction"});
    PlyStrength strength{.tension_1_mpa = positive(of, "tension_1_MPa"),
                         .compression_1_mpa = positive(of, "compression_1_MPa"),
                         .tension_2_mpa = positive(of, "tension_2_MPa"),
                         .compression_2_mpa = positive(of, "compression_2_MPa"),
                         .shear_12_mpa = positive(of, "shear_12_MPa")};
    if (const auto interaction = of.optional("interaction")) {
        strength.interaction = interaction->number(kInteraction);
    }
    return strength;
}

Isotropic read_isotropic(const JsonObject& of) {
    return {positive(of, "modulus_MPa"), of.required("poisson").number(kPoisson)};
}

}  // namespace

WallMaterial read_wall_material(const std::filesystem::path& file) {
    const JsonDocument document = JsonDocument::load(file.string());
    const JsonObject of = document.root().object({"name", "source", "ply", "matrix", "liner"});
    WallMaterial material;
    material.name = of.required("name").string();
    const JsonObject ply = of.required("ply").object(
        {"modulus_1_MPa", "modulus_2_MPa", "poisson_12", "poisson_23", "shear_12_MPa",
         "shear_23_MPa", "density_g_per_cm3", "strength"});
    material.modulus_1_mpa = positive(ply, "modulus_1_MPa");
    material.modulus_2_mpa = positive(ply, "modulus_2_MPa");
    material.poisson_12 = ply.required("poisson_12").number(kPoisson);
    material.poisson_23 = ply.required("poisson_23").number({.min = 0.0, .max = 0.99});
    material.shear_12_mpa = positive(ply, "shear_12_MPa");
    material.shear_23_mpa = positive(ply, "shear_23_MPa");
    material.density_g_per_cm3 = positive(ply, "density_g_per_cm3");
    if (const auto strength = ply.optional("strength")) {
        material.strength = read_strength(*strength);
    }
    // Positive strain energy of a transversely isotropic body.
    const double nu_21 = material.poisson_12 * material.modulus_2_mpa / material.modulus_1_mpa;
    if (1.0 - material.poisson_23 - 2.0 * material.poisson_12 * nu_21 <= 0.0) {
        ply.value().fail("material.unstable",
                         "no elastic body has these moduli and Poisson's ratios; 1 - poisson_23 - "
                         "2 poisson_12^2 modulus_2 / modulus_1 has to be above 0");
    }
    material.matrix = read_isotropic(of.required("matrix").object({"modulus_MPa", "poisson"}));
    if (const auto liner = of.optional("liner")) {
        const JsonObject sheet = liner->object({"modulus_MPa", "poisson", "thickness_mm"});
        material.liner = read_isotropic(sheet);
        material.liner_mm = positive(sheet, "thickness_mm");
    }
    return material;
}

}  // namespace meshwind
