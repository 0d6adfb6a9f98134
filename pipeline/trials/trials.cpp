#include "pipeline/trials/trials.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "mesh/revolution/revolution.h"
#include "pipeline/plan_layer.h"
#include "pipeline/trials/judged_run.h"
#include "pipeline/trials/more_room.h"

namespace meshwind {
namespace {

// Radii of the blends that are looked at where it is yet to be chosen, in tow widths.
constexpr std::array kBlendsInTows{1.0, 2.0, 3.0, 4.0};

// To the micrometre: a few digits then name them.
constexpr double kBlendsPerMm = 1000.0;

// Under so much of the wall a larger blend is looked for, although the plan can be wound.
constexpr double kWellCovered = 0.95;

// A pattern that covers less leaves a neck bare, which a wider blend may let it lie on. Where none
// covers it all, so many are wound until one holds.
constexpr double kPatternCovers = 0.99;
constexpr std::size_t kMostBarePatterns = 2;

// By friction a turn that is 10 degrees flatter takes 1.8 times the length.
constexpr double kLongerExtension = 2.0;

// With so much in reach of the fibres no larger one is looked for: a hundredth of it stays bare.
constexpr double kWellInReach = 0.96;

// No plan covers so many times what courses reach: one that has to is never wound.
constexpr double kNeverEnough = 2.0;

// More fibres and longer extensions are tried so many times at most.
constexpr int kMostMends = 2;

// A cover that fails by chance is planned with so many seeds at most, and with fewer where other
// blends, fibres and extensions are tried too.
constexpr std::uint64_t kMostSeeds = 3;
constexpr std::uint64_t kSeedsOfTries = 2;

bool can_turn_on_pins(const Job& job) {
    const TurnKindTraits& pins = traits_of(TurnKind::Pins);
    return pins.why_not == nullptr || pins.why_not(job, false).empty();
}

// Runs of the main job on one file, of which the best stands.
class Trials {
public:
    Trials(const MandrelOf& mandrel, const Machine& machine, const Job& job,
           const WindOptions& options)
        : mandrel_(mandrel),
          machine_(machine),
          options_(options),
          pins_open_(!options.import && !job.mandrel.turn_given && can_turn_on_pins(job)) {}

    /// The job as it stands, without a blend where that is yet to be chosen; then with wider
    /// blends. \param first seed that is tried, counted from 0 \throws as wind() does for the first
    /// job
    void start(const Job& job, std::uint64_t first = 0) {
        if (job.mandrel.blend_mm || options_.import) {
            run(job, best_ ? Depth::WhereItCovers : Depth::Full, first);
            return;
        }
        const Job sharp = blended(job, 0.0);
        run(sharp, first == 0 ? Depth::PatternsFirst : Depth::WhereItCovers, first);
        if (cover_put_off_) {
            find_pattern(job);
            if (done() || turns_on_pins(job)) {
                return;
            }
            run(sharp, Depth::WhereMostIsJoined);
        }
        if (first == 0 && last_joins_ > 0.0) {
            put_off_.push_back({sharp, last_joins_});
        }
        if (!(done() && covers_well()) && !pins_first()) {
            choose_blend(job);
        }
    }

    // What the job leaves open: more room for the best run, and turns on pins. Those come first
    // where they promise more; where they do not do, what was put off for them comes after all.
    void mend(const Job& job) {
        const bool put_off = pins_first();
        if (!put_off) {
            mend_room(job);
        }
        if (may_turn_on_pins()) {
            const bool by_chance = by_chance_;
            turn_on_pins(job);
            if (put_off && !done()) {
                by_chance_ = by_chance;
                start(job, 1);
                mend_room(job);
            }
        }
        for (const Look& look : put_off_) {
            if (!done()) {
                run(look.job, Depth::WhereItCovers);
                mend_room(look.job);
            }
        }
    }

    [[nodiscard]] Run best() && {
        if (options_.force && was_too_bare(*best_)) {  // whose program is asked for all the same
            best_ = once(Job(best_->layers.front().setup.job), Depth::Full, best_->seed);
        }
        if (tried_.size() > 1) {
            tried_.push_back(
                "what stands is the job with " + settings_words(best_->layers.front().setup.job) +
                (best_->seed == options_.context.seed ? ""
                                                      : " --seed " + std::to_string(best_->seed)));
            tell_tried();
            best_->remarks.insert(best_->remarks.end(), tried_.begin(), tried_.end());
        }
        return *std::move(best_);
    }

private:
    // PatternsFirst: a part that has patterns is not covered; WholePatterns: nor by one that leaves
    // wall bare. WhereMostIsJoined: a cover is put off, as by PatternsFirst, whose fibres join less
    // than is well covered. Reach: no cover is wound, it is said what of the wall can be covered.
    enum class Depth {
        Full,
        WhereItCovers,
        WhereMostIsJoined,
        PatternsFirst,
        WholePatterns,
        Reach
    };

