#include "pipeline/job/layer_keys.h"

#include "pipeline/job/job_keys.h"
#include "pipeline/job/job_ranges.h"
#include "pipeline/job/wall_keys.h"

namespace meshwind {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::string_view kFillWord = "fill";

// The words of the order, then none.
Key<PatternJob> lead_key() {
    const Words words = {"leading", "lagging", "any"};
    return {"lead",
            "whether that band lies ahead of the first one or behind it",
            {{"enum", words}, {"default", words.back()}},
            [words](const JsonValue& value, PatternJob& wish) {
                const std::size_t found = value.one_of(words);
                if (found + 1 < words.size()) {
                    wish.lead = static_cast<BandOrder>(found);
                }
            },
            [words](const PatternJob& wish) {
                return string_text(wish.lead ? words[static_cast<std::size_t>(*wish.lead)]
                                             : words.back());
            }};
}

Key<PatternJob> most_dwell_key() {
    Key<PatternJob> key =
        number("most_dwell_deg", &PatternJob::most_dwell_deg, {.min = 0.0, .max = kMaxDwell_deg},
               "largest dwell at each rim, at least dwell_deg; without it any");
    key.read = [](const JsonValue& value, PatternJob& wish) {
        wish.most_dwell_deg = value.number({.min = wish.dwell_deg, .max = kMaxDwell_deg});
    };
    return key;
}

const KeyTable<PatternJob>& pattern_keys() {
    static const KeyTable<PatternJob> kTable = {{
        count_if_any("circuits", &PatternJob::circuits, kMaxCircuits,
                     "so many circuits; not of lattices"),
        count_if_any("starts", &PatternJob::starts, kMaxCircuits,
                     "pattern number: after so many circuits a band lies beside the first one; the "
                     "interlacing"),
        lead_key(),
        number("most_overlap", &PatternJob::most_overlap, {.min = 0.0, .max = kMaxOverlap},
               "share of the distance between bands; without it 0.25, with circuits any; not of "
               "lattices"),
        number("dwell_deg", &PatternJob::dwell_deg, {.min = 0.0, .max = kMaxDwell_deg},
               "least dwell at each rim, the compensation angle"),
        most_dwell_key(),
        [] {
            Key<PatternJob> key = number(
                "band_offset_mm", &PatternJob::band_offset_mm, kBandRange,
                "distance of neighbouring bands at the widest place, instead of the tow's width: "
                "smaller overlaps, larger leaves gaps; of lattices, between the series of a rib");
            key.schema.erase("default");
            key.text = [](const PatternJob& wish) {
                return wish.band_offset_mm > 0.0 ? number_text(wish.band_offset_mm) : "";
            };
            return key;
        }(),
    }};
    return kTable;
}

bool is_lattice(const LayerJob& layer) {
    return layer.kind == LayerKind::Lattice;
}

// A count of a lattice, which other layers refuse.
Key<LayerJob> lattice_count(std::string_view name, int LatticeConstraints::*field,
                            std::int64_t most, std::string_view meaning) {
    return only_if<LayerJob>(
        is_lattice, "job.pattern_unused",
        "only a lattice reads it; a helical or polar layer has \"pattern\": {\"circuits\": N}",
        {name, meaning, count_schema(1, most),
         [=](const JsonValue& value, LayerJob& layer) {
             LatticeConstraints& lattice = layer.lattice ? *layer.lattice : layer.lattice.emplace();
             lattice.*field = static_cast<int>(value.integer(1, most));
         },
         [=](const LayerJob& layer) { return std::to_string((*layer.lattice).*field); }});
}

Key<LayerJob> series_key() {
    Key<LayerJob> key =
        lattice_count("series", &LatticeConstraints::series, kMaxSeries,
                      "bands side by side in a rib; fill: until the wall is closed; lattices only");
    key.schema = with_default(or_word(kFillWord, key.schema), LatticeConstraints{}.series);
    key.read = [read = key.read](const JsonValue& value, LayerJob& layer) {
        if (is_lattice(layer) && value.is_string() && value.one_of({kFillWord}) == 0) {
            layer.lattice->series = 0;
        } else {
            read(value, layer);
        }
    };
    key.told = nullptr;
    key.text = [text = key.text](const LayerJob& layer) {
        return layer.lattice && layer.lattice->series == 0 ? string_text(kFillWord) : text(layer);
    };
    return key;
}

Key<LayerJob> pattern_key() {
    Key<LayerJob> key = {
        "pattern",
        "what the pattern of a helical, polar or lattice layer is to be; what is left out is free. "
        "Where there is no such pattern the plan fails with the nearest",
        keys_schema(pattern_keys()),
        [](const JsonValue& value, LayerJob& layer) {
            read_keys(pattern_keys(), value, layer.pattern.emplace());
            const JsonObject object = value.object(names_of(pattern_keys()));
            for (const char* unused : {"circuits", "most_overlap"}) {
                const auto found = object.optional(unused);
                if (found && is_lattice(layer)) {
                    found->fail("job.pattern_unused",
                                "a lattice has its \"circuits\" beside \"kind\", and its bands do "
                                "not overlap; remove it");
                }
            }
        },
        [](const LayerJob& layer) {
            return layer.pattern ? "{" + keys_text(pattern_keys(), *layer.pattern) + "}" : "";
        }};
    return only_if<LayerJob>(
        [](const LayerJob& layer) {
            return is_lattice(layer) || layer.kind == LayerKind::Helical ||
                   layer.kind == LayerKind::Polar;
        },
        "job.pattern_unused",
        "only layers of kind \"helical\", \"polar\" and \"lattice\" read it; name one of these, or "
        "remove it",
        std::move(key));
}

Key<LayerJob> file_key() {
    return only_if<LayerJob>(
        [](const LayerJob& layer) { return layer.kind == LayerKind::Imported; }, "job.file_unused",
        "only an imported layer reads a file; remove it or write \"kind\": \"imported\"",
        {"file",
         "CSV of landing points, in the axes of the mandrel's file; imported layers only. The name "
         "counts from the job file",
         {{"type", "string"}, {"minLength", 1}},
         [](const JsonValue& value, LayerJob& layer) { layer.file = value.string(); },
         [](const LayerJob& layer) {
             return layer.file.empty() ? std::string() : string_text(layer.file);
         }});
}

bool has_plies_or_thickness(const LayerJob& layer) {
    return is_lattice(layer) || layer.kind == LayerKind::Wall;
}

Key<LayerJob> circuits_key() {
    Key<LayerJob> key = lattice_count("circuits", &LatticeConstraints::circuits, kMaxCircuits,
                                      "ribs of either hand; lattices only");
    key.needed = is_lattice;
    return key;
}

Key<LayerJob> plies_key() {
    Key<LayerJob> key = lattice_count("plies", &LatticeConstraints::plies, kMaxPlies,
                                      "how often all of a lattice is wound, band upon "
                                      "band; instead of target_layers");
    key.schema["default"] = LatticeConstraints{}.plies;
    return key;
}

Key<LayerJob> target_layers_key() {
    return only_if<LayerJob>([](const LayerJob& layer) { return !has_plies_or_thickness(layer); },
                             "job.pattern_unused",
                             "a lattice is wound \"plies\" times, a wall has \"layers\" or "
                             "\"thickness\"; write that",
                             number("target_layers", &LayerJob::target_layers, kLayersRange,
                                    "how often each place is to be covered; a cover rounds it "
                                    "up"));
}

void check_layer(const JsonObject& object, LayerJob& layer) {
    if (layer.kind == LayerKind::Imported && layer.file.empty()) {
        object.value().fail("job.file_missing",
                            "an imported layer needs \"file\", the CSV of its landing points");
    }
    check_wall(object, layer);
}

// Which keys a kind of layer needs and which it refuses, as only_if and check_layer do.
constexpr const char* kLayerRules = R"({"allOf": [
          {"if": {"required": ["kind"], "properties": {"kind": {"const": "imported"}}},
           "then": {"required": ["file"]}, "else": {"not": {"required": ["file"]}}},
          {"if": {"required": ["kind"], "properties": {"kind": {"const": "lattice"}}},
           "then": {"required": ["circuits"],
                    "not": {"required": ["target_layers"]},
                    "properties": {"pattern": {"not": {"anyOf": [{"required": ["circuits"]},
                                                                 {"required": ["most_overlap"]}]}}}},
           "else": {"not": {"anyOf": [{"required": ["circuits"]}, {"required": ["series"]},
                                      {"required": ["plies"]}]}}},
          {"if": {"not": {"required": ["kind"],
                          "properties": {"kind": {"enum": ["helical", "polar", "lattice"]}}}},
           "then": {"not": {"required": ["pattern"]}}},
          {"if": {"required": ["kind"], "properties": {"kind": {"const": "wall"}}},
           "then": {"not": {"required": ["target_layers"]},
                    "oneOf": [{"required": ["layers"]}, {"required": ["thickness"]}]},
           "else": {"not": {"anyOf": [{"required": ["layers"]}, {"required": ["thickness"]},
                                      {"required": ["parts"]}]}}}
        ]})";

