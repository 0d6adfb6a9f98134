#include "postproc/tables/motion_csv.h"

#include <cassert>

#include "core/text/decimal_text.h"
#include "core/text/text_number.h"
#include "machines/kinematics.h"

namespace meshwind {
namespace {

constexpr int kTimeDecimals = 6;
constexpr int kEyeDecimals = 6;

void append_row(std::string& text, const Machine& machine, const BlockList& list, std::size_t i,
                double time_s) {
    text += std::to_string(i) + ",";
    append_fixed(text, time_s, kTimeDecimals);
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        text += ',';
        append_nano(text, list.row(i)[a], decimals_of(list.axes[a].resolution_nano));
    }
    const Eigen::Isometry3d pose = mandrel_from_eye(machine, joints_at(list, i));
    for (const Eigen::Vector3d& v : {Eigen::Vector3d(pose.translation()),
                                     Eigen::Vector3d(pose.linear() * machine.eye.roller)}) {
        for (const double coordinate : v) {
            text += ',';
            append_fixed(text, coordinate, kEyeDecimals);
        }
    }
    const Block& block = list.blocks[i];
    text += ',' + (block.piece < 0 ? std::string() : std::to_string(block.piece));
    text += ',' + (block.point < 0 ? std::string() : std::to_string(block.point)) + '\n';
}

}  // namespace

std::string motion_csv(const Machine& machine, const BlockList& list) {
    assert(list.axes.size() == machine.axis_count());
    std::string text = "block,time_s";
    for (const BlockAxis& axis : list.axes) {
        text += std::string(",") + axis.letter;
    }
    text += ",ex_mm,ey_mm,ez_mm,rx,ry,rz,course,point\n";
    double time_s = 0.0;
    for (std::size_t i = 0; i < list.blocks.size(); ++i) {
        time_s += list.blocks[i].duration_s;
        append_row(text, machine, list, i, time_s);
    }
    return text;
}

}  // namespace meshwind
