#include "postproc/verify/roller_check.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/interrupt.h"
#include "core/parallel.h"
#include "machines/eye_inverse.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kChunk = 256;

// Within a degree of a wrist's singular pose its axes turn 57 times as much as the fibre.
constexpr double kSingular_sine = 0.0175;

double lean_rad(const Machine& machine, std::span<const double> joints, const Vector3d& fibre) {
    const Vector3d roller = mandrel_from_eye(machine, joints).linear() * machine.eye.roller;
    return std::asin(std::min(1.0, std::abs(roller.dot(fibre))));
}

// Between roller and band, seen along the fibre.
double twist_rad(const Machine& machine, std::span<const double> joints, const EyePoint& laid) {
    const Vector3d roller = mandrel_from_eye(machine, joints).linear() * machine.eye.roller;
    const Vector3d across = roller - roller.dot(laid.tangent) * laid.tangent;
    return std::atan2(across.cross(laid.binormal).norm(), std::abs(across.dot(laid.binormal)));
}

bool turns_head(const Machine& machine) {
    return std::any_of(machine.eye_chain.begin(), machine.eye_chain.end(),
                       [&](const Axis& axis) { return axis.type == AxisType::Rotary; });
}

}  // namespace

RollerFinding find_roller(const Machine& machine, const LaidPath& laid) {
    std::vector<std::size_t> ends;  // of blocks
    for (std::size_t i = 0; i < laid.samples.size(); ++i) {
        if (i + 1 == laid.samples.size() || laid.block[i] != laid.block[i + 1]) {
            ends.push_back(i);
        }
    }
    std::vector<double> lean(ends.size(), 0.0);
    std::vector<double> twist(ends.size(), 0.0);
    parallel_for(lean.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            lean[k] = lean_rad(machine, laid.joints.row(ends[k]), laid.samples[ends[k]].tangent);
            twist[k] = twist_rad(machine, laid.joints.row(ends[k]), laid.samples[ends[k]]);
        }
    });
    RollerFinding found;
    for (const double at_end : twist) {
        found.mean_twist_rad += at_end / static_cast<double>(twist.size());
        found.worst_twist_rad = std::max(found.worst_twist_rad, at_end);
    }
    const auto worst = std::max_element(lean.begin(), lean.end());
    if (worst != lean.end()) {
        found.worst_rad = *worst;
        found.worst_sample = ends[static_cast<std::size_t>(worst - lean.begin())];
    }
    if (!turns_head(machine) || found.worst_rad <= kRollerOff_rad) {
        return found;
    }
    const std::unique_ptr<EyeInverse> inverse = make_eye_inverse(machine);
    const double sign = spindle_sign(machine).value_or(0.0);  // other chains choose their turn
    std::vector<double> joints(machine.axis_count());
    for (std::size_t k = 0; k < lean.size() && !found.wrong_sample; ++k) {
        if (lean[k] <= kRollerOff_rad) {
            continue;
        }
        check_interrupt();
        const EyePoint& sample = laid.samples[ends[k]];
        const std::span<const double> is = laid.joints.row(ends[k]);
        const WristState state = inverse->solve(
            {.eye_mm = sample.eye_mm, .tangent = sample.tangent, .binormal = sample.binormal},
            sign * is.front(), is, joints);
        const double forced = lean_rad(machine, joints, sample.tangent);
        if (state.singular_sine > kSingular_sine && lean[k] > forced + kRollerOff_rad) {
            found.wrong_sample = ends[k];
            found.wrong_rad = lean[k];
            found.forced_rad = forced;
        }
    }
    return found;
}

}  // namespace meshwind
