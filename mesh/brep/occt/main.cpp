// meshwind-cad FILE SOLID EDGE_MM: a CAD file as even triangles, for mesh/brep/read_cad.cpp, which
// starts it: to standard output the bytes of a CadMesh and exit code 0, or code, place and words of
// what is wrong, a line each, and 2. A program of its own, so that meshwind starts, and is
// installed, without Open CASCADE, and outlives it.
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <string>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <Standard_Failure.hxx>

#include "core/error.h"
#include "core/text/text_number.h"
#include "mesh/brep/occt/occt_faces.h"
#include "mesh/brep/occt/occt_read.h"

namespace meshwind {
namespace {

// Enough for a part of 10,000 faces; a damaged file that asks for more is refused, not swapped for.
constexpr rlim_t kMaxMemory = rlim_t{6} << 30;

// Points that faces share may be so much off them: a fifth of a thin ply.
constexpr double kMaxOffFace_mm = 0.05;

CadMesh mesh_of(const std::string& file, const std::string& solid, double edge_mm) {
    const OcctPart part = read_occt(file, solid);
    OcctFaces faces(part.shape);
    const OcctMesh first = faces.first_mesh();
    if (!first.failed_faces.empty()) {
        throw InputError("mesh.cad_face", file,
                         "face " + std::to_string(first.failed_faces.front() + 1) +
                             (first.failed_faces.size() > 1
                                  ? " and " + std::to_string(first.failed_faces.size() - 1) +
                                        " more cannot be meshed"
                                  : " cannot be meshed") +
                             "; let the CAD program repair the part, or export it as .stl");
    }
    if (first.off_face_mm > kMaxOffFace_mm) {
        throw InputError("mesh.cad_tolerance", file,
                         "an edge of face " + std::to_string(first.off_face + 1) + " is " +
                             fixed(first.off_face_mm, 2) + " mm off it, more than " +
                             fixed(kMaxOffFace_mm, 2) +
                             " mm; let the CAD program repair the part, or export it as .stl");
    }
    CadMesh mesh = even_part(first.soup, first.face, faces, edge_mm);
    mesh.faces = faces.describe(part.colours);
    for (std::size_t f = 0; f < mesh.soup.faces.size(); ++f) {
        mesh.faces[static_cast<std::size_t>(mesh.face[f])].area_mm2 +=
            area_mm2(mesh.soup.points_mm, mesh.soup.faces[f]);
    }
    mesh.unit_mm = part.unit_mm;
    mesh.off_face_mm = first.off_face_mm;
    mesh.open_edges = first.open_edges;
    mesh.sewn_edges = part.sewn_edges;
    return mesh;
}

bool write(int output, const std::string& bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t count = ::write(output, bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno != EINTR) {
            return false;
        }
        done += count > 0 ? static_cast<std::size_t>(count) : 0;
    }
    return true;
}

int run(const std::string& file, const std::string& solid, double edge_mm, int output) {
    const auto fail = [output](const std::string& code, const std::string& place,
                               const std::string& words) {
        return write(output, code + '\n' + place + '\n' + words + '\n') ? 2 : 1;
    };
    try {
        return write(output, bytes_of(mesh_of(file, solid, edge_mm))) ? 0 : 1;
    } catch (const Error& error) {
        return fail(error.code(), error.place(), error.words());
    } catch (const Standard_Failure& failure) {
        return fail("mesh.cad_failed", file,
                    std::string("the CAD kernel gives up on it (") + failure.GetMessageString() +
                        "); export the part again, or as .stl");
    } catch (const std::bad_alloc&) {
        return fail("mesh.cad_failed", file,
                    "takes more than 6 GB to read; export the part alone, or as .stl");
    } catch (const std::exception& error) {
        return fail("mesh.cad_failed", file,
                    std::string("cannot be meshed (") + error.what() +
                        "); export the part again, or as .stl");
    }
}

}  // namespace
}  // namespace meshwind

int main(int count, char** arguments) {
    if (count != 4) {
        std::cerr << "usage: meshwind-cad FILE SOLID EDGE_MM; meshwind starts it for CAD files\n";
        return 2;
    }
    const rlimit memory{meshwind::kMaxMemory, meshwind::kMaxMemory};
    setrlimit(RLIMIT_AS, &memory);
    // The kernel has words for standard output, whatever its printers are told.
    const int output = dup(STDOUT_FILENO);
    const int nowhere = open("/dev/null", O_WRONLY);
    if (output < 0 || nowhere < 0 || dup2(nowhere, STDOUT_FILENO) < 0 ||
        dup2(nowhere, STDERR_FILENO) < 0) {
        return 1;
    }
    return meshwind::run(arguments[1], arguments[2], std::strtod(arguments[3], nullptr), output);
}
