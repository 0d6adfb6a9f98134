#include "pipeline/job/key_named.h"

#include <gtest/gtest.h>

#include "pipeline/job/job.h"

namespace meshwind {
namespace {

TEST(JobKeyNamed, FindsKeysByTheirLastName) {
    EXPECT_EQ(job_key_named("--friction"), "tow.friction");
    EXPECT_EQ(job_key_named("tow-friction"), "tow.friction");
    EXPECT_EQ(job_key_named("--fibres"), "fibres");
    EXPECT_EQ(job_key_named("--mandrel-cut-ends"), "mandrel.cut_ends");
    EXPECT_EQ(job_key_named("angle"), "layers.0.angle");
    for (const char* none : {"--efort", "--", "", "tow-", "tow.friction.x"}) {
        EXPECT_EQ(job_key_named(none), "") << none;
    }
}

// What is proposed can be set.
TEST(JobKeyNamed, NamesWhatSettingsTake) {
    for (const auto& [word, value] : {std::pair("--width", "3"), std::pair("blend", "auto"),
                                      std::pair("--extension", "50"), std::pair("angle", "55")}) {
        const JobSetting setting{job_key_named(word), value};
        EXPECT_NO_THROW((void)parse_job("{}", "none", {&setting, 1})) << setting.key;
    }
}

}  // namespace
}  // namespace meshwind
