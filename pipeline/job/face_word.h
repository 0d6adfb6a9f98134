/// Words by which a job names faces of a CAD file: a number, a kind, or a colour.
#pragma once

#include <string>

#include "core/text/key_table.h"

namespace meshwind {

/// A word for is_named(): a number from 1, one of kCadFaceKinds, or "#rrggbb".
/// \throws InputError json.out_of_range, json.wrong_type
[[nodiscard]] std::string read_face_word(const JsonValue& value);

[[nodiscard]] SchemaJson face_word_schema();

/// The word as JSON.
[[nodiscard]] std::string face_word_text(const std::string& word);

}  // namespace meshwind
