#include "core/version.h"

namespace meshwind {

const char* const kVersion = MESHWIND_VERSION;

}  // namespace meshwind
