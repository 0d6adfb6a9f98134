#include "pipeline/job/job_friction.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/margins.h"
#include "pipeline/setup.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

Job with_layers(std::size_t layers) {
    Job job;
    job.tow.friction = 0.2;
    job.layers.resize(layers);
    return job;
}

TEST(JobFriction, WithoutAnotherNumberAllLayersHaveOne) {
    const Job job = with_layers(3);
    for (std::size_t layer = 0; layer < 3; ++layer) {
        EXPECT_EQ(friction_of(job, layer).holds(), 0.2);
    }
    EXPECT_EQ(most_friction_of(job).holds(), 0.2);
}

TEST(JobFriction, LayersAboveTheFirstLieOnFibre) {
    Job job = with_layers(3);
    for (const double on_fibre : {0.0, 0.15, 0.35}) {
        job.tow.friction_on_fibre = on_fibre;
        EXPECT_EQ(friction_of(job, 0).holds(), 0.2);
        EXPECT_EQ(friction_of(job, 1).holds(), on_fibre);
        EXPECT_EQ(friction_of(job, 2).holds(), on_fibre);
        EXPECT_EQ(most_friction_of(job).holds(), std::max(0.2, on_fibre));
    }
    job.layers.resize(1);
    EXPECT_EQ(most_friction_of(job).holds(), 0.2) << "no layer lies on fibre";
}

TEST(JobFriction, PlannersHaveTheirShareOfIt) {
    const Friction friction = 0.25;
    EXPECT_EQ(friction.planned().holds(), margin::kPlannedFriction * 0.25);
    EXPECT_EQ(friction.share(-0.5), -0.125);
}

TEST(JobFriction, ASetupHasThatOfItsLayer) {
    Job job = test::pipe_job();
    job.tow.friction_on_fibre = 0.3;
    const meshwind::Setup first = make_setup(test::small_pipe(), test::shipped("six_axis"), job);
    EXPECT_EQ(first.friction.holds(), job.tow.friction);
    EXPECT_EQ(setup_for(first, test::small_pipe(), 1).friction.holds(), 0.3);
}

}  // namespace
}  // namespace meshwind
