/// Read-only NumPy arrays over memory of ours, without a copy; it lives as long as an array does.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <Eigen/Core>

#include "geodesic/surface_path.h"

namespace meshwind {

/// \param first number of the first row, \param rows whose distance is `stride` bytes
/// \param columns side by side; 0: the array has one dimension
/// \param owner keeps the memory alive
template <typename Number>
pybind11::array array_over(const Number* first, std::size_t rows, std::size_t columns,
                           std::size_t stride, const pybind11::object& owner) {
    std::vector<pybind11::ssize_t> shape{static_cast<pybind11::ssize_t>(rows)};
    std::vector<pybind11::ssize_t> strides{static_cast<pybind11::ssize_t>(stride)};
    if (columns > 0) {
        shape.push_back(static_cast<pybind11::ssize_t>(columns));
        strides.push_back(static_cast<pybind11::ssize_t>(sizeof(Number)));
    }
    pybind11::array_t<Number> array(shape, strides, first, owner);
    array.attr("setflags")(pybind11::arg("write") = false);
    return array;
}

/// Array of n numbers.
template <typename Number>
pybind11::array array_over(const std::vector<Number>& numbers, const pybind11::object& owner) {
    return array_over(numbers.data(), numbers.size(), 0, sizeof(Number), owner);
}

/// Array n x 3.
inline pybind11::array array_over(const std::vector<Eigen::Vector3d>& points,
                                  const pybind11::object& owner) {
    return array_over(reinterpret_cast<const double*>(points.data()), points.size(), 3,
                      sizeof(Eigen::Vector3d), owner);
}
inline pybind11::array array_over(const std::vector<std::array<std::int32_t, 3>>& faces,
                                  const pybind11::object& owner) {
    return array_over(reinterpret_cast<const std::int32_t*>(faces.data()), faces.size(), 3,
                      sizeof(std::array<std::int32_t, 3>), owner);
}

/// One member of each of n structs: n numbers, or n x 3.
template <typename Struct>
pybind11::array array_over(const std::vector<Struct>& structs, double Struct::*member,
                           const pybind11::object& owner) {
    const double* const first = structs.empty() ? nullptr : &(structs.front().*member);
    return array_over(first, structs.size(), 0, sizeof(Struct), owner);
}
template <typename Struct>
pybind11::array array_over(const std::vector<Struct>& structs, Eigen::Vector3d Struct::*member,
                           const pybind11::object& owner) {
    const double* const first = structs.empty() ? nullptr : (structs.front().*member).data();
    return array_over(first, structs.size(), 3, sizeof(Struct), owner);
}

/// Arrays over the stations of a path: position_mm, normal, tangent, s_mm, kn_per_mm, kg_per_mm.
/// \param path_of const SurfacePath& of an object of the class
template <typename Object, typename... More, typename PathOf>
void def_stations(pybind11::class_<Object, More...>& bound, PathOf path_of) {
    const auto def = [&](const char* name, auto member) {
        bound.def_property_readonly(name, [path_of, member](const pybind11::object& self) {
            return array_over(path_of(self.cast<const Object&>()), member, self);
        });
    };
    def("position_mm", &PathPoint::position_mm);
    def("normal", &PathPoint::normal);
    def("tangent", &PathPoint::tangent);
    def("s_mm", &PathPoint::s_mm);
    def("kn_per_mm", &PathPoint::kn_per_mm);
    def("kg_per_mm", &PathPoint::kg_per_mm);
}

}  // namespace meshwind
