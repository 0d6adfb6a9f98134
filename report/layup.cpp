#include "report/layup.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/units.h"
#include "winding/laminate/material_axes.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

Vector3d normal_of(const Surface& surface, std::size_t face) {
    const auto corner = [&](std::size_t k) -> const Vector3d& {
        return surface.position_mm[static_cast<std::size_t>(surface.face[face][k])];
    };
    return (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
}

}  // namespace

// The plies are measured on the run's coverage samples.
Layup::Layup(const Run& run)
    : axes_(material_axes(run.layers.front().setup.mandrel)), all_(axes_.size()) {
    for (const WoundLayer& layer : run.layers) {
        const Surface& surface = layer.setup.mandrel.surface;
        OfLayer& of = layers_.emplace_back(
            OfLayer{&surface,
                    plies_of(surface,
                             layer.plan.planner == Planner::Imported ? layer.setup.wall->surface()
                                                                     : surface,
                             layer.plan.pieces,
                             {.tow_width_mm = layer.setup.job.tow.width_mm,
                              .seed = run.seed,
                              .over_rims = layer.plan.planner != Planner::Cover}),
                    {}});
        const auto fibres = fibres_of(layer.plan.pieces);
        for (std::size_t fibre = 0; fibre < fibres.size(); ++fibre) {
            for (std::size_t course = 0; course < fibres[fibre].size(); ++course) {
                of.place.emplace_back(fibre, course);
            }
        }
        each_.push_back(arrays_of(layer, layers_.size() - 1));
    }
    const Surface& bare = *layers_.front().surface;
    for (std::size_t f = 0; f < axes_.size(); ++f) {
        for (const LayupArrays& one : each_) {
            all_.layers[f] += one.layers[f];
            all_.thickness_mm[f] += one.thickness_mm[f];
        }
        all_.area_mm2[f] = meshwind::area_mm2(bare.position_mm, bare.face[f]);
        // Samples of several layers are not the same; report.json counts as this does.
        all_.covered[f] =
            each_.size() == 1 ? each_.front().covered[f] : std::min(1.0, all_.layers[f]);
    }
    if (each_.size() == 1) {
        all_.samples = each_.front().samples;
    }
    set_angles(0, layers_.size(), all_);
    for (const WoundWall& wall : run.walls) {
        add_wall(wall);
    }
}

void Layup::add_wall(const WoundWall& wall) {
    walls_.asked_layers.resize(axes_.size());
    walls_.laid_layers.resize(axes_.size());
    for (std::size_t f = 0; f < axes_.size(); ++f) {
        walls_.asked_layers[f] += wall.asked_of_faces[f];
        for (std::size_t layer = wall.first; layer <= wall.last; ++layer) {
            walls_.laid_layers[f] += each_[layer].layers[f];
        }
    }
}

Vector3d Layup::normal(std::size_t face) const {
    return normal_of(*layers_.front().surface, face);
}

std::vector<LayupPly> Layup::plies(std::size_t face) const {
    std::vector<LayupPly> all;
    for (std::size_t layer = 0; layer < layers_.size(); ++layer) {
        const std::vector<LayupPly> one = plies_of_layer(layer, face);
        all.insert(all.end(), one.begin(), one.end());
    }
    return all;
}

std::vector<LayupPly> Layup::plies_of_layer(std::size_t layer, std::size_t face) const {
    const OfLayer& of = layers_[layer];
    std::vector<LayupPly> told;
    if (of.plies.of(face).empty()) {
        return told;
    }
    const Vector3d normal = normal_of(*of.surface, face);
    const Vector3d axis = (axes_[face] - normal * normal.dot(axes_[face])).normalized();
    for (const Ply& ply : of.plies.of(face)) {
        const auto& [fibre, course] = of.place[static_cast<std::size_t>(ply.piece)];
        told.push_back({layer, fibre, course, ply.share, ply_angle_rad(axis, normal, ply.along),
                        std::acos(std::min(1.0, std::abs(ply.along.z())))});
    }
    return told;
}

LayupArrays Layup::arrays_of(const WoundLayer& layer, std::size_t number) const {
    const OfLayer& of = layers_[number];
    LayupArrays arrays(axes_.size());
    arrays.layers = layer.plan.face_layers;
    arrays.covered = of.plies.covered;
    arrays.samples = of.plies.samples;
    for (std::size_t f = 0; f < axes_.size(); ++f) {
        arrays.thickness_mm[f] = arrays.layers[f] * layer.setup.job.tow.thickness_mm;
        arrays.area_mm2[f] = meshwind::area_mm2(of.surface->position_mm, of.surface->face[f]);
    }
    set_angles(number, number + 1, arrays);
    return arrays;
}

// Means over the plies of layers [first, last), by their shares.
void Layup::set_angles(std::size_t first, std::size_t last, LayupArrays& arrays) const {
    for (std::size_t f = 0; f < axes_.size(); ++f) {
        double share = 0.0;
        for (std::size_t layer = first; layer < last; ++layer) {
            for (const LayupPly& ply : plies_of_layer(layer, f)) {
                share += ply.share;
                arrays.spindle_deg[f] += ply.share * deg_from_rad(ply.angle_to_spindle_rad);
                arrays.winding_deg[f] += ply.share * std::abs(deg_from_rad(ply.angle_rad));
            }
        }
        if (share > 0.0) {
            arrays.spindle_deg[f] /= share;
            arrays.winding_deg[f] /= share;
        }
    }
}

}  // namespace meshwind
