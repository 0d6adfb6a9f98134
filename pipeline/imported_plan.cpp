#include "pipeline/imported_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "geodesic/biarc.h"
#include "geodesic/field_walk.h"
#include "geodesic/slip_and_bridging.h"
#include "postproc/tables/landing_circuits.h"
#include "postproc/tables/landing_path.h"
#include "winding/laminate/measure_plan.h"

namespace meshwind {
namespace {

// Courses that come so near meet: positions in tables are rounded to 0.1 mm at worst.
constexpr double kMeets_mm = 0.1;

// And there the fibre turns no more than this, which the free fibre smooths out.
constexpr double kMeets_rad = 0.05;

Eigen::Affine3d mandrel_from_table(const Mandrel& mandrel, const ImportRequest& request,
                                   bool in_mm) {
    if (request.mandrel_frame) {
        return Eigen::Affine3d::Identity();
    }
    Eigen::Affine3d from_file = mandrel.file_to_mandrel;
    if (in_mm) {
        from_file.linear() /= mandrel.unit_mm;
    }
    return from_file;
}

class Importer {
public:
    Importer(const Setup& setup, const ImportRequest& request, std::uint64_t seed, ImportFit& fit)
        : setup_(setup), request_(request), wall_(setup.wall->surface()), seed_(seed), fit_(fit) {}

    Plan run() {
        LandingTable table = read_landing_csv(request_.points.text, request_.points.file.string());
        const Eigen::Affine3d from_table =
            mandrel_from_table(setup_.mandrel, request_, table.in_mm);
        table = repeated(std::move(table), request_.circuits, request_.turn_rad, from_table);
        if (request_.smooth_mm > 0.0) {
            table = joined(std::move(table), kMeets_mm, from_table);
        }
        LandingPaths paths(wall_, {.mandrel_from_table = from_table,
                                   .farthest_mm = request_.farthest_mm,
                                   .smooth_mm = request_.smooth_mm,
                                   .file = request_.points.file.string()});
        plan_.planner = Planner::Imported;
        for (std::size_t i = 0; i < table.courses.size(); ++i) {
            const LandingCourse& course = table.courses[i];
            SurfacePath path = paths.through(course);
            if (i > 0) {
                join(table.courses[i - 1], course, path);
            }
            TautString string = paths.string_over(path);
            add(course.transition ? PieceKind::Transition : PieceKind::Course, std::move(path),
                std::move(string));
        }
        plan_.pieces.front().starts_fibre = true;
        plan_.fibres = 1;
        measure_plan(setup_.mandrel.surface, wall_, setup_.job.tow.width_mm, seed_, {}, plan_);
        tell_fit(paths.moves());
        return std::move(plan_);
    }

private:
    void tell_fit(const LandingMoves& moves) {
        fit_.file = request_.points.file.filename().string();
        fit_.mandrel_frame = request_.mandrel_frame;
        fit_.points = moves.points;
        fit_.repeated = moves.repeated;
        fit_.worst_mm = moves.worst_mm;
        fit_.mean_mm = moves.sum_mm / static_cast<double>(moves.points);
        fit_.worst_line = moves.worst_line;
        fit_.limit_mm = request_.farthest_mm;
        fit_.circuits = request_.circuits;
        fit_.smoothed_mm = moves.smoothed_mm;
    }

    void add(PieceKind kind, SurfacePath path, TautString string) {
        Piece piece;
        piece.kind = kind;
        piece.string = std::move(string);
        const SlipMeasure slip =
            measure_slip(wall_, path, piece.string,
                         {.friction = setup_.friction.holds(), .method = TraceMethod::Patches});
        for (std::size_t i = 0; i < path.size(); ++i) {
            path[i].kg_per_mm = slip.kg_per_mm[i];
        }
        piece.slip = slip.slip;
        piece.worst_slip = slip.worst;
        piece.path = std::move(path);
        plan_.courses += kind == PieceKind::Course ? 1 : 0;
        plan_.fibre_length_mm += piece.path.back().s_mm;
        plan_.worst_slip = std::max(plan_.worst_slip, piece.worst_slip);
        plan_.worst_bridge_mm = std::max(plan_.worst_bridge_mm, piece.string.worst_gap_mm);
        plan_.pieces.push_back(std::move(piece));
    }

    // Adds what leads from the last piece to a path, where they do not meet.
    void join(const LandingCourse& before, const LandingCourse& course, const SurfacePath& path) {
        const PathPoint& end = plan_.pieces.back().path.back();
        const PathPoint& start = path.front();
        const double gap_mm = (start.position_mm - end.position_mm).norm();
        const double turn_rad = std::acos(std::clamp(start.tangent.dot(end.tangent), -1.0, 1.0));
        const auto fail = [&](const std::string& why) {
            throw InputError(
                "import.not_joined",
                request_.points.file.string() + ":" + std::to_string(course.rows.front().line),
                "course " + course.name + " starts " + fixed(gap_mm, 2) +
                    " mm from the end of course " + before.name + ", turned by " +
                    fixed(deg_from_rad(turn_rad), 1) + " deg: " + why +
                    "; move them together, turn one round, or give points between");
        };
        if (gap_mm <= kMeets_mm) {
            if (turn_rad > kMeets_rad) {
                fail("a fibre does not turn on the spot");
            }
            plan_.worst_joint_mm = std::max(plan_.worst_joint_mm, gap_mm);
            return;
        }
        Biarc link = biarc(wall_, on_the_spot(end), on_the_spot(start));
        if (!link.found) {
            fail("no path over the mandrel leads from one to the other");
        }
        const double holds = setup_.friction.planned().holds();
        const double ratio = std::max(std::abs(link.slip_ratio), std::abs(link.slip_ratio_2));
        if (ratio > holds) {
            fail("the way over the mandrel asks for a slip ratio of " + fixed(ratio, 3) +
                 " where " + fixed(holds, 3) + " of the friction may be used");
        }
        TautString string = taut_string(link.path);
        const double bridge_mm = string.worst_gap_mm;
        if (bridge_mm > setup_.job.tow.bridging_tolerance_mm) {
            fail("the way over the mandrel bridges by " + fixed(bridge_mm, 2) + " mm where " +
                 fixed(setup_.job.tow.bridging_tolerance_mm, 2) + " mm are allowed");
        }
        ++fit_.joins;
        add(PieceKind::Transition, std::move(link.path), std::move(string));
        thin_out(plan_.pieces.back(), kLandingStation_mm);
    }

    // The faces of a path's ends are those of its inside, which matters on edges.
    [[nodiscard]] PathPoint on_the_spot(const PathPoint& station) const {
        FieldWalker walker(wall_, station.at);
        (void)walker.move_under(station.position_mm);
        return walker.station(station.tangent);
    }

    const Setup& setup_;
    const ImportRequest& request_;
    const Surface& wall_;
    std::uint64_t seed_;
    ImportFit& fit_;
    Plan plan_;
};

}  // namespace

Plan import_plan(const Setup& setup, const ImportRequest& request, std::uint64_t seed,
                 ImportFit& fit) {
    return Importer(setup, request, seed, fit).run();
}

}  // namespace meshwind
