#include "machines/machine_json.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <utility>

#include "core/text/key_table.h"
#include "core/text/strict_json.h"
#include "core/units.h"
#include "machines/controller_json.h"

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
constexpr JsonRange kPlace{.min = -kLargestNumber, .max = kLargestNumber};

constexpr std::string_view kForm = "meshwind-machine-1";
constexpr std::string_view kBaseWord = "base";
constexpr const char* kLetterPattern = "^[A-Z]$";
constexpr const char* kLetterOrBasePattern = "^([A-Z]|base)$";

// Rows that several tables have.

template <typename Owner>
Key<Owner> unit_vector(std::string_view name, Eigen::Vector3d Owner::*field,
                       std::string_view meaning) {
    return {name, meaning, vector_schema(), [field](const JsonValue& value, Owner& owner) {
                const Eigen::Vector3d vector = value.vector3();
                if (!(std::abs(vector.norm() - 1.0) < kUnitTolerance)) {
                    value.fail("machine.direction", "is not a unit vector; give it length 1");
                }
                owner.*field = vector.normalized();
            }};
}

template <typename Owner>
Key<Owner> position(std::string_view name, Eigen::Vector3d Owner::*field,
                    std::string_view meaning) {
    return {name, meaning, vector_schema(kPlace), [field](const JsonValue& value, Owner& owner) {
                const Eigen::Vector3d vector = value.vector3();
                if (!(vector.cwiseAbs().maxCoeff() <= kLargestNumber)) {
                    value.fail("json.out_of_range", "lies beyond 1e6 mm; write mm");
                }
                owner.*field = vector;
            }};
}

// Read by nobody but people.
template <typename Owner>
Key<Owner> remark(std::string_view name) {
    return or_null<Owner>({name,
                           "for the reader of the file",
                           {{"type", "string"}},
                           [](const JsonValue& value, Owner&) { (void)value.string(); }});
}

char axis_letter(const JsonValue& value) {
    const std::string text = value.string();
    if (text.size() != 1 || text[0] < 'A' || text[0] > 'Z') {
        value.fail("machine.letter", "is \"" + text + "\"; write one capital letter A to Z");
    }
    return text[0];
}

SchemaJson pattern_schema(const char* pattern) {
    return {{"type", "string"}, {"pattern", pattern}};
}

SchemaJson reference_to(const char* definition) {
    return {{"$ref", std::string("#/$defs/") + definition}};
}

// Axes.

// In mm or degrees in the file, by the type of the axis.
Key<Axis> axis_number(std::string_view name, double Axis::*field, const JsonRange& range,
                      std::string_view meaning) {
    return {name, meaning, number_schema(range), [=](const JsonValue& value, Axis& axis) {
                const double unit = axis.type == AxisType::Rotary ? rad_from_deg(1.0) : 1.0;
                axis.*field = unit * value.number(range);
            }};
}

std::int64_t resolution_nano(const JsonValue& value) {
    const double nano = value.number(kPositive) * kNanoPerUnit;
    if (std::abs(nano - std::round(nano)) > kNanoSlack || nano < 0.5) {
        value.fail("machine.resolution", "has more than nine decimals; write a multiple of 1e-9");
    }
    return std::llround(nano);
}

const KeyTable<Axis>& axis_keys() {
    static const KeyTable<Axis> kTable = {
        {
            required<Axis>(
                {"letter", "name of the axis in the program", pattern_schema(kLetterPattern),
                 [](const JsonValue& value, Axis& axis) { axis.letter = axis_letter(value); }}),
            required(word("type", &Axis::type, {"linear", "rotary"},
                          "linear counts mm, rotary degrees")),
            required(unit_vector("direction", &Axis::direction,
                                 "unit vector: which way it moves, or what it turns about "
                                 "right-handed, when its number grows")),
            or_null(position("point", &Axis::point_mm,
                             "a point on the line that a rotary axis turns about, mm")),
            or_null(axis_number("min", &Axis::min, {},
                                "lower end of the travel, mm or deg; null: none")),
            or_null(axis_number("max", &Axis::max, {},
                                "upper end of the travel, above min; null: none")),
            required(axis_number("velocity", &Axis::velocity, kPositive, "mm/s or deg/s")),
            required(
                axis_number("acceleration", &Axis::acceleration, kPositive, "mm/s2 or deg/s2")),
            or_null(axis_number("jerk", &Axis::jerk, {.min = 0.0, .above_min = true},
                                "mm/s3 or deg/s3; null: no limit")),
            required<Axis>({"resolution", "smallest step, mm or deg; a multiple of 1e-9",
                            number_schema(kPositive),
                            [](const JsonValue& value, Axis& axis) {
                                axis.resolution_nano = resolution_nano(value);
                            }}),
            remark<Axis>("note"),
        },
        [](const JsonObject& object, Axis& axis) {
            if (!(axis.min < axis.max)) {
                object.required("min").fail(
                    "machine.limits",
                    "is not below max; exchange them, or write null for no limit");
            }
        }};
    return kTable;
}

