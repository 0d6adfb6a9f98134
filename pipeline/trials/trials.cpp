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
constexpr std::size_t kMaxBarePatterns = 2;

// By friction a turn that is 10 degrees flatter takes 1.8 times the length.
constexpr double kLongerExtension = 2.0;

// With so much in reach of the fibres no larger one is looked for: a hundredth of it stays bare.
constexpr double kWellInReach = 0.96;

// No plan covers so many times what courses reach: one that has to is never wound.
constexpr double kNeverEnough = 2.0;

// More fibres and longer extensions are tried so many times at most.
constexpr int kMaxMends = 2;

// A cover that fails by chance is planned with so many seeds at most, and with fewer where other
// blends, fibres and extensions are tried too.
constexpr std::uint64_t kMaxSeeds = 3;
constexpr std::uint64_t kSeedsOfTries = 2;

bool can_turn_on_pins(const Job& job) {
    const TurnKindTraits& pins = traits_of(TurnKind::Pins);
    return pins.why_not == nullptr || pins.why_not(job, false).empty();
}

// How far a run goes. PatternsFirst: a part that has patterns is not covered; WholePatterns: nor by
// one that leaves wall bare. WhereMostIsJoined: a cover is put off, as by PatternsFirst, whose
// fibres join less than is well covered. Reach: no cover is wound, it is said what of the wall can
// be covered.
enum class Depth { Full, WhereItCovers, WhereMostIsJoined, PatternsFirst, WholePatterns, Reach };

double least_covered_at(Depth depth) {
    switch (depth) {
        case Depth::Full:
            return 0.0;
        case Depth::Reach:
            return kNeverEnough;
        case Depth::WholePatterns:
            return kPatternCovers;
        default:
            return kMinReach;
    }
}

// A blend, and what of the wall fibres can join with it.
struct Look {
    Job job;
    double share = 0.0;
};

// The inputs of every run but its job.
struct TrialInputs {
    const MandrelOf& mandrel;
    const Machine& machine;
    const WindOptions& options;
};

// What is said of the runs: every remark once, and what each run came to.
class TrialLog {
public:
    explicit TrialLog(const RunContext& context) : context_(context) {}

    void remark(const std::string& words) {
        if (said_.insert(words).second) {
            context_.report_remark(words);
        }
    }

    void add(std::string words) { tried_.push_back(std::move(words)); }

    void add_refused(const Job& job, const InputError& error) {
        add(settings_words(job) + " cannot be wound: " + error.what());
    }

    // Tells what has not been told yet: a blend that is passed over adds nothing.
    void tell() {
        for (; told_ < tried_.size(); ++told_) {
            context_.report_remark(tried_[told_]);
        }
    }

    [[nodiscard]] const std::vector<std::string>& tried() const { return tried_; }

private:
    const RunContext& context_;
    std::set<std::string> said_;
    std::vector<std::string> tried_;
    std::size_t told_ = 0;  // of those
};

// What the last run came to.
struct LastRun {
    std::optional<Job> next;  // that may mend it
    bool by_chance = false;   // did it fail
    Planner planner = Planner::None;
    double share = 0.0;          // of the wall, where that was too bare to be wound
    double joins = 0.0;          // of the wall by fibres, where a cover was not wound
    bool cover_put_off = false;  // was it a pattern that did not hold
};

// Runs of the main job on one file, of which the best stands.
struct Trials {
    TrialLog log;
    bool pins_open;  // they have not been tried, and may be
    std::optional<Run> best{};
    std::vector<Look> put_off{};  // covers without a blend that join too little
    LastRun last{};
};

bool is_done(const Trials& trials) {
    return stands(*trials.best);
}

// Patterns cover what they are meant to, lattices little.
bool covers_well(const Run& best) {
    return first_plan(best).planner != Planner::Cover || covered_share(best) >= kWellCovered;
}

