#include "core/parallel.h"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace meshwind {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnce) {
    for (const std::size_t count : {0U, 1U, 7U, 8U, 1000U}) {
        std::vector<int> visits(count, 0);
        parallel_for(count, 8, [&](std::size_t begin, std::size_t end) {
            EXPECT_LE(end - begin, 8U);
            for (std::size_t i = begin; i < end; ++i) {
                ++visits[i];
            }
        });
        EXPECT_EQ(visits, std::vector<int>(count, 1));
    }
}

TEST(ParallelFor, HandsExceptionsToTheCaller) {
    EXPECT_THROW(
        parallel_for(10, 1, [](std::size_t, std::size_t) { throw std::runtime_error("body"); }),
        std::runtime_error);
}

}  // namespace
}  // namespace meshwind
