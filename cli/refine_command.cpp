#include "cli/refine_command.h"

#include "cli/output_files.h"
#include "mesh/export.h"
#include "mesh/refine.h"

namespace meshwind {

std::size_t write_refined(const Mandrel& mandrel, double edge_mm,
                          const std::filesystem::path& file) {
    (void)mesh_format_of(file);
    TriangleSoup soup = refined(mandrel.surface, edge_mm).soup;
    const Eigen::Affine3d mandrel_to_file = mandrel.file_to_mandrel.inverse();
    for (Eigen::Vector3d& p : soup.points_mm) {
        p = mandrel_to_file * p;
    }
    write_file(file, mesh_file_bytes(soup, mesh_format_of(file)));
    return soup.faces.size();
}

}  // namespace meshwind
