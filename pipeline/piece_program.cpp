#include "pipeline/piece_program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/margins.h"
#include "core/units.h"
#include "pipeline/block_time.h"
#include "postproc/eye/repeated_path.h"
#include "postproc/motion/mend_motion.h"

namespace meshwind {
namespace {

// Whether a pin takes hold of the fibre turns on tenths of a mm at the pin (kLeastPinRoom_mm), and
// what the eye is off it is off there by less: by its share of the free length.
constexpr double kMostInPinTurns_mm = 0.4;

// Where the simulation finds blocks too coarse they get less of the tolerance, so many times.
constexpr int kTighterRounds = 4;

// After so many rounds the same pieces still found wrong are taken for beyond mending; where a
// motion is at hand that lays them, at once.
constexpr int kRoundsInVain = 1;

// Turns of less than this per mm (radius 100 m) are none.
constexpr double kStraight_per_mm = 1e-5;

// Where the head comes too near between stations its piece gets more clearance at them, so many
// times.
constexpr int kMoreClearanceRounds = 2;

// A better motion is chosen so many times at most.
constexpr int kMotionRounds = 12;

// And so many times after a program has been wound again, as long as each leaves fewer pieces wrong
// than the one before.
constexpr int kMendedPrograms = 3;

// The first motion is kept where it takes hardly longer: its blocks are fewer, and repeat where the
// fibre does.
constexpr double kWorthwhile = 0.99;

// Where a controller spends more than this share of the time on corners, finer blocks are tried. On
// a pipe of the hobby winder they save 12 %; yet finer ones save nothing more.
constexpr double kMostCorners = 0.02;
constexpr double kFinerForCorners = 0.25;

// Of what a program takes until its blocks are made: a first motion, and the choice of a better
// one.
constexpr double kFirstMotionShare = 0.3;
constexpr double kChosenShare = 0.7;

// A motion of least time uses the axes to the full, so its blocks follow it at least that closely.
constexpr double kMostBlock_mm = 2.0 * kKnot_mm;

class Programmer {
public:
    Programmer(const Setup& setup, std::span<const Piece> pieces)
        : setup_(setup), pieces_(pieces) {}

    std::map<std::size_t, Rejection> ask_machine() {
        CollisionRule rule = setup_.rule;
        rule.told_mm = rule.clearance_mm;
        (void)keep_clear(rule, false);
        return std::move(found_.refused);
    }

