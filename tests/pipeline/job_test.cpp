#include "pipeline/job/job.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

const fs::path kCorpus = fs::path(MESHWIND_SOURCE_DIR) / "data/conformance/job";

std::string text_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

struct Case {
    std::string file, code, place;
};

std::vector<Case> manifest() {
    std::ifstream stream(kCorpus / "manifest.csv");
    std::vector<Case> cases;
    std::string line;
    std::getline(stream, line);
    while (std::getline(stream, line)) {
        std::istringstream fields(line);
        Case entry;
        std::getline(fields, entry.file, ',');
        std::getline(fields, entry.code, ',');
        std::getline(fields, entry.place, ',');
        cases.push_back(entry);
    }
    return cases;
}

/// What `parse_job` throws for a text; the test fails when it throws nothing.
InputError error_of(const std::string& text, const std::string& name = "job.json") {
    try {
        (void)parse_job(text, name);
    } catch (const InputError& error) {
        return error;
    }
    ADD_FAILURE() << "accepted: " << text;
    return InputError("", "", "");
}

TEST(Job, DefaultsAreThePublishedOnes) {
    const Job job = parse_job("{}", "job.json");
    EXPECT_EQ(job_text(job),
              "{ \"mandrel\":{\"units\":\"auto\", \"axis\":\"auto\", \"keep_regions\":\"auto\", "
              "\"extension\":100, \"turn\":\"friction\"},\n"
              "  \"tow\":{\"width\":6, \"thickness\":0.25, \"friction\":0.2, "
              "\"bridging_tolerance\":0.5, \"density\":1.55},\n"
              "  \"layers\":[{\"kind\":\"auto\", \"target_layers\":1}],\n"
              "  \"fibres\":1,\n"
              "  \"eye\":{\"rule\":\"adaptive\", \"free_length\":200},\n"
              "  \"redundancy\":\"optimal\",\n"
              "  \"tolerance\":{\"laydown\":0.2, \"laydown_angle\":0.3, \"clearance\":5, "
              "\"bare\":0.01},\n"
              "  \"speed\":{\"fibre\":30} }\n");
}

TEST(Job, PinsAreWrittenWhereTheyAreRead) {
    const Job job = parse_job(R"({"mandrel": {"turn": "pins"}})", "pins.json");
    EXPECT_NE(job_text(job).find("\"turn\":\"pins\", \"pins\":{\"count\":\"auto\", "
                                 "\"diameter\":2, \"height\":\"auto\", \"skip\":\"auto\", "
                                 "\"offset\":\"auto\"}}"),
              std::string::npos)
        << job_text(job);
    EXPECT_EQ(job_text(parse_job(job_text(job), "again.json")), job_text(job));
}

TEST(Job, EveryKeyReachesItsField) {
    const Job job = read_job(kCorpus / "valid/all_keys.json");
    EXPECT_EQ(job.mandrel.units, LengthUnit::Millimetre);
    ASSERT_TRUE(job.mandrel.axis.has_value());
    EXPECT_EQ(job.mandrel.axis->direction, Eigen::Vector3d(0, 0, 2));
    EXPECT_EQ(job.mandrel.keep_regions, (std::vector<std::int32_t>{0, 3}));
    EXPECT_EQ(job.mandrel.extension_mm, 120.5);
    EXPECT_EQ(job.mandrel.turn, TurnKind::Pins);
    EXPECT_EQ(job.mandrel.pins.count, 80);
    EXPECT_EQ(job.mandrel.pins.diameter_mm, 1.5);
    EXPECT_EQ(job.mandrel.pins.height_mm, 6.5);
    EXPECT_EQ(job.mandrel.pins.skip, 4);
    EXPECT_EQ(job.mandrel.pins.offset_mm, 12.0);
    EXPECT_EQ(job.tow.width_mm, 8.0);
    EXPECT_EQ(job.tow.thickness_mm, 0.3);
    EXPECT_EQ(job.tow.friction, 0.25);
    EXPECT_EQ(job.mandrel.cut_ends_mm, 1.5);
    EXPECT_EQ(job.mandrel.remove_details_mm, 0.6);
    EXPECT_EQ(job.mandrel.blend_mm, 8.0);
    EXPECT_EQ(job.mandrel.mesh, MandrelOptions::Mesh::File);
    EXPECT_EQ(job.tow.friction_on_fibre, 0.35);
    EXPECT_EQ(job.tow.bridging_tolerance_mm, 0.0);
    ASSERT_EQ(job.layers.size(), 3U);
    EXPECT_EQ(job.layers[0].kind, LayerKind::Hoop);
    EXPECT_EQ(job.layers[0].target_layers, 2.0);
    EXPECT_EQ(job.layers[1].angle_deg, 54.7);
    EXPECT_EQ(job.layers[2].file, "points \"A\".csv");
    EXPECT_EQ(job.fibres, 3);
    EXPECT_EQ(job.eye.rule, EyeRule::Cylinder);
    EXPECT_EQ(job.eye.free_length_mm, 180.0);
    EXPECT_EQ(job.eye.radius_mm, 258.5);
    EXPECT_EQ(job.redundancy, RedundancyRule::Hold);
    EXPECT_EQ(job.tolerance.laydown_mm, 0.1);
    EXPECT_EQ(job.tolerance.laydown_angle_deg, 0.5);
    EXPECT_EQ(job.tolerance.clearance_mm, 0.0);
    EXPECT_EQ(job.speed.fibre_m_min, 45.0);
}

