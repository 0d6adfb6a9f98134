#include <algorithm>
#include <cmath>
#include <cstdio>
#include <variant>

#include <Eigen/Geometry>

#include "core/units.h"
#include "report/shell/deck_text.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Numbers of materials.
constexpr int kPly = 1;
constexpr int kMatrix = 2;
constexpr int kLiner = 3;

constexpr std::size_t kColumns = 16;  // of a field in large field format
constexpr std::size_t kFields = 4;    // of a line, beside its name

using Field = std::variant<std::monostate, long long, double, const char*>;

// A real with its point, as exact as the columns let it be.
std::string real(double value) {
    std::array<char, 32> text{};
    for (int digits = kColumns; digits > 0; --digits) {
        const int length = std::snprintf(text.data(), text.size(), "%.*G", digits, value);
        std::string told(text.data(), static_cast<std::size_t>(length));
        if (told.find('.') == std::string::npos) {
            told.insert(std::min(told.find('E'), told.size()), ".");
        }
        if (told.size() <= kColumns) {
            return told;
        }
    }
    return "0.";
}

std::string text_of(const Field& field) {
    if (const auto* number = std::get_if<long long>(&field)) {
        return std::to_string(*number);
    }
    if (const auto* value = std::get_if<double>(&field)) {
        return real(*value);
    }
    const auto* const* word = std::get_if<const char*>(&field);
    return word == nullptr ? "" : *word;
}

// In large field format, with as many continuations as it needs.
void append_card(std::string& text, const char* name, const std::vector<Field>& fields) {
    std::string line = std::string(name) + "*";
    for (std::size_t i = 0; i < fields.size(); ++i) {
        line.resize(8 + kColumns * (i % kFields), ' ');
        line += text_of(fields[i]);
        if (i + 1 == fields.size() || i % kFields == kFields - 1) {
            text += line + "\n";
            line = "*";
        }
    }
}

long long numbered(std::int32_t node) {
    return node + 1LL;
}

// From the side between the first two grid points to axis 1.
double axis_rad(const ShellModel& model, std::size_t f) {
    const ShellTriangle& triangle = model.mesh->triangle[f];
    const Vector3d side = model.node_mm[static_cast<std::size_t>(triangle.point[1])] -
                          model.node_mm[static_cast<std::size_t>(triangle.point[0])];
    return std::atan2(-side.dot(triangle.axis_2), side.dot(triangle.axis_1));
}

void append_isotropic(std::string& text, int number, const Isotropic& material) {
    append_card(text, "MAT1",
                {static_cast<long long>(number), material.modulus_mpa, {}, material.poisson});
}

void append_materials(std::string& text, const WallMaterial& m) {
    std::vector<Field> ply = {static_cast<long long>(kPly),
                              m.modulus_1_mpa,
                              m.modulus_2_mpa,
                              m.poisson_12,
                              m.shear_12_mpa,
                              m.shear_12_mpa,
                              m.shear_23_mpa,
                              m.density_g_per_cm3 * kTonnes_per_mm3};
    if (m.strength) {
        const PlyStrength& s = *m.strength;
        // Thermal expansion and its reference are left to the program.
        ply.insert(ply.end(), {{},
                               {},
                               {},
                               s.tension_1_mpa,
                               s.compression_1_mpa,
                               s.tension_2_mpa,
                               s.compression_2_mpa,
                               s.shear_12_mpa,
                               {},
                               s.interaction / std::sqrt(s.tension_1_mpa * s.compression_1_mpa *
                                                         s.tension_2_mpa * s.compression_2_mpa)});
    }
    append_card(text, "MAT8", ply);
    append_isotropic(text, kMatrix, m.matrix);
    if (m.liner) {
        append_isotropic(text, kLiner, *m.liner);
    }
}

// With the failure theory of Tsai and Wu where strengths are known.
void append_section(std::string& text, const ShellModel& model, std::size_t f) {
    const ShellTriangle& triangle = model.mesh->triangle[f];
    const auto number = static_cast<long long>(f + 1);
    const auto& strength = model.material->strength;
    // The bonding's strength stands for delamination, which is not looked at.
    std::vector<Field> section = {number,
                                  0.0,
                                  {},
                                  strength ? Field(strength->shear_12_mpa) : Field(),
                                  strength ? Field("TSAI") : Field(),
                                  {},
                                  {},
                                  {}};
    const auto ply = [&](int material, double thickness_mm, double angle_deg) {
        section.insert(section.end(),
                       {static_cast<long long>(material), thickness_mm, angle_deg, Field("YES")});
    };
    if (const ShellSheet sheet = sheet_under(model, triangle); sheet.thickness_mm > 0.0) {
        ply(sheet.liner ? kLiner : kMatrix, sheet.thickness_mm, 0.0);
    }
    for (const ShellPly& one : triangle.plies) {
        ply(kPly, one.thickness_mm, deg_from_rad(one.angle_rad));
    }
    append_card(text, "PCOMP", section);
    const auto& node = model.element[f];
    append_card(text, "CTRIA3",
                {number, number, numbered(node[0]), numbered(node[1]), numbered(node[2]),
                 deg_from_rad(axis_rad(model, f))});
}

}  // namespace

std::string nastran_deck(const ShellModel& model) {
    std::string text = "$ " + deck_title(model) +
                       "\nSOL 101\nCEND\nSPC = 1\nLOAD = 1\nDISPLACEMENT = ALL\nSTRESS = ALL\n"
                       "BEGIN BULK\nPARAM,POST,-1\nPARAM,K6ROT,100.\n";
    for (std::size_t i = 0; i < model.node_mm.size(); ++i) {
        const Vector3d& p = model.node_mm[i];
        append_card(text, "GRID", {static_cast<long long>(i + 1), {}, p.x(), p.y(), p.z()});
    }
    append_materials(text, *model.material);
    for (std::size_t f = 0; f < model.element.size(); ++f) {
        append_section(text, model, f);
    }
    for (const NodalForce& one : model.force) {
        append_card(
            text, "FORCE",
            {1LL, numbered(one.node), 0LL, 1.0, one.force_n.x(), one.force_n.y(), one.force_n.z()});
    }
    for (std::size_t f = 0; model.pressure_mpa != 0.0 && f < model.element.size(); ++f) {
        append_card(text, "PLOAD2", {1LL, model.pressure_mpa, static_cast<long long>(f + 1)});
    }
    for (const Support& one : model.support) {
        append_card(text, "SPC1", {1LL, static_cast<long long>(one.axis + 1), numbered(one.node)});
    }
    text += "ENDDATA\n";
    return text;
}

}  // namespace meshwind
