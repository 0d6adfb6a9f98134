#include "postproc/tables/path_csv.h"

#include <algorithm>

#include "core/interrupt.h"
#include "core/text/text_number.h"

namespace meshwind {
namespace {

constexpr int kLengthDecimals = 4;     // 0.1 um
constexpr int kDirectionDecimals = 7;  // 0.1 urad
constexpr int kCurvatureDecimals = 8;  // a radius of 100 m is seen
constexpr int kRatioDecimals = 5;

// Handed on at once.
constexpr std::size_t kWritten_bytes = std::size_t{4} << 20;

void append_vector(std::string& text, const Eigen::Vector3d& v, int decimals) {
    for (const double x : v) {
        text += ',';
        append_fixed(text, x, decimals);
    }
}

void append_cell(std::string& text, double value, int decimals) {
    text += ',';
    append_fixed(text, value, decimals);
}

}  // namespace

std::string path_csv(std::span<const Piece> pieces, const EyePath& path) {
    std::string text;
    write_path_csv(pieces, path, [&text](std::string_view more) { text += more; });
    return text;
}

void write_path_csv(std::span<const Piece> pieces, const EyePath& path,
                    const std::function<void(std::string_view)>& write) {
    const bool on_pins =
        std::any_of(path.begin(), path.end(), [](const EyePoint& eye) { return eye.on_pins; });
    std::string text =
        "course,kind,point,s_mm,x_mm,y_mm,z_mm,nx,ny,nz,tx,ty,tz,kn_per_mm,kg_per_mm,slip,"
        "bridge_mm,free_length_mm";
    text += on_pins ? ",held\n" : "\n";
    for (const EyePoint& eye : path) {
        check_interrupt();
        const Piece& piece = pieces[static_cast<std::size_t>(eye.piece)];
        const auto i = static_cast<std::size_t>(eye.point);
        const PathPoint& station = piece.path[i];
        text += std::to_string(eye.piece);
        text += piece.kind == PieceKind::Course ? ",course," : ",transition,";
        text += std::to_string(eye.point);
        append_cell(text, eye.s_mm, kLengthDecimals);
        append_vector(text, station.position_mm, kLengthDecimals);
        append_vector(text, station.normal, kDirectionDecimals);
        append_vector(text, station.tangent, kDirectionDecimals);
        append_cell(text, station.kn_per_mm, kCurvatureDecimals);
        append_cell(text, station.kg_per_mm, kCurvatureDecimals);
        append_cell(text, piece.slip[i], kRatioDecimals);
        append_cell(text, piece.string.gap_mm[i], kLengthDecimals);
        append_cell(text, eye.free_length_mm, kLengthDecimals);
        if (on_pins) {
            text += eye.held ? ",1" : ",0";
        }
        text += '\n';
        if (text.size() > kWritten_bytes) {
            write(text);
            text.clear();
        }
    }
    write(text);
}

}  // namespace meshwind
