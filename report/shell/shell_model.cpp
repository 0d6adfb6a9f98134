#include "report/shell/shell_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "core/error.h"
#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Triangles that meet at more are no smooth surface: half of what rims and steps of a part have,
// and more than neighbours on the coarsest bend that is wound.
const double kCreaseCosine = std::cos(rad_from_deg(30.0));

using Side = std::pair<std::int32_t, std::int32_t>;

Side side_of(std::int32_t a, std::int32_t b) {
    return std::minmax(a, b);
}

// Twice the area, along the normal.
Vector3d normal_area(const ShellMesh& mesh, const ShellTriangle& t) {
    const auto at = [&](std::size_t k) -> const Vector3d& {
        return mesh.point_mm[static_cast<std::size_t>(t.point[k])];
    };
    return (at(1) - at(0)).cross(at(2) - at(0));
}

class Middles {
public:
    explicit Middles(const ShellMesh& mesh) : mesh_(mesh), at_point_(mesh.point_mm.size()) {
        for (const ShellTriangle& t : mesh.triangle) {
            normal_.push_back(normal_area(mesh, t).normalized());
        }
        for (std::size_t f = 0; f < mesh.triangle.size(); ++f) {
            for (const std::int32_t point : mesh.triangle[f].point) {
                at_point_[static_cast<std::size_t>(point)].push_back(f);
            }
        }
    }

    // Of the side from `a` to `b` of a triangle: the middle of the cubic that stands square to the
    // normals of its ends (PN triangles, vlachos_2001_pn_triangles).
    [[nodiscard]] Vector3d middle(std::size_t face, std::int32_t a, std::int32_t b) const {
        const Vector3d& from = mesh_.point_mm[static_cast<std::size_t>(a)];
        const Vector3d& to = mesh_.point_mm[static_cast<std::size_t>(b)];
        const Vector3d n_a = normal_at(face, a);
        const Vector3d n_b = normal_at(face, b);
        return 0.5 * (from + to) -
               0.125 * ((to - from).dot(n_a) * n_a + (from - to).dot(n_b) * n_b);
    }

    // Whether both triangles of a side belong to one smooth surface.
    [[nodiscard]] bool smooth(std::size_t face, std::size_t other) const {
        return normal_[face].dot(normal_[other]) >= kCreaseCosine;
    }

private:
    // Of the triangles around a point that are smooth with `face`, by their angles there.
    [[nodiscard]] Vector3d normal_at(std::size_t face, std::int32_t point) const {
        Vector3d sum = Vector3d::Zero();
        for (const std::size_t f : at_point_[static_cast<std::size_t>(point)]) {
            if (smooth(face, f)) {
                sum += angle_at(mesh_.triangle[f], point) * normal_[f];
            }
        }
        return sum.normalized();
    }

    [[nodiscard]] double angle_at(const ShellTriangle& t, std::int32_t point) const {
        const std::size_t k = t.point[0] == point ? 0 : (t.point[1] == point ? 1 : 2);
        const auto at = [&](std::size_t corner) -> const Vector3d& {
            return mesh_.point_mm[static_cast<std::size_t>(t.point[corner % 3])];
        };
        const Vector3d left = at(k + 1) - at(k);
        const Vector3d right = at(k + 2) - at(k);
        return std::atan2(left.cross(right).norm(), left.dot(right));
    }

    const ShellMesh& mesh_;
    std::vector<Vector3d> normal_;
    std::vector<std::vector<std::size_t>> at_point_;
};

