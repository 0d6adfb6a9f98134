// A job file. What was read, written again, must be read alike.
#include <string>

#include "pipeline/job/job.h"
#include "tests/fuzz/harness.h"

namespace meshwind::fuzz {

void run(std::span<const std::uint8_t> bytes) {
    const std::string once = job_text(parse_job(text_of(bytes), "job.json"));
    std::string twice;
    try {
        twice = job_text(parse_job(once, "again.json"));
    } catch (const Error& error) {
        found(std::string("a job is not read back: ") + error.what() + "\n" + once);
    }
    if (once != twice) {
        found("a job is read back as another:\n" + once + "\n" + twice);
    }
}

}  // namespace meshwind::fuzz
