/// Data of a page, as one binary text that viewer/src/payload.ts reads.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace meshwind {

/// Arrays, one behind the other, and their table. A header in JSON says what they are:
///
///     u32           length of the header, which is padded so that the arrays begin at a multiple
///                   of 8 bytes
///     header        what the page's own header has, and "arrays": name -> type, width, count,
///                   offset
///     arrays        little endian, each at a multiple of 8 bytes from the first
class PageArrays {
public:
    /// \param width entries of a row \param entries of one of the types that a page knows: float,
    /// double, std::uint32_t, std::int32_t, char
    template <typename T>
    void add(const std::string& name, std::size_t width, std::span<const T> entries);

    /// \param step values are rounded to whole multiples of it: a power of two packs well; 0: no
    /// rounding
    void add_floats(const std::string& name, const std::vector<double>& values, double step = 0.0);
    void add_points(const std::string& name, const std::vector<Eigen::Vector3d>& points,
                    double step = 0.0);
    void add_faces(const std::string& name, const std::vector<std::array<std::int32_t, 3>>& faces);

    /// All arrays behind their header. \param header of the page, an object
    [[nodiscard]] std::string behind(nlohmann::json header) const;

private:
    std::string bytes_;
    nlohmann::json table_ = nlohmann::json::object();
};

}  // namespace meshwind
