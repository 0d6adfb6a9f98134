#include "winding/laminate/build_up.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include <Eigen/SparseCholesky>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// What a mesh of straight edges can show.
constexpr double kSpreadEdges = 1.5;

// Courses that cross stop anywhere on each other, in whole steps of a tow's thickness t. A taut tow
// spans such a step over sqrt(2 t / kn) to either side, 5 to 10 mm with 0.25 mm on a radius of 50
// mm: as far as it is wide and more.
constexpr double kCrossingTows = 2.0;

// And fits to two rings of neighbours carry no wave of less than six edges: with three edges to the
// knot two thirds of it go.
constexpr double kCrossingEdges = 3.0;

// Fibre is counted in cells of the meridian, so many to a knot distance: a whole number, so that
// the splines over them add up to one.
constexpr int kCells = 32;

// Half the spline's support, in knots.
constexpr double kReach = 2.0;

// Steps of diffusion whose variance is together that of the spline, a third of the spread squared.
constexpr int kDiffusionSteps = 2;

constexpr std::size_t kChunk = 256;

// The cubic B-spline with knots at whole numbers, support -2 .. 2.
double spline(double x) {
    const double a = std::abs(x);
    if (a >= kReach) {
        return 0.0;
    }
    const double outer = kReach - a;
    const double inner = 1.0 - a;
    return outer * outer * outer / 6.0 - (a < 1.0 ? 4.0 * inner * inner * inner / 6.0 : 0.0);
}

// Fibre length per cell of the meridian.
class FibreByArc {
public:
    FibreByArc(const Meridian& meridian, double cell_mm)
        : meridian_(meridian),
          cell_mm_(cell_mm),
          length_mm_(static_cast<std::size_t>(std::ceil(meridian.length_mm() / cell_mm)), 0.0) {}

    void add(const SurfacePath& path) {
        for (std::size_t i = 1; i < path.size(); ++i) {
            add_stretch(arc_of(path[i - 1]), arc_of(path[i]), path[i].s_mm - path[i - 1].s_mm);
        }
    }

    [[nodiscard]] const std::vector<double>& length_mm() const { return length_mm_; }

private:
    [[nodiscard]] double arc_of(const PathPoint& point) const {
        const Vector3d& p = point.position_mm;
        return meridian_.foot(std::hypot(p.x(), p.y()), p.z()).arc_mm;
    }

    // Fibre between two arc lengths, evenly.
    void add_stretch(double a_mm, double b_mm, double fibre_mm) {
        const double low = std::min(a_mm, b_mm);
        const double high = std::max(a_mm, b_mm);
        const std::size_t last = length_mm_.size() - 1;
        const auto cell_of = [&](double arc) {
            return std::min(static_cast<std::size_t>(arc / cell_mm_), last);
        };
        const std::size_t first = cell_of(low);
        if (first == cell_of(high)) {
            length_mm_[first] += fibre_mm;
            return;
        }
        for (std::size_t cell = first; cell <= cell_of(high); ++cell) {
            const double from = std::max(low, static_cast<double>(cell) * cell_mm_);
            const double to =
                cell == last ? high : std::min(high, static_cast<double>(cell + 1) * cell_mm_);
            length_mm_[cell] += fibre_mm * std::max(0.0, to - from) / (high - low);
        }
    }

    const Meridian& meridian_;
    double cell_mm_;
    std::vector<double> length_mm_;
};

double cot(const Vector3d& a, const Vector3d& b) {
    return a.dot(b) / a.cross(b).norm();
}

using Sparse = Eigen::SparseMatrix<double>;

// A surface as linear finite elements.
struct Sheet {
    Eigen::VectorXd mass_mm2;  // per vertex, lumped
    Eigen::VectorXd laid_mm3;  // per vertex: mass times thickness, of its faces
    Sparse stiffness;
};

Sheet sheet_of(const Surface& surface, std::span<const double> face_layers,
               double tow_thickness_mm) {
    const auto n = static_cast<Eigen::Index>(surface.position_mm.size());
    Sheet sheet{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), Sparse(n, n)};
    std::vector<Eigen::Triplet<double>> stiffness;
    stiffness.reserve(12 * surface.face.size());
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        std::array<Vector3d, 3> p;
        for (std::size_t c = 0; c < 3; ++c) {
            p[c] = surface.position_mm[static_cast<std::size_t>(surface.face[f][c])];
        }
        const double third_mm2 = (p[1] - p[0]).cross(p[2] - p[0]).norm() / 6.0;
        for (std::size_t c = 0; c < 3; ++c) {
            const Eigen::Index i = surface.face[f][c];
            const Eigen::Index j = surface.face[f][(c + 1) % 3];
            const Vector3d& opposite = p[(c + 2) % 3];
            const double weight = 0.5 * cot(p[c] - opposite, p[(c + 1) % 3] - opposite);
            sheet.mass_mm2[i] += third_mm2;
            sheet.laid_mm3[i] += third_mm2 * face_layers[f] * tow_thickness_mm;
            stiffness.emplace_back(i, i, weight);
            stiffness.emplace_back(j, j, weight);
            stiffness.emplace_back(i, j, -weight);
            stiffness.emplace_back(j, i, -weight);
        }
    }
    sheet.stiffness.setFromTriplets(stiffness.begin(), stiffness.end());
    return sheet;
}

