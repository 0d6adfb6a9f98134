#include "report/page/page_machine.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "core/units.h"
#include "mesh/mandrel/extension.h"
#include "winding/turn/pin.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

json vector_json(const Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

// Limits that are infinite are null.
json limit_json(double value) {
    return std::isfinite(value) ? json(value) : json(nullptr);
}

json add_mesh(const std::string& name, const TriangleSoup& mesh, PageArrays& arrays) {
    arrays.add_points(name + "/points", mesh.points_mm);
    arrays.add_faces(name + "/faces", mesh.faces);
    return {{"points", name + "/points"}, {"faces", name + "/faces"}};
}

// \param meshes that are there already; counted on
json shape_json(const std::variant<Capsule, EnvelopeMesh>& shape, int& meshes, PageArrays& arrays) {
    if (const auto* const capsule = std::get_if<Capsule>(&shape)) {
        return {{"type", "capsule"},
                {"from", vector_json(capsule->from_mm)},
                {"to", vector_json(capsule->to_mm)},
                {"radius", capsule->radius_mm}};
    }
    json report = add_mesh("machine/mesh" + std::to_string(++meshes),
                           std::get<EnvelopeMesh>(shape).triangles, arrays);
    report["type"] = "mesh";
    return report;
}

json chain_json(const std::vector<Axis>& chain) {
    json report = json::array();
    for (const Axis& axis : chain) {
        const bool rotary = axis.type == AxisType::Rotary;
        const auto shown = [rotary](double value) {
            return limit_json(rotary ? deg_from_rad(value) : value);
        };
        report.push_back({{"letter", std::string(1, axis.letter)},
                          {"type", rotary ? "rotary" : "linear"},
                          {"direction", vector_json(axis.direction)},
                          {"point", vector_json(axis.point_mm)},
                          {"min", shown(axis.min)},
                          {"max", shown(axis.max)},
                          {"velocity", shown(axis.velocity)},
                          {"acceleration", shown(axis.acceleration)}});
    }
    return report;
}

void append(TriangleSoup& all, const TriangleSoup& one) {
    const auto before = static_cast<std::int32_t>(all.points_mm.size());
    all.points_mm.insert(all.points_mm.end(), one.points_mm.begin(), one.points_mm.end());
    for (const auto& [a, b, c] : one.faces) {
        all.faces.push_back({a + before, b + before, c + before});
    }
}

}  // namespace

json page_machine(const Machine& machine, PageArrays& arrays) {
    int meshes = 0;
    json envelope = json::array();
    for (const EnvelopePart& part : machine.eye.envelope) {
        envelope.push_back(shape_json(part.shape, meshes, arrays));
        envelope.back()["link"] = std::string(1, part.link);
    }
    json bodies = json::array();
    for (const MachineBody& body : machine.bodies) {
        bodies.push_back(shape_json(body.shape, meshes, arrays));
        bodies.back()["link"] = body.link ? json(std::string(1, *body.link)) : json(nullptr);
    }
    json report = {{"name", machine.name},
                   {"mandrel_chain", chain_json(machine.mandrel_chain)},
                   {"eye_chain", chain_json(machine.eye_chain)},
                   {"mount", nullptr},
                   {"up", vector_json(machine.up)},
                   {"eye",
                    {{"position", vector_json(machine.eye.position_mm)},
                     {"roller", vector_json(machine.eye.roller)},
                     {"exit", vector_json(machine.eye.exit)},
                     {"envelope", envelope}}},
                   {"bodies", bodies},
                   {"fibre",
                    {{"min_free_length", machine.fibre.min_free_length_mm},
                     {"max_free_length", machine.fibre.max_free_length_mm},
                     {"max_speed", machine.fibre.max_speed_mm_s}}}};
    if (machine.mount) {
        report["mount"] = {{"origin", vector_json(machine.mount->origin_mm)},
                           {"x", vector_json(machine.mount->x)},
                           {"z", vector_json(machine.mount->z)}};
    }
    return report;
}

json page_extension(const Setup& first, PageArrays& arrays) {
    TriangleSoup all;
    for (const Rim& rim : first.mandrel.rims) {
        if (first.job.mandrel.extension_mm > 0.0) {
            const TriangleSoup one = extension_of(rim, first.job.mandrel.extension_mm);
            append(all, one);
        }
    }
    for (const PinRing& ring : first.pins) {
        for (const Pin& pin : pins_of(ring, first.mandrel.rims[std::size_t(ring.rim)])) {
            append(all, mesh_of(pin));
        }
    }
    if (all.faces.empty()) {
        return nullptr;
    }
    return add_mesh("extension", all, arrays);
}

}  // namespace meshwind