TEST(Job, NumbersOfTheEyeRulesReachTheirFields) {
    const EyeLaw lengths = read_job(kCorpus / "valid/eye_lengths.json").eye;
    EXPECT_EQ(lengths.rule, EyeRule::EqualFreeLength);
    ASSERT_EQ(lengths.lengths.size(), 2U);
    EXPECT_FALSE(lengths.lengths[0].piece.has_value());
    EXPECT_EQ(lengths.lengths[0].from_mm, 0.0);
    EXPECT_EQ(lengths.lengths[0].to_mm, 1200.0);
    EXPECT_EQ(lengths.lengths[0].free_length_mm, 250.0);
    EXPECT_EQ(lengths.lengths[1].piece, 3);
    EXPECT_EQ(lengths.lengths[1].free_length_mm, 220.5);
    const EyeLaw vertical = read_job(kCorpus / "valid/eye_vertical_plane.json").eye;
    EXPECT_EQ(vertical.rule, EyeRule::VerticalPlane);
    EXPECT_EQ(vertical.plane_x_mm, 260.0);
    const EyeLaw horizontal = read_job(kCorpus / "valid/eye_horizontal_plane.json").eye;
    EXPECT_EQ(horizontal.rule, EyeRule::HorizontalPlane);
    EXPECT_EQ(horizontal.plane_y_mm, -180.5);
    EXPECT_NE(job_text(read_job(kCorpus / "valid/eye_lengths.json")).find("\"course\":3"),
              std::string::npos);
}

TEST(Job, WishesForPatternsReachTheirFields) {
    const LayerJob wished = read_job(kCorpus / "valid/pattern_all_keys.json").layers.front();
    EXPECT_EQ(wished.kind, LayerKind::Helical);
    ASSERT_TRUE(wished.pattern.has_value());
    EXPECT_FALSE(wished.lattice.has_value());
    EXPECT_EQ(wished.pattern->circuits, 42);
    EXPECT_EQ(wished.pattern->starts, 5);
    EXPECT_EQ(wished.pattern->lead, BandOrder::Lagging);
    EXPECT_EQ(wished.pattern->most_overlap, 0.1);
    EXPECT_EQ(wished.pattern->dwell_deg, 5.5);
    EXPECT_EQ(wished.pattern->most_dwell_deg, 200.0);
    EXPECT_EQ(wished.pattern->band_offset_mm, 5.5);
    const LayerJob any = read_job(kCorpus / "valid/pattern_polar.json").layers.front();
    EXPECT_FALSE(any.pattern->lead.has_value());
    EXPECT_FALSE(any.pattern->most_overlap.has_value());
    EXPECT_FALSE(any.pattern->most_dwell_deg.has_value());
}

TEST(Job, LatticesReachTheirFields) {
    const LayerJob plain = read_job(kCorpus / "valid/lattice.json").layers.front();
    EXPECT_EQ(plain.kind, LayerKind::Lattice);
    ASSERT_TRUE(plain.lattice.has_value());
    EXPECT_EQ(plain.lattice->circuits, 6);
    EXPECT_EQ(plain.lattice->series, 1);
    EXPECT_EQ(plain.lattice->plies, 1);
    const LayerJob all = read_job(kCorpus / "valid/lattice_all_keys.json").layers.front();
    EXPECT_EQ(all.lattice->series, 2);
    EXPECT_EQ(all.lattice->plies, 3);
    EXPECT_EQ(all.pattern->band_offset_mm, 7.0);
    EXPECT_EQ(read_job(kCorpus / "valid/lattice_filled.json").layers.front().lattice->series, 0);
}

