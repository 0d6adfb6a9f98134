#include "pipeline/part_words.h"

#include <array>
#include <utility>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/text/text_number.h"
#include "mesh/even/blend.h"
#include "mesh/mandrel/round_rims.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

std::string unit_name(const Mandrel& mandrel) {
    const std::array<std::pair<double, const char*>, 5> names = {
        {{1e-3, "um"}, {1.0, "mm"}, {10.0, "cm"}, {1000.0, "m"}, {25.4, "in"}}};
    for (const auto& [mm, name] : names) {
        if (mandrel.unit_mm == mm) {
            return name;
        }
    }
    std::string text;
    append_shortest(text, mandrel.unit_mm);
    return text + " mm";
}

}  // namespace

std::string size_words(const Mandrel& mandrel) {
    const Eigen::Matrix3d file_from_mandrel =
        (mandrel.file_to_mandrel.linear() / mandrel.unit_mm).transpose();
    Eigen::AlignedBox3d box;
    for (const Vector3d& point : mandrel.whole.points_mm) {
        box.extend(file_from_mandrel * point);
    }
    const Vector3d size = box.sizes();
    const std::string rule = mandrel.unit_rule == "file" ? "stated by the file" : mandrel.unit_rule;
    return fixed(size.x(), 1) + " x " + fixed(size.y(), 1) + " x " + fixed(size.z(), 1) +
           " mm (unit " + unit_name(mandrel) + ", " + rule + ")";
}

std::string pieces_words(const std::vector<WallPiece>& pieces) {
    const auto words = [](const WallPiece& piece) {
        const Eigen::Vector3d& p = piece.middle_mm;
        return fixed(piece.area_mm2 / 100.0, 1) + " cm2 around (" + fixed(p.x(), 1) + ", " +
               fixed(p.y(), 1) + ", " + fixed(p.z(), 1) + ")";
    };
    std::string regions;
    for (const std::int32_t id : pieces.front().regions) {
        regions += (regions.empty() ? "" : ", ") + std::to_string(id);
    }
    return "its wall is in " + std::to_string(pieces.size()) +
           " pieces that do not touch: the largest has " + words(pieces[0]) + ", the next " +
           words(pieces[1]) +
           "; unite them in the modeller, or name the regions of one in the job, "
           "\"mandrel\": {\"keep_regions\": [" +
           regions + "]}";
}

void require_sound_wall(const Mandrel& mandrel, bool turns_on_extensions) {
    if (mandrel.pieces.size() > 1) {
        throw InputError("mesh.pieces", mandrel.file, pieces_words(mandrel.pieces));
    }
    if (turns_on_extensions && !mandrel.angular_ends.empty()) {
        throw InputError("mesh.end_not_round", mandrel.file, angular_end_words(mandrel));
    }
    const Rim* worst = worst_off_circle(mandrel);
    if (turns_on_extensions && worst != nullptr) {
        throw InputError("mesh.rim_not_round", mandrel.file, off_circle_words(mandrel, *worst));
    }
}

std::string sharp_words(const Mandrel& mandrel, double sharp_mm2, double tow_width_mm) {
    constexpr double kWorthAWord = 0.002;  // of the wall's area
    const double all_mm2 = area_mm2({mandrel.surface.position_mm, mandrel.surface.face});
    if (!(sharp_mm2 > kWorthAWord * all_mm2)) {
        return "";
    }
    return "a ball as wide as the tow, " + fixed(tow_width_mm, 1) + " mm, cannot touch " +
           percent(sharp_mm2 / all_mm2, 1) +
           " of the wall, in crotches and at steps; --set mandrel.blend=" + fixed(tow_width_mm, 1) +
           " would fill them up";
}

void propose_blend(const Mandrel& mandrel, double tow_width_mm, std::vector<std::string>& remarks) {
    if (mandrel.winding_mesh.blend_mm > 0.0) {
        return;
    }
    const double sharp_mm2 = out_of_reach_mm2(mandrel.surface, tow_width_mm);
    const std::string words = sharp_words(mandrel, sharp_mm2, tow_width_mm);
    if (!words.empty()) {
        remarks.push_back(words);
    }
}

std::string unit_question(const Mandrel& mandrel) {
    if (mandrel.unit_rule == "given") {
        return "; the part measures " + size_words(mandrel);
    }
    return "; is the unit right? The part measures " + size_words(mandrel) +
           "; --units mm, cm, m or in says another";
}

}  // namespace meshwind
