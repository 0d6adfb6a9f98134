#include "pipeline/job/job_keys.h"

#include "pipeline/job/face_word.h"
#include "pipeline/job/job_ranges.h"
#include "pipeline/job/layer_keys.h"

namespace meshwind {
namespace {

using Words = std::vector<std::string_view>;

// Mandrel.

Key<Job::MandrelJob> axis_key() {
    const SchemaJson vector = vector_schema();
    const SchemaJson axis = {{"type", "object"},
                             {"additionalProperties", false},
                             {"required", SchemaJson::array({"origin", "direction"})},
                             {"properties", {{"origin", vector}, {"direction", vector}}}};
    const auto read = [](const JsonValue& value, Job::MandrelJob& mandrel) {
        if (is_auto(value)) {
            return;
        }
        const JsonObject object = value.object({"origin", "direction"});
        const JsonValue direction = object.required("direction");
        mandrel.axis = {object.required("origin").vector3(), direction.vector3()};
        if (mandrel.axis->direction.isZero(0.0)) {
            direction.fail("job.zero_direction",
                           "all three numbers are 0; give the direction of the spindle");
        }
    };
    const auto text = [](const Job::MandrelJob& mandrel) {
        return mandrel.axis ? "{\"origin\":" + vector_text(mandrel.axis->origin) +
                                  ", \"direction\":" + vector_text(mandrel.axis->direction) + "}"
                            : string_text(kAutoWord);
    };
    return {"axis", "spindle axis in the file's frame and units", or_word(kAutoWord, axis), read,
            text};
}

// A list, or "auto" where there is none. \param none as JSON, empty: left out
template <typename Entry, typename Read, typename Text>
Key<Job::MandrelJob> list_key(std::string_view name, std::vector<Entry> Job::MandrelJob::*field,
                              const SchemaJson& entry, const std::string& none,
                              std::string_view meaning, const Read& read_one, const Text& text_of) {
    const SchemaJson list = {{"type", "array"}, {"minItems", 1}, {"items", entry}};
    const auto read = [=](const JsonValue& value, Job::MandrelJob& mandrel) {
        if (is_auto(value)) {
            return;
        }
        for (const JsonValue& one : value.array()) {
            (mandrel.*field).push_back(read_one(one));
        }
        if ((mandrel.*field).empty()) {
            value.fail("json.out_of_range", "is empty; list some or write \"auto\"");
        }
    };
    const auto text = [=](const Job::MandrelJob& mandrel) {
        std::string all;
        for (const Entry& one : mandrel.*field) {
            all += (all.empty() ? "" : ",") + text_of(one);
        }
        return all.empty() ? none : "[" + all + "]";
    };
    return {name, meaning, or_word(kAutoWord, list), read, text};
}

Key<Job::MandrelJob> regions_key() {
    return list_key(
        "keep_regions", &Job::MandrelJob::keep_regions, count_schema(0, kMaxId),
        string_text(kAutoWord),
        "ids of the regions that are wound, as meshwind inspect lists them; auto: the outer wall",
        [](const JsonValue& id) { return static_cast<std::int32_t>(id.integer(0, kMaxId)); },
        [](std::int32_t id) { return std::to_string(id); });
}

Key<Job::MandrelJob> faces_key() {
    return list_key("keep_faces", &Job::MandrelJob::keep_faces, face_word_schema(), "",
                    "instead of regions: the faces of a CAD file that are wound, by number, kind "
                    "or colour (\"#ff0000\"), as meshwind inspect lists them",
                    read_face_word, face_word_text);
}

const KeyTable<PinConstraints>& pin_keys() {
    static const KeyTable<PinConstraints> kTable = {{
        count_or_auto("count", &PinConstraints::count, kMaxPins,
                      "pins of a ring; of a pattern a multiple of its circuits, auto: as many; "
                      "of courses auto: 1.25 tow widths apart"),
        number("diameter", &PinConstraints::diameter_mm, kLengthRange, "mm, of a pin"),
        number_or_auto("height", &PinConstraints::height_mm, kLengthRange,
                       "mm over the extension; auto: that which leaves the free fibre most room"),
        count_or_auto("skip", &PinConstraints::skip, kMaxPins,
                      "pins that a turn runs behind; auto: as few as can be"),
        number_or_auto("offset", &PinConstraints::offset_mm, kLengthRange,
                       "least mm from the rim to the pins' axes; auto: a tow width and a diameter. "
                       "What closes the pattern is added"),
    }};
    return kTable;
}

Key<Job::MandrelJob> mesh_key() {
    using Mesh = MandrelOptions::Mesh;
    Key<Job::MandrelJob> key =
        word("mesh", &Job::MandrelJob::mesh, {"file", "even"},
             "triangles that are wound; even: where the file's are uneven, even ones over the "
             "surface that its vertices stand for; file: the file's own in any case");
    key.text = [text = key.text](const Job::MandrelJob& mandrel) {
        return mandrel.mesh == Mesh::Even ? std::string() : text(mandrel);
    };
    return key;
}

// Left out where nothing is blended.
Key<Job::MandrelJob> blend_key() {
    const auto read = [](const JsonValue& value, Job::MandrelJob& mandrel) {
        mandrel.blend_mm = is_auto(value) ? std::nullopt : std::optional(value.number(kCutRange));
    };
    const auto text = [](const Job::MandrelJob& mandrel) {
        if (mandrel.blend_mm == 0.0) {
            return std::string();
        }
        return mandrel.blend_mm ? number_text(*mandrel.blend_mm) : string_text(kAutoWord);
    };
    return {"blend",
            "mm, radius of a ball: crotches and steps that it cannot touch are filled up smoothly; "
            "the part has to be made so. auto: none where that does, else the smallest of one to "
            "four tow widths with which fibre reaches nearly as much as with any",
            or_word(kAutoWord, number_schema(kCutRange)), read, text};
}

// The key, and a flag that it was given, which is told also where it says the default.
template <typename Owner>
Key<Owner> told(Key<Owner> key, bool Owner::*given) {
    key.read = [read = std::move(key.read), given](const JsonValue& value, Owner& owner) {
        read(value, owner);
        owner.*given = true;
    };
    key.told = [text = key.text, given](const Owner& owner, const Owner& defaults) {
        const std::string is = text(owner);
        return owner.*given || is != text(defaults) ? is : std::string();
    };
    return key;
}

Key<Job::MandrelJob> turn_key() {
    static const std::string kMeaning = [] {
        std::string text =
            "how the fibre turns there; where it is not given, and friction does not "
            "do, pins are tried";
        for (const TurnKindTraits& turn : turn_kinds()) {
            if (!turn.meaning.empty()) {
                text += "; " + std::string(turn.word) + ": " + std::string(turn.meaning);
            }
        }
        return text;
    }();
    Words words;
    for (const TurnKindTraits& turn : turn_kinds()) {
        words.push_back(turn.word);
    }
    return word("turn", &Job::MandrelJob::turn, words, kMeaning);
}

const KeyTable<Job::MandrelJob>& mandrel_keys() {
    using Owner = Job::MandrelJob;
    static const KeyTable<Owner> kTable = {{
        word("units", &Owner::units, length_words(),
             "length of a unit of the mandrel's file; auto: what the file states, else mm, else "
             "metres if the part is under 10 units"),
        axis_key(),
        regions_key(),
        faces_key(),
        number("cut_ends", &Owner::cut_ends_mm, kCutRange,
               "mm that are cut off each end; without it rounded lips, tabs and notches, which are "
               "no part of the end's leg"),
        number("remove_details", &Owner::remove_details_mm, kCutRange,
               "mm up to which lettering, logos and specks stand out of the wall, or go into it, "
               "that are not wound but taken off; without it 1 mm, where the file's triangles are "
               "uneven"),
        blend_key(),
        mesh_key(),
        any_text("solid", &Owner::solid,
                 "of a CAD file with several solids: the name or number of the one to be wound, as "
                 "the message that refuses the file lists them"),
        number("edge", &Owner::edge_mm, kLengthRange,
               "mm, longest edge of the triangles over a CAD file's faces; without it by the "
               "part's size, and shorter where a face is curved"),
        told(number("extension", &Owner::extension_mm, kExtensionRange,
                    "mm of room beyond each rim where the fibre turns; where it is not given, and "
                    "checks fail, longer ones are tried, and with pins it is what they need"),
             &Owner::extension_given),
        told(turn_key(), &Owner::turn_given),
        only_if<Owner>([](const Owner& mandrel) { return traits_of(mandrel.turn).reads_pins; },
                       "job.pins_unused",
                       "only \"turn\": \"pins\" reads it; write that, or remove it",
                       object("pins", &Owner::pins, pin_keys(),
                              "the rings of pins; with turn pins only. What is chosen stands in "
                              "plan.pins of report.json")),
    }};
    return kTable;
}

// Tow, tolerance, speed.

const KeyTable<Job::TowJob>& tow_keys() {
    using Owner = Job::TowJob;
    static const KeyTable<Owner> kTable = {{
        number("width", &Owner::width_mm, kBandRange, "mm, of the band as it lies"),
        number("thickness", &Owner::thickness_mm, kThicknessRange, "mm, of the band as it lies"),
        number("friction", &Owner::friction, kFrictionRange, "largest slip ratio that holds"),
        number(
            "friction_on_fibre", &Owner::friction_on_fibre, kFrictionRange,
            "the same of all layers but the first, which lie on fibre, with their turns; without "
            "it as friction"),
        number("bridging_tolerance", &Owner::bridging_tolerance_mm, kGapRange,
               "mm, largest gap under the fibre"),
        number("max_twist_per_m", &Owner::most_twist_per_m, kTwistRange,
               "turns a metre by which the head may twist the band, for a tape; without it any"),
        number("density", &Owner::density_g_cm3, kDensityRange,
               "g/cm3 of the tow as it is laid, resin included; for masses in the report"),
        number("price_per_kg", &Owner::price_per_kg, kPriceRange,
               "of the tow as it is laid, in any currency; for the price in the report"),
    }};
    return kTable;
}

const KeyTable<Job::ToleranceJob>& tolerance_keys() {
    using Owner = Job::ToleranceJob;
    static const KeyTable<Owner> kTable = {{
        number("laydown", &Owner::laydown_mm, kDeviationRange,
               "mm between laid and planned fibre, sideways"),
        number("laydown_angle", &Owner::laydown_angle_deg, kDeviationRange,
               "degrees between the directions of laid and planned fibre"),
        number("clearance", &Owner::clearance_mm, kClearanceRange,
               "mm between machine or free fibre and mandrel"),
        number(
            "bare", &Owner::bare, kShareRange,
            "share of the wall in reach that a layer may leave bare, or a wall thinner than asked"),
    }};
    return kTable;
}

const KeyTable<Job::SpeedJob>& speed_keys() {
    static const KeyTable<Job::SpeedJob> kTable = {
        {number("fibre", &Job::SpeedJob::fibre_m_min, kSpeedRange, "m/min of fibre")}};
    return kTable;
}

// Layers.

Key<Job> layers_key() {
    const SchemaJson schema = {
        {"type", "array"},
        {"minItems", 1},
        {"default", SchemaJson::array({SchemaJson::object({{"kind", layer_words().front()}})})},
        {"items", keys_schema(layer_keys())}};
    return {"layers",
            "what is wound, in this order",
            schema,
            [](const JsonValue& value, Job& job) {
                job.layers.clear();
                for (const JsonValue& layer : value.array()) {
                    read_keys(layer_keys(), layer, job.layers.emplace_back());
                }
                if (job.layers.empty()) {
                    value.fail("json.out_of_range",
                               "is empty; give one layer at least, or leave it out");
                }
            },
            [](const Job& job) {
                std::string text;
                for (const LayerJob& layer : job.layers) {
                    text += text.empty() ? "{" : ",\n             {";
                    text += keys_text(layer_keys(), layer) + "}";
                }
                return "[" + text + "]";
            },
            [](const Job& job, const Job& defaults) {
                std::string text;
                for (const LayerJob& layer : job.layers) {
                    text += text.empty() ? "{" : ",{";
                    text += told_keys_text(layer_keys(), layer, LayerJob{}) + "}";
                }
                const bool same = job.layers.size() == defaults.layers.size() && text == "{}";
                return same ? std::string() : "[" + text + "]";
            }};
}

// The rules with planes leave no turn to choose, and "central-angle" is the word for that.
bool turn_is_forced(const Job& job) {
    return traits_of(job.eye.rule).forces_turn;
}

// The same for the schema.
SchemaJson forced_turn_rule() {
    SchemaJson forced = SchemaJson::array();
    for (const EyeRuleTraits& rule : kEyeRules) {
        if (rule.forces_turn) {
            forced.push_back(rule.word);
        }
    }
    SchemaJson all = schema_rules(R"({"allOf": [
      {"if": {"required": ["eye"],
              "properties": {"eye": {"required": ["rule"], "properties": {"rule": {}}}}},
       "then": {"properties": {"redundancy": {"const": "central-angle"}}}}
    ]})");
    all["allOf"][0]["if"]["properties"]["eye"]["properties"]["rule"]["enum"] = forced;
    return all;
}

}  // namespace