// From unknowns to vertices: all vertices of a rim share one unknown, others have their own.
Sparse rims_as_one(const Surface& surface) {
    std::vector<std::int32_t> rim_of(surface.position_mm.size(), -1);
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            if (surface.rim[f][e] >= 0) {
                for (const std::size_t end : {e, (e + 1) % 3}) {
                    rim_of[static_cast<std::size_t>(surface.face[f][end])] = surface.rim[f][e];
                }
            }
        }
    }
    std::map<std::int32_t, Eigen::Index> unknown_of_rim;
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(rim_of.size());
    Eigen::Index unknowns = 0;
    for (std::size_t v = 0; v < rim_of.size(); ++v) {
        Eigen::Index unknown = unknowns;
        if (rim_of[v] >= 0) {
            unknown = unknown_of_rim.try_emplace(rim_of[v], unknowns).first->second;
        }
        unknowns += unknown == unknowns ? 1 : 0;
        entries.emplace_back(static_cast<Eigen::Index>(v), unknown, 1.0);
    }
    Sparse hold(static_cast<Eigen::Index>(rim_of.size()), unknowns);
    hold.setFromTriplets(entries.begin(), entries.end());
    return hold;
}

}  // namespace

double spread_mm(const Surface& surface, double tow_width_mm) {
    return std::max(tow_width_mm, kSpreadEdges * surface.mean_edge_mm);
}

double crossing_spread_mm(const Surface& surface, double tow_width_mm) {
    return std::max(kCrossingTows * tow_width_mm, kCrossingEdges * surface.mean_edge_mm);
}

std::vector<double> regular_build_up_mm(const Surface& surface, const BodyOfRevolution& body,
                                        std::span<const Piece> pieces, double tow_width_mm,
                                        double tow_thickness_mm) {
    const Meridian& meridian = body.meridian;
    const double cell_mm = spread_mm(surface, tow_width_mm) / kCells;
    FibreByArc fibre(meridian, cell_mm);
    for (const Piece& piece : pieces) {
        if (piece.path.front().at.face != kNoFace) {  // turns lie on extensions
            fibre.add(piece.path);
        }
    }
    const std::vector<double>& length_mm = fibre.length_mm();
    std::vector<double> ring_mm2(length_mm.size());
    for (std::size_t cell = 0; cell < ring_mm2.size(); ++cell) {
        const double from = static_cast<double>(cell) * cell_mm;
        const double to = std::min(from + cell_mm, meridian.length_mm());
        ring_mm2[cell] = 2.0 * kPi * meridian.at(0.5 * (from + to)).radius_mm * (to - from);
    }
    const auto at = [&](double arc_mm) {
        const double place = arc_mm / cell_mm - 0.5;
        const double reach = kReach * kCells;
        const auto first = static_cast<std::size_t>(std::max(0.0, std::ceil(place - reach)));
        const auto last =
            std::min(length_mm.size() - 1, static_cast<std::size_t>(std::max(0.0, place + reach)));
        double covered_mm2 = 0.0;
        double area_mm2 = 0.0;
        for (std::size_t cell = first; cell <= last; ++cell) {
            const double weight = spline((static_cast<double>(cell) - place) / kCells);
            covered_mm2 += weight * tow_width_mm * length_mm[cell];
            area_mm2 += weight * ring_mm2[cell];
        }
        return tow_thickness_mm * covered_mm2 / area_mm2;
    };
    std::vector<double> thickness_mm(surface.position_mm.size());
    parallel_for(thickness_mm.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const Vector3d& p = surface.position_mm[v];
            thickness_mm[v] = at(meridian.foot(std::hypot(p.x(), p.y()), p.z()).arc_mm);
        }
    });
    return thickness_mm;
}

std::vector<double> build_up_mm(const Surface& surface, std::span<const double> face_layers,
                                double tow_width_mm, double tow_thickness_mm) {
    const Sheet sheet = sheet_of(surface, face_layers, tow_thickness_mm);
    // Variance along a line: twice the time.
    const double spread = crossing_spread_mm(surface, tow_width_mm);
    const double time_mm2 = spread * spread / 6.0 / kDiffusionSteps;
    const Sparse flow = time_mm2 * sheet.stiffness;
    // Both steps, (M + F) 1/M (M + F), at once, so that rims are held in the result and not between
    // the steps: that is what takes the slope there to zero, too.
    Sparse matrix = Sparse(flow * sheet.mass_mm2.cwiseInverse().asDiagonal() * flow) + 2.0 * flow;
    matrix += Sparse(sheet.mass_mm2.asDiagonal());
    const Sparse hold = rims_as_one(surface);
    const Eigen::SimplicialLDLT<Sparse> solver(Sparse(hold.transpose() * matrix * hold));
    if (solver.info() != Eigen::Success) {
        throw InputError("thicken.thin", "",
                         "the layers' thickness cannot be spread over triangles as thin as some of "
                         "this mesh; refine or remesh the part");
    }
    const Eigen::VectorXd held = hold.transpose() * sheet.laid_mm3;
    const Eigen::VectorXd thickness = hold * Eigen::VectorXd(solver.solve(held));
    // Obtuse triangles may undershoot by a little beside what is bare.
    std::vector<double> result(surface.position_mm.size());
    for (std::size_t v = 0; v < result.size(); ++v) {
        result[v] = std::max(0.0, thickness[static_cast<Eigen::Index>(v)]);
    }
    return result;
}

}  // namespace meshwind
