#include "cli/piece_program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/units.h"

namespace meshwind {
namespace {

// Where the head has more room than that the corner may be cut by up to this much.
constexpr double kMostBetweenBlocks_mm = 2.0;

// And where a plan leaves less than nothing, blocks are not cut to crumbs for it: it is refused.
constexpr double kLeastBetweenBlocks_mm = 0.1;

// Laid fibre against the plan. For the choice of blocks a quarter is left for what the choice does
// not see: rounding to the axes' resolution (0.005 mm at 300 mm from the spindle) and the first
// order.
constexpr double kChoiceShare = 0.75;

// Share of the friction that plan and blocks may use together: the rest is for measuring it.
constexpr double kUsedFriction = 0.995;

// Share of the head's spare clearance that blocks may use: between two points it may be less.
constexpr double kUsedRoom = 0.5;

// Where the simulation finds blocks too coarse they get this share of the tolerance they had, so
// many times.
constexpr double kTighter = 0.5;
constexpr int kTighterRounds = 4;

// After so many rounds the same pieces still found wrong are taken for beyond mending.
constexpr int kRoundsInVain = 1;

// Turns of less than this per mm (radius 100 m) are none.
constexpr double kStraight_per_mm = 1e-5;

// Where the head comes too near between stations its piece gets so much more clearance at them, so
// many times: a free length that grows by 3 mm per mm of fibre moves the head by up to 12 mm
// between two.
constexpr double kMoreClearance_mm = 1.0;
constexpr int kMoreClearanceRounds = 2;

constexpr RedundancyPolicy kPolicy = RedundancyPolicy::CentralAngle;

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
        const auto tell = [&](const char* step, double share) {
            if (options.progress) {
                options.progress(step, share);
            }
        };
        const auto done = [&](const char* stage) {
            if (options.stage_done) {
                options.stage_done(stage);
            }
        };
        tell("post", 0.0);
        CollisionRule rule = setup_.rule;
        rule.told_mm = rule.clearance_mm + kMostBetweenBlocks_mm / kUsedRoom;
        leave_room(keep_clear(rule, options.in_spite));
        if (!found_.refused.empty() && !options.in_spite) {
            return std::move(found_);
        }
        share_.assign(path_.size(), 1.0);
        make_blocks();
        done("post");
        std::map<std::size_t, Rejection> wrong;
        for (int round = 0;; ++round) {
            tell("verify", static_cast<double>(round) / kTighterRounds);
            found_.read = options.through_text ? options.through_text(found_) : as_run();
            found_.verification = verify_program(setup_, found_.read, planned_fibre(pieces_));
            std::map<std::size_t, Rejection> now;
            for (const std::size_t block : found_.verification.wrong_blocks) {
                now.emplace(static_cast<std::size_t>(found_.blocks.blocks[block].piece),
                            Rejection::Laydown);
            }
            const bool in_vain = round > kRoundsInVain && now == wrong;
            wrong = std::move(now);
            if (round == kTighterRounds || in_vain || !tighten()) {
                break;
            }
            make_blocks();
        }
        done("verify");
        found_.refused.merge(wrong);
        return std::move(found_);
    }

private:
    [[nodiscard]] BlockTolerance block_tolerance() const {
        BlockTolerance tolerance;
        tolerance.sideways_mm = kChoiceShare * setup_.job.tolerance.laydown_mm;
        tolerance.angle_rad = kChoiceShare * rad_from_deg(setup_.job.tolerance.laydown_angle_deg);
        tolerance.eye_mm = kMostBetweenBlocks_mm;
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
            CollisionReport report = check_collisions(setup_.machine, setup_.envelope,
                                                      *setup_.obstacles, path_, joints_, rule);
            const std::size_t refused = found_.refused.size();
            for (const std::size_t point : report.fibre_hits) {
                refuse(path_[point], Rejection::FibreHit);
            }
            for (const std::size_t point : report.head_hits) {
                refuse(path_[point], Rejection::HeadHit);
            }
            const bool only_head =
                refused == 0 && report.fibre_hits.empty() && !report.head_hits.empty();
            if (!only_head || round == kMoreClearanceRounds) {
                return std::move(report.clearance_mm);
            }
            for (const auto& [piece, reason] : found_.refused) {
                more_mm[piece] += kMoreClearance_mm;
            }
        }
    }

    void solve_motion(std::span<const double> more_clearance_mm) {
        found_.refused.clear();
        found_.eyes = equal_free_length(pieces_, *setup_.obstacles, setup_.rule.free_fibre,
                                        more_clearance_mm);
        path_ = refine_path(setup_.machine, found_.eyes.path, kPolicy, block_tolerance());
        joints_ = solve_joints(setup_.machine, path_, kPolicy);
        found_.path_points = path_.size();
        for (const std::size_t point : found_.eyes.blocked) {
            refuse(found_.eyes.path[point], Rejection::FreeLength);
        }
        for (const LimitViolation& violation : joints_.violations) {
            refuse(path_[violation.point], Rejection::AxisTravel);
        }
    }

    void leave_room(std::vector<double> clearance_mm) {
        room_mm_ = std::move(clearance_mm);
        for (double& room : room_mm_) {
            room = std::clamp(kUsedRoom * (room - setup_.rule.clearance_mm), kLeastBetweenBlocks_mm,
                              kMostBetweenBlocks_mm);
        }
    }

    // Blocks for the motion.
    void make_blocks() {
        const std::vector<double> turn_room = turn_room_per_mm();
        found_.choice = choose_blocks(setup_.machine,
                                      {.path = path_,
                                       .joints = joints_,
                                       .room_mm = room_mm_,
                                       .turn_room_per_mm = turn_room,
                                       .share = share_},
                                      block_tolerance());
        const std::span<const std::size_t> ends = found_.choice.ends;
        const TimeLawOptions time{.fibre_speed_mm_s = setup_.job.speed.fibre_m_min * 1000.0 / 60.0,
                                  .tick_s = setup_.dialect->tick_s()};
        const auto timed_for = [&](const Machine& machine) {
            return meshwind::make_blocks(machine, points_at(path_, ends), points_at(joints_, ends),
                                         found_.choice.fibre_mm, time);
        };
        TimedBlocks timed = timed_for(setup_.machine);
        BlockList prepared = setup_.dialect->prepare(timed.list);
        if (prepared.axes != timed.list.axes) {
            // Other steps are other positions, so the time law is asked again.
            timed = timed_for(with_steps(setup_.machine, prepared.axes));
            prepared = setup_.dialect->prepare(std::move(timed.list));
        }
        found_.duration_s = timed.time.duration_s;
        found_.binding = std::move(timed.time.binding);
        // What the program runs, repeated circuits included.
        FoldedProgram folded = setup_.dialect->fold(std::move(prepared));
        found_.blocks = std::move(folded.list);
        found_.layout = std::move(folded.layout);
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
                share_[point] *= kTighter;
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
            const double spare = kUsedFriction * setup_.job.tow.friction - piece.slip[i];
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
