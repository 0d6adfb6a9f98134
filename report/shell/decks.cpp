#include "report/shell/decks.h"

#include <charconv>

#include "core/version.h"
#include "report/shell/deck_text.h"

namespace meshwind {

const std::vector<DeckFormat>& deck_formats() {
    static const std::vector<DeckFormat> kFormats = {
        {"calculix", ".inp", ElementOrder::Quadratic, calculix_deck},
        {"abaqus", ".inp", ElementOrder::Linear, abaqus_deck},
        {"nastran", ".bdf", ElementOrder::Linear, nastran_deck}};
    return kFormats;
}

std::string ply_name(std::size_t element, std::size_t ply) {
    return "O" + std::to_string(element) + "_" + std::to_string(ply);
}

ShellSheet sheet_under(const ShellModel& model, const ShellTriangle& triangle) {
    if (model.material->liner) {
        return {true, model.material->liner_mm};
    }
    return {false, triangle.plies.empty() ? model.mesh->tow_thickness_mm : 0.0};
}

std::string deck_title(const ShellModel& model) {
    return std::string("meshwind ") + kVersion + ": " + model.material->name + ", " +
           std::to_string(model.mesh->triangle.size()) + " shells of up to " +
           std::to_string(model.mesh->most_plies()) + " plies; N, mm, MPa, t";
}

void append_value(std::string& text, double value) {
    // Fields of CalculiX are 20 columns wide: a sign, a point and "e-15" beside the digits.
    constexpr int kDigits = 13;
    std::array<char, 32> digits{};
    const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                       std::chars_format::general, kDigits);
    text.append(digits.data(), written.ptr);
}

void append_values(std::string& text, std::span<const double> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        text += i > 0 ? "," : "";
        append_value(text, values[i]);
    }
}

void append_keyword_mesh(std::string& text, const ShellModel& model, const char* type,
                         std::size_t nodes) {
    text += "*NODE, NSET=NALL\n";
    for (std::size_t i = 0; i < model.node_mm.size(); ++i) {
        text += std::to_string(i + 1) + ",";
        append_values(text, {model.node_mm[i].data(), 3});
        text += '\n';
    }
    text += std::string("*ELEMENT, TYPE=") + type + ", ELSET=EALL\n";
    for (std::size_t f = 0; f < model.element.size(); ++f) {
        text += std::to_string(f + 1);
        for (std::size_t k = 0; k < nodes; ++k) {
            text += "," + std::to_string(model.element[f][k] + 1);
        }
        text += '\n';
    }
}

void append_keyword_isotropic(std::string& text, const char* name, const Isotropic& material) {
    text += std::string("*MATERIAL, NAME=") + name + "\n*ELASTIC\n";
    append_values(text, std::array{material.modulus_mpa, material.poisson});
    text += '\n';
}

void append_keyword_loads(std::string& text, const ShellModel& model) {
    if (!model.force.empty()) {
        text += "*CLOAD\n";
        for (const NodalForce& one : model.force) {
            for (int axis = 0; axis < 3; ++axis) {
                text += std::to_string(one.node + 1) + "," + std::to_string(axis + 1) + ",";
                append_value(text, one.force_n[axis]);
                text += '\n';
            }
        }
    }
    if (model.pressure_mpa != 0.0) {
        text += "*DLOAD\nEALL,P,";
        append_value(text, model.pressure_mpa);
        text += '\n';
    }
}

void append_keyword_supports(std::string& text, const ShellModel& model) {
    text += "*BOUNDARY\n";
    for (const Support& one : model.support) {
        const std::string axis = "," + std::to_string(one.axis + 1);
        text += std::to_string(one.node + 1);
        text += axis;
        text += axis;
        text += '\n';
    }
}

}  // namespace meshwind
