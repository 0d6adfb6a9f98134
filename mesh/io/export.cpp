#include "mesh/io/export.h"

#include <bit>
#include <cstdint>
#include <fstream>
#include <limits>
#include <system_error>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/text/text_number.h"
#include "mesh/io/import.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

void append_little_endian(std::string& bytes, std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) {
        bytes.push_back(static_cast<char>((value >> shift) & 0xffU));
    }
}

void append_float(std::string& bytes, double value) {
    // + 0 turns -0 into 0.
    append_little_endian(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value) + 0.0F));
}

void append_floats(std::string& bytes, const Vector3d& v) {
    append_float(bytes, v.x());
    append_float(bytes, v.y());
    append_float(bytes, v.z());
}

std::string stl_bytes(const TriangleSoup& soup) {
    constexpr std::size_t kHeader = 80;
    constexpr std::size_t kPerTriangle = 50;
    if (soup.faces.size() > std::numeric_limits<std::uint32_t>::max()) {
        throw InputError("export.too_large", "",
                         std::to_string(soup.faces.size()) +
                             " triangles are more than an STL file can count; use PLY");
    }
    // Readers take a file that begins with "solid" for text.
    std::string bytes = "binary STL, mm, meshwind";
    bytes.resize(kHeader, ' ');
    bytes.reserve(kHeader + 4 + kPerTriangle * soup.faces.size());
    append_little_endian(bytes, static_cast<std::uint32_t>(soup.faces.size()));
    for (const auto& [a, b, c] : soup.faces) {
        const Vector3d& p = soup.points_mm[static_cast<std::size_t>(a)];
        const Vector3d& q = soup.points_mm[static_cast<std::size_t>(b)];
        const Vector3d& r = soup.points_mm[static_cast<std::size_t>(c)];
        append_floats(bytes, (q - p).cross(r - p).normalized());
        append_floats(bytes, p);
        append_floats(bytes, q);
        append_floats(bytes, r);
        bytes.append(2, '\0');
    }
    return bytes;
}

void append_points(std::string& text, const TriangleSoup& soup, const char* lead) {
    for (const Vector3d& point : soup.points_mm) {
        text.append(lead);
        append_shortest(text, point.x());
        text.push_back(' ');
        append_shortest(text, point.y());
        text.push_back(' ');
        append_shortest(text, point.z());
        text.push_back('\n');
    }
}

void append_faces(std::string& text, const TriangleSoup& soup, const char* lead, int first) {
    for (const auto& [a, b, c] : soup.faces) {
        text.append(lead);
        text.append(std::to_string(a + first)).push_back(' ');
        text.append(std::to_string(b + first)).push_back(' ');
        text.append(std::to_string(c + first)).push_back('\n');
    }
}

std::string obj_text(const TriangleSoup& soup) {
    std::string text = "# meshwind, mm\n";
    append_points(text, soup, "v ");
    append_faces(text, soup, "f ", 1);
    return text;
}

std::string ply_text(const TriangleSoup& soup) {
    std::string text = "ply\nformat ascii 1.0\ncomment meshwind, mm\nelement vertex ";
    text += std::to_string(soup.points_mm.size());
    text += "\nproperty double x\nproperty double y\nproperty double z\nelement face ";
    text += std::to_string(soup.faces.size());
    text += "\nproperty list uchar int vertex_indices\nend_header\n";
    append_points(text, soup, "");
    append_faces(text, soup, "3 ", 0);
    return text;
}

std::string off_text(const TriangleSoup& soup) {
    std::string text = "OFF\n" + std::to_string(soup.points_mm.size()) + ' ' +
                       std::to_string(soup.faces.size()) + " 0\n";
    append_points(text, soup, "");
    append_faces(text, soup, "3 ", 0);
    return text;
}

}  // namespace

MeshFormat mesh_format_of(const std::filesystem::path& file) {
    const std::string extension = lower_ending(file);
    if (extension == ".stl") {
        return MeshFormat::Stl;
    }
    if (extension == ".obj") {
        return MeshFormat::Obj;
    }
    if (extension == ".ply") {
        return MeshFormat::Ply;
    }
    if (extension == ".off") {
        return MeshFormat::Off;
    }
    throw InputError("export.unknown_format", file.string(),
                     "the extension \"" + extension + "\" is none of .stl, .obj, .ply, .off");
}

std::string mesh_file_bytes(const TriangleSoup& soup, MeshFormat format) {
    switch (format) {
        case MeshFormat::Obj:
            return obj_text(soup);
        case MeshFormat::Ply:
            return ply_text(soup);
        case MeshFormat::Off:
            return off_text(soup);
        case MeshFormat::Stl:
            break;
    }
    return stl_bytes(soup);
}

void write_mesh_file(const TriangleSoup& soup, const std::filesystem::path& file) {
    const std::string bytes = mesh_file_bytes(soup, mesh_format_of(file));
    std::filesystem::path unfinished = file;
    unfinished += ".part";
    std::ofstream stream(unfinished, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    std::error_code error;
    if (stream) {
        std::filesystem::rename(unfinished, file, error);
    }
    if (!stream || error) {
        std::error_code ignored;
        std::filesystem::remove(unfinished, ignored);
        throw IoError("export.unwritable", file.string(),
                      "cannot be written; check that the folder exists and has room");
    }
}

}  // namespace meshwind