TEST(Job, WallsReachTheirFields) {
    const LayerJob plain = read_job(kCorpus / "valid/wall_layers.json").layers.front();
    EXPECT_EQ(plain.kind, LayerKind::Wall);
    ASSERT_TRUE(plain.wall.has_value());
    EXPECT_EQ(plain.wall->amount.layers, 4.0);
    EXPECT_FALSE(plain.wall->amount.thickness_mm.has_value());
    EXPECT_TRUE(plain.wall->parts.empty());
    const LayerJob all = read_job(kCorpus / "valid/wall_all_keys.json").layers.front();
    EXPECT_EQ(all.angle_deg, 55.0);
    EXPECT_EQ(all.wall->amount.thickness_mm, 2.5);
    const std::vector<WallPart>& parts = all.wall->parts;
    ASSERT_EQ(parts.size(), 4U);
    EXPECT_EQ(parts[0].region, 3);
    EXPECT_EQ(parts[0].amount.layers, 12.0);
    ASSERT_TRUE(parts[1].box.has_value());
    EXPECT_EQ(parts[1].box->least, Eigen::Vector3d(-10.0, 0.0, 5.5));
    EXPECT_EQ(parts[1].box->most, Eigen::Vector3d(10.0, 20.0, 30.0));
    EXPECT_EQ(parts[1].amount.thickness_mm, 3.0);
    EXPECT_EQ(parts[2].point, Eigen::Vector3d(1.0, 2.0, 3.0));
    EXPECT_EQ(parts[2].within_mm, 40.0);
    EXPECT_EQ(parts[3].rim, 2);
    EXPECT_EQ(parts[3].within_mm, 12.5);
}

TEST(Job, RedundancyLeftOutIsTheBestThatTheRuleLeaves) {
    EXPECT_EQ(parse_job("{}", "").redundancy, RedundancyRule::Optimal);
    EXPECT_EQ(parse_job(R"({"eye": {"rule": "cylinder", "radius": 250}})", "").redundancy,
              RedundancyRule::Optimal);
    EXPECT_EQ(parse_job(R"({"redundancy": "oscillate"})", "").redundancy,
              RedundancyRule::Oscillate);
    // The planes leave nothing to choose.
    for (const std::string eye : {R"({"rule": "vertical-plane", "plane_x": 260})",
                                  R"({"rule": "horizontal-plane", "plane_y": -180})"}) {
        const std::string rest = R"({"eye": )" + eye;
        EXPECT_EQ(parse_job(rest + "}", "").redundancy, RedundancyRule::CentralAngle);
        EXPECT_EQ(parse_job(rest + R"(, "redundancy": "central-angle"})", "").redundancy,
                  RedundancyRule::CentralAngle);
        for (const std::string word : {"hold", "oscillate", "optimal"}) {
            const InputError error = error_of(rest + R"(, "redundancy": ")" + word + "\"}");
            EXPECT_EQ(error.code(), "job.turn_forced");
            EXPECT_EQ(error.place(), "job.json: /redundancy");
        }
    }
}

TEST(Job, TextReadsBackAsTheSameJob) {
    for (const auto& entry : fs::directory_iterator(kCorpus / "valid")) {
        const std::string text = job_text(read_job(entry.path()));
        EXPECT_EQ(job_text(parse_job(text, "again.json")), text) << entry.path();
    }
}

TEST(Job, ToldTextReadsBackAsTheSameJob) {
    EXPECT_EQ(told_job_text(Job{}), "{}");
    EXPECT_EQ(told_job_text(parse_job(R"({"tow": {"width": 12}, "layers": [{}]})", "")),
              R"({"tow":{"width":12}})");
    for (const auto& entry : fs::directory_iterator(kCorpus / "valid")) {
        const Job job = read_job(entry.path());
        const Job again = parse_job(told_job_text(job), "again.json");
        EXPECT_EQ(job_text(again), job_text(job)) << entry.path();
        EXPECT_EQ(again.fibres_given, job.fibres_given);
        EXPECT_EQ(again.mandrel.turn_given, job.mandrel.turn_given);
        EXPECT_EQ(again.mandrel.extension_given, job.mandrel.extension_given);
    }
}

// What is given as it is by default keeps other fibres, extensions and turns from being tried.
TEST(Job, ToldTextHasWhatWasGiven) {
    const std::string given = R"({"mandrel":{"turn":"friction"},"fibres":1})";
    EXPECT_EQ(told_job_text(parse_job(given, "")), given);
}

