#include "cli/job.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "cli/job_ranges.h"
#include "core/text_number.h"
#include "machines/strict_json.h"

namespace meshwind {
namespace {

// The words of the file, in the order of the enumerators.
const std::initializer_list<std::string_view> kUnitWords = {"auto", "um", "mm", "cm", "m", "in"};
const std::initializer_list<std::string_view> kTurnWords = {"friction", "pins", "pole"};
const std::initializer_list<std::string_view> kLayerWords = {"auto",  "helical",  "hoop",   "polar",
                                                             "cover", "imported", "lattice"};
// Those of the order, then none.
const std::initializer_list<std::string_view> kLeadWords = {"leading", "lagging", "any"};
const std::initializer_list<std::string_view> kEyeWords = {
    "equal-free-length", "cylinder", "horizontal-plane", "vertical-plane", "adaptive"};
const std::initializer_list<std::string_view> kRedundancyWords = {"central-angle", "hold",
                                                                  "oscillate", "optimal"};

constexpr JsonRange kAngleDeg = {.min = 0.0, .max = 90.0};

/// Leaves `target` as it is where the key is absent.
void read_number(const JsonObject& object, std::string_view key, const JsonRange& range,
                 double& target) {
    if (const auto value = object.optional(key)) {
        target = value->number(range);
    }
}

template <typename Enum>
void read_word(const JsonObject& object, std::string_view key,
               std::initializer_list<std::string_view> words, Enum& target) {
    if (const auto value = object.optional(key)) {
        target = static_cast<Enum>(value->one_of(words));
    }
}

template <typename Enum>
std::string_view word_of(Enum value, std::initializer_list<std::string_view> words) {
    return words.begin()[static_cast<std::size_t>(value)];
}

std::optional<Job::MandrelAxis> read_axis(const JsonValue& value) {
    if (value.is_string()) {
        (void)value.one_of({"auto"});
        return std::nullopt;
    }
    const JsonObject object = value.object({"origin", "direction"});
    const JsonValue direction = object.required("direction");
    const Job::MandrelAxis axis{object.required("origin").vector3(), direction.vector3()};
    if (axis.direction.isZero(0.0)) {
        direction.fail("job.zero_direction",
                       "all three numbers are 0; give the direction of the spindle");
    }
    return axis;
}

std::vector<std::int32_t> read_regions(const JsonValue& value) {
    std::vector<std::int32_t> regions;
    if (value.is_string()) {
        (void)value.one_of({"auto"});
        return regions;
    }
    for (const JsonValue& id : value.array()) {
        regions.push_back(
            static_cast<std::int32_t>(id.integer(0, std::numeric_limits<std::int32_t>::max())));
    }
    if (regions.empty()) {
        value.fail("json.out_of_range", "is empty; list region ids or write \"auto\"");
    }
    return regions;
}

std::optional<JsonValue> unless_auto(const JsonObject& object, std::string_view key) {
    std::optional<JsonValue> value = object.optional(key);
    if (value && value->is_string()) {
        (void)value->one_of({"auto"});
        return std::nullopt;
    }
    return value;
}

PinWish read_pins(const JsonValue& value) {
    PinWish pins;
    const JsonObject object = value.object({"count", "diameter", "height", "skip", "offset"});
    if (const auto count = unless_auto(object, "count")) {
        pins.count = static_cast<int>(count->integer(1, kMostPins));
    }
    read_number(object, "diameter", kLengthRange, pins.diameter_mm);
    if (const auto height = unless_auto(object, "height")) {
        pins.height_mm = height->number(kLengthRange);
    }
    if (const auto skip = unless_auto(object, "skip")) {
        pins.skip = static_cast<int>(skip->integer(1, kMostPins));
    }
    if (const auto offset = unless_auto(object, "offset")) {
        pins.offset_mm = offset->number(kLengthRange);
    }
    return pins;
}

Job::MandrelJob read_mandrel(const JsonValue& value) {
    Job::MandrelJob mandrel;
    const JsonObject object =
        value.object({"units", "axis", "keep_regions", "extension", "turn", "pins"});
    read_word(object, "units", kUnitWords, mandrel.units);
    if (const auto axis = object.optional("axis")) {
        mandrel.axis = read_axis(*axis);
    }
    if (const auto regions = object.optional("keep_regions")) {
        mandrel.keep_regions = read_regions(*regions);
    }
    read_number(object, "extension", kExtensionRange, mandrel.extension_mm);
    read_word(object, "turn", kTurnWords, mandrel.turn);
    if (const auto pins = object.optional("pins")) {
        if (mandrel.turn != TurnKind::Pins) {
            pins->fail("job.pins_unused",
                       "only \"turn\": \"pins\" reads it; write that, or remove it");
        }
        mandrel.pins = read_pins(*pins);
    }
    return mandrel;
}

Job::TowJob read_tow(const JsonValue& value) {
    Job::TowJob tow;
    const JsonObject object =
        value.object({"width", "thickness", "friction", "bridging_tolerance", "density"});
    read_number(object, "width", kBandRange, tow.width_mm);
    read_number(object, "thickness", kThicknessRange, tow.thickness_mm);
    read_number(object, "friction", kFrictionRange, tow.friction);
    read_number(object, "bridging_tolerance", kGapRange, tow.bridging_tolerance_mm);
    read_number(object, "density", kDensityRange, tow.density_g_cm3);
    return tow;
}

PatternJob read_pattern(const JsonValue& value, LayerKind kind) {
    PatternJob wish;
    const JsonObject object = value.object({"circuits", "starts", "lead", "most_overlap",
                                            "most_dwell_deg", "dwell_deg", "band_offset_mm"});
    for (const char* key : {"circuits", "most_overlap"}) {
        const auto unused = object.optional(key);
        if (unused && kind == LayerKind::Lattice) {
            unused->fail("job.pattern_unused",
                         "a lattice has its \"circuits\" beside \"kind\", and its bands do not "
                         "overlap; remove it");
        }
    }
    if (const auto circuits = object.optional("circuits")) {
        wish.circuits = circuits->integer(1, kMostCircuits);
    }
    if (const auto starts = object.optional("starts")) {
        wish.starts = starts->integer(1, kMostCircuits);
    }
    if (const auto lead = object.optional("lead")) {
        const std::size_t word = lead->one_of(kLeadWords);
        if (word + 1 < kLeadWords.size()) {
            wish.lead = static_cast<BandOrder>(word);
        }
    }
    if (const auto overlap = object.optional("most_overlap")) {
        wish.most_overlap = overlap->number({.min = 0.0, .max = kMostOverlap});
    }
    read_number(object, "dwell_deg", {.min = 0.0, .max = kMostDwell_deg}, wish.dwell_deg);
    if (const auto most = object.optional("most_dwell_deg")) {
        wish.most_dwell_deg = most->number({.min = wish.dwell_deg, .max = kMostDwell_deg});
    }
    read_number(object, "band_offset_mm", kBandRange, wish.band_offset_mm);
    return wish;
}

int read_count(const JsonObject& object, std::string_view key, std::int64_t most, int otherwise) {
    const auto value = object.optional(key);
    return value ? static_cast<int>(value->integer(1, most)) : otherwise;
}

LatticeWish read_lattice(const JsonObject& object) {
    LatticeWish lattice;
    lattice.circuits = static_cast<int>(object.required("circuits").integer(1, kMostCircuits));
    const auto series = object.optional("series");
    if (series && series->is_string()) {
        (void)series->one_of({"fill"});
        lattice.series = 0;
    } else {
        lattice.series = read_count(object, "series", kMostSeries, lattice.series);
    }
    lattice.plies = read_count(object, "plies", kMostPlies, lattice.plies);
    if (const auto unused = object.optional("target_layers")) {
        unused->fail("job.pattern_unused", "a lattice is wound \"plies\" times; write that");
    }
    return lattice;
}

// What only patterns read.
void read_patterns(const JsonObject& object, LayerJob& layer) {
    const bool lattice = layer.kind == LayerKind::Lattice;
    if (lattice) {
        layer.lattice = read_lattice(object);
    }
    for (const char* key : {"circuits", "series", "plies"}) {
        const auto unused = object.optional(key);
        if (unused && !lattice) {
            unused->fail("job.pattern_unused",
                         "only a lattice reads it; a helical or polar layer has \"pattern\": "
                         "{\"circuits\": N}");
        }
    }
    if (const auto pattern = object.optional("pattern")) {
        if (!lattice && layer.kind != LayerKind::Helical && layer.kind != LayerKind::Polar) {
            pattern->fail("job.pattern_unused",
                          "only layers of kind \"helical\", \"polar\" and \"lattice\" read it; "
                          "name one of these, or remove it");
        }
        layer.pattern = read_pattern(*pattern, layer.kind);
    }
}

LayerJob read_layer(const JsonValue& value) {
    LayerJob layer;
    const JsonObject object = value.object(
        {"kind", "angle", "target_layers", "pattern", "circuits", "series", "plies", "file"});
    read_word(object, "kind", kLayerWords, layer.kind);
    read_patterns(object, layer);
    if (object.optional("angle")) {
        read_number(object, "angle", kAngleDeg, layer.angle_deg.emplace());
    }
    read_number(object, "target_layers", kLayersRange, layer.target_layers);
    const auto file = object.optional("file");
    if (file) {
        layer.file = file->string();
    }
    if (layer.kind == LayerKind::Imported && layer.file.empty()) {
        value.fail("job.file_missing",
                   "an imported layer needs \"file\", the CSV of its landing points");
    }
    if (layer.kind != LayerKind::Imported && file) {
        file->fail(
            "job.file_unused",
            "only an imported layer reads a file; remove it or write \"kind\": \"imported\"");
    }
    return layer;
}

std::vector<LayerJob> read_layers(const JsonValue& value) {
    std::vector<LayerJob> layers;
    for (const JsonValue& layer : value.array()) {
        layers.push_back(read_layer(layer));
    }
    if (layers.empty()) {
        value.fail("json.out_of_range", "is empty; give one layer at least, or leave it out");
    }
    return layers;
}

LengthPiece read_length(const JsonValue& value) {
    const JsonObject object = value.object({"course", "from_mm", "to_mm", "free_length"});
    LengthPiece piece;
    const auto course = object.optional("course");
    if (course) {
        piece.piece =
            static_cast<std::int32_t>(course->integer(0, std::numeric_limits<std::int32_t>::max()));
        for (const char* end : {"from_mm", "to_mm"}) {
            if (const auto unused = object.optional(end)) {
                unused->fail("job.eye_unused",
                             "\"course\" names the whole course; remove one of the two");
            }
        }
    } else {
        piece.from_mm = object.required("from_mm").number(kAlongRange);
        piece.to_mm = object.required("to_mm").number(
            {.min = piece.from_mm, .max = kAlongRange.max, .above_min = true});
    }
    piece.free_length_mm = object.required("free_length").number(kLengthRange);
    return piece;
}

// A key belongs to one rule; with others it would say something that nothing does.
void refuse_unused(const JsonObject& object, const EyeLaw& eye, std::string_view key,
                   EyeRule rule) {
    const auto value = object.optional(key);
    if (value && eye.rule != rule) {
        value->fail("job.eye_unused", "only the rule \"" + std::string(word_of(rule, kEyeWords)) +
                                          "\" reads it; remove it or choose that rule");
    }
}

EyeLaw read_eye(const JsonValue& value) {
    EyeLaw eye;
    const JsonObject object =
        value.object({"rule", "free_length", "lengths", "radius", "plane_x", "plane_y"});
    read_word(object, "rule", kEyeWords, eye.rule);
    read_number(object, "free_length", kLengthRange, eye.free_length_mm);
    refuse_unused(object, eye, "lengths", EyeRule::EqualFreeLength);
    refuse_unused(object, eye, "radius", EyeRule::Cylinder);
    refuse_unused(object, eye, "plane_x", EyeRule::VerticalPlane);
    refuse_unused(object, eye, "plane_y", EyeRule::HorizontalPlane);
    if (const auto lengths = object.optional("lengths")) {
        for (const JsonValue& piece : lengths->array()) {
            eye.lengths.push_back(read_length(piece));
        }
    }
    if (eye.rule == EyeRule::Cylinder) {
        eye.radius_mm = object.required("radius").number(kLengthRange);
    }
    if (eye.rule == EyeRule::VerticalPlane) {
        eye.plane_x_mm = object.required("plane_x").number(kLengthRange);
    }
    if (eye.rule == EyeRule::HorizontalPlane) {
        const JsonValue plane = object.required("plane_y");
        eye.plane_y_mm = plane.number(kPlaneRange);
        if (eye.plane_y_mm == 0.0) {
            plane.fail("json.out_of_range",
                       "0 is the height of the spindle, where \"equal-free-length\" and "
                       "\"cylinder\" have the eye; give another height, negative below");
        }
    }
    return eye;
}

// The rules with planes leave no turn to choose, and "central-angle" is the word for that.
RedundancyRule read_redundancy(const JsonObject& root, EyeRule eye) {
    const bool forced = eye == EyeRule::VerticalPlane || eye == EyeRule::HorizontalPlane;
    RedundancyRule rule = forced ? RedundancyRule::CentralAngle : Job{}.redundancy;
    read_word(root, "redundancy", kRedundancyWords, rule);
    if (forced && rule != RedundancyRule::CentralAngle) {
        root.required("redundancy")
            .fail("job.turn_forced", "the eye rule \"" + std::string(word_of(eye, kEyeWords)) +
                                         "\" says how the mandrel turns; remove \"redundancy\" "
                                         "or choose another rule");
    }
    return rule;
}

Job job_of(const JsonDocument& document) {
    const JsonObject root = document.root().object(
        {"mandrel", "tow", "layers", "fibres", "eye", "redundancy", "tolerance", "speed"});
    Job job;
    if (const auto mandrel = root.optional("mandrel")) {
        job.mandrel = read_mandrel(*mandrel);
    }
    if (const auto tow = root.optional("tow")) {
        job.tow = read_tow(*tow);
    }
    if (const auto layers = root.optional("layers")) {
        job.layers = read_layers(*layers);
    }
    if (const auto fibres = root.optional("fibres")) {
        job.fibres = static_cast<int>(fibres->integer(1, kMostFibres));
    }
    if (const auto eye = root.optional("eye")) {
        job.eye = read_eye(*eye);
    }
    job.redundancy = read_redundancy(root, job.eye.rule);
    if (const auto tolerance = root.optional("tolerance")) {
        const JsonObject object = tolerance->object({"laydown", "laydown_angle", "clearance"});
        read_number(object, "laydown", kDeviationRange, job.tolerance.laydown_mm);
        read_number(object, "laydown_angle", kDeviationRange, job.tolerance.laydown_angle_deg);
        read_number(object, "clearance", kClearanceRange, job.tolerance.clearance_mm);
    }
    if (const auto speed = root.optional("speed")) {
        read_number(speed->object({"fibre"}), "fibre", kSpeedRange, job.speed.fibre_m_min);
    }
    return job;
}

void append_member(std::string& text, std::string_view key, std::string_view value) {
    if (text.back() != '{') {
        text += ", ";
    }
    text += '"';
    text += key;
    text += "\":";
    text += value;
}

void append_member(std::string& text, std::string_view key, double value) {
    std::string digits;
    append_shortest(digits, value);
    append_member(text, key, digits);
}

/// JSON string: quotes, backslashes and control characters escaped.
std::string json_string(std::string_view raw) {
    constexpr std::string_view kHexDigits = "0123456789abcdef";
    std::string text = "\"";
    for (const char c : raw) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            text += '\\';
            text += c;
        } else if (code < 0x20) {
            text += "\\u00";
            text += kHexDigits[code >> 4U];
            text += kHexDigits[code & 15U];
        } else {
            text += c;
        }
    }
    return text + '"';
}

