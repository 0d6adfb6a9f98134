#include "machines/machine_json.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "core/text/strict_json.h"
#include "core/units.h"

namespace meshwind {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Unit vectors in files have at least six digits; a larger error is a wrong vector, not rounding.
constexpr double kUnitTolerance = 1e-5;
// Nano units per mm or degree: nine decimals are the most that a controller reads.
constexpr double kNanoPerUnit = 1e9;
// A resolution such as 0.001 is not a binary number; its nano value is off by far less than this.
constexpr double kNanoSlack = 1e-3;
constexpr double kMmPerM = 1000.0;
constexpr double kSecondsPerMinute = 60.0;
// Wider than this a machine hall, not a machine: a slip of units.
constexpr double kLargestNumber = 1e6;

constexpr JsonRange kPositive{.min = 0.0, .max = kLargestNumber, .above_min = true};
constexpr JsonRange kLength{.min = 0.0, .max = kLargestNumber};

Eigen::Vector3d unit_vector(const JsonValue& value) {
    const Eigen::Vector3d vector = value.vector3();
    if (!(std::abs(vector.norm() - 1.0) < kUnitTolerance)) {
        value.fail("machine.direction", "is not a unit vector; give it length 1");
    }
    return vector.normalized();
}

Eigen::Vector3d position(const JsonValue& value) {
    const Eigen::Vector3d vector = value.vector3();
    if (!(vector.cwiseAbs().maxCoeff() <= kLargestNumber)) {
        value.fail("json.out_of_range", "lies beyond 1e6 mm; write mm");
    }
    return vector;
}

char axis_letter(const JsonValue& value) {
    const std::string text = value.string();
    if (text.size() != 1 || text[0] < 'A' || text[0] > 'Z') {
        value.fail("machine.letter", "is \"" + text + "\"; write one capital letter A to Z");
    }
    return text[0];
}

std::int64_t resolution_nano(const JsonValue& value) {
    const double nano = value.number(kPositive) * kNanoPerUnit;
    if (std::abs(nano - std::round(nano)) > kNanoSlack || nano < 0.5) {
        value.fail("machine.resolution", "has more than nine decimals; write a multiple of 1e-9");
    }
    return std::llround(nano);
}

double optional_number(const JsonObject& object, std::string_view key, const JsonRange& range,
                       double otherwise) {
    const std::optional<JsonValue> value = object.optional(key);
    return value ? value->number(range) : otherwise;
}

Axis read_axis(const JsonValue& value) {
    const JsonObject object =
        value.object({"letter", "type", "direction", "point", "min", "max", "velocity",
                      "acceleration", "jerk", "resolution", "note"});
    Axis axis;
    axis.letter = axis_letter(object.required("letter"));
    axis.type = object.required("type").one_of({"linear", "rotary"}) == 0 ? AxisType::Linear
                                                                          : AxisType::Rotary;
    axis.direction = unit_vector(object.required("direction"));
    if (const auto point = object.optional("point")) {
        axis.point_mm = position(*point);
    }
    const double unit = axis.type == AxisType::Rotary ? rad_from_deg(1.0) : 1.0;
    axis.min = unit * optional_number(object, "min", {}, -kInfinity);
    axis.max = unit * optional_number(object, "max", {}, kInfinity);
    if (!(axis.min < axis.max)) {
        object.required("min").fail("machine.limits",
                                    "is not below max; exchange them, or write null for no limit");
    }
    axis.velocity = unit * object.required("velocity").number(kPositive);
    axis.acceleration = unit * object.required("acceleration").number(kPositive);
    axis.jerk = unit * optional_number(object, "jerk", {.min = 0.0, .above_min = true}, kInfinity);
    axis.resolution_nano = resolution_nano(object.required("resolution"));
    if (const auto note = object.optional("note")) {
        (void)note->string();
    }
    return axis;
}

bool has_letter(const std::vector<Axis>& axes, char letter) {
    return std::any_of(axes.begin(), axes.end(),
                       [letter](const Axis& axis) { return axis.letter == letter; });
}

std::vector<Axis> read_chain(const JsonValue& value, const std::vector<Axis>& before) {
    std::vector<Axis> chain;
    for (const JsonValue& entry : value.array()) {
        Axis axis = read_axis(entry);
        if (has_letter(before, axis.letter) || has_letter(chain, axis.letter)) {
            entry.fail("machine.duplicate_letter",
                       std::string("letter ") + axis.letter +
                           " is taken by another axis; choose a free one");
        }
        chain.push_back(std::move(axis));
    }
    return chain;
}

// The capsule or mesh of an envelope part or a body.
std::variant<Capsule, EnvelopeMesh> read_shape(const JsonValue& value,
                                               const std::filesystem::path& folder) {
    const JsonObject object =
        value.object({"type", "link", "from", "to", "radius", "file", "note"});
    if (object.required("type").one_of({"capsule", "mesh"}) == 0) {
        (void)value.object({"type", "link", "from", "to", "radius", "note"});
        return Capsule{.from_mm = position(object.required("from")),
                       .to_mm = position(object.required("to")),
                       .radius_mm = object.required("radius").number(kPositive)};
    }
    (void)value.object({"type", "link", "file", "note"});
    const std::filesystem::path name = object.required("file").string();
    return EnvelopeMesh{.file = (name.is_absolute() ? name : folder / name).string()};
}

MachineBody read_body(const JsonValue& value, const std::vector<Axis>& mandrel_chain,
                      const std::filesystem::path& folder) {
    MachineBody body{{}, read_shape(value, folder)};
    const JsonValue link =
        value.object({"type", "link", "from", "to", "radius", "file", "note"}).required("link");
    if (link.string() != "base") {
        body.link = axis_letter(link);
        if (!has_letter(mandrel_chain, *body.link)) {
            link.fail("machine.link", std::string("axis ") + *body.link +
                                          " is not in the mandrel chain; name the axis that "
                                          "carries the body, or \"base\"");
        }
    }
    return body;
}

MandrelMount read_mount(const JsonValue& value) {
    const JsonObject object = value.object({"origin", "x", "z", "note"});
    MandrelMount mount;
    if (const auto origin = object.optional("origin")) {
        mount.origin_mm = position(*origin);
    }
    if (const auto x = object.optional("x")) {
        mount.x = unit_vector(*x);
    }
    if (const auto z = object.optional("z")) {
        mount.z = unit_vector(*z);
    }
    if (std::abs(mount.x.dot(mount.z)) > kUnitTolerance) {
        value.fail("machine.mount",
                   "x and z are not at right angles; give both, or leave both out");
    }
    // Six digits are enough in the file; inside the axes are at right angles to the last bit.
    mount.x = (mount.x - mount.x.dot(mount.z) * mount.z).normalized();
    return mount;
}

EnvelopePart read_part(const JsonValue& value, const std::vector<Axis>& eye_chain,
                       const std::filesystem::path& folder) {
    const JsonObject object =
        value.object({"type", "link", "from", "to", "radius", "file", "note"});
    EnvelopePart part;
    const JsonValue link = object.required("link");
    part.link = axis_letter(link);
    if (!has_letter(eye_chain, part.link)) {
        link.fail("machine.link", std::string("axis ") + part.link +
                                      " is not in the eye chain; name the axis that carries it");
    }
    part.shape = read_shape(value, folder);
    return part;
}

EyeHead read_eye(const JsonValue& value, const std::vector<Axis>& eye_chain,
                 const std::filesystem::path& folder) {
    const JsonObject object = value.object({"position", "roller", "exit", "envelope"});
    EyeHead eye;
    eye.position_mm = position(object.required("position"));
    eye.roller = unit_vector(object.required("roller"));
    eye.exit = unit_vector(object.required("exit"));
    if (std::abs(eye.roller.dot(eye.exit)) > kUnitTolerance) {
        value.fail("machine.eye",
                   "roller and exit are not at right angles; the fibre leaves "
                   "across the roller");
    }
    if (const auto envelope = object.optional("envelope")) {
        for (const JsonValue& part : envelope->array()) {
            eye.envelope.push_back(read_part(part, eye_chain, folder));
        }
    }
    return eye;
}

FibreLimits read_fibre(const JsonValue& value) {
    const JsonObject object =
        value.object({"min_free_length", "max_free_length", "take_up", "max_speed"});
    FibreLimits fibre;
    const JsonValue least = object.required("min_free_length");
    fibre.min_free_length_mm = least.number(kLength);
    fibre.max_free_length_mm = object.required("max_free_length").number(kPositive);
    if (!(fibre.min_free_length_mm < fibre.max_free_length_mm)) {
        least.fail("machine.limits", "is not below max_free_length; exchange them");
    }
    fibre.take_up_mm = object.required("take_up").number(kLength);
    fibre.max_speed_mm_s =
        object.required("max_speed").number(kPositive) * kMmPerM / kSecondsPerMinute;
    return fibre;
}

std::vector<std::string> read_lines(const JsonObject& object, std::string_view key) {
    std::vector<std::string> lines;
    if (const auto value = object.optional(key)) {
        for (const JsonValue& line : value->array()) {
            lines.push_back(line.string());
            if (lines.back().find_first_of("\r\n") != std::string::npos) {
                line.fail("machine.comment", "holds a line break; write one entry per line");
            }
        }
    }
    return lines;
}

Controller read_controller(const JsonValue& value) {
    const JsonObject object =
        value.object({"dialect", "feed", "header", "footer", "program_number"});
    Controller controller;
    controller.dialect = object.required("dialect").string();
    if (const auto feed = object.optional("feed")) {
        controller.feed = feed->one_of({"inverse-time", "per-minute"}) == 0 ? FeedMode::InverseTime
                                                                            : FeedMode::PerMinute;
    }
    controller.header = read_lines(object, "header");
    controller.footer = read_lines(object, "footer");
    if (const auto number = object.optional("program_number")) {
        constexpr int kLargestProgramNumber = 99'999'999;  // eight digits, the longest O word
        controller.program_number =
            static_cast<std::int32_t>(number->integer(1, kLargestProgramNumber));
    }
    return controller;
}

Machine machine_from(const JsonDocument& document, const std::string& file) {
    const JsonObject object =
        document.root().object({"schema", "name", "description", "mandrel_chain", "eye_chain",
                                "mandrel", "eye", "bodies", "fibre", "controller"});
    const JsonValue schema = object.required("schema");
    if (schema.string() != "meshwind-machine-1") {
        schema.fail("machine.schema",
                    "is \"" + schema.string() + "\"; this program reads \"meshwind-machine-1\"");
    }
    if (const auto description = object.optional("description")) {
        (void)description->string();
    }
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    Machine machine;
    machine.name = object.required("name").string();
    const JsonValue mandrel_chain = object.required("mandrel_chain");
    machine.mandrel_chain = read_chain(mandrel_chain, {});
    if (machine.mandrel_chain.empty()) {
        mandrel_chain.fail("machine.missing_axis", "has no axis; list at least one");
    }
    machine.eye_chain = read_chain(object.required("eye_chain"), machine.mandrel_chain);
    if (const auto mount = object.optional("mandrel")) {
        machine.mount = read_mount(*mount);
    }
    machine.eye = read_eye(object.required("eye"), machine.eye_chain, folder);
    if (const auto bodies = object.optional("bodies")) {
        for (const JsonValue& body : bodies->array()) {
            machine.bodies.push_back(read_body(body, machine.mandrel_chain, folder));
        }
    }
    machine.fibre = read_fibre(object.required("fibre"));
    machine.controller = read_controller(object.required("controller"));
    return machine;
}

}  // namespace

Machine read_machine(const std::string& file) {
    return machine_from(JsonDocument::load(file), file);
}

Machine parse_machine(std::string_view text, const std::string& file) {
    return machine_from(JsonDocument::parse(text, file), file);
}

}  // namespace meshwind
