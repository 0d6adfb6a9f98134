/// Every key of the job file, each as one row.
#pragma once

#include "core/text/key_table.h"
#include "pipeline/job/job.h"

namespace meshwind {

[[nodiscard]] const KeyTable<Job>& job_keys();
[[nodiscard]] const KeyTable<EyeLaw>& eye_keys();

/// The words of the file for LengthUnit, in the order of the enumerators.
[[nodiscard]] const std::vector<std::string_view>& length_words();

/// The words of the file for LayerKind, in the order of the enumerators.
[[nodiscard]] const std::vector<std::string_view>& layer_words();

}  // namespace meshwind
