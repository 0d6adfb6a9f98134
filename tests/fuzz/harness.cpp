#include "tests/fuzz/harness.h"

#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        meshwind::fuzz::run({data, size});
    } catch (const meshwind::InputError&) {
    } catch (const meshwind::IoError&) {
    }
    return 0;
}

namespace meshwind::fuzz {

void found(std::string_view words) {
    std::fprintf(stderr, "FOUND: %.*s\n", static_cast<int>(words.size()), words.data());
    std::abort();
}

}  // namespace meshwind::fuzz
