#include "winding/cover.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Geometry>

#include "core/parallel.h"
#include "core/units.h"
#include "winding/coverage.h"
#include "winding/one_fibre.h"
#include "winding/random.h"

namespace meshwind {
namespace {

// Steering of the candidates as shares of the friction: geodesic, and three strengths to either
// side. The strongest leaves room for the error of measuring slip on the mesh.
constexpr std::array<double, 7> kSteering = {0.0, 0.31, -0.31, 0.62, -0.62, 0.92, -0.92};

// Samples per band width: a gap of a quarter band is seen.
constexpr double kSamplesPerBand = 4.0;

// On a wall so large that this would take more samples, they lie further apart.
constexpr double kMaxSamples = 6e5;

// A candidate whose half is longer than this many bounding boxes circles without meeting a rim.
constexpr double kMaxHalfLengthBoxes = 8.0;

// Times that rejected courses are replaced by others before the plan does without.
constexpr int kMaxReplacements = 12;

// A way between two nodes is scarce with fewer courses than this, and worth the search when at
// least so many lie there, windable or not.
constexpr std::size_t kScarce = 48;
constexpr std::size_t kEstablished = 8;
constexpr int kScarceRounds = 4;
constexpr std::size_t kHardRatio = 2;  // a way is hard when less than one in two can be wound
constexpr std::size_t kShare = 240;    // of every scarce way in the draw: all count the same

// How far a candidate near a member is turned at most.
constexpr double kNearTurn_rad = 5.0 * kPi / 180.0;

// Added to the clearance while candidates are judged at a few stations, so that a course still
// fits when every station is tried.
constexpr double kHeadMargin_mm = 0.3;

// Plans that are tried until the machine can wind the whole.
constexpr int kMaxAttempts = 8;

// Rounds after which a plan of several fibres is not waited for any longer but narrowed to one.
constexpr int kSettling = 3;

// Distance of the stations of a plan: what the machine is told of the curve between them is below
// its own following error.
constexpr double kStation_mm = 4.0;

// Streams of random numbers, so that one draw never depends on another.
enum Stream : std::uint64_t { Sampling = 1, Seeds = 2, Angles = 3, Steerings = 4 };

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
                                  stream(Sampling))),
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
        reached_.assign(samples_.size(), 0);
        closest_miss_.assign(samples_.size(), Refusal::None);
        plan_.planner = "cover";
    }

    Plan run() {
        grow_library();
        if (members_.empty()) {
            plan_.failure = "no admissible course: " + commonest_refusal();
            describe_uncovered();
            return std::move(plan_);
        }
        verdict_.assign(members_.size(), Verdict::Unknown);
        verify_hard_ways();
        for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
            choose();
            if (order_.empty()) {
                plan_.failure = "every course was refused by the machine or by its measured slip";
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

    [[nodiscard]] std::uint64_t stream(Stream which) const { return options_.seed * 16 + which; }

    void tell(const char* step, double share) const {
        if (options_.progress) {
            options_.progress(step, share);
        }
    }

    // A candidate through a given sample; `draw` numbers the random draws of the whole run.
    Candidate candidate_at(std::int32_t sample, std::uint64_t draw) const {
        const auto pick = random_bits(stream(Steerings), draw) % kSteering.size();
        return {samples_.at[at(sample)], kPi * random_unit(stream(Angles), draw),
                kSteering[pick] * options_.tow.friction};
    }

    void try_candidates(const std::vector<std::int32_t>& seeds) {
        std::vector<Candidate> candidates;
        candidates.reserve(seeds.size());
        for (const std::int32_t sample : seeds) {
            candidates.push_back(candidate_at(sample, draws_++));
        }
        const std::vector<Refusal> outcome = judge_candidates(candidates);
        for (std::size_t i = 0; i < seeds.size(); ++i) {
            closest_miss_[at(seeds[i])] = std::max(closest_miss_[at(seeds[i])], outcome[i]);
        }
    }

    // Adds the admissible ones to the library; says what became of each.
    std::vector<Refusal> judge_candidates(const std::vector<Candidate>& candidates) {
        LibraryPart part = build_library(rules_, candidates);
        plan_.effort.candidates += static_cast<std::int64_t>(candidates.size());
        for (const Refusal refusal : part.outcome) {
            ++plan_.effort.refusals[static_cast<std::size_t>(refusal)];
        }
        for (Member& member : part.members) {
            for (const std::int32_t sample : member.footprint) {
                reached_[at(sample)] = 1;
            }
            members_.push_back(std::move(member));
        }
        return std::move(part.outcome);
    }

    void grow_library() {
        std::vector<std::int32_t> seeds;
        seeds.reserve(static_cast<std::size_t>(options_.candidates));
        for (int i = 0; i < options_.candidates; ++i) {
            seeds.push_back(static_cast<std::int32_t>(
                random_bits(stream(Seeds), static_cast<std::uint64_t>(i)) % samples_.size()));
        }
        tell("library", 0.0);
        try_candidates(seeds);
        for (int round = 0; round < options_.rounds; ++round) {
            tell("library", (round + 1.0) / (options_.rounds + 1.0));
            const std::vector<std::int32_t> missed = unreached();
            if (missed.empty()) {
                break;
            }
            seeds.clear();
            for (int i = 0; i < options_.aimed_candidates; ++i) {
                const auto draw = static_cast<std::uint64_t>(i) << 8U;
                seeds.push_back(missed[random_bits(stream(Seeds),
                                                   draw + 1 + static_cast<std::uint64_t>(round)) %
                                       missed.size()]);
            }
            try_candidates(seeds);
        }
        for (int round = 0; round < kScarceRounds; ++round) {
            grow_scarce_ways();
        }
        tell("library", 1.0);
    }

    // Ways between nodes that few courses take although many lie there: mostly those that can
    // hardly be wound in that direction. One continuous fibre needs them, so further candidates are
    // drawn near them.
    void grow_scarce_ways() {
        std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> ways;
        std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> windable;
        for (std::size_t i = 0; i < members_.size(); ++i) {
            for (const bool backward : {false, true}) {
                const std::pair way{departure_node(start_of(members_[i], backward)),
                                    arrival_node(end_of(members_[i], backward))};
                ways[way].push_back(i);
                if (backward ? members_[i].windable_backward : members_[i].windable_forward) {
                    windable[way].push_back(i);
                }
            }
        }
        // Near those that can be wound, once there are any.
        std::vector<std::size_t> near;
        for (const auto& [way, lying] : ways) {
            const auto& wound = windable[way];
            if (wound.size() < kScarce && lying.size() >= kEstablished) {
                const auto& source = wound.empty() ? lying : wound;
                for (std::size_t i = 0; i < kShare; ++i) {
                    near.push_back(source[i % source.size()]);
                }
            }
        }
        std::vector<Candidate> candidates;
        for (int i = 0; !near.empty() && i < options_.scarce_candidates / kScarceRounds; ++i) {
            const std::uint64_t draw = draws_++;
            candidates.push_back(candidate_near(
                members_[near[random_bits(stream(Seeds), ~draw) % near.size()]], draw));
        }
        judge_candidates(candidates);
    }

    // A candidate through a station of a member, turned a little, with the same or another
    // steering.
    [[nodiscard]] Candidate candidate_near(const Member& member, std::uint64_t draw) const {
        const SurfacePath path = trace_both_ways(rules_, member.candidate);
        const auto pick = static_cast<std::size_t>(random_unit(stream(Sampling), draw) *
                                                   static_cast<double>(path.size()));
        const PathPoint& station = path[pick];
        const double turn = (2.0 * random_unit(stream(Angles), draw) - 1.0) * kNearTurn_rad;
        Candidate candidate{station.at, direction_angle(station.normal, station.tangent) + turn,
                            member.candidate.slip_ratio};
        const auto steering = random_bits(stream(Steerings), draw) % (2 * kSteering.size());
        if (steering < kSteering.size()) {
            candidate.slip_ratio = kSteering[steering] * options_.tow.friction;
        }
        return candidate;
    }

    [[nodiscard]] std::vector<std::int32_t> unreached() const {
        std::vector<std::int32_t> missed;
        for (std::size_t i = 0; i < reached_.size(); ++i) {
            if (reached_[i] == 0) {
                missed.push_back(static_cast<std::int32_t>(i));
            }
        }
        return missed;
    }

    [[nodiscard]] std::string commonest_refusal() const {
        const auto& refusals = plan_.effort.refusals;
        const auto most = std::max_element(refusals.begin() + 1, refusals.end());
        return std::to_string(*most) + " of " + std::to_string(plan_.effort.candidates) +
               " candidates: " + name_of(static_cast<Refusal>(most - refusals.begin()));
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
        SlipMeasure slip = measure_slip(mandrel_.surface, piece.path, piece.string,
                                        {.friction = options_.tow.friction});
        piece.slip = std::move(slip.slip);
        piece.worst_slip = slip.worst;
        piece.start_rim = start_of(member, backward).rim;
        piece.end_rim = end_of(member, backward).rim;
        return piece;
    }

    // Checks the slip of a member as measured and asks the machine; direction by direction.
    Verdict verify(Member& member) const {
        for (const bool backward : {false, true}) {
            bool& windable = backward ? member.windable_backward : member.windable_forward;
            if (!windable) {
                continue;
            }
            Piece piece = course_of(member, backward);
            thin_out(piece, kStation_mm);
            if (piece.worst_slip > options_.tow.friction) {
                return Verdict::Rejected;
            }
            windable = !options_.accept || options_.accept(piece);
        }
        return member.windable_forward || member.windable_backward ? Verdict::Accepted
                                                                   : Verdict::Rejected;
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
        parallel_for(unknown.size(), 1, [&](std::size_t begin, std::size_t) {
            const std::int32_t i = unknown[begin];
            verdict_[at(i)] = verify(members_[at(i)]);
        });
        bool all = true;
        for (const std::int32_t i : unknown) {
            if (verdict_[at(i)] == Verdict::Rejected) {
                all = false;
                members_[at(i)].windable_forward = false;
                members_[at(i)].windable_backward = false;
                ++plan_.effort.rejected_courses;
            }
        }
        return all;
    }

    // Verifies the members of hard ways, where few of those that lie there can be wound: the one
    // fibre depends on them, so it must be known early which the machine accepts.
    void verify_hard_ways() {
        std::map<std::pair<std::size_t, std::size_t>, std::vector<std::int32_t>> windable;
        std::map<std::pair<std::size_t, std::size_t>, std::size_t> lying;
        for (std::size_t i = 0; i < members_.size(); ++i) {
            for (const bool backward : {false, true}) {
                const std::pair way{departure_node(start_of(members_[i], backward)),
                                    arrival_node(end_of(members_[i], backward))};
                ++lying[way];
                if (backward ? members_[i].windable_backward : members_[i].windable_forward) {
                    windable[way].push_back(static_cast<std::int32_t>(i));
                }
            }
        }
        std::vector<std::int32_t> hard;
        for (const auto& [way, members] : windable) {
            if (members.size() * kHardRatio < lying[way]) {
                hard.insert(hard.end(), members.begin(), members.end());
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
                const bool known_only = round == kMaxReplacements;
                allowed[i] = static_cast<char>(verdict_[i] == Verdict::Accepted ||
                                               (verdict_[i] == Verdict::Unknown && !known_only));
            }
            selection_ = select_courses(members_, allowed, samples_.size(), options_.select);
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
                verdict_[i] = Verdict::Rejected;
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
            verdict_[at(member)] = Verdict::Rejected;
            members_[at(member)].windable_forward = false;
            members_[at(member)].windable_backward = false;
            ++plan_.effort.rejected_courses;
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
            static_cast<double>(std::count(reached_.begin(), reached_.end(), 1)) /
            static_cast<double>(samples_.size());
        describe_uncovered();
        plan_.face_layers = layers_per_face(mandrel_.surface, samples_, selection_.layers);
        plan_.face_angle_rad = angle_per_face(mandrel_.surface, plan_.pieces);
    }

    [[nodiscard]] std::string reason_of(std::size_t sample) const {
        if (reached_[sample] != 0 && within_reach_[sample] == 0) {
            return "the courses that pass here cannot be joined to the one fibre, or the machine "
                   "refuses "
                   "them";
        }
        if (reached_[sample] != 0) {
            return "a course for it would lay more fibre over covered wall than it gains";
        }
        if (closest_miss_[sample] == Refusal::None) {
            return "no candidate was tried here";
        }
        return name_of(closest_miss_[sample]);
    }

    void describe_uncovered() {
        within_reach_.assign(samples_.size(), 0);
        for (const Member& member : members_) {
            for (const std::int32_t sample : member.footprint) {
                if (member.windable_forward || member.windable_backward) {
                    within_reach_[at(sample)] = 1;
                }
            }
        }
        selection_.layers.resize(samples_.size(), 0);
        std::map<std::pair<std::int32_t, std::string>, double> area;
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            if (selection_.layers[i] == 0) {
                const std::int32_t region = mandrel_.surface.region[at(samples_.at[i].face)];
                area[{region, reason_of(i)}] += samples_.area_mm2;
            }
        }
        for (const auto& [key, mm2] : area) {
            plan_.uncovered.push_back({key.first, mm2, key.second});
        }
    }

    const Mandrel& mandrel_;
    const CoverOptions& options_;
    CoverageSamples samples_;
    FootprintFinder footprints_;
    CourseRules rules_;
    std::vector<Member> members_;
    std::vector<Verdict> verdict_;
    std::vector<char> reached_;
    std::vector<char> within_reach_;  // per sample: passed by a member that the one fibre can use
    std::vector<Refusal> closest_miss_;  // per sample: the last check that a candidate there failed
    Selection selection_;
    std::vector<LaidCourse> laid_;
    std::vector<OrderedCourse> order_;
    std::int32_t entry_ =
        -1;  // the one way into the node where the fibre ends, if that has no way out
    std::uint64_t draws_ = 0;
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
