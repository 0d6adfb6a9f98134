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

// Turned by more in a block the head goes over to the band's other side.
constexpr double kTurnedOver_rad = rad_from_deg(120.0);

constexpr std::size_t kChunk = 256;

// Within a degree of a wrist's singular pose its axes turn 57 times as much as the fibre.
constexpr double kSingular_sine = 0.0175;

// Off the square to the fibre.
double lean_rad(const Vector3d& roller, const Vector3d& fibre) {
    return std::asin(std::min(1.0, std::abs(roller.dot(fibre))));
}

// From the band to the roller, about the fibre, -pi to pi.
double twist_rad(const Vector3d& roller, const EyePoint& laid) {
    const Vector3d across = roller - roller.dot(laid.tangent) * laid.tangent;
    return std::atan2(laid.binormal.cross(across).dot(laid.tangent), across.dot(laid.binormal));
}

Vector3d roller_at(const Machine& machine, std::span<const double> joints) {
    return mandrel_from_eye(machine, joints).linear() * machine.eye.roller;
}

// Between the lines of both, 0 to pi/2.
double unsigned_rad(double twist_rad) {
    return std::min(std::abs(twist_rad), kPi - std::abs(twist_rad));
}

// How the head turns against the band, block by block. \param twist_rad per sample
void measure_turning(const LaidPath& laid, const std::vector<double>& twist_rad,
                     RollerFinding& found) {
    double turned_rad = 0.0;  // within the block
    for (std::size_t i = 1; i < twist_rad.size(); ++i) {
        turned_rad += std::remainder(twist_rad[i] - twist_rad[i - 1], 2.0 * kPi);
        if (i + 1 == twist_rad.size() || laid.block[i] != laid.block[i + 1]) {
            found.turned_rad += std::abs(turned_rad);
            found.turned_over += std::abs(turned_rad) > kTurnedOver_rad ? 1U : 0U;
            turned_rad = 0.0;
        }
    }
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
    std::vector<double> lean(laid.samples.size(), 0.0);
    std::vector<double> twist(laid.samples.size(), 0.0);
    parallel_for(twist.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vector3d roller = roller_at(machine, laid.joints.row(i));
            lean[i] = lean_rad(roller, laid.samples[i].tangent);
            twist[i] = twist_rad(roller, laid.samples[i]);
        }
    });
    RollerFinding found;
    for (const std::size_t i : ends) {
        found.mean_twist_rad += unsigned_rad(twist[i]) / static_cast<double>(ends.size());
        found.worst_twist_rad = std::max(found.worst_twist_rad, unsigned_rad(twist[i]));
    }
    measure_turning(laid, twist, found);
    const auto worst = std::ranges::max_element(ends, {}, [&](std::size_t i) { return lean[i]; });
    if (worst != ends.end()) {
        found.worst_rad = lean[*worst];
        found.worst_sample = *worst;
    }
    if (!turns_head(machine) || found.worst_rad <= kRollerOff_rad) {
        return found;
    }
    const std::unique_ptr<EyeInverse> inverse = make_eye_inverse(machine);
    const double sign = spindle_sign(machine).value_or(0.0);  // other chains choose their turn
    std::vector<double> joints(machine.axis_count());
    for (const std::size_t i : ends) {
        if (lean[i] <= kRollerOff_rad) {
            continue;
        }
        check_interrupt();
        const EyePoint& sample = laid.samples[i];
        const std::span<const double> is = laid.joints.row(i);
        const WristState state = inverse->solve(
            {.eye_mm = sample.eye_mm, .tangent = sample.tangent, .binormal = sample.binormal},
            sign * is.front(), is, joints);
        const double forced = lean_rad(roller_at(machine, joints), sample.tangent);
        if (state.singular_sine > kSingular_sine && lean[i] > forced + kRollerOff_rad) {
            found.wrong_sample = i;
            found.wrong_rad = lean[i];
            found.forced_rad = forced;
            break;
        }
    }
    return found;
}

}  // namespace meshwind