std::string vector_text(const Eigen::Vector3d& vector) {
    std::string text = "[";
    for (int i = 0; i < 3; ++i) {
        append_shortest(text, vector[i]);
        text += i < 2 ? "," : "]";
    }
    return text;
}

std::string mandrel_end_text(const Job::MandrelJob& mandrel) {
    if (mandrel.turn != TurnKind::Pins) {
        return "}";
    }
    const PinWish& pins = mandrel.pins;
    const std::string chosen = "\"auto\"";
    std::string text = "{";
    append_member(text, "count", pins.count > 0 ? std::to_string(pins.count) : chosen);
    append_member(text, "diameter", pins.diameter_mm);
    const auto add = [&](const char* key, double mm) {
        mm > 0.0 ? append_member(text, key, mm) : append_member(text, key, chosen);
    };
    add("height", pins.height_mm.value_or(0.0));
    append_member(text, "skip", pins.skip > 0 ? std::to_string(pins.skip) : chosen);
    add("offset", pins.offset_mm);
    return ", \"pins\":" + text + "}}";
}

std::string mandrel_text(const Job::MandrelJob& mandrel) {
    std::string text = "{";
    append_member(text, "units", json_string(word_of(mandrel.units, kUnitWords)));
    append_member(text, "axis",
                  mandrel.axis ? "{\"origin\":" + vector_text(mandrel.axis->origin) +
                                     ", \"direction\":" + vector_text(mandrel.axis->direction) + "}"
                               : "\"auto\"");
    std::string regions = "\"auto\"";
    if (!mandrel.keep_regions.empty()) {
        regions = "[";
        for (const std::int32_t id : mandrel.keep_regions) {
            regions += (regions.size() > 1 ? "," : "") + std::to_string(id);
        }
        regions += "]";
    }
    append_member(text, "keep_regions", regions);
    append_member(text, "extension", mandrel.extension_mm);
    append_member(text, "turn", json_string(word_of(mandrel.turn, kTurnWords)));
    return text + mandrel_end_text(mandrel);
}