KeyTable<LayerJob> make_layer_keys() {
    return {
        {
            word("kind", &LayerJob::kind, layer_words(),
                 "helical, polar and hoop: patterns on bodies of revolution, helical on elbows, "
                 "too; lattice: an open grid of ribs on bodies of revolution; cover: courses on "
                 "anything; wall: a thickness, in as many patterns or covers as it takes; "
                 "imported: landing points made elsewhere; auto: a pattern where the "
                 "mandrel is a body of revolution or an elbow that one covers, else cover"),
            number("angle", &LayerJob::angle_deg, {.min = 0.0, .max = 90.0},
                   "wanted winding angle: degrees from the axial direction of the pipe under the "
                   "fibre; without it any. A cover comes as near as friction, turns and evenness "
                   "let it"),
            circuits_key(),
            series_key(),
            plies_key(),
            target_layers_key(),
            pattern_key(),
            file_key(),
        },
        check_layer,
        schema_rules(kLayerRules)};
}

}  // namespace

const KeyTable<LayerJob>& layer_keys() {
    static const KeyTable<LayerJob> kTable = [] {
        KeyTable<LayerJob> table = make_layer_keys();
        for (Key<LayerJob>& key : wall_keys()) {
            table.keys.push_back(std::move(key));
        }
        return table;
    }();
    return kTable;
}

}  // namespace meshwind
