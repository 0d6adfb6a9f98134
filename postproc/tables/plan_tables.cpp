#include "postproc/tables/plan_tables.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/text/csv_table.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "machines/kinematics.h"

namespace meshwind {
namespace {

// Bridges under this height are rounding of the table's fourth decimal.
constexpr double kLifted_mm = 5e-5;

constexpr CsvErrors kErrors{.column = "plan.column",
                            .number = "plan.number",
                            .column_mend = "name the folder that the main job wrote"};

// Words when two values differ by more than `slack`.
std::optional<std::string> differing(const std::string& name, double is, double planned,
                                     double slack, const char* unit, int decimals) {
    if (std::abs(is - planned) <= slack) {
        return std::nullopt;
    }
    return name + " is " + fixed(is, decimals) + unit + ", planned " + fixed(planned, decimals) +
           unit;
}

std::optional<std::string> block_difference(const Machine& machine, const BlockList& list,
                                            std::size_t block, const PlannedMotion& planned,
                                            double duration_s) {
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        const double step =
            static_cast<double>(list.axes[a].resolution_nano) / static_cast<double>(kNanoPerUnit);
        const bool rotary = list.axes[a].type == AxisType::Rotary;
        if (auto words = differing(std::string(1, list.axes[a].letter), list.value(block, a),
                                   planned.value[a], 0.5 * step, rotary ? " deg" : " mm",
                                   decimals_of(list.axes[a].resolution_nano))) {
            return words;
        }
    }
    const Eigen::Isometry3d pose = mandrel_from_eye(machine, joints_at(list, block));
    const double off_mm = (pose.translation() - planned.eye_mm).norm();
    const double turned = (pose.linear() * machine.eye.roller - planned.roller).norm();
    if (off_mm > kSameEye_mm || turned > kSameRoller) {
        return "the eye is " + fixed(off_mm, 4) + " mm and its roller " +
               fixed(deg_from_rad(2.0 * std::asin(std::min(0.5 * turned, 1.0))), 3) +
               " deg from where the same axes were planned; is it the machine of the plan?";
    }
    return differing("its duration", list.blocks[block].duration_s, duration_s,
                     kSameTime_s + kSameTimeShare * duration_s, " s", 6);
}

// Words where a rapid move takes an axis elsewhere than to the start. Starts of many digits are
// taken in whole units first.
std::string approach_difference(const BlockList& list, const PlannedMotion& start) {
    constexpr double kWholeUnit = 1.0;
    if (!list.head) {
        return "";
    }
    for (const RapidMove& move : list.head->approach) {
        for (std::size_t a = 0; a < list.axes.size(); ++a) {
            const double is = static_cast<double>(move.nano[a]) / static_cast<double>(kNanoPerUnit);
            if (move.named[a] && move.known[a] && std::abs(is - start.value[a]) >= kWholeUnit) {
                const std::string unit = list.axes[a].type == AxisType::Rotary ? " deg" : " mm";
                std::string words = "the rapid move of line " + std::to_string(move.line);
                words +=
                    std::string(" takes ") + list.axes[a].letter + " to " + fixed(is, 3) + unit;
                words += ", planned is " + fixed(start.value[a], 3) + unit;
                return words;
            }
        }
    }
    return "";
}

}  // namespace

PlannedFibre read_path_csv(std::string_view text, const std::string& file) {
    CsvTable table(text, file, kErrors);
    const std::size_t course = table.column("course");
    const std::size_t point = table.column("point");
    const std::size_t bridge = table.column("bridge_mm");
    const std::optional<std::size_t> held = table.find("held");
    const std::array position = {table.column("x_mm"), table.column("y_mm"), table.column("z_mm")};
    const std::array normal = {table.column("nx"), table.column("ny"), table.column("nz")};
    const std::array tangent = {table.column("tx"), table.column("ty"), table.column("tz")};
    PlannedFibre fibre;
    while (table.next()) {
        fibre.push_back({table.whole_number(course), table.whole_number(point),
                         table.vector(position), table.vector(normal), table.vector(tangent),
                         table.number(bridge) > kLifted_mm,
                         held && table.whole_number(*held) != 0});
    }
    if (fibre.size() < 2) {
        table.fail("plan.empty", "has no landing points; name the folder that the main job wrote");
    }
    return fibre;
}

std::vector<PlannedMotion> read_motion_csv(std::string_view text, const std::string& file,
                                           const Machine& machine) {
    CsvTable table(text, file, kErrors);
    const std::size_t time = table.column("time_s");
    const std::array eye = {table.column("ex_mm"), table.column("ey_mm"), table.column("ez_mm")};
    const std::array roller = {table.column("rx"), table.column("ry"), table.column("rz")};
    std::vector<std::size_t> letter;
    for (std::size_t a = 0; a < machine.axis_count(); ++a) {
        letter.push_back(table.column(std::string(1, machine.axis(a).letter)));
    }
    std::vector<PlannedMotion> motion;
    while (table.next()) {
        PlannedMotion row{table.number(time), {}, table.vector(eye), table.vector(roller)};
        for (const std::size_t column : letter) {
            row.value.push_back(table.number(column));
        }
        motion.push_back(std::move(row));
    }
    return motion;
}

MotionDifference first_difference(const Machine& machine, const BlockList& list,
                                  const std::vector<PlannedMotion>& planned) {
    const std::size_t both = std::min(list.blocks.size(), planned.size());
    if (!planned.empty()) {
        if (const std::string words = approach_difference(list, planned.front()); !words.empty()) {
            return {0, words};
        }
    }
    for (std::size_t b = 0; b < both; ++b) {
        const double duration_s = b == 0 ? 0.0 : planned[b].time_s - planned[b - 1].time_s;
        if (auto words = block_difference(machine, list, b, planned[b], duration_s)) {
            return {b, *words};
        }
    }
    if (list.blocks.size() != planned.size()) {
        return {both,
                "the program has " + std::to_string(list.moves()) + " blocks, planned " +
                    std::to_string(planned.size() - std::min<std::size_t>(planned.size(), 1))};
    }
    return {};
}

}  // namespace meshwind
