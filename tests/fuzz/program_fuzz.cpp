// A program: '0' to '9' is the dialect, then its text. What was read, written again, must be read
// alike; what is short enough is wound on a small tube.
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "machines/machine_json.h"
#include "mesh/mandrel/extension.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/shapes/make.h"
#include "postproc/ringhead/krl.h"
#include "postproc/robot/dialects.h"
#include "postproc/verify/verify.h"
#include "tests/fuzz/harness.h"

namespace meshwind::fuzz {
namespace {

constexpr std::array<std::string_view, 10> kDialects = {
    "linuxcnc", "fanuc", "siemens", "grbl", "marlin", "pulses", "carried", "rapid", "krl", "tp"};

// Only so that an input takes milliseconds: longer programs are read and written, not wound.
constexpr std::size_t kMaxBlocks = 40;
constexpr double kMaxWay = 2000.0;  // mm and degrees of all axes together

constexpr double kExtension_mm = 60.0;

Machine machine_of(std::string_view dialect) {
    const bool robot = dialect == "rapid" || dialect == "krl" || dialect == "tp";
    const std::string file = robot ? "robot_winder.json" : "six_axis.json";
    Machine machine = read_machine(MESHWIND_SOURCE_DIR "/machines/" + file);
    machine.controller.dialect = dialect;
    machine.controller.header.clear();
    const bool inverse = dialect == "linuxcnc" || dialect == "fanuc" || robot;
    machine.controller.feed = inverse ? FeedMode::InverseTime : FeedMode::PerMinute;
    return machine;
}

// What a program is wound on, and by.
struct World {
    explicit World(std::string_view dialect)
        : machine(machine_of(dialect)), envelope(head_envelope(machine)) {
        CylinderShape tube;
        tube.radius_mm = 50.0;
        tube.length_mm = 160.0;
        const Mandrel mandrel = build_mandrel(make_cylinder(tube, {.edge_mm = 20.0}), "tube");
        std::vector<TriangleSoup> parts{mandrel.whole};
        for (const Rim& rim : mandrel.rims) {
            parts.push_back(extension_of(rim, kExtension_mm));
        }
        obstacles.emplace(parts);
        wall.emplace(extended_surface(mandrel, kExtension_mm));
        rules.collision.free_fibre.min_mm = machine.fibre.min_free_length_mm;
        rules.collision.free_fibre.max_mm = machine.fibre.max_free_length_mm;
    }

    Machine machine;
    HeadEnvelope envelope;
    std::optional<RayQuery> obstacles;
    std::optional<LaydownSurface> wall;
    VerifyRules rules;
};

const World& world_of(std::size_t dialect) {
    static std::array<std::unique_ptr<World>, kDialects.size()> worlds;
    if (!worlds[dialect]) {
        worlds[dialect] = std::make_unique<World>(kDialects[dialect]);
    }
    return *worlds[dialect];
}

// False where a block moves no axis: such ones are not written.
bool moves_in_each_block(const BlockList& list) {
    for (std::size_t b = 1; b < list.blocks.size(); ++b) {
        const auto now = list.row(b);
        if (std::equal(now.begin(), now.end(), list.row(b - 1).begin())) {
            return false;
        }
    }
    return list.blocks.size() > 1;
}

void write_and_read(const Dialect& dialect, const World& world, const BlockList& list) {
    std::string text;
    BlockList written;
    try {
        FoldedProgram folded = dialect.fold(dialect.prepare(list));
        text = dialect.write(world.machine, folded.list, folded.layout, {});
        written = std::move(folded.list);
    } catch (const InputError&) {
        return;  // no program of a planner: e.g. more digits than the controller has
    }
    if (!moves_in_each_block(written)) {
        return;
    }
    try {
        const BlockList again = dialect.read(text, "again", world.machine);
        if (again.blocks.size() != written.blocks.size() || again.nano != written.nano) {
            found("a program is read back as another:\n" + text);
        }
    } catch (const InputError& error) {
        found(std::string("a program is not read back: ") + error.what() + "\n" + text);
    }
}

double way_of(const BlockList& list) {
    double way = 0.0;
    for (std::size_t b = 1; b < list.blocks.size(); ++b) {
        for (std::size_t a = 0; a < list.axes.size(); ++a) {
            way += std::abs(list.value(b, a) - list.value(b - 1, a));
        }
    }
    return way;
}

void wind(const World& world, BlockList list) {
    if (list.blocks.size() > kMaxBlocks || !(way_of(list) < kMaxWay)) {
        return;
    }
    if (!list.tie_on_mm) {
        list.tie_on_mm = Eigen::Vector3d(50.0, 0.0, 0.0);
    }
    const Verification wound = verify({.program = list,
                                       .machine = world.machine,
                                       .envelope = world.envelope,
                                       .wall = *world.wall,
                                       .obstacles = *world.obstacles,
                                       .rules = world.rules,
                                       .plan = {}});
    for (const Check& check : wound.checks) {
        if (check.ok != check.words.empty()) {
            found("a check without words: " + check.name);
        }
        for (const auto& [name, number] : check.numbers) {
            if (std::isnan(number)) {
                found("a check whose " + name + " is no number: " + check.name);
            }
        }
    }
    (void)laid_csv(wound, list);
}

}  // namespace

void run(std::span<const std::uint8_t> bytes) {
    if (bytes.empty()) {
        return;
    }
    // '0' is the first.
    const std::size_t which =
        (bytes[0] + kDialects.size() - '0' % kDialects.size()) % kDialects.size();
    const std::string_view text = text_of(bytes.subspan(1));
    if (kDialects[which] == "carried") {
        (void)durations_s(read_krl(text, "program"));
        return;
    }
    const World& world = world_of(which);
    const std::unique_ptr<Dialect> dialect = make_dialect(kDialects[which]);
    const BlockList list = dialect->read(text, "program", world.machine);
    write_and_read(*dialect, world, list);
    wind(world, list);
}

}  // namespace meshwind::fuzz