    PieceProgram run(const PieceProgramOptions& options) {
        const auto done = [&](const char* stage) {
            if (options.stage_done) {
                options.stage_done(stage);
            }
        };
        tell(options, "post", 0.0);
        spindle_rad_ = options.spindle_rad;
        search_ = options.lengths;
        repeated_.reset();
        CollisionRule rule = setup_.rule;
        rule.told_mm = rule.clearance_mm + margin::kMostBetweenBlocks_mm / margin::kBlocksOfRoom;
        std::optional<MotionImprover> improver;
        leave_room(keep_clear(rule, options.in_spite || options.optimal));
        // Where a strict rule has no eye, no motion makes it one.
        const bool broken_rule =
            setup_.job.eye.rule != EyeRule::Adaptive && !found_.eyes.blocked.empty();
        double first_s = std::numeric_limits<double>::infinity();
        if (options.optimal && !broken_rule) {
            if (found_.refused.empty()) {
                share_.assign(path_.size(), 1.0);
                longer_.assign(path_.size(), 1.0);
                make_blocks();
                first_s = found_.duration_s;
            }
            tell(options, "post", kFirstMotionShare);
            improver.emplace(improver_of(found_.eyes));
            improver->choose();
            tell(options, "post", kChosenShare);
            if (!make_clear(*improver, rule)) {
                improver.reset();
            }
        }
        std::map<std::size_t, Rejection> wrong;
        std::size_t wrong_before = std::numeric_limits<std::size_t>::max();
        std::optional<PieceProgram> hardly_faster;
        std::optional<MotionImprover> aside;  // of many stations: its motion is hardly faster
        for (int mendings = 0;; ++mendings) {
            if (options.optimal && !improver) {
                leave_room(keep_clear(rule, options.in_spite));
            }
            if (!found_.refused.empty() && !options.in_spite) {
                return std::move(found_);
            }
            share_.assign(path_.size(), 1.0);
            longer_.assign(path_.size(), 1.0);
            most_mm_ = improver ? kMostBlock_mm : std::numeric_limits<double>::infinity();
            make_blocks();
            tell(options, "post", 1.0);
            done("post");
            if (improver && repeated_ && !aside && found_.duration_s > kWorthwhile * first_s) {
                aside.emplace(std::move(*improver));
                improver.reset();
                continue;
            }
            wrong = wind_again(options, improver ? 0 : kRoundsInVain);
            done("verify");
            if (wrong.empty() && improver && found_.duration_s > kWorthwhile * first_s) {
                hardly_faster = std::exchange(found_, {});
                improver.reset();
                continue;
            }
            if (!wrong.empty() && !improver && aside && aside->path().size() > 0) {
                improver.emplace(std::move(*aside));
                if (make_clear(*improver, rule)) {
                    continue;
                }
                improver.reset();
            }
            if (wrong.empty() || !improver) {
                break;
            }
            const bool mended = mendings < kMendedPrograms && wrong.size() < wrong_before &&
                                improver->give_up(of_improver(wrong_stations())) &&
                                make_clear(*improver, rule);
            wrong_before = wrong.size();
            if (!mended) {
                improver.reset();
            }
        }
        if (hardly_faster && !wrong.empty()) {
            found_ = std::move(*hardly_faster);
            wrong.clear();
        }
        found_.refused.merge(wrong);
        found_.optimal = improver || hardly_faster;
        return std::move(found_);
    }

private:
    static void tell(const PieceProgramOptions& options, const char* step, double share) {
        options.context.report_progress(step, share);
    }

    // Winds the blocks again, finer where they are too coarse, until that has not helped for more
    // than some rounds. Returns the pieces that they do not lay as planned.
    std::map<std::size_t, Rejection> wind_again(const PieceProgramOptions& options,
                                                int rounds_in_vain) {
        std::map<std::size_t, Rejection> wrong;
        for (int round = 0;; ++round) {
            tell(options, "verify", static_cast<double>(round) / kTighterRounds);
            const bool many = path_.size() > kManyStations;
            if (many) {
                forget_motion();
            }
            found_.read = options.through_text ? options.through_text(found_) : as_run();
            found_.verification = verify_program(setup_, found_.read, planned_fibre(pieces_));
            std::map<std::size_t, Rejection> now;
            for (const std::size_t block : found_.verification.wrong_blocks) {
                now.emplace(static_cast<std::size_t>(found_.blocks.blocks[block].piece),
                            Rejection::Laydown);
            }
            const bool in_vain = round > rounds_in_vain && now == wrong;
            wrong = std::move(now);
            const std::vector<FastBlock>& fast = found_.verification.fast_blocks;
            if (many && !(fast.empty() && found_.verification.coarse_blocks.empty())) {
                refine(policy_);
            }
            lengthen(fast, found_.blocks.blocks, path_, longer_);
            if (round == kTighterRounds || in_vain || !(tighten() || !fast.empty())) {
                return wrong;
            }
            make_blocks();
        }
    }

    [[nodiscard]] BlockTolerance block_tolerance(double finer = 1.0) const {
        const double share = margin::kBlocksOfDeviation * finer;
        BlockTolerance tolerance;
        tolerance.sideways_mm = share * setup_.job.tolerance.laydown_mm;
        tolerance.angle_rad = share * rad_from_deg(setup_.job.tolerance.laydown_angle_deg);
        tolerance.eye_mm = margin::kMostBetweenBlocks_mm;
        tolerance.most_mm = most_mm_;
        return tolerance;
    }

    void refuse(const EyePoint& point, Rejection reason) {
        found_.refused.emplace(static_cast<std::size_t>(point.piece), reason);
    }

