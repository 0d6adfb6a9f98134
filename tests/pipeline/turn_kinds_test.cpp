#include "pipeline/job/turn_kinds.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "pipeline/job/job.h"

namespace meshwind {
namespace {

LayerJob layer_of(LayerKind kind) {
    LayerJob layer;
    layer.kind = kind;
    return layer;
}

TEST(TurnKinds, RowsStandInTheOrderOfTheEnumerators) {
    std::set<std::string_view> words;
    for (const TurnKindTraits& turn : turn_kinds()) {
        EXPECT_EQ(&traits_of(turn.kind), &turn) << turn.word;
        EXPECT_TRUE(words.insert(turn.word).second) << turn.word;
        EXPECT_NE(turn.turns, nullptr) << turn.word;
    }
}

TEST(TurnKinds, JobsHaveTheirWords) {
    for (const TurnKindTraits& turn : turn_kinds()) {
        const std::string text = R"({"mandrel": {"turn": ")" + std::string(turn.word) + "\"}}";
        EXPECT_EQ(parse_job(text, "job.json").mandrel.turn, turn.kind);
        const std::string pins =
            R"({"mandrel": {"turn": ")" + std::string(turn.word) + R"(", "pins": {"skip": 3}}})";
        if (turn.reads_pins) {
            EXPECT_EQ(parse_job(pins, "job.json").mandrel.pins.skip, 3);
        } else {
            EXPECT_ANY_THROW((void)parse_job(pins, "job.json")) << turn.word;
        }
    }
}

TEST(TurnKinds, PinsAreForOneLayerWithAPatternOrForAnyThatCoursesCover) {
    const TurnKindTraits& pins = traits_of(TurnKind::Pins);
    Job job;
    for (const LayerKind kind : {LayerKind::Helical, LayerKind::Lattice}) {
        job.layers = {layer_of(kind)};
        EXPECT_EQ(pins.why_not(job, false), "");
        EXPECT_NE(pins.why_not(job, true), "");
        job.layers.push_back(layer_of(kind));
        EXPECT_NE(pins.why_not(job, false), "");
    }
    for (const LayerKind kind : {LayerKind::Hoop, LayerKind::Polar, LayerKind::Imported}) {
        job.layers = {layer_of(kind)};
        EXPECT_NE(pins.why_not(job, false), "") << name_of(kind);
    }
    job.layers = {layer_of(LayerKind::Auto)};
    EXPECT_EQ(pins.why_not(job, false), "");
    job.layers = {layer_of(LayerKind::Cover), layer_of(LayerKind::Wall)};
    EXPECT_EQ(pins.why_not(job, false), "");
    job.layers.push_back(layer_of(LayerKind::Hoop));
    EXPECT_NE(pins.why_not(job, false), "");
}

}  // namespace
}  // namespace meshwind