TEST(Job, CorpusFailsWithTheStatedCodeAndPlace) {
    const std::vector<Case> cases = manifest();
    ASSERT_GT(cases.size(), 40U);
    for (const Case& entry : cases) {
        SCOPED_TRACE(entry.file);
        const std::string name = fs::path(entry.file).filename().string();
        const std::string text = text_of(kCorpus / entry.file);
        if (entry.code == "ok") {
            EXPECT_NO_THROW((void)parse_job(text, name));
            continue;
        }
        const InputError error = error_of(text, name);
        EXPECT_EQ(error.code(), entry.code);
        EXPECT_EQ(error.place(), name + entry.place);
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
}

TEST(Job, ManifestNamesEveryFile) {
    std::set<fs::path> named;
    for (const Case& entry : manifest()) {
        named.insert(kCorpus / entry.file);
    }
    for (const std::string folder : {"valid", "invalid"}) {
        for (const auto& entry : fs::directory_iterator(kCorpus / folder)) {
            EXPECT_TRUE(named.contains(entry.path())) << entry.path();
        }
    }
}

TEST(Job, SuggestsTheNearestKeyAndWord) {
    const InputError key = error_of(R"({"tow": {"widht": 6}})");
    EXPECT_EQ(key.code(), "json.unknown_key");
    EXPECT_EQ(key.place(), "job.json: /tow/widht");
    EXPECT_NE(std::string(key.what()).find("\"width\""), std::string::npos);
    EXPECT_NE(std::string(error_of(R"({"redundancy": "optimum"})").what()).find("\"optimal\""),
              std::string::npos);
}

TEST(Job, SettingsLieOverTheFile) {
    const std::vector<JobSetting> settings = {{"tow.width", "8"},
                                              {"layers.0.kind", "helical"},
                                              {"layers.0.angle", "55.5"},
                                              {"layers.1.kind", "\"hoop\""},
                                              {"eye", R"({"rule": "cylinder", "radius": 90})"},
                                              {"fibres", "2"}};
    const Job job = parse_job(R"({"tow": {"width": 3, "friction": 0.3}})", "job.json", settings);
    EXPECT_EQ(job.tow.width_mm, 8.0);
    EXPECT_EQ(job.tow.friction, 0.3);
    ASSERT_EQ(job.layers.size(), 2U);
    EXPECT_EQ(job.layers[0].kind, LayerKind::Helical);
    EXPECT_EQ(job.layers[0].angle_deg, 55.5);
    EXPECT_EQ(job.layers[1].kind, LayerKind::Hoop);
    EXPECT_EQ(job.eye.rule, EyeRule::Cylinder);
    EXPECT_EQ(job.eye.radius_mm, 90.0);
    EXPECT_EQ(job.fibres, 2);
}

TEST(Job, KeysOfOneSectionAreFoundFromTheTop) {
    for (const auto& [key, meant] : {std::pair{"turn", "\"mandrel.turn\""},
                                     {"angle", "\"layers.0.angle\""},
                                     {"clearance", "\"tolerance.clearance\""}}) {
        const JobSetting setting{key, "1"};
        try {
            (void)parse_job("{}", "job.json", std::span(&setting, 1));
            ADD_FAILURE() << key;
        } catch (const InputError& error) {
            EXPECT_EQ(error.code(), "json.unknown_key");
            EXPECT_NE(std::string(error.what()).find(meant), std::string::npos) << error.what();
        }
    }
}

// A setting is read as strictly as the file.
TEST(Job, SettingsThatLeadNowhereAreRefused) {
    const auto code_and_place = [](const JobSetting& setting) {
        try {
            (void)parse_job("{}", "job.json", std::span(&setting, 1));
        } catch (const InputError& error) {
            return error.code() + " " + error.place();
        }
        return std::string("taken");
    };
    EXPECT_EQ(code_and_place({"tow.widht", "8"}), "json.unknown_key job.json: /tow/widht");
    EXPECT_EQ(code_and_place({"tow.width", "wide"}), "json.wrong_type job.json: /tow/width");
    EXPECT_EQ(code_and_place({"tow.width", "-1"}), "json.out_of_range job.json: /tow/width");
    EXPECT_EQ(code_and_place({"layers.3.kind", "hoop"}), "json.no_such_place job.json");
    EXPECT_EQ(code_and_place({"fibres.most", "2"}), "json.wrong_type job.json: /fibres");
    EXPECT_EQ(code_and_place({"tow..width", "2"}), "json.no_such_place job.json");
    EXPECT_EQ(code_and_place({"", "2"}), "json.no_such_place job.json");
}

TEST(Job, MissingFileIsAnIoError) {
    EXPECT_THROW((void)read_job("no/such/job.json"), IoError);
}

TEST(LengthUnit, MillimetresOfEachUnit) {
    EXPECT_EQ(mm_per(LengthUnit::Auto), 0.0);
    EXPECT_EQ(mm_per(LengthUnit::Micrometre), 1e-3);
    EXPECT_EQ(mm_per(LengthUnit::Millimetre), 1.0);
    EXPECT_EQ(mm_per(LengthUnit::Centimetre), 10.0);
    EXPECT_EQ(mm_per(LengthUnit::Metre), 1000.0);
    EXPECT_EQ(mm_per(LengthUnit::Inch), 25.4);
}

}  // namespace
}  // namespace meshwind