Key<Machine> chain_key(const char* name, std::vector<Axis> Machine::*field, bool may_be_empty,
                       std::string_view meaning) {
    SchemaJson schema = {{"type", "array"}, {"items", reference_to("axis")}};
    if (!may_be_empty) {
        schema["minItems"] = 1;
    }
    return {name, meaning, schema, [=](const JsonValue& value, Machine& machine) {
                for (const JsonValue& entry : value.array()) {
                    Axis& axis = (machine.*field).emplace_back();
                    axis.min = -kInfinity;
                    axis.max = kInfinity;
                    axis.jerk = kInfinity;
                    read_keys(axis_keys(), entry, axis);
                }
                if ((machine.*field).empty() && !may_be_empty) {
                    value.fail("machine.missing_axis", "has no axis; list at least one");
                }
            }};
}

// Parts of the head, and bodies beside it.

Key<EnvelopePart> link_key(const EnvelopePart&) {
    return {"link", "axis of the eye chain that carries it", pattern_schema(kLetterPattern),
            [](const JsonValue& value, EnvelopePart& part) { part.link = axis_letter(value); }};
}

Key<MachineBody> link_key(const MachineBody&) {
    return {"link", "axis of the mandrel chain that carries it, or base",
            pattern_schema(kLetterOrBasePattern), [](const JsonValue& value, MachineBody& body) {
                if (value.string() != kBaseWord) {
                    body.link = axis_letter(value);
                }
            }};
}

// A row of a part that is of its shape.
template <typename Part, typename Shape>
Key<Part> of_shape(Key<Shape> key) {
    return required<Part>({key.name, key.meaning, key.schema,
                           [read = std::move(key.read)](const JsonValue& value, Part& part) {
                               read(value, std::get<Shape>(part.shape));
                           }});
}

// By the word under "type" a part is a shape from the start.
template <typename Part, typename Shape>
Key<Part> type_key(std::string_view name) {
    return required<Part>({"type", "", {{"const", name}}, [](const JsonValue&, Part& part) {
                               part.shape = Shape{};
                           }});
}

template <typename Part>
const KeyTable<Part>& capsule_keys() {
    static const KeyTable<Part> kTable = {{
        type_key<Part, Capsule>("capsule"),
        required(link_key(Part{})),
        of_shape<Part>(position("from", &Capsule::from_mm, "one end of the capsule's axis, mm")),
        of_shape<Part>(position("to", &Capsule::to_mm, "its other end, mm")),
        of_shape<Part>(required(number("radius", &Capsule::radius_mm, kPositive, "mm"))),
        remark<Part>("note"),
    }};
    return kTable;
}

// What "file" says counts from the machine file: resolve_meshes.
template <typename Part>
const KeyTable<Part>& mesh_keys() {
    static const KeyTable<Part> kTable = {{
        type_key<Part, EnvelopeMesh>("mesh"),
        required(link_key(Part{})),
        of_shape<Part>(any_text("file", &EnvelopeMesh::file,
                                "mesh in mm; the name counts from the machine file")),
        remark<Part>("note"),
    }};
    return kTable;
}

template <typename Part>
JsonObject part_object(const JsonValue& value) {
    std::vector<std::string_view> names = names_of(capsule_keys<Part>());
    for (const std::string_view name : names_of(mesh_keys<Part>())) {
        if (std::find(names.begin(), names.end(), name) == names.end()) {
            names.push_back(name);
        }
    }
    return value.object(names);
}