    // What the machine does for the pieces, point by point. Returns the clearance at each,
    // if the free lengths and the axes allow it or in spite of them.
    std::vector<double> keep_clear(const CollisionRule& rule, bool in_spite) {
        std::vector<double> more_mm(pieces_.size(), 0.0);
        for (int round = 0;; ++round) {
            solve_motion(more_mm);
            if (!found_.refused.empty() && !in_spite) {
                return {};
            }
            const std::size_t refused = found_.refused.size();
            CollisionReport report = refuse_hits(rule);
            const bool only_head = refused == 0 && report.fibre_hits.empty() &&
                                   report.body_hits.empty() && !report.head_hits.empty();
            const bool by_rule = setup_.job.eye.rule != EyeRule::Adaptive;
            if (!only_head || by_rule || round == kMoreClearanceRounds) {
                return std::move(report.clearance_mm);
            }
            for (const auto& [piece, reason] : found_.refused) {
                more_mm[piece] += margin::kMended_mm;
            }
        }
    }

    void solve_motion(std::span<const double> more_clearance_mm) {
        found_.refused.clear();
        found_.eyes = eye_path(pieces_, setup_.job.eye, *setup_.obstacles, setup_.rule.free_fibre,
                               more_clearance_mm, search_);
        refine(first_policy());
        for (const std::size_t point : found_.eyes.blocked) {
            refuse(found_.eyes.path[point], Rejection::FreeLength);
        }
        refuse_beyond_travel();
    }

    // What a motion of least time starts from is the central angle.
    [[nodiscard]] RedundancyPolicy first_policy() const {
        switch (setup_.job.redundancy) {
            case RedundancyRule::Hold:
                return RedundancyPolicy::Hold;
            case RedundancyRule::Oscillate:
                return RedundancyPolicy::Oscillate;
            default:
                return RedundancyPolicy::CentralAngle;
        }
    }

    void refine(RedundancyPolicy policy) {
        forget_motion();
        policy_ = policy;
        path_ = refine_path(setup_.machine, found_.eyes.path, policy, block_tolerance());
        joints_ = solve_joints(setup_.machine, path_, policy);
        found_.path_points = path_.size();
        go_on_from_spindle();
    }

    // Of a long fibre it takes as much memory as the plan; it can be had again.
    void forget_motion() {
        path_ = EyePath();  // {} would keep the memory
        joints_ = JointPath();
    }

    void go_on_from_spindle() {
        const Axis& spindle = setup_.machine.mandrel_chain.back();
        const std::size_t axis = setup_.machine.mandrel_chain.size() - 1;
        if (!spindle_rad_ || std::isfinite(spindle.min) || std::isfinite(spindle.max)) {
            return;
        }
        const double turns = std::round((*spindle_rad_ - joints_.row(0)[axis]) / (2.0 * kPi));
        for (std::size_t i = axis; i < joints_.joints.size(); i += joints_.axis_count) {
            joints_.joints[i] += 2.0 * kPi * turns;
        }
    }

    void refuse_beyond_travel() {
        for (const LimitViolation& violation : joints_.violations) {
            refuse(path_[violation.point], Rejection::AxisTravel);
        }
        for (const JointNote& note : joints_.notes) {
            if (note.kind == JointNoteKind::EyeOutOfReach) {
                refuse(path_[note.first], Rejection::AxisTravel);
            }
        }
    }

    CollisionReport refuse_hits(const CollisionRule& rule) {
        CollisionReport report = check_collisions(setup_.machine, setup_.envelope,
                                                  *setup_.obstacles, path_, joints_, rule);
        for (const std::size_t point : report.fibre_hits) {
            refuse(path_[point], Rejection::FibreHit);
        }
        for (const auto* const hits : {&report.head_hits, &report.body_hits}) {
            for (const std::size_t point : *hits) {
                refuse(path_[point], Rejection::HeadHit);
            }
        }
        return report;
    }

