#include "winding/cover.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/parallel.h"
#include "core/units.h"
#include "winding/coverage.h"
#include "winding/grow.h"
#include "winding/one_fibre.h"
#include "winding/random.h"
#include "winding/uncovered.h"

namespace meshwind {
namespace {

// Samples per band width: a gap of a quarter band is seen.
constexpr double kSamplesPerBand = 4.0;

// On a wall so large that this would take more samples, they lie further apart.
constexpr double kMaxSamples = 6e5;

// A candidate whose half is longer than this many bounding boxes circles without meeting a rim.
constexpr double kMaxHalfLengthBoxes = 8.0;

// Times that rejected courses are replaced by others before the plan does without. Most plans need
// under ten; each round fills only what the one before left open.
constexpr int kMaxReplacements = 30;

constexpr std::size_t kHardRatio = 2;  // a way is hard when less than one in two can be wound

// Added to the clearance while candidates are judged at a few stations, so that a course still
// fits when every station is tried.
constexpr double kHeadMargin_mm = 0.3;

// Plans that are tried until the machine can wind the whole.
constexpr int kMaxAttempts = 8;

// Rounds after which a plan of several fibres is narrowed to one although courses in it are still
// being replaced: narrowing cannot be undone.
constexpr int kSettling = 20;

// Distance of the stations of a plan: what the machine is told of the curve between them is below
// its own following error.
constexpr double kStation_mm = 4.0;

std::size_t at(std::int32_t i) {
    return static_cast<std::size_t>(i);
}

enum class Verdict : char { Unknown, Accepted, Rejected };

class CoverPlanner {
public:
    CoverPlanner(const Mandrel& mandrel, const RayQuery& obstacles, const CoverOptions& options)
        : mandrel_(mandrel),
          options_(options),
          samples_(sample_surface(mandrel.surface, sample_spacing_mm(mandrel, options),
                                  seed_of(Stream::Sampling, options.seed))),
          footprints_(mandrel.surface, samples_, options.tow.width_mm),
          rules_{mandrel,
                 obstacles,
                 footprints_,
                 options.tow,
                 options.turn,
                 options.free_fibre,
                 max_half_length_mm(mandrel.surface)} {
        rules_.turn.friction = options.tow.friction;
        rules_.turn.band_mm = options.tow.width_mm;
        rules_.free_fibre.clearance_mm += kHeadMargin_mm;
        plan_.planner = "cover";
    }

    Plan run() {
        library_ = grow_library(rules_, samples_, options_);
        plan_.effort.candidates = library_.candidates;
        plan_.effort.refusals = library_.refusals;
        tell("library", 1.0);
        if (members_.empty()) {
            plan_.failure = "no admissible course: " + commonest_refusal();
            describe_uncovered();
            return std::move(plan_);
        }
        verdict_.assign(members_.size(), Verdict::Unknown);
        rejection_.assign(members_.size(), Rejection::None);
        verify_hard_ways();
        for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
            choose();
            if (order_.empty()) {
                plan_.failure = "every course was refused, " + commonest_rejection();
                describe_uncovered();
                return std::move(plan_);
            }
            lay_out();
            if (!reject_pieces(attempt + 1 == kMaxAttempts)) {
                break;
            }
        }
        measure();
        return std::move(plan_);
    }

private:
    static double max_half_length_mm(const Surface& surface) {
        Eigen::AlignedBox3d box;
        for (const Eigen::Vector3d& p : surface.position_mm) {
            box.extend(p);
        }
        return kMaxHalfLengthBoxes * box.diagonal().norm();
    }

    static double sample_spacing_mm(const Mandrel& mandrel, const CoverOptions& options) {
        const double area = area_mm2({mandrel.surface.position_mm, mandrel.surface.face});
        return std::max(options.tow.width_mm / kSamplesPerBand, std::sqrt(area / kMaxSamples));
    }

    void tell(const char* step, double share) const {
        if (options_.progress) {
            options_.progress(step, share);
        }
    }

    [[nodiscard]] std::string commonest_refusal() const {
        const auto& refusals = plan_.effort.refusals;
        const auto most = std::max_element(refusals.begin() + 1, refusals.end());
        return std::to_string(*most) + " of " + std::to_string(plan_.effort.candidates) +
               " candidates: " + name_of(static_cast<Refusal>(most - refusals.begin()));
    }

