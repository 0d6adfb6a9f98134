#include "pipeline/job/wall_keys.h"

#include <string>

#include "pipeline/job/face_word.h"
#include "pipeline/job/job_ranges.h"

namespace meshwind {
namespace {

constexpr const char* kLayers =
    "least layers of the tow that lie everywhere; instead of \"thickness\"";
constexpr const char* kThickness = "mm, least thickness everywhere; instead of \"layers\"";

bool is_wall(const LayerJob& layer) {
    return layer.kind == LayerKind::Wall;
}

WallJob& wall_of(LayerJob& layer) {
    return layer.wall ? *layer.wall : layer.wall.emplace();
}

void check_amount(const JsonObject& object, const WallAmount& amount) {
    if (amount.layers.has_value() == amount.thickness_mm.has_value()) {
        object.value().fail("job.wall_amount",
                            "give either \"layers\" or \"thickness\" in mm, not both");
    }
}

// Field of what a part has of a wall's amount.
Key<WallPart> part_number(std::string_view name, std::optional<double> WallAmount::*field,
                          const JsonRange& range, std::string_view meaning) {
    return {
        name, meaning, number_schema(range),
        [=](const JsonValue& value, WallPart& part) { part.amount.*field = value.number(range); },
        [=](const WallPart& part) {
            return part.amount.*field ? number_text(*(part.amount.*field)) : std::string();
        }};
}

Key<WallPart> box_key() {
    const SchemaJson box = {{"type", "object"},
                            {"additionalProperties", false},
                            {"required", SchemaJson::array({"min", "max"})},
                            {"properties", {{"min", vector_schema()}, {"max", vector_schema()}}}};
    return {"box", "what lies in it, in the file's frame and units", box,
            [](const JsonValue& value, WallPart& part) {
                const JsonObject object = value.object({"min", "max"});
                part.box = {object.required("min").vector3(), object.required("max").vector3()};
            },
            [](const WallPart& part) {
                return part.box ? "{\"min\":" + vector_text(part.box->least) +
                                      ", \"max\":" + vector_text(part.box->most) + "}"
                                : std::string();
            }};
}

Key<WallPart> point_key() {
    return {
        "point", "what lies \"within\" so many mm of it; in the file's frame and units",
        vector_schema(),
        [](const JsonValue& value, WallPart& part) { part.point = value.vector3(); },
        [](const WallPart& part) { return part.point ? vector_text(*part.point) : std::string(); }};
}

// A number of a region or rim.
Key<WallPart> id_key(std::string_view name, std::optional<std::int32_t> WallPart::*field,
                     std::string_view meaning) {
    return {name, meaning, count_schema(0, kMaxId),
            [=](const JsonValue& value, WallPart& part) {
                part.*field = static_cast<std::int32_t>(value.integer(0, kMaxId));
            },
            [=](const WallPart& part) {
                return part.*field ? std::to_string(*(part.*field)) : std::string();
            }};
}

Key<WallPart> face_key() {
    return {"face",
            "faces of a CAD file, by number, kind or colour (\"#ff0000\"), as meshwind inspect "
            "lists them",
            face_word_schema(),
            [](const JsonValue& value, WallPart& part) { part.cad_face = read_face_word(value); },
            [](const WallPart& part) {
                return part.cad_face ? face_word_text(*part.cad_face) : std::string();
            }};
}

// One place, and a distance where the place needs one.
void check_place(const JsonObject& object, const WallPart& part) {
    const int places = (part.region ? 1 : 0) + (part.cad_face ? 1 : 0) + (part.box ? 1 : 0) +
                       (part.point ? 1 : 0) + (part.rim ? 1 : 0);
    if (places != 1) {
        object.value().fail("job.wall_place",
                            "give one of \"region\", \"face\", \"box\", \"point\" and \"rim\"");
    }
    if ((part.point || part.rim) != part.within_mm.has_value()) {
        object.value().fail("job.wall_place",
                            "\"point\" and \"rim\" need \"within\", a distance in mm, which the "
                            "others do not read");
    }
    check_amount(object, part.amount);
}

const KeyTable<WallPart>& part_keys() {
    static const KeyTable<WallPart> kTable = {
        {
            id_key("region", &WallPart::region, "a region, as meshwind inspect lists them"),
            face_key(),
            box_key(),
            point_key(),
            id_key("rim", &WallPart::rim, "what lies \"within\" so many mm of this rim"),
            number("within", &WallPart::within_mm, kLengthRange, "mm, of a point or rim"),
            part_number("layers", &WallAmount::layers, kLayersRange, kLayers),
            part_number("thickness", &WallAmount::thickness_mm, kThicknessRange, kThickness),
        },
        [](const JsonObject& object, WallPart& part) { check_place(object, part); },
        schema_rules(R"({
          "oneOf": [{"required": ["region"]}, {"required": ["face"]}, {"required": ["box"]},
                    {"required": ["point", "within"]}, {"required": ["rim", "within"]}],
          "anyOf": [{"required": ["layers"], "not": {"required": ["thickness"]}},
                    {"required": ["thickness"], "not": {"required": ["layers"]}}]
        })")};
    return kTable;
}

// Written where it is given.
Key<LayerJob> only_of_walls(Key<LayerJob> key) {
    key.text = [text = std::move(key.text)](const LayerJob& layer) {
        return layer.wall ? text(layer) : std::string();
    };
    return only_if<LayerJob>(is_wall, "job.wall_unused",
                             "only a layer of kind \"wall\" reads it; others have "
                             "\"target_layers\"",
                             std::move(key));
}

Key<LayerJob> wall_number(std::string_view name, std::optional<double> WallAmount::*field,
                          const JsonRange& range, std::string_view meaning) {
    return only_of_walls({name, meaning, number_schema(range),
                          [=](const JsonValue& value, LayerJob& layer) {
                              wall_of(layer).amount.*field = value.number(range);
                          },
                          [=](const LayerJob& layer) {
                              const auto& amount = layer.wall->amount.*field;
                              return amount ? number_text(*amount) : std::string();
                          }});
}

Key<LayerJob> parts_key() {
    const SchemaJson schema = {{"type", "array"}, {"items", keys_schema(part_keys())}};
    return only_of_walls({"parts",
                          "where the wall is to be thicker or thinner; of several that hold a "
                          "place the last one counts",
                          schema,
                          [](const JsonValue& value, LayerJob& layer) {
                              for (const JsonValue& part : value.array()) {
                                  read_keys(part_keys(), part, wall_of(layer).parts.emplace_back());
                              }
                          },
                          [](const LayerJob& layer) {
                              std::string text;
                              for (const WallPart& part : layer.wall->parts) {
                                  text += text.empty() ? "{" : ", {";
                                  text += keys_text(part_keys(), part) + "}";
                              }
                              return text.empty() ? text : "[" + text + "]";
                          }});
}

}  // namespace

std::vector<Key<LayerJob>> wall_keys() {
    return {wall_number("layers", &WallAmount::layers, kLayersRange, kLayers),
            wall_number("thickness", &WallAmount::thickness_mm, kThicknessRange, kThickness),
            parts_key()};
}

void check_wall(const JsonObject& object, const LayerJob& layer) {
    if (is_wall(layer)) {
        check_amount(object, layer.wall ? layer.wall->amount : WallAmount{});
    }
}

}  // namespace meshwind