    // Of many stations only those of a few circuits, where they repeat.
    [[nodiscard]] MotionImprover improver_of(const EyePathResult& eyes) {
        EyePath safe = eyes.path;
        const std::vector<double> central = spindle_turns(safe, RedundancyPolicy::CentralAngle);
        for (std::size_t i = 0; i < safe.size(); ++i) {
            safe[i].turn_rad = central[i];
        }
        std::vector<double> ahead_mm = eyes.ahead_mm;
        repeated_ = repetition_of(safe, ahead_mm);
        if (repeated_) {
            safe = repeated_->few();
            ahead_mm = repeated_->few_ahead_mm();
        }
        return {setup_.machine,
                *setup_.obstacles,
                setup_.rule.free_fibre,
                fibre_speed_mm_s(),
                setup_.job.eye.rule != EyeRule::Adaptive,
                std::move(safe),
                std::move(ahead_mm)};
    }

    // What the improver has chosen, for all stations.
    [[nodiscard]] EyePath improved(const MotionImprover& improver) {
        return repeated_ ? repeated_->all(std::move(found_.eyes.path), improver.path())
                         : improver.path();
    }

    // Of the improver's path, for stations of the whole one.
    [[nodiscard]] std::vector<std::size_t> of_improver(std::vector<std::size_t> stations) const {
        if (repeated_) {
            for (std::size_t& station : stations) {
                station = repeated_->few_of(station);
            }
            std::sort(stations.begin(), stations.end());
            stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
        }
        return stations;
    }

    // Takes over the improver's motion and mends it until it is clear; false where that fails.
    bool make_clear(MotionImprover& improver, const CollisionRule& rule) {
        for (int round = 0; round < kMotionRounds; ++round) {
            std::vector<std::size_t> hits;
            for (const auto& [first, last] : improver.changed()) {
                const std::vector<std::size_t> found = hits_within(improver.path(), first, last);
                hits.insert(hits.end(), found.begin(), found.end());
            }
            if (hits.empty()) {
                found_.eyes.path = improved(improver);
                found_.refused.clear();
                refine(RedundancyPolicy::Chosen);
                CollisionReport report = check_collisions(setup_.machine, setup_.envelope,
                                                          *setup_.obstacles, path_, joints_, rule);
                hits = of_improver(hit_stations(path_, joints_, report, found_.eyes.path));
                if (hits.empty()) {
                    found_.eyes.blocked.clear();
                    measure_lengths(found_.eyes);
                    leave_room(std::move(report.clearance_mm));
                    return true;
                }
            }
            if (!improver.mend(hits)) {
                return false;
            }
        }
        return false;
    }

    // Stations between two of a path at which its motion hits something or passes a limit.
    [[nodiscard]] std::vector<std::size_t> hits_within(const EyePath& stations, std::size_t first,
                                                       std::size_t last) const {
        const EyePath part(stations.begin() + static_cast<std::ptrdiff_t>(first),
                           stations.begin() + static_cast<std::ptrdiff_t>(last) + 1);
        const EyePath path =
            refine_path(setup_.machine, part, RedundancyPolicy::Chosen, block_tolerance());
        const JointPath joints = solve_joints(setup_.machine, path, RedundancyPolicy::Chosen);
        CollisionRule rule = setup_.rule;
        rule.told_mm = rule.clearance_mm;
        return hit_stations(path, joints,
                            check_collisions(setup_.machine, setup_.envelope, *setup_.obstacles,
                                             path, joints, rule),
                            stations);
    }

    static std::vector<std::size_t> hit_stations(const EyePath& path, const JointPath& joints,
                                                 const CollisionReport& report,
                                                 const EyePath& stations) {
        std::vector<std::size_t> found;
        const auto add = [&](std::size_t point) {
            found.push_back(station_of(path[point].piece, path[point].point, stations));
        };
        for (const auto* const hits : {&report.fibre_hits, &report.head_hits, &report.body_hits}) {
            std::for_each(hits->begin(), hits->end(), add);
        }
        for (const LimitViolation& violation : joints.violations) {
            add(violation.point);
        }
        return found;
    }