    // "123 of 456: the head would come too near"
    [[nodiscard]] std::string commonest_rejection() const {
        const auto& rejections = plan_.effort.rejections;
        const auto most = std::max_element(rejections.begin() + 1, rejections.end());
        return std::to_string(*most) + " of " + std::to_string(members_.size()) + ": " +
               name_of(static_cast<Rejection>(most - rejections.begin()));
    }

    // The finished course of a member, wound in one direction, with its measured slip.
    [[nodiscard]] Piece course_of(const Member& member, bool backward) const {
        Piece piece;
        piece.kind = PieceKind::Course;
        piece.path = trace_both_ways(rules_, member.candidate);
        if (backward) {
            piece.path = reversed(piece.path);
        }
        piece.string = taut_string(piece.path);
        SlipMeasure slip =
            measure_slip(mandrel_.surface, piece.path, piece.string,
                         {.friction = options_.tow.friction, .method = TraceMethod::Patches});
        piece.slip = std::move(slip.slip);
        piece.worst_slip = slip.worst;
        piece.start_rim = start_of(member, backward).rim;
        piece.end_rim = end_of(member, backward).rim;
        return piece;
    }

    // Checks the slip of a member as measured and asks the machine; direction by direction. None
    // when it can be wound at least one way, else what the last direction failed for.
    Rejection verify(Member& member) const {
        Rejection rejection = Rejection::None;
        for (const bool backward : {false, true}) {
            bool& windable = backward ? member.windable_backward : member.windable_forward;
            if (!windable) {
                continue;
            }
            Piece piece = course_of(member, backward);
            thin_out(piece, kStation_mm);
            if (piece.worst_slip > options_.tow.friction) {
                rejection = Rejection::Slip;
            } else if (options_.accept) {
                rejection = options_.accept(piece);
            } else {
                rejection = Rejection::None;
            }
            windable = rejection == Rejection::None;
        }
        return member.windable_forward || member.windable_backward ? Rejection::None : rejection;
    }

    void reject(std::size_t member, Rejection reason) {
        verdict_[member] = Verdict::Rejected;
        rejection_[member] = reason;
        members_[member].windable_forward = false;
        members_[member].windable_backward = false;
        ++plan_.effort.rejections[static_cast<std::size_t>(reason)];
        plan_.effort.rejected_courses += reason == Rejection::Apart ? 0 : 1;
    }

    // Verifies what is chosen and not yet known; false when any of it was rejected.
    bool verify_chosen() {
        std::vector<std::int32_t> unknown;
        for (const std::int32_t i : selection_.chosen) {
            if (verdict_[at(i)] == Verdict::Unknown) {
                unknown.push_back(i);
                verdict_[at(i)] = Verdict::Accepted;  // listed once, even where laid twice
            }
        }
        return verify_all(unknown);
    }

    // \pre every member is listed once; false when any was rejected
    bool verify_all(const std::vector<std::int32_t>& unknown) {
        std::vector<Rejection> found(unknown.size());
        parallel_for(unknown.size(), 1, [&](std::size_t begin, std::size_t) {
            found[begin] = verify(members_[at(unknown[begin])]);
        });
        bool all = true;
        for (std::size_t k = 0; k < unknown.size(); ++k) {
            verdict_[at(unknown[k])] = Verdict::Accepted;
            if (found[k] != Rejection::None) {
                reject(at(unknown[k]), found[k]);
                all = false;
            }
        }
        return all;
    }

    // Verifies the members of hard ways, where few of those that lie there can be wound: the one
    // fibre depends on them, so it must be known early which the machine accepts.
    void verify_hard_ways() {
        std::vector<std::int32_t> hard;
        for (const auto& [nodes, way] : ways_between_nodes(members_)) {
            if (way.windable.size() * kHardRatio < way.lying.size()) {
                hard.insert(hard.end(), way.windable.begin(), way.windable.end());
            }
        }
        std::sort(hard.begin(), hard.end());
        hard.erase(std::unique(hard.begin(), hard.end()), hard.end());
        verify_all(hard);
    }

