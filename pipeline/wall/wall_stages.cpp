#include "pipeline/wall/wall_stages.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "core/error.h"
#include "core/index.h"
#include "core/random.h"
#include "core/text/text_number.h"
#include "geodesic/on_surface.h"
#include "mesh/nearest.h"
#include "mesh/revolution/revolution.h"
#include "mesh/segment/rims.h"
#include "mesh/triangle_soup.h"
#include "postproc/verify/check_kinds.h"
#include "winding/laminate/coverage.h"
#include "winding/laminate/measure_plan.h"

namespace meshwind {
namespace {

// A stage is planned for the mandrel that it begins on: it grows by this share of the radius of the
// narrowest leg at most, and by so many layers, for which there is time to make them even.
constexpr double kMaxGrowth = 0.04;
constexpr double kMaxLayersOfAStage = 6.0;

// Circuits of a pattern lie in both hands: it lays no less.
constexpr int kLayersOfAPattern = 2;

// Stages behind those, which fill the last thin places.
constexpr int kMendingStages = 2;

// Of the share that may be thinner, what is once thin places are filled: a wall is judged by
// others, and courses are given up later.
constexpr double kFilledTo = 0.65;

// Of the places that ask for the thinnest wall, share that asks for no more than a pattern lays:
// where bands overlap and on domes more lies than was asked for.
constexpr double kMaxPlaces = 0.75;

// A whole number of layers is meant, not one more.
constexpr double kSameLayers = 1e-9;

int layers_of_a_stage(const Mandrel& bare, double tow_thickness_mm) {
    double layers = kMaxLayersOfAStage;
    for (const Rim& rim : bare.rims) {
        layers = std::min(layers, kMaxGrowth * rim.radius_mm / tow_thickness_mm);
    }
    const int whole = static_cast<int>(layers);
    return whole < kLayersOfAPattern && find_revolution(bare).body ? kLayersOfAPattern
                                                                   : std::max(1, whole);
}

// What a job's wall asks for, on its mandrel.
class AskedWall {
public:
    AskedWall(const Mandrel& bare, const Job& job, std::size_t index, std::string place)
        : bare_(bare),
          wall_(job.layers[index].wall.value_or(WallJob{})),
          tow_thickness_mm_(job.tow.thickness_mm),
          to_file_(bare.file_to_mandrel.inverse()),
          place_(std::move(place)) {
        everywhere_ = layers_of(wall_.amount, place_);
        for (std::size_t i = 0; i < wall_.parts.size(); ++i) {
            const std::string here = place_ + "/parts/" + std::to_string(i);
            layers_.push_back(layers_of(wall_.parts[i].amount, here));
            require_there(wall_.parts[i], here);
        }
    }

    [[nodiscard]] std::int32_t layers_at(const SurfacePoint& at_place) const {
        std::int32_t layers = everywhere_;
        for (std::size_t i = 0; i < layers_.size(); ++i) {
            if (holds(wall_.parts[i], at_place)) {
                layers = layers_[i];
            }
        }
        return layers;
    }

private:
    [[nodiscard]] std::int32_t layers_of(const WallAmount& amount, const std::string& here) const {
        const double layers =
            amount.layers.value_or(amount.thickness_mm.value_or(0.0) / tow_thickness_mm_);
        if (layers < 1.0 - kSameLayers) {
            throw InputError("job.wall_thin", here,
                             fixed(layers * tow_thickness_mm_, 3) +
                                 " mm are less than one layer of a tow of " +
                                 fixed(tow_thickness_mm_, 3) + " mm; ask for that at least");
        }
        return static_cast<std::int32_t>(std::ceil(layers - kSameLayers));
    }

