#include "report/page/page_arrays.h"

#include <bit>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace meshwind {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

static_assert(std::endian::native == std::endian::little);

// Arrays begin at multiples of so many bytes.
constexpr std::size_t kAlignment = 8;

template <typename T>
constexpr const char* type_name() {
    if constexpr (std::is_same_v<T, float>) {
        return "f32";
    } else if constexpr (std::is_same_v<T, double>) {
        return "f64";
    } else if constexpr (std::is_same_v<T, std::uint32_t>) {
        return "u32";
    } else if constexpr (std::is_same_v<T, std::int32_t>) {
        return "i32";
    } else {
        static_assert(std::is_same_v<T, char>);
        return "u8";
    }
}

void pad(std::string& bytes, std::size_t ahead, char with) {
    while ((bytes.size() + ahead) % kAlignment != 0) {
        bytes += with;
    }
}

float rounded(double value, double step) {
    return static_cast<float>(step > 0.0 ? std::round(value / step) * step : value);
}

}  // namespace

template <typename T>
void PageArrays::add(const std::string& name, std::size_t width, std::span<const T> entries) {
    pad(bytes_, 0, '\0');
    table_[name] = {{"type", type_name<T>()},
                    {"width", width},
                    {"count", entries.size() / width},
                    {"offset", bytes_.size()}};
    const auto raw = std::as_bytes(entries);
    bytes_.append(reinterpret_cast<const char*>(raw.data()), raw.size());
}

template void PageArrays::add(const std::string&, std::size_t, std::span<const float>);
template void PageArrays::add(const std::string&, std::size_t, std::span<const double>);
template void PageArrays::add(const std::string&, std::size_t, std::span<const std::uint32_t>);
template void PageArrays::add(const std::string&, std::size_t, std::span<const std::int32_t>);
template void PageArrays::add(const std::string&, std::size_t, std::span<const char>);

void PageArrays::add_floats(const std::string& name, const std::vector<double>& values,
                            double step) {
    std::vector<float> entries;
    entries.reserve(values.size());
    for (const double value : values) {
        entries.push_back(rounded(value, step));
    }
    add<float>(name, 1, entries);
}

void PageArrays::add_points(const std::string& name, const std::vector<Vector3d>& points,
                            double step) {
    std::vector<float> entries;
    entries.reserve(3 * points.size());
    for (const Vector3d& p : points) {
        entries.insert(entries.end(),
                       {rounded(p.x(), step), rounded(p.y(), step), rounded(p.z(), step)});
    }
    add<float>(name, 3, entries);
}

void PageArrays::add_faces(const std::string& name,
                           const std::vector<std::array<std::int32_t, 3>>& faces) {
    std::vector<std::uint32_t> entries;
    entries.reserve(3 * faces.size());
    for (const auto& face : faces) {
        for (const std::int32_t v : face) {
            entries.push_back(static_cast<std::uint32_t>(v));
        }
    }
    add<std::uint32_t>(name, 3, entries);
}

std::string PageArrays::behind(json header) const {
    header["arrays"] = table_;
    std::string head = header.dump(-1, ' ', false, json::error_handler_t::replace);
    pad(head, sizeof(std::uint32_t), ' ');
    const auto length = std::bit_cast<std::array<char, 4>>(static_cast<std::uint32_t>(head.size()));
    return std::string(length.data(), length.size()) + head + bytes_;
}

}  // namespace meshwind
