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

TEST(Profiles, StandBelowTheJobAndItsSettings) {
    const Job glass = load_profile(kSource / "data/profiles/glass_2400tex.json");
    const Job both = load_profile(kSource / "data/profiles/wet_winding.json", glass);
    EXPECT_EQ(both.tow.width_mm, glass.tow.width_mm);
    EXPECT_NE(both.tow.friction, glass.tow.friction);
    const JobSetting density{"tow.density", "1.7"};
    const Job job = parse_job(R"({"tow": {"width": 5}, "mandrel": {"extension": 40}})", "j",
                              {&density, 1}, both);
    EXPECT_EQ(job.tow.width_mm, 5.0);
    EXPECT_EQ(job.tow.thickness_mm, glass.tow.thickness_mm);
    EXPECT_EQ(job.tow.friction, both.tow.friction);
    EXPECT_EQ(job.tow.density_g_cm3, 1.7);
    // What came of all is a job of its own.
    EXPECT_EQ(job_text(parse_job(told_job_text(job), "told")), job_text(job));
}

TEST(Profiles, ThatAreNotThereAreAnErrorOfTheFile) {
    const fs::path file = "glas_2400tex.json";
    EXPECT_EQ(test::refusal_of([&] { (void)load_profile(file); }),
              (test::Refused{"io.cannot_read", file.string()}));
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