template <typename Owner, typename Part>
Key<Owner> parts_key(std::string_view name, std::vector<Part> Owner::*field, const char* capsule,
                     const char* mesh, std::string_view meaning) {
    const SchemaJson items = {
        {"oneOf", SchemaJson::array({reference_to(capsule), reference_to(mesh)})}};
    return or_null<Owner>({name,
                           meaning,
                           {{"type", "array"}, {"items", items}},
                           [field](const JsonValue& value, Owner& owner) {
                               for (const JsonValue& entry : value.array()) {
                                   const bool is_capsule =
                                       part_object<Part>(entry).required("type").one_of(
                                           {"capsule", "mesh"}) == 0;
                                   read_keys(is_capsule ? capsule_keys<Part>() : mesh_keys<Part>(),
                                             entry, (owner.*field).emplace_back());
                               }
                           }});
}

// The other objects.

const KeyTable<MandrelMount>& mount_keys() {
    static const KeyTable<MandrelMount> kTable = {
        {
            or_null(position("origin", &MandrelMount::origin_mm, "its origin, mm")),
            or_null(unit_vector("x", &MandrelMount::x, "unit vector of its X axis")),
            or_null(unit_vector("z", &MandrelMount::z,
                                "unit vector of its Z axis, the spindle; at a right angle to x")),
            remark<MandrelMount>("note"),
        },
        [](const JsonObject& object, MandrelMount& mount) {
            if (std::abs(mount.x.dot(mount.z)) > kUnitTolerance) {
                object.value().fail(
                    "machine.mount",
                    "x and z are not at right angles; give both, or leave both out");
            }
            // Six digits are enough in the file; inside the axes are at right angles to the last
            // bit.
            mount.x = (mount.x - mount.x.dot(mount.z) * mount.z).normalized();
        }};
    return kTable;
}

const KeyTable<EyeHead>& eye_head_keys() {
    static const KeyTable<EyeHead> kTable = {
        {
            required(position("position", &EyeHead::position_mm, "mm")),
            required(unit_vector("roller", &EyeHead::roller, "unit vector along the roller")),
            required(unit_vector("exit", &EyeHead::exit,
                                 "unit vector of the way out, normal to the roller")),
            parts_key("envelope", &EyeHead::envelope, "capsule", "mesh",
                      "parts of the head that must not touch the mandrel, each on an axis of the "
                      "eye chain"),
        },
        [](const JsonObject& object, EyeHead& eye) {
            if (std::abs(eye.roller.dot(eye.exit)) > kUnitTolerance) {
                object.value().fail("machine.eye",
                                    "roller and exit are not at right angles; the fibre leaves "
                                    "across the roller");
            }
        }};
    return kTable;
}

const KeyTable<FibreLimits>& fibre_keys() {
    static const KeyTable<FibreLimits> kTable = {
        {
            required(number("min_free_length", &FibreLimits::min_free_length_mm, kLength,
                            "shortest fibre between mandrel and eye, mm")),
            required(number("max_free_length", &FibreLimits::max_free_length_mm, kPositive,
                            "longest, mm")),
            required(number("take_up", &FibreLimits::take_up_mm, kLength,
                            "length the tensioner can take back, mm")),
            required<FibreLimits>(
                {"max_speed", "highest speed of the fibre, m/min", number_schema(kPositive),
                 [](const JsonValue& value, FibreLimits& fibre) {
                     fibre.max_speed_mm_s = value.number(kPositive) * kMmPerM / kSecondsPerMinute;
                 }}),
        },
        [](const JsonObject& object, FibreLimits& fibre) {
            if (!(fibre.min_free_length_mm < fibre.max_free_length_mm)) {
                object.required("min_free_length")
                    .fail("machine.limits", "is not below max_free_length; exchange them");
            }
        }};
    return kTable;
}

// What the keys of the whole file ask of each other.

void check_letters(const JsonObject& object, const Machine& machine) {
    std::set<char> taken;
    for (const auto& [name, chain] : {std::pair("mandrel_chain", &machine.mandrel_chain),
                                      std::pair("eye_chain", &machine.eye_chain)}) {
        const std::vector<JsonValue> entries = object.required(name).array();
        for (std::size_t i = 0; i < chain->size(); ++i) {
            const char letter = (*chain)[i].letter;
            if (!taken.insert(letter).second) {
                entries[i].fail("machine.duplicate_letter",
                                std::string("letter ") + letter +
                                    " is taken by another axis; choose a free one");
            }
        }
    }
}

