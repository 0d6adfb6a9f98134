#include "study/study_run.h"

#include <set>

#include "core/error.h"
#include "core/units.h"

namespace meshwind {

StudyOutcome run_study(const std::vector<StudyMandrel>& mandrels, const MeshSizeOptions& options) {
    StudyOutcome outcome;
    outcome.options = options;
    outcome.options.validate();
    std::set<std::string> names;
    for (const StudyMandrel& mandrel : mandrels) {
        if (!names.insert(mandrel.name).second) {
            throw InputError("study.twice", mandrel.name, "stands twice; name it once");
        }
        outcome.references.emplace_back(mandrel.name, mandrel.reference_words);
    }
    outcome.study = mesh_size_study(mandrels, outcome.options);
    return outcome;
}

double shown_error(Quantity quantity, double error) {
    const bool angle = quantity == Quantity::WindingAngle || quantity == Quantity::SpindleAngle;
    return angle ? deg_from_rad(error) : error;
}

std::string unit_of(Quantity quantity) {
    switch (quantity) {
        case Quantity::WindingAngle:
        case Quantity::SpindleAngle:
            return "deg";
        case Quantity::Slip:
            return "-";
        default:
            return "mm";
    }
}

}  // namespace meshwind