// Nodes and elements.
void build_elements(const ShellMesh& mesh, ElementOrder order, ShellModel& model) {
    model.node_mm = mesh.point_mm;
    model.element.resize(mesh.triangle.size());
    const Middles middles(mesh);
    std::map<Side, std::vector<std::size_t>> faces;
    for (std::size_t f = 0; f < mesh.triangle.size(); ++f) {
        const auto& point = mesh.triangle[f].point;
        for (std::size_t k = 0; k < 3; ++k) {
            model.element[f][k] = point[k];
            faces[side_of(point[k], point[(k + 1) % 3])].push_back(f);
        }
    }
    if (order == ElementOrder::Linear) {
        return;
    }
    for (const auto& [side, of] : faces) {
        const auto node = static_cast<std::int32_t>(model.node_mm.size());
        const bool crease = of.size() == 2 && !middles.smooth(of[0], of[1]);
        model.node_mm.push_back(
            crease ? Vector3d(0.5 * (mesh.point_mm[static_cast<std::size_t>(side.first)] +
                                     mesh.point_mm[static_cast<std::size_t>(side.second)]))
                   : middles.middle(of.front(), side.first, side.second));
        for (const std::size_t f : of) {
            const auto& point = mesh.triangle[f].point;
            for (std::size_t k = 0; k < 3; ++k) {
                if (side_of(point[k], point[(k + 1) % 3]) == side) {
                    model.element[f][3 + k] = node;
                }
            }
        }
    }
}

// What part of a force that is spread evenly along a rim each of its nodes takes; 1 in sum.
std::map<std::int32_t, double> shares_along(const ShellModel& model, const ShellRim& rim,
                                            const std::map<Side, std::int32_t>& middle) {
    std::map<std::int32_t, double> share;
    double whole = 0.0;
    for (std::size_t i = 0; i < rim.point.size(); ++i) {
        const std::int32_t a = rim.point[i];
        const std::int32_t b = rim.point[(i + 1) % rim.point.size()];
        const double length = (model.node_mm[static_cast<std::size_t>(b)] -
                               model.node_mm[static_cast<std::size_t>(a)])
                                  .norm();
        whole += length;
        const auto between = middle.find(side_of(a, b));
        const double end = between == middle.end() ? 0.5 : 1.0 / 6.0;
        share[a] += end * length;
        share[b] += end * length;
        if (between != middle.end()) {
            share[between->second] += (1.0 - 2.0 * end) * length;
        }
    }
    for (auto& [node, part] : share) {
        part /= whole;
    }
    return share;
}

class Loader {
public:
    Loader(const ShellModel& model, ElementOrder order) : model_(model) {
        for (std::size_t f = 0; order == ElementOrder::Quadratic && f < model.element.size(); ++f) {
            const auto& node = model.element[f];
            for (std::size_t k = 0; k < 3; ++k) {
                middle_[side_of(node[k], node[(k + 1) % 3])] = node[3 + k];
            }
        }
    }

    [[nodiscard]] std::vector<NodalForce> forces() const {
        std::vector<NodalForce> all;
        for (const auto& [node, force] : force_) {
            all.push_back({node, force});
        }
        return all;
    }

    void pull(const ShellRim& rim, const Vector3d& force_n) {
        for (const auto& [node, share] : shares_along(model_, rim, middle_)) {
            add(node, share * force_n);
        }
    }

    // Forces square to the rim's plane, as a beam's section has them, for the moment's part in that
    // plane, and around the rim for its part along the axis.
    void turn(const ShellRim& rim, const Vector3d& moment_nmm) {
        const Vector3d along = rim.area_mm2.normalized();
        const auto shares = shares_along(model_, rim, middle_);
        Vector3d centre = Vector3d::Zero();
        for (const auto& [node, share] : shares) {
            centre += share * position(node);
        }
        Eigen::Matrix3d inertia = along * along.transpose();
        for (const auto& [node, share] : shares) {
            const Vector3d arm = across(position(node) - centre, along).cross(along);
            inertia += share * arm * arm.transpose();
        }
        const Vector3d bending = inertia.ldlt().solve(across(moment_nmm, along));
        const double twisting = moment_nmm.dot(along) / (inertia.trace() - 1.0);
        for (const auto& [node, share] : shares) {
            const Vector3d arm = across(position(node) - centre, along).cross(along);
            add(node, share * (arm.dot(bending) * along - twisting * arm));
        }
    }

private:
    static Vector3d across(const Vector3d& v, const Vector3d& along) {
        return v - v.dot(along) * along;
    }
    [[nodiscard]] const Vector3d& position(std::int32_t node) const {
        return model_.node_mm[static_cast<std::size_t>(node)];
    }
    void add(std::int32_t node, const Vector3d& force_n) {
        force_.try_emplace(node, Vector3d::Zero()).first->second += force_n;
    }

    const ShellModel& model_;
    std::map<Side, std::int32_t> middle_;
    std::map<std::int32_t, Vector3d> force_;
};

