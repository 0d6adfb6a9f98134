/// The header of a PLY file and the values behind it, text or binary alike.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace meshwind {

enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float32;
    bool list = false;
    PlyType count_type = PlyType::Uint8;  ///< of a list's length
};

struct PlyElement {
    std::string name;
    std::size_t rows = 0;
    std::vector<PlyProperty> properties;
};

enum class PlyFormat { Text, LittleEndian, BigEndian };

struct PlyHeader {
    PlyFormat format = PlyFormat::Text;
    std::vector<PlyElement> elements;
    std::size_t bytes = 0;  ///< of the header, the end of its last line included
    std::int64_t lines = 0;
};

/// \throws InputError mesh.not_a_mesh, mesh.truncated (more rows than the file has bytes for)
[[nodiscard]] PlyHeader read_ply_header(std::string_view bytes, const std::string& file);

/// The values behind the header, one after the other, of any format.
class PlyValues {
public:
    virtual ~PlyValues() = default;
    /// Before each row. \throws InputError mesh.truncated; Interrupted
    virtual void begin_row() = 0;
    /// \throws InputError mesh.truncated, mesh.bad_line
    virtual double number(PlyType type) = 0;
    /// Takes a whole number. \throws InputError mesh.bad_line for any other
    virtual std::int64_t integer(PlyType type) = 0;
    /// After each row of text nothing may be left on its line. \throws InputError mesh.bad_line
    virtual void end_row() = 0;
    [[noreturn]] virtual void refuse(const std::string& code, const std::string& message) const = 0;
};

[[nodiscard]] std::unique_ptr<PlyValues> ply_values(std::string_view bytes, const std::string& file,
                                                    const PlyHeader& header);

}  // namespace meshwind
