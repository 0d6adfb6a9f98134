/// `meshwind study mesh-size`: which mesh a part needs.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "study/mesh_size.h"

namespace meshwind {

struct StudyRequest {
    std::vector<std::string>
        mandrels;  ///< cylinder, torus, ellipsoid, tee or a file; empty: the four
    std::vector<double> radii_mm{20.0, 70.0, 450.0};  ///< of the cylinders
    MeshSizeOptions options;
    double unit_mm = 0.0;  ///< length of a file unit; 0: found
    std::filesystem::path out;
};

struct StudyOutcome {
    MeshSizeOptions options;
    std::vector<std::pair<std::string, std::string>> references;  ///< mandrel, compared with what
    MeshSizeStudy study;
};

/// Runs the study and writes study.csv, study.json, study.svg and, when timing is asked for,
/// timing.csv. \throws InputError study.*, make.*, mesh.*; IoError
[[nodiscard]] StudyOutcome run_study(const StudyRequest& request);

/// The table and what it says about the advice of fu_2009_post_processing.
void print_study(std::ostream& out, const StudyOutcome& outcome,
                 const std::filesystem::path& folder);

}  // namespace meshwind
