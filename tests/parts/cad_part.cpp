/// A part that looks as if it came from a modeller, made at random:
///
///     cad_part SEED FOLDER
///
/// writes FOLDER/part_SEED.stl, the same in exact faces as .step where it has them all, and
/// FOLDER/part_SEED.json with what is true of it. The same seed
/// gives the same files with the same version of Open CASCADE.
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <string_view>

#include "part.h"
#include "tessellate.h"
#include "truth.h"

namespace {

constexpr int kAttempts = 30;

using cad_part::Built;
using cad_part::Part;
using cad_part::Random;

bool write_text(const std::string& file, const std::string& content) {
    std::ofstream out(file, std::ios::binary);
    out << content;
    out.close();
    return !out.fail();
}

int make(std::uint64_t seed, const std::string& folder) {
    Random random(seed);
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        Part part = cad_part::draw_kind(random);
        cad_part::draw_details(part, random);
        const auto options = cad_part::draw_export(random);
        const auto built = cad_part::build(part, random);
        if (!built) {
            std::fprintf(stderr, "attempt %d: no %s\n", attempt, part.kind.c_str());
            continue;
        }
        auto triangles = cad_part::tessellated(*built, options);
        if (!cad_part::watertight(triangles)) {
            std::fprintf(stderr, "attempt %d: a leaking mesh of a %s\n", attempt,
                         part.kind.c_str());
            continue;
        }
        if (part.skin) {
            triangles = skin_of(part, triangles);
        }
        if (built->missing) {
            const std::size_t all = triangles.size();
            triangles = without_face(triangles, *built->missing);
            if (triangles.size() == all) {
                std::fprintf(stderr, "attempt %d: no face to leave out\n", attempt);
                continue;
            }
        }
        const std::string name = "part_" + std::to_string(seed);
        const std::string stl = name + ".stl";
        const bool exact = !part.skin && !built->missing;
        if (!write_stl(folder + "/" + stl, triangles, options, random) ||
            (exact && !write_step(folder + "/" + name + ".step", built->shape, options)) ||
            !write_text(folder + "/" + name + ".json",
                        truth_json(seed, stl, part, options, triangles.size()))) {
            std::fprintf(stderr, "%s: cannot be written\n", (folder + "/" + name).c_str());
            return 2;
        }
        return 0;
    }
    std::fprintf(stderr, "seed %llu: no part in %d attempts\n",
                 static_cast<unsigned long long>(seed), kAttempts);
    return 1;
}

}  // namespace

int main(int count, char** arguments) {
    std::uint64_t seed = 0;
    if (count == 3) {
        const std::string_view word = arguments[1];
        const auto read = std::from_chars(word.data(), word.data() + word.size(), seed);
        if (read.ec == std::errc() && read.ptr == word.data() + word.size()) {
            return make(seed, arguments[2]);
        }
    }
    std::fputs("usage: cad_part SEED FOLDER\n", stderr);
    return 2;
}
