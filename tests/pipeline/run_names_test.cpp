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
            EXPECT_EQ(layer_of("some-where/program" + suffix + ".ngc"), layer);
        }
    }
}

TEST(RunNames, WhatIsNoLayerIsTheFirst) {
    for (const char* name : {"program.ngc", "layer-3.ngc", "a-layer-3/program.ngc", "a-layer-0.ngc",
                             "a-layer-99999999999999999999.ngc"}) {
        EXPECT_EQ(layer_of(name), 0U) << name;
    }
}

}  // namespace
}  // namespace meshwind