std::string tow_text(const Job::TowJob& tow) {
    std::string text = "{";
    append_member(text, "width", tow.width_mm);
    append_member(text, "thickness", tow.thickness_mm);
    append_member(text, "friction", tow.friction);
    append_member(text, "bridging_tolerance", tow.bridging_tolerance_mm);
    append_member(text, "density", tow.density_g_cm3);
    return text + "}";
}

std::string pattern_text(const PatternJob& wish) {
    std::string text = "{";
    const auto add_count = [&](std::string_view key, std::int64_t count) {
        if (count > 0) {
            append_member(text, key, std::to_string(count));
        }
    };
    add_count("circuits", wish.circuits);
    add_count("starts", wish.starts);
    append_member(text, "lead", json_string(wish.lead ? word_of(*wish.lead, kLeadWords) : "any"));
    if (wish.most_overlap) {
        append_member(text, "most_overlap", *wish.most_overlap);
    }
    append_member(text, "dwell_deg", wish.dwell_deg);
    if (wish.most_dwell_deg) {
        append_member(text, "most_dwell_deg", *wish.most_dwell_deg);
    }
    if (wish.band_offset_mm > 0.0) {
        append_member(text, "band_offset_mm", wish.band_offset_mm);
    }
    return text + "}";
}

std::string layers_text(std::span<const LayerJob> layers) {
    std::string text = "[";
    for (const LayerJob& layer : layers) {
        text += text.size() > 1 ? ",\n             {" : "{";
        append_member(text, "kind", json_string(name_of(layer.kind)));
        if (layer.angle_deg) {
            append_member(text, "angle", *layer.angle_deg);
        }
        if (layer.lattice) {
            append_member(text, "circuits", std::to_string(layer.lattice->circuits));
            append_member(text, "series",
                          layer.lattice->series > 0 ? std::to_string(layer.lattice->series)
                                                    : json_string("fill"));
            append_member(text, "plies", std::to_string(layer.lattice->plies));
        } else {
            append_member(text, "target_layers", layer.target_layers);
        }
        if (layer.pattern) {
            append_member(text, "pattern", pattern_text(*layer.pattern));
        }
        if (!layer.file.empty()) {
            append_member(text, "file", json_string(layer.file));
        }
        text += "}";
    }
    return text + "]";
}

