// Replays the inputs of a folder where there is no libFuzzer, and holds the bounds of each.
#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

// Of the processor and of memory, for an input under 100 kB.
constexpr double kMost_s = 10.0;
constexpr long kMost_kB = 1L << 20;
constexpr std::size_t kMaxBytes = 100'000;

struct Usage {
    double user_s;
    long peak_kB;
};

Usage usage() {
    rusage now{};
    ::getrusage(RUSAGE_SELF, &now);
    return {
        static_cast<double>(now.ru_utime.tv_sec) + 1e-6 * static_cast<double>(now.ru_utime.tv_usec),
        now.ru_maxrss};
}

bool replay(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
    // Named before it runs: a crash leaves no other word.
    std::fprintf(stderr, "%s\n", file.filename().c_str());
    const Usage before = usage();
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    const Usage after = usage();
    const bool kept = bytes.size() < kMaxBytes && after.user_s - before.user_s <= kMost_s &&
                      after.peak_kB - before.peak_kB <= kMost_kB;
    if (!kept) {
        std::fprintf(stderr, "beyond the bounds: %zu bytes, %.1f s, %ld kB\n", bytes.size(),
                     after.user_s - before.user_s, after.peak_kB - before.peak_kB);
    }
    return kept;
}

}  // namespace

int main(int count, char** arguments) {
    std::vector<fs::path> files;
    for (int i = 1; i < count; ++i) {
        for (const fs::directory_entry& entry : fs::directory_iterator(arguments[i])) {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    if (files.empty()) {
        std::fprintf(stderr, "no inputs\n");
        return 1;
    }
    return std::all_of(files.begin(), files.end(), replay) ? 0 : 1;
}
