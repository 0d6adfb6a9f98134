/// Which mesh a part needs: a study of mandrels against their references.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "study/mesh_size.h"

namespace meshwind {

struct StudyOutcome {
    MeshSizeOptions options;
    std::vector<std::pair<std::string, std::string>> references;  ///< mandrel, compared with what
    MeshSizeStudy study;
};

/// \throws InputError study.*: the same name twice, options out of range
[[nodiscard]] StudyOutcome run_study(const std::vector<StudyMandrel>& mandrels,
                                     const MeshSizeOptions& options);

/// The number a reader gets for an error, degrees for angles; and its unit: "mm", "deg", "-".
[[nodiscard]] double shown_error(Quantity quantity, double error);
[[nodiscard]] std::string unit_of(Quantity quantity);

}  // namespace meshwind
