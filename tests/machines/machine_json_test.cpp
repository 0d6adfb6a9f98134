#include "machines/machine_json.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace meshwind {
namespace {

const std::string kSource = MESHWIND_SOURCE_DIR;

struct Case {
    std::string file;
    std::string code;
    std::string place;
};

std::vector<Case> read_manifest(const std::string& folder) {
    std::ifstream stream(folder + "/manifest.csv");
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

TEST(MachineJson, ConformanceCorpusIsReadOrRefusedAsStated) {
    const std::string folder = kSource + "/data/conformance/machine";
    const std::vector<Case> cases = read_manifest(folder);
    ASSERT_GT(cases.size(), 40u);
    for (const Case& entry : cases) {
        SCOPED_TRACE(entry.file);
        const std::string file = folder + "/" + entry.file;
        try {
            (void)read_machine(file);
            EXPECT_EQ(entry.code, "ok");
        } catch (const InputError& error) {
            EXPECT_EQ(error.code(), entry.code) << error.what();
            EXPECT_EQ(error.place().find(file), 0u) << error.place();
            if (!entry.place.empty()) {
                EXPECT_EQ(error.place(), file + entry.place);
            }
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    }
}

TEST(MachineJson, SixAxisMachineHasSiUnitsInside) {
    const Machine machine = read_machine(kSource + "/machines/six_axis.json");
    ASSERT_EQ(machine.axis_count(), 6u);
    const Axis& spindle = machine.axis(0);
    EXPECT_EQ(spindle.letter, 'C');
    EXPECT_TRUE(std::isinf(spindle.max));
    EXPECT_TRUE(std::isinf(spindle.jerk));
    EXPECT_DOUBLE_EQ(spindle.velocity, 4.0 * kPi);
    EXPECT_EQ(spindle.resolution_nano, 1'000'000);
    const Axis& carriage = machine.axis(machine.joint_of('Z').value());
    EXPECT_EQ(carriage.min, -3000.0);
    EXPECT_EQ(carriage.velocity, 1000.0);
    EXPECT_DOUBLE_EQ(machine.axis(machine.joint_of('B').value()).max, rad_from_deg(100.0));
    EXPECT_FALSE(machine.joint_of('U'));
    EXPECT_DOUBLE_EQ(machine.fibre.max_speed_mm_s, 1000.0);
    EXPECT_EQ(machine.controller.dialect, "linuxcnc");
    ASSERT_EQ(machine.eye.envelope.size(), 3u);
    EXPECT_EQ(std::get<Capsule>(machine.eye.envelope[0].shape).radius_mm, 3.5);
}

TEST(MachineJson, AxesOfARobotArriveAsTheyAreNamed) {
    const auto read = [](const std::string& name) {
        return read_machine(kSource + "/data/conformance/machine/valid/" + name).controller;
    };
    EXPECT_EQ(read("robot_axes.json").robot_axes, "CZYXAB");
    EXPECT_EQ(read("robot_axes.json").external_axes, "");
    EXPECT_EQ(read("external_axes.json").external_axes, "C-Z");
    EXPECT_EQ(read("six_axis.json").robot_axes, "");
}

TEST(MachineJson, EnvelopeMeshNamesCountFromTheMachineFile) {
    const std::string folder = kSource + "/data/conformance/machine/valid";
    const Machine machine = read_machine(folder + "/mesh_envelope.json");
    EXPECT_EQ(std::get<EnvelopeMesh>(machine.eye.envelope.back().shape).file, folder + "/arm.stl");
}

}  // namespace
}  // namespace meshwind
