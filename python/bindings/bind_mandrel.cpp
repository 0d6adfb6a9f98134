#include <memory>

#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"

namespace meshwind {

namespace py = pybind11;

void bind_mandrel(py::module_& module) {
    py::class_<Rim>(module, "Rim")
        .def_readonly("id", &Rim::id)
        .def_readonly("centre_mm", &Rim::centre_mm)
        .def_readonly("axis", &Rim::axis)
        .def_readonly("radius_mm", &Rim::radius_mm)
        .def("__repr__", [](const Rim& rim) {
            return "<meshwind.Rim " + std::to_string(rim.id) + ", radius " +
                   std::to_string(rim.radius_mm) + " mm>";
        });

    py::class_<Mandrel, std::shared_ptr<Mandrel>>(module, "Mandrel")
        .def_property_readonly("points_mm",
                               [](const py::object& self) {
                                   return array_over(
                                       self.cast<const Mandrel&>().surface.position_mm, self);
                               })
        .def_property_readonly("triangles",
                               [](const py::object& self) {
                                   return array_over(self.cast<const Mandrel&>().surface.face,
                                                     self);
                               })
        .def_property_readonly("regions",
                               [](const py::object& self) {
                                   return array_over(self.cast<const Mandrel&>().surface.region,
                                                     self);
                               })
        .def_readonly("rims", &Mandrel::rims)
        .def_readonly("remarks", &Mandrel::remarks)
        .def_readonly("unit_mm", &Mandrel::unit_mm)
        .def_property_readonly("mandrel_from_file",
                               [](const Mandrel& mandrel) {
                                   return Eigen::Matrix4d(mandrel.file_to_mandrel.matrix());
                               })
        .def("__repr__", [](const Mandrel& mandrel) {
            return "<meshwind.Mandrel " + mandrel.file + ", " +
                   std::to_string(mandrel.surface.face.size()) + " triangles, " +
                   std::to_string(mandrel.rims.size()) + " rims>";
        });

    py::class_<TracedPath, std::shared_ptr<TracedPath>> path(module, "Path");
    def_stations(path, [](const TracedPath& traced) -> const SurfacePath& { return traced.path; });
    path.def_property_readonly("slip",
                               [](const py::object& self) {
                                   return array_over(self.cast<const TracedPath&>().slip, self);
                               })
        .def_property_readonly("bridge_mm",
                               [](const py::object& self) {
                                   return array_over(self.cast<const TracedPath&>().string.gap_mm,
                                                     self);
                               })
        .def_readonly("words", &TracedPath::words)
        .def("__len__", [](const TracedPath& traced) { return traced.path.size(); })
        .def("__repr__",
             [](const TracedPath& traced) { return "<meshwind.Path " + traced.words + ">"; });
}

}  // namespace meshwind
