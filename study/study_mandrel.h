/// Mandrels of a study: meshes of any edge length of one surface, and its exact paths.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mesh/mandrel.h"
#include "study/path_reference.h"

namespace meshwind {

struct StudyMeshOptions {
    double edge_mm = 5.0;
    bool irregular = true;  ///< made parts; a file's mesh is as irregular as it is
    std::uint64_t seed = 1;
};

struct StudyMandrel {
    std::string name;             ///< "cylinder-70", "torus", "tee.stl"
    std::string reference_words;  ///< reference of the paths, in a few words
    std::unique_ptr<PathReference> reference;
    /// \throws InputError make.* or study.edge when the surface cannot be meshed with such edges
    std::function<Surface(const StudyMeshOptions&)> mesh;
    TriangleSoup samples;              ///< triangles on or near the surface: where paths may start
    std::unique_ptr<Mandrel> mandrel;  ///< of a file; used by `mesh`
    std::unique_ptr<Surface> refined;  ///< of a file; used by `reference`
};

/// Cylinder around z, 400 mm long, against the closed form. \throws InputError make.not_positive
[[nodiscard]] StudyMandrel cylinder_study(double radius_mm);

/// The default shapes of `meshwind make`.
[[nodiscard]] StudyMandrel torus_study();
[[nodiscard]] StudyMandrel ellipsoid_study();
[[nodiscard]] StudyMandrel tee_study();

/// Radii of the cylinders where none are asked for.
inline constexpr std::array kStudyRadii_mm = {20.0, 70.0, 450.0};

/// The mandrels that a study knows by a name: "cylinder" of each radius, "torus", "ellipsoid",
/// "tee". \return none for any other name
[[nodiscard]] std::vector<StudyMandrel> known_studies(const std::string& name,
                                                      std::span<const double> radii_mm);

/// A part known only by its mesh: that mesh and coarser ones of it, against paths by
/// TraceMethod::Patches on the mesh refined once. \throws InputError refine.too_many
[[nodiscard]] StudyMandrel file_study(Mandrel mandrel);

/// A CAD part: its winding surface with triangles of each edge length, against paths on its exact
/// faces, approximated by triangles of a third of the shortest (81 times as near, by the fourth
/// order). \param shortest_mm of the study \throws Error as load_mandrel()
[[nodiscard]] StudyMandrel cad_study(const std::filesystem::path& file, double shortest_mm);

/// cad_study() or file_study(), by the ending of the file's name.
[[nodiscard]] StudyMandrel study_of_file(const std::filesystem::path& file, double unit_mm,
                                         double shortest_mm);

/// The winding surface of triangles, creases and rims as the import finds them.
[[nodiscard]] Surface frozen_surface(const TriangleSoup& soup);

/// Random starts of paths on the reference's surface, in any direction in it.
/// \return `count` starts, spread evenly by area; the same for the same seed
[[nodiscard]] std::vector<CurveState> random_starts(const StudyMandrel& mandrel, int count,
                                                    std::uint64_t seed);

}  // namespace meshwind