// Fibre turns by friction, fails or covers little, and the job leaves that open. A wall that is
// wound takes too long to be wound twice.
bool may_turn_on_pins(const Trials& trials) {
    const Run& best = *trials.best;
    return trials.pins_open && first_plan(best).planner == Planner::Cover &&
           !(stands(best) && covers_well(best)) && (best.walls.empty() || !best.planned());
}

// No choice of courses with turns by friction covers most of the wall.
bool pins_first(const Trials& trials) {
    return may_turn_on_pins(trials) && can_cover(*trials.best) < kWellCovered;
}

Job longer(Job job) {
    job.mandrel.extension_mm *= kLongerExtension;
    return job;
}

Job blended(Job job, double widths) {
    job.mandrel.blend_mm = std::round(kBlendsPerMm * widths * job.tow.width_mm) / kBlendsPerMm;
    return job;
}

std::optional<Job> room_for(const Run& run) {
    const Job& job = run.layers.front().setup.job;
    return stands(run) ? more_fibres(job, first_plan(run)) : more_room(job, first_plan(run));
}

struct TimedMandrel {
    Mandrel mandrel;
    double reading_s = 0.0;
};

TimedMandrel read_for(const TrialInputs& inputs, const Job& job, TrialLog& log) {
    log.tell();
    const auto begun = std::chrono::steady_clock::now();
    Mandrel mandrel = inputs.mandrel(job);
    const double reading_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    return {std::move(mandrel), reading_s};
}

Run wind_once(const TrialInputs& inputs, TimedMandrel&& read, const Job& job, Depth depth,
              std::uint64_t seed, TrialLog& log) {
    WindOptions options = inputs.options;
    options.context.remark = [&log](const std::string& words) { log.remark(words); };
    options.context.seed = seed;
    options.patterns_first = depth == Depth::PatternsFirst || depth == Depth::WholePatterns;
    options.least_covered = least_covered_at(depth);
    options.least_joined =
        depth == Depth::PatternsFirst || depth == Depth::WhereMostIsJoined ? kWellCovered : 0.0;
    options.reading_s += read.reading_s;
    return wind(std::move(read.mandrel), inputs.machine, job, options);
}

LastRun outcome_of(const Run& run) {
    LastRun last;
    last.next = room_for(run);
    last.planner = first_plan(run).planner;
    last.share = was_too_bare(run) ? covered_share(run) : 0.0;
    last.joins = joins_enough(run) ? can_cover(run) : 0.0;
    last.cover_put_off = last.planner == Planner::Pattern && !run.planned();
    last.by_chance = fails_by_chance(run);
    return last;
}

void take(Run&& run, std::uint64_t first_seed, Trials& trials) {
    trials.log.add(tried_words(run, first_seed));
    trials.last = outcome_of(run);
    if (!trials.best || is_better(run, *trials.best)) {
        trials.best = std::move(run);
    }
}

// Winds the job once, and where that fails by chance and nothing stands with the next seeds; from a
// later seed on only where the last run failed by chance. Throws as wind() does for the first job.
void try_job(const TrialInputs& inputs, const Job& job, Depth depth, std::uint64_t first,
             Trials& trials) {
    const std::uint64_t first_seed = inputs.options.context.seed;
    const std::uint64_t seeds = trials.best && is_done(trials) ? 1
                                : depth == Depth::Full         ? kMaxSeeds
                                                               : kSeedsOfTries;
    LastRun& last = trials.last;
    last.by_chance = last.by_chance || first == 0;
    last.joins = 0.0;
    for (std::uint64_t k = first; last.by_chance && k < seeds && (k == 0 || !pins_first(trials));
         ++k) {
        try {
            take(wind_once(inputs, read_for(inputs, job, trials.log), job, depth, first_seed + k,
                           trials.log),
                 first_seed, trials);
        } catch (const InputError& error) {
            if (!trials.best) {
                throw;
            }
            trials.log.add_refused(job, error);
            last.share = 0.0;
            return;  // of no use for what stands
        }
    }
}

