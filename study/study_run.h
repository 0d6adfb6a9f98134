/// Runs a mesh-size study of mandrels against their references: the mesh that a part needs.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "study/mesh_size.h"

namespace meshwind {

struct StudyOutcome {
    MeshSizeOptions options;
    std::vector<std::pair<std::string, std::string>> references;  ///< mandrel, its reference
    MeshSizeStudy study;
};

/// \throws InputError study.*: the same name twice, options out of range
[[nodiscard]] StudyOutcome run_study(const std::vector<StudyMandrel>& mandrels,
                                     const MeshSizeOptions& options);

/// Number shown for an error, degrees for angles; and its unit: "mm", "deg", "-".
[[nodiscard]] double shown_error(Quantity quantity, double error);
[[nodiscard]] std::string unit_of(Quantity quantity);

}  // namespace meshwind