    void require_there(const WallPart& part, const std::string& here) const {
        const auto& regions = bare_.surface.region;
        if (part.region &&
            std::find(regions.begin(), regions.end(), *part.region) == regions.end()) {
            throw InputError("job.no_region", here + "/region",
                             "region " + std::to_string(*part.region) +
                                 " is no part of the wall; meshwind inspect lists its regions");
        }
        const auto& faces = bare_.cad_face;
        if (part.cad_face && std::none_of(faces.begin(), faces.end(), [&](std::int32_t face) {
                return is_face(face, *part.cad_face);
            })) {
            throw InputError("job.no_face", here + "/face",
                             "face " + *part.cad_face +
                                 " is no part of the wall; meshwind inspect lists the faces of a "
                                 "CAD file");
        }
        if (part.rim && at(*part.rim) >= bare_.rims.size()) {
            throw InputError("job.no_rim", here + "/rim",
                             "there is no rim " + std::to_string(*part.rim) +
                                 "; meshwind inspect lists the rims");
        }
        for (std::size_t f = 0; f < bare_.surface.face.size(); ++f) {
            if (holds(part, {.face = static_cast<std::int32_t>(f)})) {
                return;
            }
        }
        throw InputError("job.wall_place", here, "no triangle of the wall has its middle there");
    }

    [[nodiscard]] bool is_face(std::int32_t face, const std::string& word) const {
        return face >= 0 && is_named(bare_.cad_faces[at(face)], at(face) + 1, word);
    }

    [[nodiscard]] bool holds(const WallPart& part, const SurfacePoint& place) const {
        if (part.region) {
            return bare_.surface.region[at(place.face)] == *part.region;
        }
        if (part.cad_face) {
            return is_face(bare_.cad_face[at(place.face)], *part.cad_face);
        }
        const Eigen::Vector3d position = position_mm(bare_.surface, place);
        if (part.box) {
            const Eigen::Vector3d in_file = to_file_ * position;
            return (in_file.array() >= part.box->least.array()).all() &&
                   (in_file.array() <= part.box->most.array()).all();
        }
        if (part.point) {
            return (bare_.file_to_mandrel * *part.point - position).norm() <= *part.within_mm;
        }
        return off_circle_mm(bare_.rims[at(*part.rim)], position) <= *part.within_mm;
    }

