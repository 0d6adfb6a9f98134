#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/units.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "report/report.h"
#include "report/write_run.h"

namespace meshwind {
namespace {

namespace py = pybind11;

std::vector<PieceOfRun> pieces_of(const FibreOfRun& fibre) {
    const std::size_t count = fibres_of(fibre.of.get().plan.pieces)[fibre.fibre].size();
    std::vector<PieceOfRun> pieces;
    for (std::size_t course = 0; course < count; ++course) {
        pieces.push_back({fibre.of, fibre.first_piece + course, course});
    }
    return pieces;
}

std::vector<FibreOfRun> fibres_of_layer(const LayerOfRun& layer) {
    std::vector<FibreOfRun> fibres;
    std::size_t first = 0;
    for (std::size_t i = 0; i < layer.get().programs.size(); ++i) {
        fibres.push_back({layer, i, first});
        first += fibres_of(layer.get().plan.pieces)[i].size();
    }
    return fibres;
}

// n x axes, mm or degrees.
py::array positions_of(const BlockList& list) {
    py::array_t<double> positions({list.blocks.size(), list.axes.size()});
    auto at = positions.mutable_unchecked<2>();
    for (std::size_t b = 0; b < list.blocks.size(); ++b) {
        for (std::size_t a = 0; a < list.axes.size(); ++a) {
            at(static_cast<py::ssize_t>(b), static_cast<py::ssize_t>(a)) = list.value(b, a);
        }
    }
    return positions;
}

py::array times_of(const BlockList& list) {
    py::array_t<double> times(static_cast<py::ssize_t>(list.blocks.size()));
    auto at = times.mutable_unchecked<1>();
    double now_s = 0.0;
    for (std::size_t b = 0; b < list.blocks.size(); ++b) {
        now_s += list.blocks[b].duration_s;
        at(static_cast<py::ssize_t>(b)) = now_s;
    }
    return times;
}

// The plies of all triangles, one after the other, as one array for each of their numbers.
py::dict plies_of_run(const Layup& layup) {
    std::vector<std::int32_t> triangle;
    std::vector<std::int32_t> layer;
    std::vector<std::int32_t> fibre;
    std::vector<std::int32_t> course;
    std::vector<double> share;
    std::vector<double> angle;
    for (std::size_t f = 0; f < layup.axes().size(); ++f) {
        for (const LayupPly& ply : layup.plies(f)) {
            triangle.push_back(static_cast<std::int32_t>(f));
            layer.push_back(static_cast<std::int32_t>(ply.layer));
            fibre.push_back(static_cast<std::int32_t>(ply.fibre));
            course.push_back(static_cast<std::int32_t>(ply.course));
            share.push_back(ply.share);
            angle.push_back(deg_from_rad(ply.angle_rad));
        }
    }
    py::dict plies;
    const auto add = [&](const char* name, const auto& numbers) {
        using Number = typename std::decay_t<decltype(numbers)>::value_type;
        plies[name] = py::array_t<Number>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
    };
    add("triangle", triangle);
    add("layer", layer);
    add("fibre", fibre);
    add("course", course);
    add("share", share);
    add("angle_deg", angle);
    return plies;
}

void bind_layup(py::module_& module) {
    py::class_<LayupOfRun> layup(module, "Layup");
    const auto def = [&](const char* name, std::vector<double> LayupArrays::*member) {
        layup.def_property_readonly(name, [member](const py::object& self) {
            return array_over(self.cast<const LayupOfRun&>().get().all().*member, self);
        });
    };
    def("layers", &LayupArrays::layers);
    def("thickness_mm", &LayupArrays::thickness_mm);
    def("winding_angle_deg", &LayupArrays::winding_deg);
    def("area_mm2", &LayupArrays::area_mm2);
    def("covered_share", &LayupArrays::covered);
    layup
        .def_property_readonly("axis_1",
                               [](const py::object& self) {
                                   return array_over(self.cast<const LayupOfRun&>().get().axes(),
                                                     self);
                               })
        .def("plies", [](const LayupOfRun& self) { return plies_of_run(self.get()); });
}

void bind_piece(py::module_& module) {
    py::class_<PieceOfRun> piece(module, "Piece");
    def_stations(piece,
                 [](const PieceOfRun& self) -> const SurfacePath& { return self.get().path; });
    piece
        .def_property_readonly("kind",
                               [](const PieceOfRun& self) {
                                   return self.get().kind == PieceKind::Course ? "course"
                                                                               : "transition";
                               })
        .def_readonly("course", &PieceOfRun::course)
        .def_property_readonly("start_rim",
                               [](const PieceOfRun& self) { return self.get().start_rim; })
        .def_property_readonly("end_rim", [](const PieceOfRun& self) { return self.get().end_rim; })
        .def_property_readonly("slip",
                               [](const py::object& self) {
                                   return array_over(self.cast<const PieceOfRun&>().get().slip,
                                                     self);
                               })
        .def_property_readonly("bridge_mm",
                               [](const py::object& self) {
                                   return array_over(
                                       self.cast<const PieceOfRun&>().get().string.gap_mm, self);
                               })
        .def("__len__", [](const PieceOfRun& self) { return self.get().path.size(); });
}

void bind_fibre(py::module_& module) {
    py::class_<FibreOfRun>(module, "Fibre")
        .def_property_readonly("pieces", &pieces_of)
        .def_property_readonly("program",
                               [](const FibreOfRun& self) -> py::object {
                                   return self.of.owner->run.usable
                                              ? py::object(py::str(self.get().text))
                                              : py::object(py::none());
                               })
        .def_property_readonly("file", [](const FibreOfRun& self) { return self.get().file; })
        .def_property_readonly("axes",
                               [](const FibreOfRun& self) {
                                   std::vector<std::string> letters;
                                   for (const BlockAxis& axis : self.get().made.blocks.axes) {
                                       letters.emplace_back(1, axis.letter);
                                   }
                                   return letters;
                               })
        .def_property_readonly(
            "positions",
            [](const FibreOfRun& self) { return positions_of(self.get().made.blocks); })
        .def_property_readonly(
            "positions_nano",
            [](const py::object& self) {
                const BlockList& list = self.cast<const FibreOfRun&>().get().made.blocks;
                return array_over(list.nano.data(), list.blocks.size(), list.axes.size(),
                                  list.axes.size() * sizeof(std::int64_t), self);
            })
        .def_property_readonly(
            "time_s", [](const FibreOfRun& self) { return times_of(self.get().made.blocks); })
        .def_property_readonly("landing_mm",
                               [](const py::object& self) {
                                   return array_over(
                                       self.cast<const FibreOfRun&>().get().made.eyes.path,
                                       &EyePoint::landing_mm, self);
                               })
        .def_property_readonly("eye_mm",
                               [](const py::object& self) {
                                   return array_over(
                                       self.cast<const FibreOfRun&>().get().made.eyes.path,
                                       &EyePoint::eye_mm, self);
                               })
        .def_property_readonly("free_length_mm", [](const py::object& self) {
            return array_over(self.cast<const FibreOfRun&>().get().made.eyes.path,
                              &EyePoint::free_length_mm, self);
        });
}

}  // namespace

void bind_run(py::module_& module) {
    bind_piece(module);
    bind_fibre(module);
    bind_layup(module);
    py::class_<LayerOfRun>(module, "Layer")
        .def_property_readonly(
            "kind",
            [](const LayerOfRun& self) { return std::string(name_of(self.get().job.kind)); })
        .def_property_readonly(
            "planner",
            [](const LayerOfRun& self) { return std::string(name_of(self.get().plan.planner)); })
        .def_property_readonly("mandrel",
                               [](const LayerOfRun& self) {
                                   return std::shared_ptr<Mandrel>(
                                       self.owner,
                                       &self.owner->run.layers[self.layer].setup.mandrel);
                               })
        .def_property_readonly("layers",
                               [](const py::object& self) {
                                   return array_over(
                                       self.cast<const LayerOfRun&>().get().plan.face_layers, self);
                               })
        .def_property_readonly("fibres", &fibres_of_layer);

    // Python keeps the report there that it has made of the text.
    py::class_<OwnedRun, std::shared_ptr<OwnedRun>>(module, "Run", py::dynamic_attr())
        .def_property_readonly("ok", [](const OwnedRun& self) { return self.run.passed(); })
        .def_property_readonly("usable", [](const OwnedRun& self) { return self.run.usable; })
        .def_property_readonly("remarks", [](const OwnedRun& self) { return self.run.remarks; })
        .def_property_readonly("layers",
                               [](const std::shared_ptr<OwnedRun>& self) {
                                   std::vector<LayerOfRun> layers;
                                   for (std::size_t i = 0; i < self->run.layers.size(); ++i) {
                                       layers.push_back({self, i});
                                   }
                                   return layers;
                               })
        .def_property_readonly("layup",
                               [](const std::shared_ptr<OwnedRun>& self) -> py::object {
                                   if (!self->run.planned()) {
                                       return py::none();
                                   }
                                   if (!self->layup) {
                                       self->layup.emplace(self->run);
                                   }
                                   return py::cast(LayupOfRun{self});
                               })
        .def("report_text", [](const OwnedRun& self) { return report_text(self.run); })
        .def(
            "write",
            [](const OwnedRun& self, const std::filesystem::path& folder) {
                write_run(self.run, folder);
            },
            py::arg("folder"), py::call_guard<py::gil_scoped_release>());
}

}  // namespace meshwind
