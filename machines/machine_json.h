/// Reader and JSON Schema of machine files ("meshwind-machine-1"), both from one table of keys.
#pragma once

#include <string>
#include <string_view>

#include "machines/machine.h"

namespace meshwind {

/// \throws IoError io.cannot_read; InputError json.* (core/text/strict_json.h), and
///   machine.schema            another schema than "meshwind-machine-1"
///   machine.letter            an axis letter that is not one of A to Z
///   machine.duplicate_letter  two axes with one letter
///   machine.missing_axis      an empty mandrel chain
///   machine.direction         a direction, roller or exit that is not of length 1
///   machine.limits            min not below max, or min_free_length not below max_free_length
///   machine.resolution        not a multiple of 1e-9 mm or deg
///   machine.eye               roller and exit not at right angles
///   machine.mount             x and z of the mandrel's frame not at right angles
///   machine.link              an envelope part on an axis that is not in the eye chain, or a body
///                             on one that is not in the mandrel chain
///   machine.comment           a header or footer line with a line break
[[nodiscard]] Machine read_machine(const std::string& file);

/// The same from text; `file` serves in messages and as the place that mesh names are relative to.
[[nodiscard]] Machine parse_machine(std::string_view text, const std::string& file);

/// JSON Schema of machine files; data/schema/machine.schema.json is this text.
[[nodiscard]] std::string machine_schema_text();

}  // namespace meshwind
