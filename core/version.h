/// The version of the program and its libraries.
#pragma once

namespace meshwind {

extern const char* const kVersion;  ///< "1.2.3"

}  // namespace meshwind