// The smallest blend with which a pattern covers all of a part that has patterns, on longer
// extensions too where the job leaves them open: flat fibre takes long to be turned by friction.
// Where none does, the one that covers most. Only what may stand is wound.
void find_pattern(const TrialInputs& inputs, const Job& job, Trials& trials) {
    const bool open = !job.mandrel.extension_given && !turns_on_pins(job) &&
                      find_revolution(trials.best->layers.front().setup.mandrel).body.has_value();
    std::vector<Look> bare;
    const auto settled = [&](const Job& each) {
        try_job(inputs, each, Depth::WholePatterns, 0, trials);
        bare.push_back({each, trials.last.share});
        return is_done(trials) || trials.last.planner != Planner::Pattern;
    };
    if (open && settled(longer(blended(job, 0.0)))) {
        return;
    }
    for (const double widths : kBlendsInTows) {
        const Job blend = blended(job, widths);
        if (settled(blend) || (open && trials.last.share == 0.0 && settled(longer(blend)))) {
            return;
        }
    }
    std::stable_sort(bare.begin(), bare.end(),
                     [](const Look& a, const Look& b) { return a.share > b.share; });
    bare.resize(std::min(bare.size(), kMaxBarePatterns));
    for (const Look& look : bare) {
        if (look.share > 0.0 && !is_done(trials)) {
            try_job(inputs, look.job, Depth::PatternsFirst, 0, trials);
        }
    }
}

// Share of the wall that fibres can join; 0 where it cannot be enough. Where one fibre cannot do
// the job gets as many as can.
double look_at(const TrialInputs& inputs, Job& job, Trials& trials) {
    const std::uint64_t seed = inputs.options.context.seed;
    try {
        TimedMandrel read = read_for(inputs, job, trials.log);
        if (read.mandrel.winding_mesh.blended_mm2 < job.tow.width_mm * job.tow.width_mm) {
            return 0.0;  // what it changes no tow would show
        }
        Run look = wind_once(inputs, std::move(read), job, Depth::Reach, seed, trials.log);
        const Plan& plan = first_plan(look);
        double share = 0.0;
        if (joins_enough(look)) {
            share = can_cover(look);
            if (plan.coverage.joinable < kMinReach * plan.coverage.reachable) {
                job = more_fibres(job, plan).value_or(job);
            }
        }
        take(std::move(look), seed, trials);
        return share;
    } catch (const InputError& error) {
        trials.log.add_refused(job, error);
        return 0.0;
    }
}

// What is wound now need not be at the end.
void forget_put_off(TurnKind turn, std::vector<Look>& put_off) {
    put_off.erase(std::remove_if(put_off.begin(), put_off.end(),
                                 [&](const Look& look) { return look.job.mandrel.turn == turn; }),
                  put_off.end());
}

// The smallest blend that lets the fibres reach most of the wall, or nearly as much as any.
void choose_blend(const TrialInputs& inputs, const Job& job, Trials& trials) {
    const bool was_done = is_done(trials);
    const double before = was_done ? can_cover(*trials.best) + kWorthMore : 0.0;
    double most = before;
    std::vector<Look> looks;
    for (const Look& look : trials.put_off) {
        if (look.job.mandrel.turn == job.mandrel.turn) {
            looks.push_back(look);
            most = std::max(most, look.share);
        }
    }
    for (const double widths : kBlendsInTows) {
        Look& look = looks.emplace_back(Look{blended(job, widths), most});
        if (most < kWellInReach) {
            look.share = look_at(inputs, look.job, trials);
            most = std::max(most, look.share);
        }
        if (is_done(trials) && !was_done) {
            return;
        }
    }
    for (const Look& look : looks) {
        if (look.share > before && look.share >= most - kWorthMore) {
            if (look.job.mandrel.blend_mm == 0.0) {
                forget_put_off(job.mandrel.turn, trials.put_off);
            }
            try_job(inputs, look.job, Depth::WhereItCovers, 0, trials);
            if (is_done(trials)) {
                return;
            }
        }
    }
}