    const Mandrel& bare_;
    const WallJob wall_;
    double tow_thickness_mm_;
    Eigen::Affine3d to_file_;
    std::string place_;
    std::int32_t everywhere_ = 1;
    std::vector<std::int32_t> layers_;  // per part
};

WallPlaces places_of(const Surface& surface, const AskedWall& asked, double tow_width_mm,
                     std::uint64_t seed, Stream stream) {
    const CoverageSamples samples = plan_samples(surface, tow_width_mm, seed, stream);
    WallPlaces places;
    places.at = samples.at;
    for (const SurfacePoint& place : places.at) {
        places.asked.push_back(asked.layers_at(place));
    }
    places.laid.assign(places.at.size(), 0);
    return places;
}

std::string job_place(const std::filesystem::path& job_file, std::size_t index) {
    return (job_file.empty() ? "job" : job_file.string()) + ": /layers/" + std::to_string(index);
}

// What a plan lays is added. \return whether a place comes to have what is asked for
bool lay(const Surface& surface, const Plan& plan, double tow_width_mm, WallPlaces& places) {
    const std::vector<std::int32_t> more =
        layers_of_courses(surface, samples_at(surface, places.at), plan.pieces, tow_width_mm);
    bool lifts = false;
    for (std::size_t i = 0; i < more.size(); ++i) {
        const std::int32_t lacks = places.asked[i] - places.laid[i];
        lifts = lifts || (lacks > 0 && more[i] >= lacks);
        places.laid[i] += more[i];
    }
    return lifts;
}

double ratio_at(const WallPlaces& places, std::size_t i) {
    return static_cast<double>(places.laid[i]) / static_cast<double>(places.asked[i]);
}

// Value below which a share of the numbers lies; 0 without any.
double quantile(std::vector<double> values, double share) {
    if (values.empty()) {
        return 0.0;
    }
    const auto rank =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
    std::nth_element(values.begin(), rank, values.end());
    return *rank;
}

}  // namespace

WallStages::WallStages(const Mandrel& bare, const Job& job, std::size_t index, std::uint64_t seed,
                       const std::filesystem::path& job_file)
    : tow_width_mm_(job.tow.width_mm),
      tow_thickness_mm_(job.tow.thickness_mm),
      most_below_(job.tolerance.bare),
      area_mm2_(area_mm2({bare.surface.position_mm, bare.surface.face})) {
    const AskedWall asked(bare, job, index, job_place(job_file, index));
    measured_ = places_of(bare.surface, asked, tow_width_mm_, seed, Stream::Sampling);
    weighed_ = places_of(bare.surface, asked, tow_width_mm_, seed, Stream::Ground);
    judged_ = places_of(bare.surface, asked, tow_width_mm_, seed, Stream::Judging);
    for (std::size_t f = 0; f < bare.surface.face.size(); ++f) {
        asked_of_faces_.push_back(asked.layers_at({.face = static_cast<std::int32_t>(f)}));
    }
    reached_.assign(measured_.at.size(), 0);
    const NearestPoints measured(samples_at(bare.surface, measured_.at).position_mm);
    for (const SurfacePoint& place : judged_.at) {
        region_.push_back(bare.surface.region[at(place.face)]);
        position_mm_.push_back(position_mm(bare.surface, place));
        nearest_.push_back(measured.nearest(position_mm_.back()));
    }
    most_asked_ = *std::max_element(measured_.asked.begin(), measured_.asked.end());
    const int layers = layers_of_a_stage(bare, tow_thickness_mm_);
    planned_stages_ = (most_asked_ + layers - 1) / layers;
}

bool WallStages::done() const {
    return stages_ >= planned_stages_ && (in_vain_ || below_share() <= most_below_ ||
                                          stages_ >= planned_stages_ + kMendingStages);
}

AskedPlaces WallStages::asked_of(const WallPlaces& places) const {
    AskedPlaces ask;
    ask.at = places.at;
    const int stage = std::min(stages_ + 1, planned_stages_);
    for (std::size_t i = 0; i < places.at.size(); ++i) {
        const double by_now = static_cast<double>(places.asked[i]) * stage / planned_stages_;
        ask.layers.push_back(static_cast<std::int32_t>(std::ceil(by_now - kSameLayers)) -
                             places.laid[i]);
    }
    return ask;
}

StageAsk WallStages::next() const {
    StageAsk ask;
    ask.measured = asked_of(measured_);
    ask.weighed = asked_of(weighed_);
    ask.stages_left = std::max(0, planned_stages_ - stages_);
    ask.filled_to = kFilledTo * most_below_;
    ask.beyond_layers = ask.stages_left > 1 ? 0.0 : beyond_even_layers(most_asked_);
    const std::int32_t thinnest = *std::min_element(measured_.asked.begin(), measured_.asked.end());
    std::vector<double> layers;
    for (std::size_t i = 0; i < measured_.at.size(); ++i) {
        const bool in_reach = stages_ == 0 || reached_[i] != 0;
        ask.left.push_back(in_reach ? measured_.asked[i] - measured_.laid[i] : 0);
        ask.measured.layers[i] = std::min(ask.measured.layers[i], ask.left[i]);
        if (in_reach && measured_.asked[i] == thinnest) {
            layers.push_back(ask.measured.layers[i]);
        }
    }
    ask.everywhere = quantile(std::move(layers), kMaxPlaces);
    return ask;
}

void WallStages::enter(const Surface& surface, const Plan& plan) {
    in_vain_ = !lay(surface, plan, tow_width_mm_, measured_);
    lay(surface, plan, tow_width_mm_, weighed_);
    lay(surface, plan, tow_width_mm_, judged_);
    note_reach(plan);
    if (stages_ == 0) {
        least_mm_ = plan.least_fibre_mm.value_or(0.0);
    }
    const FibreUse use = fibre_use(plan, tow_width_mm_, area_mm2_, 1.0);
    fibre_mm_ += plan.fibre_length_mm;
    turns_mm_ += use.turn_share * plan.fibre_length_mm;
    ++stages_;
}

// A place is in reach where courses pass it in every stage that the thickness takes: one that they
// no longer pass once the wall has grown cannot come to its thickness. Of a pattern it is what it
// covers. What the fibres cannot join is out of reach where that is little.
void WallStages::note_reach(const Plan& plan) {
    const auto count = [](const std::vector<char>& places) {
        return static_cast<double>(std::count(places.begin(), places.end(), 1));
    };
    const bool joins_most = count(plan.joinable) >= kCoveredShare * count(plan.reached);
    const std::vector<char>& reach = joins_most ? plan.joinable : plan.reached;
    for (std::size_t i = 0; i < reached_.size() && !laid(); ++i) {
        const bool now = reach.empty() ? measured_.laid[i] > 0 : reach[i] != 0;
        const bool before = stages_ == 0 || reached_[i] != 0;
        reached_[i] = (now && before) || measured_.laid[i] >= measured_.asked[i] ? 1 : 0;
    }
}

double WallStages::below_share() const {
    double below = 0.0;
    double all = 0.0;
    for (std::size_t i = 0; i < judged_.at.size(); ++i) {
        all += in_reach(i) ? 1.0 : 0.0;
        below += in_reach(i) && judged_.laid[i] < judged_.asked[i] ? 1.0 : 0.0;
    }
    return below / std::max(1.0, all);
}

std::vector<ThinRegion> WallStages::thin_regions() const {
    struct Tally {
        double all = 0.0;
        double below = 0.0;
        ThinRegion region;
    };
    std::map<std::int32_t, Tally> tallies;
    for (std::size_t i = 0; i < judged_.at.size(); ++i) {
        const std::int32_t lacks = judged_.asked[i] - judged_.laid[i];
        if (!in_reach(i)) {
            continue;
        }
        Tally& tally = tallies[region_[i]];
        tally.region.region = region_[i];
        tally.all += 1.0;
        tally.below += lacks > 0 ? 1.0 : 0.0;
        if (lacks * tow_thickness_mm_ > tally.region.most_lacking_mm) {
            tally.region.most_lacking_mm = lacks * tow_thickness_mm_;
            tally.region.at_mm = position_mm_[i];
        }
    }
    std::vector<ThinRegion> thin;
    for (auto& [id, tally] : tallies) {
        if (tally.below > 0.0) {
            tally.region.below_share = tally.below / tally.all;
            thin.push_back(tally.region);
        }
    }
    std::stable_sort(thin.begin(), thin.end(), [](const ThinRegion& a, const ThinRegion& b) {
        return a.most_lacking_mm > b.most_lacking_mm;
    });
    return thin;
}

WallFigures WallStages::figures() const {
    WallFigures figures;
    const auto places = static_cast<double>(judged_.at.size());
    std::vector<double> reached;
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < judged_.at.size(); ++i) {
        const double ratio = ratio_at(judged_, i);
        figures.asked_layers += judged_.asked[i];
        sum += ratio;
        squares += ratio * ratio;
        if (in_reach(i)) {
            reached.push_back(ratio);
        }
    }
    figures.asked_layers /= places;
    figures.reachable = static_cast<double>(reached.size()) / places;
    figures.below_share = below_share();
    figures.mean_ratio = sum / places;
    figures.cv = sum > 0.0 ? std::sqrt(std::max(0.0, squares * places - sum * sum)) / sum : 0.0;
    figures.p1_ratio = quantile(std::move(reached), 0.01);
    figures.fibre_mm = fibre_mm_;
    figures.turn_share = fibre_mm_ > 0.0 ? turns_mm_ / fibre_mm_ : 0.0;
    figures.fibre_factor = fibre_mm_ * tow_width_mm_ / (area_mm2_ * figures.asked_layers);
    figures.least_factor = least_mm_ * tow_width_mm_ / (area_mm2_ * figures.asked_layers);
    figures.stages = stages_;
    figures.thin = thin_regions();
    return figures;
}

void require_wall(const Mandrel& bare, const Job& job, std::size_t index,
                  const std::filesystem::path& job_file) {
    const AskedWall asked(bare, job, index, job_place(job_file, index));
}

Check wall_check(const WallFigures& figures, double most_below) {
    Check check(check_kind::kWall, figures.below_share <= most_below);
    check.numbers = {{"below", figures.below_share},
                     {"limit", most_below},
                     {"mean", figures.mean_ratio},
                     {"p1", figures.p1_ratio}};
    if (!figures.thin.empty()) {
        check.place = {.position_mm = figures.thin.front().at_mm};
    }
    if (!check.ok) {
        check.words =
            percent(figures.below_share, 1) + " of the wall in reach is thinner than asked for:";
        const char* joint = " ";
        for (const ThinRegion& thin : figures.thin) {
            check.words += joint + percent(thin.below_share, 1) + " of region " +
                           std::to_string(thin.region) + ", which lacks up to " +
                           fixed(thin.most_lacking_mm, 2) + " mm";
            joint = ", ";
        }
    }
    return check;
}

}  // namespace meshwind