    static std::size_t station_of(std::int32_t piece, std::int32_t point, const EyePath& stations) {
        const auto at = std::lower_bound(
            stations.begin(), stations.end(), std::pair(piece, point),
            [](const EyePoint& a, const auto& key) { return std::pair(a.piece, a.point) < key; });
        return std::min(static_cast<std::size_t>(at - stations.begin()), stations.size() - 1);
    }

    [[nodiscard]] std::vector<std::size_t> wrong_stations() const {
        std::vector<std::size_t> found;
        for (const std::size_t block : found_.verification.wrong_blocks) {
            const Block& at = found_.blocks.blocks[block];
            found.push_back(station_of(at.piece, at.point, found_.eyes.path));
        }
        return found;
    }

    [[nodiscard]] double fibre_speed_mm_s() const {
        return std::min(setup_.job.speed.fibre_m_min * 1000.0 / 60.0,
                        margin::kPaidOutSpeed * setup_.machine.fibre.max_speed_mm_s);
    }

    void leave_room(std::vector<double> clearance_mm) {
        room_mm_ = std::move(clearance_mm);
        for (double& room : room_mm_) {
            room = std::clamp(margin::kBlocksOfRoom * (room - setup_.rule.clearance_mm),
                              margin::kLeastBetweenBlocks_mm, margin::kMostBetweenBlocks_mm);
        }
        for (std::size_t i = 0; i < room_mm_.size(); ++i) {
            if (!pieces_[static_cast<std::size_t>(path_[i].piece)].free_start.empty()) {
                room_mm_[i] = std::min(room_mm_[i], kMostInPinTurns_mm);
            }
        }
    }

    // Blocks for the motion. A controller that slows down at corners runs shorter ones faster, for
    // they turn less from one to the next.
    void make_blocks() {
        make_blocks(1.0);
        const double whole_s = found_.duration_s;
        if (setup_.dialect->has_junction_deviation() && found_.corner_s > kMostCorners * whole_s) {
            make_blocks(kFinerForCorners);
            if (found_.duration_s > kWorthwhile * whole_s) {
                make_blocks(1.0);
            }
        }
    }

    // \param finer share of the tolerances that blocks may take up
    void make_blocks(double finer) {
        const std::vector<double> turn_room = turn_room_per_mm();
        found_.choice = choose_blocks(setup_.machine,
                                      {.path = path_,
                                       .joints = joints_,
                                       .room_mm = room_mm_,
                                       .turn_room_per_mm = turn_room,
                                       .share = share_},
                                      block_tolerance(finer));
        const std::span<const std::size_t> ends = found_.choice.ends;
        const TimeLawOptions time{.fibre_speed_mm_s = fibre_speed_mm_s(),
                                  .corner_mm = setup_.dialect->corner_tolerance_mm(setup_.machine),
                                  .tick_s = setup_.dialect->tick_s()};
        const std::vector<double> fibre_mm = counted_fibre_mm(found_.choice, longer_);
        const auto timed_for = [&](const Machine& machine) {
            return meshwind::make_blocks(machine, points_at(path_, ends), points_at(joints_, ends),
                                         fibre_mm, time);
        };
        TimedBlocks timed = timed_for(setup_.machine);
        BlockList prepared = setup_.dialect->prepare(timed.list);
        if (prepared.axes != timed.list.axes) {
            // Other steps are other positions, so the time law is asked again.
            timed = timed_for(with_steps(setup_.machine, prepared.axes));
            prepared = setup_.dialect->prepare(timed.list);
        }
        found_.duration_s = timed.time.duration_s;
        found_.least_s = path_.back().s_mm / fibre_speed_mm_s();
        found_.binding = std::move(timed.time.binding);
        renumber(found_.binding, timed.list, prepared);
        // What the program runs, repeated circuits included.
        FoldedProgram folded = setup_.dialect->fold(std::move(prepared));
        found_.blocks = std::move(folded.list);
        found_.layout = std::move(folded.layout);
        found_.corner_s =
            setup_.dialect->run_time_s(setup_.machine, found_.blocks) - found_.blocks.duration_s();
        found_.duration_s += found_.corner_s;
        found_.exact = exact_blocks(ends);
    }

