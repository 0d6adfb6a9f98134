#include "mesh/import.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include "core/error.h"

namespace meshwind {
namespace {

constexpr std::size_t kStlHeaderBytes = 84;    // 80 bytes of text and the triangle count
constexpr std::size_t kStlTriangleBytes = 50;  // normal, three points, attribute
constexpr std::size_t kHeadBytes = 4096;       // far beyond any header that states a unit or counts

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

std::string read_bytes(const std::filesystem::path& file, std::size_t limit) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) {
        throw IoError("mesh.missing_file", file.string(), "no such file, check the name");
    }
    if (std::filesystem::is_directory(file, error)) {
        throw IoError("mesh.unreadable", file.string(), "is a folder, name the mesh file in it");
    }
    std::ifstream stream(file, std::ios::binary);
    const auto size = std::filesystem::file_size(file, error);
    if (!stream || error) {
        throw IoError("mesh.unreadable", file.string(), "cannot be opened, check its permissions");
    }
    std::string bytes(std::min<std::size_t>(limit, size), '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (stream.gcount() != static_cast<std::streamsize>(bytes.size())) {
        throw IoError("mesh.unreadable", file.string(), "ends while being read, copy it again");
    }
    return bytes;
}

bool is_text(std::string_view head) {
    return std::none_of(head.begin(), head.end(), [](unsigned char c) {
        return c < 32 && c != '\n' && c != '\r' && c != '\t' && c != '\f' && c != '\v';
    });
}

std::string_view last_line(std::string_view bytes) {
    const std::size_t end = bytes.find_last_not_of(" \t\r\n");
    if (end == std::string_view::npos) {
        return {};
    }
    bytes = bytes.substr(0, end + 1);
    const std::size_t start = bytes.find_last_of("\r\n");
    bytes = start == std::string_view::npos ? bytes : bytes.substr(start + 1);
    return bytes.substr(std::min(bytes.find_first_not_of(" \t"), bytes.size()));
}

void check_ascii_stl(const std::string& bytes, const std::string& name) {
    if (lower(std::string_view(bytes).substr(0, kHeadBytes)).find("facet") == std::string::npos) {
        throw InputError("mesh.not_a_mesh", name,
                         "is text without a single STL facet, export the part as STL");
    }
    const std::string end = lower(last_line(bytes).substr(0, 8));
    if (end != "endsolid" && end != "endfacet") {
        throw InputError("mesh.truncated", name,
                         "the text ends inside a facet, export or copy the file again");
    }
}

// Cuts off bytes beyond the last triangle: some exporters pad, and assimp then takes the file for
// text.
void check_stl(std::string& bytes, const std::string& name) {
    std::uint32_t count = 0;
    if (bytes.size() >= kStlHeaderBytes) {
        std::memcpy(&count, bytes.data() + 80, sizeof count);
    }
    const std::size_t expected = kStlHeaderBytes + kStlTriangleBytes * std::size_t{count};
    if (bytes.size() == expected) {
        return;
    }
    if (is_text(std::string_view(bytes).substr(0, kHeadBytes))) {
        check_ascii_stl(bytes, name);
        return;
    }
    if (bytes.size() < kStlHeaderBytes || bytes.size() < expected) {
        const std::size_t held = bytes.size() < kStlHeaderBytes
                                     ? 0
                                     : (bytes.size() - kStlHeaderBytes) / kStlTriangleBytes;
        throw InputError("mesh.truncated", name,
                         "holds " + std::to_string(held) + " of the " + std::to_string(count) +
                             " triangles its header announces, export or copy the file again");
    }
    bytes.resize(expected);
}

// A corrupted count would make the reader allocate for it: no element takes less than a byte.
void check_count(double count, const std::string& bytes, const std::string& name) {
    if (count > static_cast<double>(bytes.size())) {
        throw InputError("mesh.truncated", name,
                         "its header announces more elements than the file has bytes, export or "
                         "copy the file again");
    }
}

void check_ply(const std::string& bytes, const std::string& name) {
    if (bytes.rfind("ply", 0) != 0 || bytes.find("end_header") == std::string::npos) {
        throw InputError("mesh.not_a_mesh", name, "has no PLY header, export the part again");
    }
    std::istringstream header(bytes.substr(0, bytes.find("end_header")));
    double rows = 0.0;
    for (std::string line; std::getline(header, line);) {
        std::istringstream words(line);
        std::string element;
        std::string kind;
        double count = 0.0;
        if (words >> element >> kind >> count && element == "element") {
            check_count(count, bytes, name);
            rows += count;
        }
    }
    check_count(rows, bytes, name);
}

void check_off(const std::string& bytes, const std::string& name) {
    std::istringstream stream(bytes.substr(0, kHeadBytes));
    std::string counts;
    bool magic = false;
    for (std::string line; counts.empty() && std::getline(stream, line);) {
        line = line.substr(0, line.find('#'));
        const std::size_t off = line.find("OFF");
        if (!magic && off != std::string::npos) {
            magic = true;
            line = line.substr(off + 3);
        }
        if (line.find_first_of("0123456789") != std::string::npos) {
            counts = line;
        }
    }
    double points = -1.0;
    double faces = -1.0;
    if (!magic || !(std::istringstream(counts) >> points >> faces)) {
        throw InputError("mesh.not_a_mesh", name, "has no OFF header, export the part again");
    }
    check_count(points + faces, bytes, name);
}

std::string checked_format(std::string& bytes, const std::filesystem::path& file) {
    const std::string name = file.string();
    const std::string format = lower(file.extension().string());
    if (bytes.find_first_not_of(" \t\r\n") == std::string::npos) {
        throw InputError("mesh.empty_file", name, "is empty, export the part again");
    }
    if (format == ".stl") {
        check_stl(bytes, name);
    } else if (format == ".ply") {
        check_ply(bytes, name);
    } else if (format == ".off") {
        check_off(bytes, name);
    } else if (format != ".obj") {
        throw InputError("mesh.unknown_format", name,
                         "the ending '" + format + "' is not known, use .stl, .obj, .ply or .off");
    }
    return format.substr(1);
}

void append(const aiMesh& part, TriangleSoup& soup) {
    const auto offset = static_cast<std::int32_t>(soup.points_mm.size());
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
        const aiVector3D& p = part.mVertices[v];
        soup.points_mm.emplace_back(p.x, p.y, p.z);
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
        const aiFace& face = part.mFaces[f];
        if (face.mNumIndices == 3) {
            soup.faces.push_back({offset + static_cast<std::int32_t>(face.mIndices[0]),
                                  offset + static_cast<std::int32_t>(face.mIndices[1]),
                                  offset + static_cast<std::int32_t>(face.mIndices[2])});
        }
    }
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

TriangleSoup read_triangles(const std::filesystem::path& file) {
    std::string bytes = read_bytes(file, std::string::npos);
    const std::string format = checked_format(bytes, file);
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(),
                                                       aiProcess_Triangulate, format.c_str());
    if (scene == nullptr) {
        std::string reason = importer.GetErrorString();
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        throw InputError("mesh.not_a_mesh", file.string(),
                         "cannot be read as " + format + " (" + reason + "), export it again");
    }
    TriangleSoup soup;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        append(*scene->mMeshes[m], soup);
    }
    if (soup.faces.empty()) {
        throw InputError("mesh.no_triangles", file.string(),
                         "holds no triangle, export the part's surface as triangles");
    }
    check_finite(soup, file.string());
    return soup;
}

double stated_unit_mm(const std::filesystem::path& file) {
    const std::string head = lower(read_bytes(file, kHeadBytes));
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
