#include "pipeline/load_inputs.h"

#include <filesystem>
#include <variant>

#include <gtest/gtest.h>

#include "machines/machine_json.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = MESHWIND_SOURCE_DIR;

TEST(LoadInputs, WhatIsNotThereIsAnErrorOfTheFile) {
    for (const fs::path file : {"no/such.json", "no/such.csv"}) {
        EXPECT_EQ(test::refusal_of([&] { (void)load_machine(file); }).code, "io.cannot_read");
        EXPECT_EQ(test::refusal_of([&] { (void)load_job(file); }).code, "io.cannot_read");
        EXPECT_EQ(test::refusal_of([&] { (void)read_landing_points(file); }).code,
                  "io.cannot_read");
    }
}

// The tables of imported layers stand beside the job; this one names one that is not there.
TEST(LoadInputs, TablesOfImportedLayersAreReadWithTheJob) {
    const fs::path file = kSource / "data/conformance/job/valid/all_keys.json";
    const LayerJob imported = read_job(file).layers.back();
    ASSERT_EQ(imported.kind, LayerKind::Imported);
    EXPECT_EQ(imported.points.text, "");
    EXPECT_EQ(test::refusal_of([&] { (void)load_job(file); }).code, "io.cannot_read");
    const fs::path table = kSource / "data/l_frame_axis.csv";
    const LandingText points = read_landing_points(table);
    EXPECT_EQ(points.file, table);
    EXPECT_EQ(points.text.size(), fs::file_size(table));
}

TEST(LoadInputs, MeshesOfAMachineAreReadWithIt) {
    const fs::path file = kSource / "data/conformance/machine/valid/mesh_envelope.json";
    bool named = false;
    for (const EnvelopePart& part : read_machine(file.string()).eye.envelope) {
        named = named || std::holds_alternative<EnvelopeMesh>(part.shape);
    }
    EXPECT_TRUE(named);
    EXPECT_EQ(test::refusal_of([&] { (void)load_machine(file); }).code, "mesh.missing_file");
}

}  // namespace
}  // namespace meshwind