    // A blend, and what of the wall fibres can join with it.
    struct Look {
        Job job;
        double share = 0.0;
    };

    // Once, and where that fails by chance and nothing stands with the next seeds; from a later
    // seed on only where what by_chance_ is of did. Throws as wind() does for the first job.
    void run(const Job& job, Depth depth, std::uint64_t first = 0) {
        const std::uint64_t seeds = best_ && done()        ? 1
                                    : depth == Depth::Full ? kMostSeeds
                                                           : kSeedsOfTries;
        by_chance_ = by_chance_ || first == 0;
        last_joins_ = 0.0;
        for (std::uint64_t k = first; by_chance_ && k < seeds && (k == 0 || !pins_first()); ++k) {
            try {
                take(once(job, depth, options_.context.seed + k));
            } catch (const InputError& error) {
                if (!best_) {
                    throw;
                }
                note_refused(job, error);
                last_share_ = 0.0;
                return;  // of no use for what stands
            }
        }
    }

    // The smallest blend with which a pattern covers all of a part that has patterns, on longer
    // extensions too where the job leaves them open: flat fibre takes long to be turned by
    // friction. Where none does, the one that covers most. Only what may stand is wound.
    void find_pattern(const Job& job) {
        const bool open = !job.mandrel.extension_given && !turns_on_pins(job) &&
                          find_revolution(best_->layers.front().setup.mandrel).body.has_value();
        std::vector<Look> bare;
        const auto settled = [&](const Job& each) {
            run(each, Depth::WholePatterns);
            bare.push_back({each, last_share_});
            return done() || last_planner_ != Planner::Pattern;
        };
        if (open && settled(longer(blended(job, 0.0)))) {
            return;
        }
        for (const double widths : kBlendsInTows) {
            const Job blend = blended(job, widths);
            if (settled(blend) || (open && last_share_ == 0.0 && settled(longer(blend)))) {
                return;
            }
        }
        std::stable_sort(bare.begin(), bare.end(),
                         [](const Look& a, const Look& b) { return a.share > b.share; });
        bare.resize(std::min(bare.size(), kMostBarePatterns));
        for (const Look& look : bare) {
            if (look.share > 0.0 && !done()) {
                run(look.job, Depth::PatternsFirst);
            }
        }
    }

    static Job longer(Job job) {
        job.mandrel.extension_mm *= kLongerExtension;
        return job;
    }

    // The smallest blend that lets the fibres reach most of the wall, or nearly as much as any.
    void choose_blend(const Job& job) {
        const bool was_done = done();
        const double before = was_done ? can_cover(*best_) + kWorthMore : 0.0;
        double most = before;
        std::vector<Look> looks;
        for (const Look& look : put_off_) {
            if (look.job.mandrel.turn == job.mandrel.turn) {
                looks.push_back(look);
                most = std::max(most, look.share);
            }
        }
        for (const double widths : kBlendsInTows) {
            Look& look = looks.emplace_back(Look{blended(job, widths), most});
            if (most < kWellInReach) {
                look.share = look_at(look.job);
                most = std::max(most, look.share);
            }
            if (done() && !was_done) {
                return;
            }
        }
        for (const Look& look : looks) {
            if (look.share > before && look.share >= most - kWorthMore) {
                if (look.job.mandrel.blend_mm == 0.0) {
                    forget_put_off(job.mandrel.turn);
                }
                run(look.job, Depth::WhereItCovers);
                if (done()) {
                    return;
                }
            }
        }
    }

    // What is wound now need not be at the end.
    void forget_put_off(TurnKind turn) {
        put_off_.erase(
            std::remove_if(put_off_.begin(), put_off_.end(),
                           [&](const Look& look) { return look.job.mandrel.turn == turn; }),
            put_off_.end());
    }

    [[nodiscard]] bool done() const { return stands(*best_); }

    // Fibre turns by friction, fails or covers little, and the job leaves that open. A wall that is
    // wound takes too long to be wound twice.
    [[nodiscard]] bool may_turn_on_pins() const {
        return pins_open_ && first_plan(*best_).planner == Planner::Cover &&
               !(done() && covers_well()) && (best_->walls.empty() || !best_->planned());
    }

    // No choice of courses with turns by friction covers most of the wall.
    [[nodiscard]] bool pins_first() const {
        return may_turn_on_pins() && can_cover(*best_) < kWellCovered;
    }

    void turn_on_pins(Job job) {
        pins_open_ = false;
        job.mandrel.turn = TurnKind::Pins;
        start(job);
        mend_room(job);
    }

    // More room for the best run, and for what comes of it, where that turns as the job does.
    void mend_room(const Job& job) {
        if (best_->layers.front().setup.job.mandrel.turn != job.mandrel.turn) {
            return;
        }
        next_ = room_for(*best_);
        for (int mend = 0; mend < kMostMends && next_; ++mend) {
            run(*std::exchange(next_, std::nullopt), Depth::WhereItCovers);
        }
    }

