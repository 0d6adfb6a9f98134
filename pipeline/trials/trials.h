/// The main job on a mandrel's file: run again with more room, with other seeds, with a blend.
#pragma once

#include "pipeline/wind.h"

namespace meshwind {

/// The main job, reading the mandrel, as often as it helps:
/// - Where the job's blend is yet to be chosen and no pattern holds of a part that has patterns,
///   with wider and wider blends, and on longer extensions where the job does not give them, until
///   one covers the part; else with those that cover most. It is covered by single courses only
///   then.
/// - Where the job's blend is yet to be chosen and the plan without one fails or covers little, it
///   is asked of wider and wider blends what of the wall the fibres could join, without winding.
///   The smallest stands that lets them join most of it, or nearly as much as any.
/// - Where the plan says that more fibres or longer extensions would reach more of the wall, and
///   the job does not give them, with those.
/// - A cover that covers most and fails is planned with the next seeds.
/// - Where turns by friction fail or cover little still, and the job leaves the kind of turn open,
///   the same on pins. They stand where they cover clearly more.
///
/// The first run that passes every check stands, unless another covers much more; else the one that
/// covers most. Tries that cover too little to pass end before they are wound. What each came to is
/// among the remarks. \throws as wind() and `mandrel`
[[nodiscard]] Run wind(const MandrelOf& mandrel, const Machine& machine, const Job& job,
                       const WindOptions& options = {});

}  // namespace meshwind