// The job as it stands, without a blend where that is yet to be chosen; then with wider blends.
// Throws as wind() does for the first job. \param first seed that is tried, counted from 0
void start(const TrialInputs& inputs, const Job& job, std::uint64_t first, Trials& trials) {
    if (job.mandrel.blend_mm || inputs.options.import) {
        try_job(inputs, job, trials.best ? Depth::WhereItCovers : Depth::Full, first, trials);
        return;
    }
    const Job sharp = blended(job, 0.0);
    try_job(inputs, sharp, first == 0 ? Depth::PatternsFirst : Depth::WhereItCovers, first, trials);
    if (trials.last.cover_put_off) {
        find_pattern(inputs, job, trials);
        if (is_done(trials) || turns_on_pins(job)) {
            return;
        }
        try_job(inputs, sharp, Depth::WhereMostIsJoined, 0, trials);
    }
    if (first == 0 && trials.last.joins > 0.0) {
        trials.put_off.push_back({sharp, trials.last.joins});
    }
    if (!(is_done(trials) && covers_well(*trials.best)) && !pins_first(trials)) {
        choose_blend(inputs, job, trials);
    }
}

// More room for the best run, and for what comes of it, where that turns as the job does.
void mend_room(const TrialInputs& inputs, const Job& job, Trials& trials) {
    if (trials.best->layers.front().setup.job.mandrel.turn != job.mandrel.turn) {
        return;
    }
    std::optional<Job>& next = trials.last.next;
    next = room_for(*trials.best);
    for (int mend = 0; mend < kMaxMends && next; ++mend) {
        try_job(inputs, *std::exchange(next, std::nullopt), Depth::WhereItCovers, 0, trials);
    }
}

void turn_on_pins(const TrialInputs& inputs, Job job, Trials& trials) {
    trials.pins_open = false;
    job.mandrel.turn = TurnKind::Pins;
    start(inputs, job, 0, trials);
    mend_room(inputs, job, trials);
}

// What the job leaves open: more room for the best run, and turns on pins. Those come first where
// they promise more; where they do not do, what was put off for them comes after all.
void mend(const TrialInputs& inputs, const Job& job, Trials& trials) {
    const bool pins_before_room = pins_first(trials);
    if (!pins_before_room) {
        mend_room(inputs, job, trials);
    }
    if (may_turn_on_pins(trials)) {
        const bool by_chance = trials.last.by_chance;
        turn_on_pins(inputs, job, trials);
        if (pins_before_room && !is_done(trials)) {
            trials.last.by_chance = by_chance;
            start(inputs, job, 1, trials);
            mend_room(inputs, job, trials);
        }
    }
    for (const Look& look : trials.put_off) {
        if (!is_done(trials)) {
            try_job(inputs, look.job, Depth::WhereItCovers, 0, trials);
            mend_room(inputs, look.job, trials);
        }
    }
}

// The run that stands, with what was tried among its remarks.
Run best_of(const TrialInputs& inputs, Trials&& trials) {
    Run& best = *trials.best;
    TrialLog& log = trials.log;
    if (inputs.options.force && was_too_bare(best)) {  // whose program is asked for all the same
        const Job job = best.layers.front().setup.job;
        best = wind_once(inputs, read_for(inputs, job, log), job, Depth::Full, best.seed, log);
    }
    if (log.tried().size() > 1) {
        log.add("what stands is the job with " + settings_words(best.layers.front().setup.job) +
                (best.seed == inputs.options.context.seed
                     ? ""
                     : " --seed " + std::to_string(best.seed)));
        log.tell();
        best.remarks.insert(best.remarks.end(), log.tried().begin(), log.tried().end());
    }
    return std::move(best);
}

}  // namespace

Run wind(const MandrelOf& mandrel, const Machine& machine, const Job& job,
         const WindOptions& options) {
    const TrialInputs inputs{mandrel, machine, options};
    Trials trials{.log = TrialLog(options.context),
                  .pins_open = !options.import && !job.mandrel.turn_given && can_turn_on_pins(job)};
    start(inputs, job, 0, trials);
    mend(inputs, job, trials);
    return best_of(inputs, std::move(trials));
}

}  // namespace meshwind