    // Patterns cover what they are meant to, lattices little.
    [[nodiscard]] bool covers_well() const {
        return first_plan(*best_).planner != Planner::Cover ||
               covered_share(*best_) >= kWellCovered;
    }

    static Job blended(Job job, double widths) {
        job.mandrel.blend_mm = std::round(kBlendsPerMm * widths * job.tow.width_mm) / kBlendsPerMm;
        return job;
    }

    // Share of the wall that fibres can join; 0 where it cannot be enough. Where one fibre cannot
    // do the job gets as many as can.
    [[nodiscard]] double look_at(Job& job) {
        try {
            Mandrel mandrel = read(job);
            if (mandrel.winding_mesh.blended_mm2 < job.tow.width_mm * job.tow.width_mm) {
                return 0.0;  // what it changes no tow would show
            }
            Run look = once(std::move(mandrel), job, Depth::Reach, options_.context.seed);
            const Plan& plan = first_plan(look);
            double share = 0.0;
            if (joins_enough(look)) {
                share = can_cover(look);
                if (plan.coverage.joinable < kLeastReach * plan.coverage.reachable) {
                    job = more_fibres(job, plan).value_or(job);
                }
            }
            take(std::move(look));
            return share;
        } catch (const InputError& error) {
            note_refused(job, error);
            return 0.0;
        }
    }

    void note_refused(const Job& job, const InputError& error) {
        tried_.push_back(settings_words(job) + " cannot be wound: " + error.what());
    }

    // What has not been told yet: a blend that is passed over adds nothing.
    void tell_tried() {
        for (; told_ < tried_.size(); ++told_) {
            options_.context.report_remark(tried_[told_]);
        }
    }

    static std::optional<Job> room_for(const Run& run) {
        const Job& job = run.layers.front().setup.job;
        return stands(run) ? more_fibres(job, first_plan(run)) : more_room(job, first_plan(run));
    }

    void take(Run&& run) {
        tried_.push_back(tried_words(run, options_.context.seed));
        next_ = room_for(run);
        last_planner_ = first_plan(run).planner;
        last_share_ = was_too_bare(run) ? covered_share(run) : 0.0;
        last_joins_ = joins_enough(run) ? can_cover(run) : 0.0;
        cover_put_off_ = last_planner_ == Planner::Pattern && !run.planned();
        by_chance_ = fails_by_chance(run);
        if (!best_ || is_better(run, *best_)) {
            best_ = std::move(run);
        }
    }

    [[nodiscard]] static double least_covered(Depth depth) {
        switch (depth) {
            case Depth::Full:
                return 0.0;
            case Depth::Reach:
                return kNeverEnough;
            case Depth::WholePatterns:
                return kPatternCovers;
            default:
                return kLeastReach;
        }
    }

    [[nodiscard]] Run once(const Job& job, Depth depth, std::uint64_t seed) {
        return once(read(job), job, depth, seed);
    }

    [[nodiscard]] Mandrel read(const Job& job) {
        tell_tried();
        const auto begun = std::chrono::steady_clock::now();
        Mandrel mandrel = mandrel_(job);
        reading_s_ =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
        return mandrel;
    }

    [[nodiscard]] Run once(Mandrel&& mandrel, const Job& job, Depth depth, std::uint64_t seed) {
        WindOptions options = options_;
        options.context.remark = [this](const std::string& words) {
            if (said_.insert(words).second) {
                options_.context.report_remark(words);
            }
        };
        options.context.seed = seed;
        options.patterns_first = depth == Depth::PatternsFirst || depth == Depth::WholePatterns;
        options.least_covered = least_covered(depth);
        options.least_joined =
            depth == Depth::PatternsFirst || depth == Depth::WhereMostIsJoined ? kWellCovered : 0.0;
        options.reading_s += reading_s_;
        return wind(std::move(mandrel), machine_, job, options);
    }

    const MandrelOf& mandrel_;
    const Machine& machine_;
    const WindOptions& options_;
    bool pins_open_;  // they have not been tried, and may be
    std::optional<Run> best_;
    std::vector<Look> put_off_;  // covers without a blend that join too little
    std::optional<Job> next_;    // that may mend the last run that was wound
    bool by_chance_ = false;     // did that fail
    Planner last_planner_ = Planner::None;
    double last_share_ = 0.0;     // of the wall, where that was too bare to be wound
    double last_joins_ = 0.0;     // of the wall by fibres, where a cover was not wound
    bool cover_put_off_ = false;  // was it a pattern that did not hold
    double reading_s_ = 0.0;      // the mandrel of the last run
    std::set<std::string> said_;
    std::vector<std::string> tried_;
    std::size_t told_ = 0;  // of those
};

}  // namespace

Run wind(const MandrelOf& mandrel, const Machine& machine, const Job& job,
         const WindOptions& options) {
    Trials trials(mandrel, machine, job, options);
    trials.start(job);
    trials.mend(job);
    return std::move(trials).best();
}

}  // namespace meshwind
