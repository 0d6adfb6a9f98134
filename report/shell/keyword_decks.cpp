#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/units.h"
#include "report/shell/deck_text.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Of a film that only makes plies equal in number: as little as the program takes.
constexpr double kFilm_mm = 5e-4;

void append_ply_material(std::string& text, const WallMaterial& m) {
    text += "*MATERIAL, NAME=UD\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n";
    append_values(text, std::array{m.modulus_1_mpa, m.modulus_2_mpa, m.modulus_2_mpa, m.poisson_12,
                                   m.poisson_12, m.poisson_23, m.shear_12_mpa, m.shear_12_mpa});
    text += '\n';
    append_value(text, m.shear_23_mpa);
    text += "\n*DENSITY\n";
    append_value(text, m.density_g_per_cm3 * kTonnes_per_mm3);
    text += '\n';
}

void append_materials(std::string& text, const WallMaterial& material) {
    append_ply_material(text, material);
    append_keyword_isotropic(text, "MATRIX", material.matrix);
    if (material.liner) {
        append_keyword_isotropic(text, "LINER", *material.liner);
    }
}

// Axes 1 and 2 turned towards each other by the ply's angle.
void append_axes(std::string& text, const ShellTriangle& triangle, double angle_rad) {
    const Vector3d along =
        std::cos(angle_rad) * triangle.axis_1 + std::sin(angle_rad) * triangle.axis_2;
    const Vector3d across =
        std::cos(angle_rad) * triangle.axis_2 - std::sin(angle_rad) * triangle.axis_1;
    append_values(text,
                  std::array{along.x(), along.y(), along.z(), across.x(), across.y(), across.z()});
    text += '\n';
}

// A ply without fibre.
void append_sheet(std::string& text, double thickness_mm, const char* material) {
    append_value(text, thickness_mm);
    text += std::string(",,") + material + "\n";
}

// An element as a set of its own, and the first line of its section. The wall lies on the mandrel:
// its lower side is where the nodes are.
void open_section(std::string& text, std::size_t f, const char* more) {
    const std::string number = std::to_string(f + 1);
    const std::string set = "ELSET=E" + number;
    for (const char* const part : {"*ELSET, ", set.c_str(), "\n", number.c_str(),
                                   "\n*SHELL SECTION, ", set.c_str(), ", COMPOSITE", more, "\n"}) {
        text += part;
    }
}

void append_calculix_section(std::string& text, const ShellModel& model, std::size_t f,
                             std::size_t rows) {
    const ShellTriangle& triangle = model.mesh->triangle[f];
    for (std::size_t k = 0; k < triangle.plies.size(); ++k) {
        text += "*ORIENTATION, NAME=" + ply_name(f + 1, k + 1) + "\n";
        append_axes(text, triangle, triangle.plies[k].angle_rad);
    }
    open_section(text, f, ", OFFSET=-0.5");
    std::size_t written = triangle.plies.size();
    if (const ShellSheet sheet = sheet_under(model, triangle); sheet.thickness_mm > 0.0) {
        append_sheet(text, sheet.thickness_mm, sheet.liner ? "LINER" : "MATRIX");
        ++written;
    }
    for (std::size_t k = 0; k < triangle.plies.size(); ++k) {
        append_value(text, triangle.plies[k].thickness_mm);
        text += ",,UD," + ply_name(f + 1, k + 1) + "\n";
    }
    for (; written < rows; ++written) {
        append_sheet(text, kFilm_mm, "MATRIX");
    }
}

}  // namespace

std::string calculix_deck(const ShellModel& model) {
    std::string text = "** " + deck_title(model) + "\n";
    append_keyword_mesh(text, model, "S6", 6);
    append_materials(text, *model.material);
    std::size_t rows = 0;
    for (const ShellTriangle& triangle : model.mesh->triangle) {
        const bool sheet = sheet_under(model, triangle).thickness_mm > 0.0;
        rows = std::max(rows, triangle.plies.size() + (sheet ? 1 : 0));
    }
    for (std::size_t f = 0; f < model.element.size(); ++f) {
        append_calculix_section(text, model, f, rows);
    }
    append_keyword_supports(text, model);
    text += "*STEP\n*STATIC\n";
    append_keyword_loads(text, model);
    text += "*EL PRINT, ELSET=EALL, GLOBAL=NO\nS\n*END STEP\n";
    return text;
}

std::string abaqus_deck(const ShellModel& model) {
    std::string text = "** " + deck_title(model) + "\n";
    append_keyword_mesh(text, model, "S3", 3);
    append_materials(text, *model.material);
    text +=
        "*DISTRIBUTION TABLE, NAME=AXES_TABLE\nCOORD3D, COORD3D\n"
        "*DISTRIBUTION, NAME=AXES, LOCATION=ELEMENT, TABLE=AXES_TABLE\n,1,0,0,0,1,0\n";
    for (std::size_t f = 0; f < model.element.size(); ++f) {
        text += std::to_string(f + 1) + ",";
        append_axes(text, model.mesh->triangle[f], 0.0);
    }
    text += "*ORIENTATION, NAME=WALL, DEFINITION=COORDINATES\nAXES\n3, 0.\n";
    for (std::size_t f = 0; f < model.element.size(); ++f) {
        const ShellTriangle& triangle = model.mesh->triangle[f];
        open_section(text, f, ", ORIENTATION=WALL, OFFSET=SNEG");
        if (const ShellSheet sheet = sheet_under(model, triangle); sheet.thickness_mm > 0.0) {
            append_value(text, sheet.thickness_mm);
            text += std::string(", 3, ") + (sheet.liner ? "LINER" : "MATRIX") + ", 0\n";
        }
        for (const ShellPly& ply : triangle.plies) {
            append_value(text, ply.thickness_mm);
            text += ", 3, UD, ";
            append_value(text, deg_from_rad(ply.angle_rad));
            text += '\n';
        }
    }
    append_keyword_supports(text, model);
    text += "*STEP, NAME=LOAD\n*STATIC\n";
    append_keyword_loads(text, model);
    text += "*OUTPUT, FIELD\n*NODE OUTPUT\nU\n*ELEMENT OUTPUT, DIRECTIONS=YES\nS\n*END STEP\n";
    return text;
}

}  // namespace meshwind
