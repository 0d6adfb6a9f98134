/// The keys of a layer of the job. Included by .cpp files of this folder only.
#pragma once

#include "core/text/key_table.h"
#include "pipeline/job/job.h"

namespace meshwind {

[[nodiscard]] const KeyTable<LayerJob>& layer_keys();

}  // namespace meshwind