    void choose() {
        std::vector<char> allowed(members_.size(), 1);
        for (int round = 0; round <= kMaxReplacements; ++round) {
            tell("choose", static_cast<double>(round) / kMaxReplacements);
            for (std::size_t i = 0; i < members_.size(); ++i) {
                allowed[i] = static_cast<char>(
                    verdict_[i] == Verdict::Accepted ||
                    (verdict_[i] == Verdict::Unknown && round < kMaxReplacements));
            }
            exhausted_ = round == kMaxReplacements;
            // What was verified stays: the next round only fills the holes that rejections left.
            std::vector<std::int32_t> kept;
            for (const std::int32_t i : selection_.chosen) {
                if (allowed[at(i)] != 0 && std::find(kept.begin(), kept.end(), i) == kept.end()) {
                    kept.push_back(i);
                }
            }
            selection_ = select_courses(members_, allowed, samples_.size(), options_.select, kept);
            if (entry_ >= 0 && allowed[at(entry_)] != 0 &&
                std::find(selection_.chosen.begin(), selection_.chosen.end(), entry_) ==
                    selection_.chosen.end()) {
                selection_.chosen.push_back(entry_);
                for (const std::int32_t sample : members_[at(entry_)].footprint) {
                    ++selection_.layers[at(sample)];
                }
            }
            laid_ = balance_courses(members_, allowed, mandrel_.rims.size(), options_.select,
                                    selection_);
            const bool settled = verify_chosen();
            if (!settled && round < kSettling) {
                continue;
            }
            order_ = order_courses(mandrel_.rims, members_, laid_, rules_.turn);
            const bool narrower = fibres_in(order_).size() > 1 && narrow_to_main_fibre();
            if (settled && !narrower) {
                break;
            }
            if (narrower) {
                selection_.chosen.clear();  // the choice starts anew among what is left
            }
        }
        order_ = order_courses(mandrel_.rims, members_, laid_, rules_.turn);
        keep_main_fibre();
    }

    // From here on only what the main fibre can be extended by: what no single fibre can reach is
    // better not chosen at all. False when that excludes nothing.
    bool narrow_to_main_fibre() {
        FibreReach reach =
            reach_of(members_, order_, main_fibre(members_, order_), 2 * mandrel_.rims.size());
        entry_ = -1;
        if (!reach.last.empty() && !find_entry(reach.last.front())) {
            reach.last.clear();
        }
        bool narrower = false;
        for (std::size_t i = 0; i < members_.size(); ++i) {
            Member& member = members_[i];
            for (const bool backward : {false, true}) {
                bool& windable = backward ? member.windable_backward : member.windable_forward;
                const bool held = reach.holds(departure_node(start_of(member, backward)),
                                              arrival_node(end_of(member, backward)),
                                              static_cast<std::int32_t>(i) == entry_);
                narrower = narrower || (windable && !held);
                windable = windable && held;
            }
            if (!member.windable_forward && !member.windable_backward) {
                if (verdict_[i] != Verdict::Rejected) {
                    reject(i, Rejection::Apart);
                }
            }
        }
        return narrower;
    }

    // The first entry of the last node that the machine accepts in that direction.
    bool find_entry(const LastNode& last) {
        for (const std::int32_t i : last.entries) {
            if (verdict_[at(i)] == Verdict::Unknown) {
                verify_all({i});
            }
            const Member& member = members_[at(i)];
            const bool backward = arrival_node(end_of(member, true)) == last.node;
            if (backward ? member.windable_backward : member.windable_forward) {
                entry_ = i;
                return true;
            }
        }
        return false;
    }

    void keep_main_fibre() {
        const FibreStretch fibre = main_fibre(members_, order_);
        plan_.effort.courses_out_of_reach = 0;
        for (std::size_t i = 0; i < order_.size(); ++i) {
            if (i < fibre.first || i >= fibre.second) {
                for (const std::int32_t sample : members_[at(order_[i].course.member)].footprint) {
                    --selection_.layers[at(sample)];
                }
                ++plan_.effort.courses_out_of_reach;
            }
        }
        order_ = {order_.begin() + static_cast<std::ptrdiff_t>(fibre.first),
                  order_.begin() + static_cast<std::ptrdiff_t>(fibre.second)};
    }

    // Asks the machine about the whole; rejects the courses it refuses, or whose turn it refuses.
    bool reject_pieces(bool last_attempt) {
        if (!options_.refused || last_attempt) {
            return false;
        }
        const std::vector<std::size_t> refused = options_.refused(plan_.pieces);
        for (const std::size_t piece : refused) {
            const std::size_t course = piece / 2;  // courses and turns alternate
            const std::int32_t member = order_[course].course.member;
            reject(at(member), Rejection::InItsPlace);
        }
        return !refused.empty();
    }

