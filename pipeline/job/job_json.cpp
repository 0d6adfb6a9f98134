#include <array>
#include <cstddef>

#include "core/text/strict_json.h"
#include "core/text/text_file.h"
#include "pipeline/job/job.h"
#include "pipeline/job/job_keys.h"

namespace meshwind {
namespace {

constexpr std::array<double, 6> kMillimetres = {0.0, 1e-3, 1.0, 10.0, 1e3, 25.4};

Job job_of(const JsonDocument& document, Job job) {
    read_keys(job_keys(), document.root(), job);
    return job;
}

}  // namespace

double mm_per(LengthUnit unit) {
    return kMillimetres[static_cast<std::size_t>(unit)];
}

LengthUnit length_unit(double mm) {
    const auto* const found = std::find(kMillimetres.begin(), kMillimetres.end(), mm);
    return found == kMillimetres.end() ? LengthUnit::Auto
                                       : static_cast<LengthUnit>(found - kMillimetres.begin());
}

std::optional<double> mm_per(std::string_view word) {
    const auto& words = length_words();
    const auto found = std::find(words.begin(), words.end(), word);
    return found == words.end()
               ? std::nullopt
               : std::optional(mm_per(static_cast<LengthUnit>(found - words.begin())));
}

std::string_view name_of(LayerKind kind) {
    return layer_words()[static_cast<std::size_t>(kind)];
}

Job parse_job(std::string_view text, const std::string& name, std::span<const JobSetting> settings,
              const Job& base) {
    JsonDocument document = JsonDocument::parse(text, name);
    for (const JobSetting& setting : settings) {
        document.set(setting.key, setting.value);
    }
    return job_of(document, base);
}

Job read_job(const std::filesystem::path& file, std::span<const JobSetting> settings,
             const Job& base) {
    return parse_job(read_text_file(file), file.string(), settings, base);
}

std::string job_text(const Job& job) {
    return "{ " + keys_text(job_keys(), job, ",\n  ") + " }\n";
}

std::string told_job_text(const Job& job) {
    return "{" + told_keys_text(job_keys(), job, Job{}) + "}";
}

std::string job_schema_text() {
    SchemaJson schema = {
        {"$schema", "https://json-schema.org/draft/2020-12/schema"},
        {"title", "meshwind job"},
        {"description",
         "What to wind, and how. Every key may be left out. Lengths in mm, angles in degrees."}};
    schema.update(keys_schema(job_keys()));
    return schema.dump(2) + "\n";
}

}  // namespace meshwind
