#include "pipeline/run_names.h"

#include <gtest/gtest.h>

namespace meshwind {
namespace {

TEST(RunNames, FirstLayerAndFibreHaveNone) {
    EXPECT_EQ(layer_suffix(0) + fibre_suffix(0), "");
    EXPECT_EQ(layer_suffix(0) + fibre_suffix(1), "-2");
    EXPECT_EQ(layer_suffix(2) + fibre_suffix(0), "-layer-3");
    EXPECT_EQ(layer_suffix(2) + fibre_suffix(1), "-layer-3-2");
    EXPECT_EQ(grown_mandrel_name(2), "mandrel-layer-3.obj");
}

TEST(RunNames, AProgramsNameTellsLayerAndFibre) {
    for (std::size_t layer = 0; layer < 12; ++layer) {
        for (std::size_t fibre = 0; fibre < 12; ++fibre) {
            const std::string suffix = layer_suffix(layer) + fibre_suffix(fibre);
            EXPECT_EQ(suffix_of("some-where/program" + suffix + ".ngc"), suffix);
        }
    }
}

}  // namespace
}  // namespace meshwind