const Words& length_words() {
    static const Words kWords = {"auto", "um", "mm", "cm", "m", "in"};
    return kWords;
}

const Words& layer_words() {
    static const Words kWords = {"auto",  "helical",  "hoop",    "polar",
                                 "cover", "imported", "lattice", "wall"};
    return kWords;
}

const KeyTable<Job>& job_keys() {
    static const KeyTable<Job> kTable = {
        {
            object("mandrel", &Job::mandrel, mandrel_keys(),
                   "the part: how its file is read and what of it is wound"),
            object("tow", &Job::tow, tow_keys(), "the band that is wound"),
            layers_key(),
            told(count("fibres", &Job::fibres, kMaxFibres,
                       "continuous fibres that may be wound one after the other, each by a program "
                       "of its own; a further one is taken only where it covers more, or where "
                       "the machine cannot follow a turn. Where it is not given, and checks fail, "
                       "more are tried"),
                 &Job::fibres_given),
            object("eye", &Job::eye, eye_keys(), "where the delivery eye is"),
            word("redundancy", &Job::redundancy, {"central-angle", "hold", "oscillate", "optimal"},
                 "how the mandrel turns where several turns would do: with the eye in front of the "
                 "spindle; not until the eye is 90 degrees (hold) or 30 degrees (oscillate) off "
                 "that; or so that winding takes the least time (optimal). The rules with planes "
                 "leave only central-angle, which is then the default"),
            object("tolerance", &Job::tolerance, tolerance_keys(), "what the checks allow"),
            object("speed", &Job::speed, speed_keys(), "how fast it is wound"),
        },
        [](const JsonObject& object, Job& job) {
            if (!turn_is_forced(job)) {
                return;
            }
            const auto said = object.optional("redundancy");
            if (said && job.redundancy != RedundancyRule::CentralAngle) {
                said->fail("job.turn_forced",
                           "the eye rule \"" + std::string(name_of(job.eye.rule)) +
                               "\" says how the mandrel turns; remove \"redundancy\" or choose "
                               "another rule");
            }
            job.redundancy = RedundancyRule::CentralAngle;
        },
        forced_turn_rule()};
    return kTable;
}

}  // namespace meshwind