    void lay_out() {
        plan_.pieces.clear();
        plan_.fibres = 0;
        plan_.fibre_length_mm = 0.0;
        plan_.worst_slip = 0.0;
        plan_.worst_bridge_mm = 0.0;
        plan_.worst_joint_mm = 0.0;
        const std::vector<OrderedCourse>& order = order_;
        bool fresh = true;
        for (std::size_t i = 0; i < order.size(); ++i) {
            const auto [member, backward] = order[i].course;
            Piece piece = course_of(members_[at(member)], backward);
            thin_out(piece, kStation_mm);
            piece.starts_fibre = fresh;
            plan_.fibres += fresh ? 1 : 0;
            add_piece(std::move(piece));
            fresh = order[i].cut_after;
            if (!fresh) {
                const LaidCourse& next = order[i + 1].course;
                add_piece(turn_between(end_of(members_[at(member)], backward),
                                       start_of(members_[at(next.member)], next.backward)));
            }
        }
        plan_.courses = static_cast<int>(order.size());
    }

    [[nodiscard]] Piece turn_between(const RimCrossing& from, const RimCrossing& to) const {
        Turn turn = make_turn(mandrel_.rims[at(from.rim)], from, to, rules_.turn, kStation_mm);
        Piece piece;
        piece.kind = PieceKind::Transition;
        piece.string.gap_mm.assign(turn.path.size(), 0.0);
        piece.string.slope.assign(turn.path.size(), 0.0);
        for (const PathPoint& point : turn.path) {
            piece.slip.push_back(std::abs(point.kg_per_mm) / point.kn_per_mm);
        }
        piece.worst_slip = turn.slip;
        piece.path = std::move(turn.path);
        piece.start_rim = from.rim;
        piece.end_rim = to.rim;
        return piece;
    }

    void add_piece(Piece piece) {
        if (!piece.starts_fibre) {
            const double gap =
                (piece.path.front().position_mm - plan_.pieces.back().path.back().position_mm)
                    .norm();
            plan_.worst_joint_mm = std::max(plan_.worst_joint_mm, gap);
        }
        plan_.fibre_length_mm += piece.path.back().s_mm;
        plan_.worst_slip = std::max(plan_.worst_slip, piece.worst_slip);
        plan_.worst_bridge_mm = std::max(plan_.worst_bridge_mm, piece.string.worst_gap_mm);
        plan_.pieces.push_back(std::move(piece));
    }

    void measure() {
        plan_.coverage = measure_coverage(selection_.layers);
        plan_.coverage.reachable =
            static_cast<double>(std::count(library_.reached.begin(), library_.reached.end(), 1)) /
            static_cast<double>(samples_.size());
        describe_uncovered();
        plan_.face_layers = layers_per_face(mandrel_.surface, samples_, selection_.layers);
        plan_.face_angle_rad = angle_per_face(mandrel_.surface, plan_.pieces);
    }

    void describe_uncovered() {
        selection_.layers.resize(samples_.size(), 0);
        for (std::size_t i = 0; exhausted_ && i < verdict_.size(); ++i) {
            if (verdict_[i] == Verdict::Unknown) {
                rejection_[i] = Rejection::Unchecked;
                ++plan_.effort.rejections[static_cast<std::size_t>(Rejection::Unchecked)];
            }
        }
        plan_.uncovered =
            uncovered_wall(mandrel_.surface, samples_, library_, rejection_, selection_.layers);
    }

    const Mandrel& mandrel_;
    const CoverOptions& options_;
    CoverageSamples samples_;
    FootprintFinder footprints_;
    CourseRules rules_;
    Library library_;
    std::vector<Member>& members_ = library_.members;
    std::vector<Verdict> verdict_;
    std::vector<Rejection> rejection_;  // per member: why it was rejected
    bool exhausted_ = false;            // the last choice took only what was verified before
    Selection selection_;
    std::vector<LaidCourse> laid_;
    std::vector<OrderedCourse> order_;
    std::int32_t entry_ =
        -1;  // the one way into the node where the fibre ends, if that has no way out
    Plan plan_;
};

}  // namespace

Plan plan_cover(const Mandrel& mandrel, const RayQuery& obstacles, const CoverOptions& options) {
    if (mandrel.rims.empty()) {
        Plan plan;
        plan.planner = "cover";
        plan.failure =
            "the mandrel has no rim: courses have nowhere to turn back (a closed body needs a "
            "polar "
            "opening or an open end)";
        return plan;
    }
    return CoverPlanner(mandrel, obstacles, options).run();
}

}  // namespace meshwind
