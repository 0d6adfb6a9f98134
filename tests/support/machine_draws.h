/// Random numbers for the tests of machines/.
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "core/units.h"
#include "machines/machine.h"
#include "tests/support/machine_file.h"

namespace meshwind::test {

class Draw {
public:
    explicit Draw(unsigned seed) : engine_(seed) {}

    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }

    Eigen::Vector3d direction() {
        Eigen::Vector3d v;
        do {
            v = {between(-1.0, 1.0), between(-1.0, 1.0), between(-1.0, 1.0)};
        } while (v.norm() < 0.1);
        return v.normalized();
    }

    // Within the travel; where it has no end, within some turns.
    std::vector<double> joints(const Machine& machine) {
        std::vector<double> q;
        for (std::size_t j = 0; j < machine.axis_count(); ++j) {
            const Axis& axis = machine.axis(j);
            q.push_back(between(std::max(axis.min, -20.0 * kPi), std::min(axis.max, 20.0 * kPi)));
        }
        return q;
    }

private:
    std::mt19937 engine_;
};

}  // namespace meshwind::test
