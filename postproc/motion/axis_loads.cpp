#include "postproc/motion/axis_loads.h"

#include <cassert>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "machines/kinematics.h"

namespace meshwind {
namespace {

// Follows the axes from step to step.
class LoadMeter {
public:
    LoadMeter(const Machine& machine, const JointPath& joints)
        : machine_(machine),
          joints_(joints),
          speed_(joints.axis_count, 0.0),
          before_ramp_s_(joints.axis_count, 0.0) {}

    // From step `last_` into `step`; a step 0 is rest.
    void enter(std::size_t step, double duration_s) {
        Eigen::VectorXd cut = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(speed_.size()));
        double linear_mm2 = 0.0;
        for (std::size_t a = 0; a < joints_.axis_count; ++a) {
            const Axis& axis = machine_.axis(a);
            const double speed =
                step == 0 ? 0.0 : (joints_.row(step)[a] - joints_.row(step - 1)[a]) / duration_s;
            const double change = speed - speed_[a];
            const double ramp = ramp_s(axis, change);
            if (last_ != 0) {
                const double used = 0.5 * (before_ramp_s_[a] + ramp) / last_s_;
                raise(loads_.acceleration, used, last_, a);
            }
            raise(loads_.velocity, std::abs(speed) / axis.velocity, step, a);
            const double off = change * ramp / 8.0;
            cut[static_cast<Eigen::Index>(a)] = off;
            linear_mm2 += axis.type == AxisType::Linear ? off * off : 0.0;
            speed_[a] = speed;
            before_ramp_s_[a] = ramp;
        }
        if (step != 0 && last_ != 0) {
            raise(loads_.linear, std::sqrt(linear_mm2));
            raise(loads_.eye, (eye_moves(machine_, joints_.row(last_)) * cut).norm());
        }
        last_ = step;
        last_s_ = duration_s;
    }

    [[nodiscard]] const AxisLoads& loads() const { return loads_; }

private:
    static void raise(AxisLoad& load, double ratio, std::size_t step, std::size_t joint) {
        if (ratio > load.ratio) {
            load = {ratio, step, joint};
        }
    }

    void raise(CornerCut& cut, double mm) const {
        if (mm > cut.mm) {
            cut = {mm, last_};
        }
    }

    const Machine& machine_;
    const JointPath& joints_;
    std::vector<double> speed_;
    std::vector<double> before_ramp_s_;
    std::size_t last_ = 0;
    double last_s_ = 0.0;
    AxisLoads loads_;
};

}  // namespace

double ramp_s(const Axis& axis, double change) {
    const double v = std::abs(change);
    if (std::isinf(axis.jerk)) {
        return v / axis.acceleration;
    }
    const double build_up_s = axis.acceleration / axis.jerk;
    return v >= axis.acceleration * build_up_s ? v / axis.acceleration + build_up_s
                                               : 2.0 * std::sqrt(v / axis.jerk);
}

AxisLoads axis_loads(const Machine& machine, const JointPath& joints,
                     std::span<const double> step_s) {
    assert(step_s.size() == joints.size());
    LoadMeter meter(machine, joints);
    for (std::size_t i = 1; i < joints.size(); ++i) {
        if (step_s[i] > 0.0) {
            meter.enter(i, step_s[i]);
        }
    }
    meter.enter(0, 0.0);
    return meter.loads();
}

}  // namespace meshwind