std::string eye_text(const EyeLaw& eye) {
    std::string text = "{";
    append_member(text, "rule", json_string(word_of(eye.rule, kEyeWords)));
    append_member(text, "free_length", eye.free_length_mm);
    std::string lengths;
    for (const LengthPiece& piece : eye.lengths) {
        lengths += lengths.empty() ? "[{" : ", {";
        if (piece.piece) {
            append_member(lengths, "course", std::to_string(*piece.piece));
        } else {
            append_member(lengths, "from_mm", piece.from_mm);
            append_member(lengths, "to_mm", piece.to_mm);
        }
        append_member(lengths, "free_length", piece.free_length_mm);
        lengths += "}";
    }
    if (!lengths.empty()) {
        append_member(text, "lengths", lengths + "]");
    }
    if (eye.rule == EyeRule::Cylinder) {
        append_member(text, "radius", eye.radius_mm);
    }
    if (eye.rule == EyeRule::VerticalPlane) {
        append_member(text, "plane_x", eye.plane_x_mm);
    }
    if (eye.rule == EyeRule::HorizontalPlane) {
        append_member(text, "plane_y", eye.plane_y_mm);
    }
    return text + "}";
}

}  // namespace

double mm_per(LengthUnit unit) {
    constexpr std::array<double, 6> kMillimetres = {0.0, 1e-3, 1.0, 10.0, 1e3, 25.4};
    return kMillimetres[static_cast<std::size_t>(unit)];
}