template <typename Part>
void check_links(const std::optional<JsonValue>& list, const std::vector<Part>& parts,
                 const std::vector<Axis>& chain, const std::string& words) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::optional<char> link = parts[i].link;
        if (link && std::none_of(chain.begin(), chain.end(),
                                 [&](const Axis& axis) { return axis.letter == *link; })) {
            part_object<Part>(list->array()[i])
                .required("link")
                .fail("machine.link", std::string("axis ") + *link + words);
        }
    }
}

const KeyTable<Machine>& machine_keys() {
    static const KeyTable<Machine> kTable = {
        {
            required<Machine>({"schema",
                               "form of the file",
                               {{"const", kForm}},
                               [](const JsonValue& value, Machine&) {
                                   if (value.string() != kForm) {
                                       value.fail("machine.schema",
                                                  "is \"" + value.string() +
                                                      "\"; this program reads \"" +
                                                      std::string(kForm) + "\"");
                                   }
                               }}),
            required(any_text("name", &Machine::name, "for report and program")),
            remark<Machine>("description"),
            required(chain_key("mandrel_chain", &Machine::mandrel_chain, false,
                               "axes that carry the mandrel, from the base outward")),
            required(chain_key("eye_chain", &Machine::eye_chain, true,
                               "axes that carry the eye, from the base outward; empty: the eye "
                               "stands still")),
            or_null<Machine>({"mandrel",
                              "the mandrel's frame in the machine frame; without it that of the "
                              "spindle, or both are "
                              "the same",
                              keys_schema(mount_keys()),
                              [](const JsonValue& value, Machine& machine) {
                                  read_keys(mount_keys(), value, machine.mount.emplace());
                              }}),
            required(
                object("eye", &Machine::eye, eye_head_keys(), "where the fibre leaves the head")),
            parts_key("bodies", &Machine::bodies, "bodyCapsule", "bodyMesh",
                      "parts that fibre and envelope keep clear of, on an axis of the mandrel "
                      "chain or on the base"),
            required(object("fibre", &Machine::fibre, fibre_keys(),
                            "what the way of the fibre through the machine allows")),
            required(object("controller", &Machine::controller, controller_keys(),
                            "what reads the program")),
        },
        [](const JsonObject& object, Machine& machine) {
            check_letters(object, machine);
            check_robot_letters(object.required("controller"), machine);
            check_links(
                object.required("eye").object(names_of(eye_head_keys())).optional("envelope"),
                machine.eye.envelope, machine.eye_chain,
                " is not in the eye chain; name the axis that carries it");
            check_links(object.optional("bodies"), machine.bodies, machine.mandrel_chain,
                        " is not in the mandrel chain; name the axis that carries the body, or "
                        "\"base\"");
        }};
    return kTable;
}

template <typename Part>
void resolve_meshes(std::vector<Part>& parts, const std::filesystem::path& folder) {
    for (Part& part : parts) {
        if (auto* const mesh = std::get_if<EnvelopeMesh>(&part.shape)) {
            const std::filesystem::path name = mesh->file;
            mesh->file = (name.is_absolute() ? name : folder / name).string();
        }
    }
}

Machine machine_from(const JsonDocument& document, const std::string& file) {
    Machine machine;
    read_keys(machine_keys(), document.root(), machine);
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    resolve_meshes(machine.eye.envelope, folder);
    resolve_meshes(machine.bodies, folder);
    return machine;
}

}  // namespace

Machine read_machine(const std::string& file) {
    return machine_from(JsonDocument::load(file), file);
}

Machine parse_machine(std::string_view text, const std::string& file) {
    return machine_from(JsonDocument::parse(text, file), file);
}

std::string machine_schema_text() {
    SchemaJson schema = {
        {"$schema", "https://json-schema.org/draft/2020-12/schema"},
        {"title", "meshwind machine file"},
        {"description",
         "Lengths mm, angles degrees, times s; directions and points in the machine frame with all "
         "axes at zero. The reader checks more: unit lengths, unique letters, min below max, links "
         "that exist."}};
    schema.update(keys_schema(machine_keys()));
    schema["$defs"] = {{"axis", keys_schema(axis_keys())},
                       {"capsule", keys_schema(capsule_keys<EnvelopePart>())},
                       {"mesh", keys_schema(mesh_keys<EnvelopePart>())},
                       {"bodyCapsule", keys_schema(capsule_keys<MachineBody>())},
                       {"bodyMesh", keys_schema(mesh_keys<MachineBody>())}};
    return schema.dump(2) + "\n";
}

}  // namespace meshwind
