#include "mesh/io/import.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/text/lower_case.h"
#include "mesh/io/mesh_readers.h"

namespace meshwind {
namespace {

constexpr std::size_t kHeadBytes = 4096;  // far beyond any header that states a unit or counts

// Indices have 32 bits, and no format has a point or polygon in less than 4 bytes but PLY, which
// counts its own.
constexpr std::size_t kMaxBytes = std::size_t{1} << 33;
constexpr std::size_t kPieceBytes = std::size_t{1} << 24;  // between two cancellation points

void check_readable(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) {
        throw IoError("mesh.missing_file", file.string(), "no such file, check the name");
    }
    if (std::filesystem::is_directory(status)) {
        throw IoError("mesh.unreadable", file.string(), "is a folder, name the mesh file in it");
    }
    // To open a pipe that nobody writes to would wait for ever.
    if (!std::filesystem::is_regular_file(status)) {
        throw IoError("mesh.unreadable", file.string(),
                      "is a pipe or a device, write the mesh to a file first");
    }
}

std::string read_bytes(const std::filesystem::path& file, std::size_t limit) {
    check_readable(file);
    std::error_code error;
    std::ifstream stream(file, std::ios::binary);
    const auto size = std::filesystem::file_size(file, error);
    if (!stream || error) {
        throw IoError("mesh.unreadable", file.string(), "cannot be opened, check its permissions");
    }
    if (size > kMaxBytes) {
        throw InputError("mesh.too_large", file.string(),
                         "is larger than 8 GB, export the part with fewer triangles");
    }
    std::string bytes(std::min<std::size_t>(limit, size), '\0');
    for (std::size_t done = 0; done < bytes.size(); done += kPieceBytes) {
        check_interrupt();
        const std::size_t piece = std::min(kPieceBytes, bytes.size() - done);
        stream.read(bytes.data() + done, static_cast<std::streamsize>(piece));
    }
    if (!stream) {
        throw IoError("mesh.unreadable", file.string(), "ends while being read, copy it again");
    }
    return bytes;
}

bool is_text(std::string_view head) {
    return std::none_of(head.begin(), head.end(), [](unsigned char c) {
        return c < 32 && c != '\n' && c != '\r' && c != '\t' && c != '\f' && c != '\v';
    });
}

enum class StlKind { Text, Binary };

// By the size alone: there are binary files that begin with "solid".
StlKind kind_of_stl(std::string_view bytes) {
    const bool exact = bytes.size() >= kStlHeaderBytes &&
                       bytes.size() == kStlHeaderBytes + kStlTriangleBytes * stl_count(bytes);
    return !exact && is_text(bytes.substr(0, kHeadBytes)) ? StlKind::Text : StlKind::Binary;
}

TriangleSoup read_format(std::string_view bytes, const std::string& name) {
    const std::string format = lower_ending(name);
    for (const MeshReader& reader : kMeshReaders) {
        if (format == reader.ending) {
            return reader.read(bytes, name);
        }
    }
    throw InputError("mesh.unknown_format", name,
                     "the ending '" + format + "' is not known, use " + mesh_endings() +
                         "; as a mandrel also .step, .iges or .brep of CAD, and .csv or .dxf for "
                         "the outline of a body of revolution");
}

void check_finite(const TriangleSoup& soup, const std::string& name) {
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        for (const std::int32_t v : soup.faces[f]) {
            if (!soup.points_mm[static_cast<std::size_t>(v)].allFinite()) {
                throw InputError("mesh.not_finite", name,
                                 "triangle " + std::to_string(f + 1) +
                                     " has a coordinate that is no finite number, export again");
            }
        }
    }
}

double unit_named(const std::string& word) {
    static constexpr std::pair<std::string_view, double> kUnits[] = {
        {"mm", 1.0},          {"millimeter", 1.0}, {"millimeters", 1.0}, {"millimetre", 1.0},
        {"millimetres", 1.0}, {"cm", 10.0},        {"centimeter", 10.0}, {"centimeters", 10.0},
        {"m", 1000.0},        {"meter", 1000.0},   {"meters", 1000.0},   {"metre", 1000.0},
        {"metres", 1000.0},   {"in", 25.4},        {"inch", 25.4},       {"inches", 25.4}};
    for (const auto& [known, mm] : kUnits) {
        if (word == known) {
            return mm;
        }
    }
    return 0.0;
}

}  // namespace

TriangleSoup read_stl(std::string_view bytes, const std::string& name) {
    if (kind_of_stl(bytes) == StlKind::Binary) {
        return read_binary_stl(bytes, name);
    }
    if (lower_case(bytes.substr(0, kHeadBytes)).find("facet") == std::string::npos) {
        throw InputError("mesh.not_a_mesh", name,
                         "is text without a single STL facet, export the part as STL");
    }
    return triangles_of(read_text_stl(bytes, name));
}

std::string read_part_file(const std::filesystem::path& file) {
    return read_bytes(file, std::string::npos);
}

std::string lower_ending(const std::filesystem::path& file) {
    return lower_case(file.extension().string());
}

std::string mesh_endings() {
    std::string endings;
    for (std::size_t i = 0; i < kMeshReaders.size(); ++i) {
        const bool last = i + 1 == kMeshReaders.size();
        endings += (i == 0 ? "" : last ? " or " : ", ") + std::string(kMeshReaders[i].ending);
    }
    return endings;
}

TriangleSoup read_triangles(const std::filesystem::path& file) {
    return parse_triangles(read_part_file(file), file.string());
}

TriangleSoup parse_triangles(std::string_view bytes, const std::string& name) {
    if (bytes.find_first_not_of(" \t\r\n") == std::string_view::npos) {
        throw InputError("mesh.empty_file", name, "is empty, export the part again");
    }
    TriangleSoup soup = read_format(bytes, name);
    if (soup.faces.empty()) {
        throw InputError("mesh.no_triangles", name,
                         "holds no triangle, export the part's surface as triangles");
    }
    check_finite(soup, name);
    return soup;
}

double stated_unit_mm(const std::filesystem::path& file) {
    const std::string head = lower_case(read_bytes(file, kHeadBytes));
    for (std::size_t at = head.find("unit"); at != std::string::npos; at = head.find("unit", at)) {
        at += 4;
        at += at < head.size() && head[at] == 's' ? 1 : 0;
        std::size_t word = head.find_first_not_of(" \t", at);
        if (word == std::string::npos || (head[word] != '=' && head[word] != ':')) {
            continue;
        }
        word = head.find_first_not_of(" \t", word + 1);
        std::size_t end = word;
        while (end < head.size() && std::isalpha(static_cast<unsigned char>(head[end])) != 0) {
            ++end;
        }
        if (word != std::string::npos && unit_named(head.substr(word, end - word)) > 0.0) {
            return unit_named(head.substr(word, end - word));
        }
    }
    return 0.0;
}

}  // namespace meshwind