    // Those that blocks are chosen to end at. What moves no axis by a step ends no block of the
    // program.
    [[nodiscard]] BlockList exact_blocks(std::span<const std::size_t> ends) const {
        BlockList list;
        list.axes = found_.blocks.axes;
        list.tie_on_mm = found_.eyes.path.front().landing_mm;
        for (const std::size_t point : ends) {
            list.blocks.push_back({1.0, path_[point].piece, path_[point].point, 0});
            const std::span<const double> joints = joints_.row(point);
            for (std::size_t a = 0; a < joints.size(); ++a) {
                const double value =
                    list.axes[a].type == AxisType::Rotary ? deg_from_rad(joints[a]) : joints[a];
                list.nano.push_back(std::llround(value * static_cast<double>(kNanoPerUnit)));
            }
        }
        return list;
    }

    [[nodiscard]] BlockList as_run() const {
        BlockList list = found_.blocks;
        list.tie_on_mm = found_.eyes.path.front().landing_mm;
        return list;
    }

    // Asks for finer blocks where the simulation found some too coarse; false where it found none.
    bool tighten() {
        const auto key = [](const auto& at) { return std::pair(at.piece, at.point); };
        const std::vector<Block>& blocks = found_.blocks.blocks;
        bool any = false;
        std::size_t point = 0;
        for (const std::size_t block : found_.verification.coarse_blocks) {
            const auto from = key(blocks[block > 0 ? block - 1 : 0]);
            const auto to = key(blocks[block]);
            while (point < path_.size() && key(path_[point]) < from) {
                ++point;
            }
            for (; point < path_.size() && key(path_[point]) <= to; ++point) {
                share_[point] *= margin::kTighterBlocks;
                any = true;
            }
        }
        return any;
    }

    // How much the blocks may turn the fibre on top of the plan without using up the friction, per
    // point; where the plan lifts the fibre off, as they like.
    [[nodiscard]] std::vector<double> turn_room_per_mm() const {
        std::vector<double> room;
        for (const EyePoint& point : path_) {
            const Piece& piece = pieces_[static_cast<std::size_t>(point.piece)];
            const auto i = static_cast<std::size_t>(point.point);
            const double spare = setup_.friction.share(margin::kLaidFriction) - piece.slip[i];
            room.push_back(piece.string.gap_mm[i] > 0.0
                               ? std::numeric_limits<double>::infinity()
                               : std::max(spare * piece.path[i].kn_per_mm, kStraight_per_mm));
        }
        return room;
    }

    const Setup& setup_;
    std::span<const Piece> pieces_;
    PieceProgram found_;
    EyePath path_;                 // with points between stations where the axes need them
    JointPath joints_;             // along that path
    std::vector<double> room_mm_;  // per point: how far the eye may be off
    std::vector<double> share_;    // per point: of the tolerance, for blocks
    std::vector<double> longer_;   // per point: of the time that the fibre takes at its full speed
    std::optional<double> spindle_rad_;
    LengthSearch search_ = LengthSearch::Near;
    RedundancyPolicy policy_ = RedundancyPolicy::CentralAngle;  // of the motion that is at hand
    std::optional<RepeatedPath> repeated_;                      // what the improver works on
    double most_mm_ = std::numeric_limits<double>::infinity();  // fibre of a block
};

}  // namespace

std::map<std::size_t, Rejection> refused_by_machine(const Setup& setup,
                                                    std::span<const Piece> pieces) {
    return Programmer(setup, pieces).ask_machine();
}

PieceProgram program_of(const Setup& setup, std::span<const Piece> pieces,
                        const PieceProgramOptions& options) {
    return Programmer(setup, pieces).run(options);
}

}  // namespace meshwind