Job parse_job(std::string_view text, const std::string& name) {
    return job_of(JsonDocument::parse(text, name));
}

Job read_job(const std::filesystem::path& file) {
    return job_of(JsonDocument::load(file.string()));
}

std::string_view name_of(LayerKind kind) {
    return word_of(kind, kLayerWords);
}

std::string_view name_of(EyeRule rule) {
    return word_of(rule, kEyeWords);
}

std::string job_text(const Job& job) {
    std::string tolerance = "{";
    append_member(tolerance, "laydown", job.tolerance.laydown_mm);
    append_member(tolerance, "laydown_angle", job.tolerance.laydown_angle_deg);
    append_member(tolerance, "clearance", job.tolerance.clearance_mm);
    std::string speed = "{";
    append_member(speed, "fibre", job.speed.fibre_m_min);

    return "{ \"mandrel\":" + mandrel_text(job.mandrel) + ",\n  \"tow\":" + tow_text(job.tow) +
           ",\n  \"layers\":" + layers_text(job.layers) +
           ",\n  \"fibres\":" + std::to_string(job.fibres) + ",\n  \"eye\":" + eye_text(job.eye) +
           ",\n  \"redundancy\":" + json_string(word_of(job.redundancy, kRedundancyWords)) +
           ",\n  \"tolerance\":" + tolerance + "},\n  \"speed\":" + speed + "} }\n";
}

}  // namespace meshwind