std::array<std::size_t, 2> pair_of_rims(const ShellMesh& mesh, const ShellLoads& loads) {
    if (loads.rims) {
        for (const std::size_t rim : *loads.rims) {
            if (rim >= mesh.rim.size()) {
                throw InputError("shell.no_rim", "rim " + std::to_string(rim + 1),
                                 "the wall has rims 1 to " + std::to_string(mesh.rim.size()));
            }
        }
        if ((*loads.rims)[0] == (*loads.rims)[1]) {
            throw InputError("shell.no_rim", "rim " + std::to_string((*loads.rims)[0] + 1),
                             "a load between two rims needs two");
        }
        return *loads.rims;
    }
    if (mesh.rim.size() < 2) {
        throw InputError("shell.no_pair", "axial load or moment",
                         "needs two rims, and the wall has " + std::to_string(mesh.rim.size()));
    }
    std::array<std::size_t, 2> best = {0, 1};
    double worth = -std::numeric_limits<double>::infinity();
    for (std::size_t b = 1; b < mesh.rim.size(); ++b) {
        for (std::size_t a = 0; a < b; ++a) {
            const Vector3d off = mesh.rim[b].centre_mm - mesh.rim[a].centre_mm;
            const double facing = mesh.rim[b].area_mm2.normalized().dot(off) -
                                  mesh.rim[a].area_mm2.normalized().dot(off);
            if (facing > worth) {
                worth = facing;
                best = {a, b};
            }
        }
    }
    return best;
}

// The six of all displacements that hold a body still best: rows of rigid motions, by pivoting.
std::vector<Support> six_supports(const ShellModel& model) {
    const std::size_t corners = model.mesh->point_mm.size();
    Vector3d centre = Vector3d::Zero();
    for (std::size_t i = 0; i < corners; ++i) {
        centre += model.node_mm[i] / static_cast<double>(corners);
    }
    double size = 0.0;
    for (std::size_t i = 0; i < corners; ++i) {
        size = std::max(size, (model.node_mm[i] - centre).norm());
    }
    Eigen::Matrix<double, 6, Eigen::Dynamic> motion(6, static_cast<Eigen::Index>(3 * corners));
    for (std::size_t i = 0; i < corners; ++i) {
        const Vector3d arm = (model.node_mm[i] - centre) / size;
        for (int axis = 0; axis < 3; ++axis) {
            auto column = motion.col(static_cast<Eigen::Index>(3 * i) + axis);
            column.head<3>() = Vector3d::Unit(axis);
            column.tail<3>() = arm.cross(Vector3d::Unit(axis));
        }
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> pivoted(motion);
    std::vector<Support> supports;
    for (int k = 0; k < 6; ++k) {
        const Eigen::Index column = pivoted.colsPermutation().indices()[k];
        supports.push_back({static_cast<std::int32_t>(column / 3), static_cast<int>(column % 3)});
    }
    return supports;
}

}  // namespace

ShellModel shell_model(const ShellMesh& mesh, const WallMaterial& material, const ShellLoads& loads,
                       ElementOrder order) {
    ShellModel model;
    model.mesh = &mesh;
    model.material = &material;
    model.pressure_mpa = loads.pressure_mpa;
    build_elements(mesh, order, model);
    Loader loader(model, order);
    for (const ShellRim& rim : mesh.rim) {
        if (loads.pressure_mpa != 0.0) {
            loader.pull(rim, loads.pressure_mpa * rim.area_mm2);
        }
    }
    if (loads.axial_n != 0.0 || !loads.moment_nmm.isZero()) {
        const auto [first, second] = pair_of_rims(mesh, loads);
        const Vector3d along =
            (mesh.rim[second].centre_mm - mesh.rim[first].centre_mm).normalized();
        loader.pull(mesh.rim[second], loads.axial_n * along);
        loader.pull(mesh.rim[first], -loads.axial_n * along);
        loader.turn(mesh.rim[second], loads.moment_nmm);
        loader.turn(mesh.rim[first], -loads.moment_nmm);
    }
    model.force = loader.forces();
    model.support = six_supports(model);
    return model;
}

}  // namespace meshwind
