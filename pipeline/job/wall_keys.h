/// The keys of layers of kind "wall".
#pragma once

#include <vector>

#include "core/text/key_table.h"
#include "pipeline/job/job.h"

namespace meshwind {

/// For the table of layers. Other kinds refuse them.
[[nodiscard]] std::vector<Key<LayerJob>> wall_keys();

/// Checks that a wall states its thickness. \throws InputError job.wall_amount
void check_wall(const JsonObject& object, const LayerJob& layer);

}  // namespace meshwind
