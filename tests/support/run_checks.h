/// The checks of a run, for the tests of pipeline/.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "pipeline/wind.h"

namespace meshwind::test {

inline const Check& check_of(const Run& run, const std::string& name) {
    for (const Check& check : run.checks) {
        if (check.name == name) {
            return check;
        }
    }
    throw std::out_of_range(name);
}

inline std::vector<std::string> failed_checks(const Run& run) {
    std::vector<std::string> failed;
    for (const Check& check : run.checks) {
        if (!check.ok) {
            failed.push_back(check.name);
        }
    }
    return failed;
}

}  // namespace meshwind::test
