// The L-shaped frame of petru_2016_frames in closed form: 550 mm along z, a quarter arc of 140 mm
// in xz, 360 mm along x. The reference is y, turned backward by half a turn over the arc.
#pragma once

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "postproc/ringhead/frame_axis.h"
#include "postproc/ringhead/ring_head.h"

namespace meshwind::test {

inline constexpr double kArm_mm = 550.0;
inline constexpr double kBendEnd_mm = 690.0;
inline constexpr double kFrame_mm = 1050.0;
inline constexpr double kBendRadius_mm = 140.0 / (0.5 * kPi);

inline double l_frame_turn(double s_mm) {
    return kPi * std::clamp((s_mm - kArm_mm) / (kBendEnd_mm - kArm_mm), 0.0, 1.0);
}

inline AxisFrame l_frame_at(double s_mm) {
    const double angle = std::clamp(s_mm - kArm_mm, 0.0, kBendEnd_mm - kArm_mm) / kBendRadius_mm;
    AxisFrame frame;
    frame.tangent = {std::sin(angle), 0.0, std::cos(angle)};
    frame.point_mm = {kBendRadius_mm * (1.0 - std::cos(angle)) + std::max(s_mm - kBendEnd_mm, 0.0),
                      0.0, std::min(s_mm, kArm_mm) + kBendRadius_mm * std::sin(angle)};
    frame.reference =
        Eigen::AngleAxisd(-l_frame_turn(s_mm), frame.tangent) * Eigen::Vector3d::UnitY();
    return frame;
}

// Stations every `step_mm` with the exact tangents.
inline FrameAxis l_frame(double step_mm) {
    std::vector<AxisStation> stations;
    for (int i = 0; i * step_mm < kFrame_mm + 0.5 * step_mm; ++i) {
        const double s = i * step_mm;
        const AxisFrame exact = l_frame_at(s);
        stations.push_back(
            {exact.point_mm, exact.tangent, Eigen::Vector3d::UnitY(), l_frame_turn(s)});
    }
    return FrameAxis(std::move(stations));
}

inline nlohmann::json l_frame_reference() {
    std::ifstream in(std::string(MESHWIND_SOURCE_DIR) + "/data/reference/seed002.json");
    return nlohmann::json::parse(in);
}

inline Eigen::Vector3d vector_of(const nlohmann::json& list) {
    return {list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>()};
}

inline RingHead l_frame_head() {
    const nlohmann::json head = l_frame_reference()["head"];
    return {vector_of(head["centre_mm"]), vector_of(head["direction"]),
            vector_of(head["reference"]), head["ring_distance_mm"].get<double>(),
            head["ring_radius_mm"].get<double>()};
}

}  // namespace meshwind::test
