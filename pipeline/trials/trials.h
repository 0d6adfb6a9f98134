/// Repeats the main job on a mandrel's file with more room, other seeds or a blend.
#pragma once

#include "pipeline/wind.h"

namespace meshwind {

/// The main job with its mandrel read, repeated as long as it helps:
/// - Where the job's blend is yet to be chosen and no pattern holds of a part that has patterns,
///   with wider and wider blends, and on longer extensions where the job does not give them, until
///   one covers the part; else with those that cover most. Only then is it covered by single
///   courses.
/// - Where the job's blend is yet to be chosen and the plan without one fails or covers little, the
///   share of the wall that fibres could join is computed for wider and wider blends, without
///   winding. The smallest blend is taken that lets them join most of it, or nearly as much as any.
/// - Where the plan says that more fibres or longer extensions would reach more of the wall, and
///   the job does not give them, with those.
/// - A cover that covers most and fails is planned again with the next seeds.
/// - Where turns by friction fail or cover little still, and the job leaves the kind of turn open,
///   the same on pins. Pins are taken where they cover clearly more.
///
/// The first run that passes every check is taken, unless another covers much more; else the one
/// that covers most. Tries that cover too little to pass end before they are wound. The outcome of
/// each is among the remarks. \throws as wind() and `mandrel`
[[nodiscard]] Run wind(const MandrelOf& mandrel, const Machine& machine, const Job& job,
                       const WindOptions& options = {});

}  // namespace meshwind
