#include "winding/cover/cover.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "core/index.h"
#include "core/margins.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "winding/cover/cover_annealing.h"
#include "winding/cover/fibre_routes.h"
#include "winding/cover/grow.h"
#include "winding/cover/join.h"
#include "winding/cover/joints.h"
#include "winding/cover/lay_out.h"
#include "winding/cover/order_to_follow.h"
#include "winding/cover/prove.h"
#include "winding/cover/uncovered.h"
#include "winding/laminate/course_character.h"
#include "winding/laminate/coverage.h"
#include "winding/laminate/measure_plan.h"

namespace meshwind {
namespace {

// Routes of so many fibres are looked for, at most.
constexpr std::size_t kRoutesLookedFor = 9;

// So many others are tried in place of a course that leads from stage to stage. It takes 20 ms
// each, and without one a stage is lost.
constexpr std::size_t kMostSpares = 200;

// Where courses reach less of the wall nothing is planned: what comes of it is no part.
constexpr double kWorthPlanning = 0.5;

// What does not hold of the courses that fill thin places makes room for others so many times.
constexpr int kMostFills = 10;

// Attempts that refuse as many courses as before, or more, before no others are put there; none are
// before the last attempts either.
constexpr int kMostInVain = 2;
constexpr int kAttemptsWithoutOthers = 2;

class CoverPlanner {
public:
    CoverPlanner(const Mandrel& mandrel, const RayQuery& obstacles, const CoverOptions& options,
                 const Windability* machine)
        : mandrel_(mandrel),
          options_(options),
          machine_(machine),
          stage_(options.stage != nullptr
                     ? *options.stage
                     : whole_cover(mandrel.surface, options.tow.width_mm, options.context.seed,
                                   options.select.target_layers, options.most_bare)),
          select_(options.select),
          samples_(samples_at(mandrel.surface, stage_.measured.at)),
          footprints_(mandrel.surface, samples_, options.tow.width_mm),
          lifted_(mandrel.surface),
          rules_{mandrel,
                 obstacles,
                 footprints_,
                 options.tow,
                 options.turns,
                 options.free_fibre,
                 max_half_length_mm(mandrel.surface)},
          prover_(rules_, machine),
          reach_prover_(samples_.size(),
                        [this](PlacedCourse& course) { return prover_.prove(course); }) {
        rules_.turns.rule.friction = options.tow.friction;
        rules_.turns.rule.band_mm = options.tow.width_mm;
        rules_.angle_rad = options.angle_rad;
        rules_.lifted = &lifted_;
        rules_.free_fibre.clearance_mm += margin::kCandidates_mm;
        select_.targets = stage_.measured.layers;
        plan_.planner = Planner::Cover;
        plan_.effort.seed = options.context.seed;
        plan_.effort.effort = options.context.effort;
    }

    TriedPlan run() {
        library_ = grow_library(rules_, samples_, options_);
        plan_.effort.candidates = library_.candidates;
        plan_.effort.refusals = library_.refusals;
        tell("library", 1.0);
        if (members_.empty()) {
            return fail("no admissible course: " + refused_most(plan_.effort));
        }
        plan_.what_if = ask_what_if(rules_, samples_, library_,
                                    seed_of(Stream::Otherwise, options_.context.seed));
        if (reached_share(library_.reached) < kWorthPlanning) {
            rejection_.assign(members_.size(), Rejection::NotPlanned);
            return fail(hardly_reachable());
        }
        ground_.emplace(rules_, samples_at(mandrel_.surface, stage_.weighed.at), samples_,
                        members_);
        library_size_ = members_.size();
        allowed_.assign(members_.size(), 1);
        rejection_.assign(members_.size(), Rejection::None);
        const double sketched = reached_share(library_.reached);
        library_.reached = prove_reach();
        // The answers are what sketches reach: what they bring is told beside what holds.
        for (WhatIf& what_if : plan_.what_if) {
            what_if.reachable -= sketched - reached_share(library_.reached);
        }
        find_routes();
        joinable_ = prove_reach();
        if (const double share = reached_share(joinable_);
            !is_enough(share) || share < options_.least_joined) {
            plan_.coverage.fraction = share;
            return too_bare("the courses that the fibres can join reach only ");
        }
        choose();
        improve();
        keep_what_winds();
        if (std::vector<std::int32_t> layers = layers_of(courses_, samples_.size());
            !is_enough(measure_coverage(layers).fraction)) {
            layers_ = std::move(layers);
            plan_.coverage = measure_coverage(layers_);
            return too_bare("courses cover only ");
        }
        make_it_hold();
        if (order_.empty()) {
            return fail("every course was refused, " + rejected_most(plan_.effort));
        }
        measure();
        return {std::move(plan_), std::move(trial_)};
    }

private:
    TriedPlan fail(std::string words) {
        plan_.failure = std::move(words);
        describe_uncovered();
        return {std::move(plan_), nullptr};
    }

    void tell(const char* step, double share) const {
        options_.context.report_progress(step, share);
    }

    [[nodiscard]] std::string hardly_reachable() const {
        return "courses reach only " + fixed(100.0 * reached_share(library_.reached), 1) +
               " % of the wall, under " + fixed(100.0 * kWorthPlanning, 0) +
               " % nothing is planned; refused most often, " + refused_most(plan_.effort);
    }

    void note_refused(const Member& member, Rejection reason) {
        const std::lock_guard lock(refused_mutex_);
        refused_.emplace_back(member.footprint, reason);
        ++plan_.effort.rejections[static_cast<std::size_t>(reason)];
        ++plan_.effort.rejected_courses;
    }

    // Which ways between nodes are open to the machine, and the routes that the fibres take best.
    // What lies off them is struck off the library.
    void find_routes() {
        const Ways ways = ways_between_nodes(members_);
        const auto [known, refused] = prove_ways(
            members_, ways, [this](PlacedCourse& course) { return prover_.prove(course); },
            [this](double share) { tell("route", share); });
        for (const auto& [member, rejection] : refused) {
            note_refused(members_[at(member)], rejection);
        }
        routes_ = best_routes(members_, known, 2 * mandrel_.rims.size(), samples_.size(),
                              kRoutesLookedFor);
        for (const FibreRoute& route : routes_) {
            plan_.reach_of_fibres.push_back(route.reach);
        }
        routes_.resize(std::min(routes_.size(), static_cast<std::size_t>(options_.fibres)));
        if (known.empty()) {  // nothing of what was tried holds, wherever it leads
            allowed_.assign(library_size_, 0);
            rejection_.assign(library_size_, commonest_rejection(plan_.effort));
            return;
        }
        for (const FibreRoute& route : routes_) {
            for (std::size_t stage = 0; stage < route.links.size(); ++stage) {
                const LaidCourse& link = route.links[stage];
                courses_.push_back(placed(link.member, link.backward));
                courses_.back().link = static_cast<std::int32_t>(spare_links_.size());
                spare_links_.push_back(spare_links(members_, ways, known, route, stage));
            }
        }
        strike_off_what_is_apart();
    }

    // Fibres that no route needs may go from stage to stage by other courses than the links.
    [[nodiscard]] bool fibres_to_spare() const { return options_.fibres > fibres_needed(); }

    [[nodiscard]] int fibres_needed() const { return std::max(1, int(routes_.size())); }

    [[nodiscard]] int fibres() const {
        return fibres_to_spare() ? options_.fibres : fibres_needed();
    }

    [[nodiscard]] bool on_a_route(const NodePair& nodes) const {
        return std::any_of(routes_.begin(), routes_.end(), [&](const FibreRoute& route) {
            return fibres_to_spare() ? route.leads(nodes) : route.holds(nodes);
        });
    }

    void strike_off_what_is_apart() {
        for (std::size_t i = 0; i < library_size_; ++i) {
            Member& member = members_[i];
            for (const bool backward : {false, true}) {
                bool& windable = backward ? member.windable_backward : member.windable_forward;
                windable = windable && on_a_route(nodes_of(member, backward));
            }
            if (allowed_[i] != 0 && !is_windable(member)) {
                strike_off(i, Rejection::Apart);
            }
        }
    }

    // Those to begin with that hold.
    void choose() {
        courses_ = those_that_hold(std::move(courses_), false);
        std::map<LaidCourse, PlacedCourse> proven;
        const FirstChoice first = choose_first(
            members_, allowed_, joinable_, samples_.position_mm, 2 * mandrel_.rims.size(), select_,
            stage_, [&](std::span<const LaidCourse> courses) { return hold(courses, proven); });
        plan_.least_fibre_mm = first.least_fibre_mm;
        for (const LaidCourse& course : first.courses) {
            courses_.push_back(proven.at(course));
        }
    }

    // Which of these hold; the others are struck off the library. \param proven what holds, kept
    std::vector<char> hold(std::span<const LaidCourse> courses,
                           std::map<LaidCourse, PlacedCourse>& proven) {
        std::set<LaidCourse> unknown;
        std::copy_if(courses.begin(), courses.end(), std::inserter(unknown, unknown.end()),
                     [&](const LaidCourse& course) { return !proven.contains(course); });
        std::vector<PlacedCourse> tried;
        tried.reserve(unknown.size());
        for (const LaidCourse& course : unknown) {
            tried.push_back(placed(course.member, course.backward));
        }
        for (PlacedCourse& course : those_that_hold(std::move(tried), false)) {
            proven.emplace(LaidCourse{course.of_library, course.backward}, std::move(course));
        }
        std::vector<char> holds;
        for (const LaidCourse& course : courses) {
            holds.push_back(proven.contains(course));
        }
        return holds;
    }

    // What courses reach that hold, per sample; behind the last stage none are chosen.
    [[nodiscard]] std::vector<char> prove_reach() {
        if (stage_.stages_left == 0) {
            return library_.reached;
        }
        tell("prove", 0.0);
        std::vector<char> reached = reach_prover_.prove(std::span(members_).first(library_size_));
        for (const auto& [member, rejection] : reach_prover_.refused()) {
            strike_off(at(member), rejection);
        }
        return reached;
    }

    // Not followed yet.
    [[nodiscard]] PlacedCourse placed(std::int32_t member, bool backward) const {
        return {
            .member = members_[at(member)], .path = {}, .backward = backward, .of_library = member};
    }

    // The others are refused. \param to_stay their own programs are wound as well
    std::vector<PlacedCourse> those_that_hold(std::vector<PlacedCourse> courses, bool to_stay) {
        tell("prove", 0.0);
        const std::vector<Rejection> found = prover_.prove_all(courses, to_stay);
        std::vector<PlacedCourse> holding;
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (found[i] == Rejection::None) {
                holding.push_back(std::move(courses[i]));
            } else {
                refuse(courses[i], found[i]);
            }
        }
        return holding;
    }

    void anneal_proven(bool mending) {
        AnnealOptions annealing = annealing_of({.last_stage = last_stage(),
                                                .angle_wanted = options_.angle_rad.has_value(),
                                                .spare_fibres = fibres_to_spare(),
                                                .mending = mending,
                                                .effort = options_.context.effort});
        annealing.select = select_;
        annealing.select.targets = stage_.weighed.layers;
        annealing.beyond_layers = stage_.beyond_layers;
        annealing.fibres = fibres();
        annealing.seed = seed_of(Stream::Annealing, options_.context.seed) + (++annealings_ << 32U);
        annealing.progress = [this](double share) { tell("anneal", share); };
        annealing.way = [this](const NodePair& nodes) { return on_a_route(nodes); };
        annealing.verify = [this, mending](PlacedCourse& course) {
            const Rejection rejection =
                mending ? prover_.prove_and_wind(course) : prover_.prove(course);
            if (rejection != Rejection::None) {
                FootprintFinder::Scratch scratch = footprints_.make_scratch();
                Member refused;  // on the samples of the plan, not on those of the annealing
                refused.footprint = footprints_.footprint(course.path, scratch);
                note_refused(refused, rejection);
            }
            return rejection == Rejection::None;
        };
        const AnnealEffort effort =
            anneal(rules_, *ground_, members_, allowed_, courses_, annealing);
        plan_.effort.proposals += effort.proposals;
        plan_.effort.taken += effort.accepted;
    }

    [[nodiscard]] bool last_stage() const { return stage_.stages_left < 2; }

    // The last thin places take courses for their sake. Behind the last stage nothing is made even.
    void improve() {
        if (stage_.stages_left > 0) {
            anneal_proven(false);
        }
        if (last_stage()) {
            fill();
        }
    }

    // In place of courses given up. Annealing would take out again what fills thin places.
    void replace_lost() { last_stage() ? fill() : anneal_proven(true); }

    void fill() {
        for (int round = 0; round < kMostFills; ++round) {
            const std::vector<std::int32_t> members =
                fill_thin_places(std::span(members_).first(library_size_), allowed_, joinable_,
                                 layers_of(courses_, samples_.size()), select_, stage_.filled_to);
            if (members.empty()) {
                return;
            }
            Joints joints(2 * mandrel_.rims.size(), courses_);
            std::vector<PlacedCourse> filling;
            for (const std::int32_t i : members) {
                const bool backward = joints.evener_backward(members_[at(i)]);
                joints.add(members_[at(i)], backward, 1);
                filling.push_back(placed(i, backward));
            }
            filling = those_that_hold(std::move(filling), true);
            std::move(filling.begin(), filling.end(), std::back_inserter(courses_));
        }
    }

    // Replaces the courses whose own programs do not lay them as planned.
    void keep_what_winds() {
        tell("prove", 0.0);
        const auto refused = prover_.wind_all(courses_);
        if (!refused.empty()) {
            give_up(refused);
            replace_lost();
        }
    }

    // Adds what it takes to join the courses, and puts them in order. Fibres to be cut where the
    // machine cannot follow a turn are not spent on what does not join.
    void join_to_fibres() {
        join(fibres());
        put_in_order();
        if (plan_.effort.turns_refused > 0 && fibres() > 1) {
            join(std::max(1, fibres() - plan_.effort.turns_refused));
            put_in_order();
        }
    }

    // Adds proven members of the library until as many courses arrive as depart, wherever there is
    // a way.
    void join(int fibres) {
        const auto place = [this](const LaidCourse& course, PlacedCourse& in_place) {
            in_place = placed(course.member, course.backward);
            return prover_.prove_and_wind(in_place);
        };
        const auto strike = [this](std::size_t member, Rejection why) { strike_off(member, why); };
        joiner_.join({members_, library_size_, std::span(allowed_).first(library_size_),
                      mandrel_.rims.size(), samples_.size(), select_,
                      std::min(fibres, fibres_needed()), fibres, place, strike},
                     courses_);
    }

    // It is not tried again.
    void refuse(const PlacedCourse& course, Rejection reason) {
        if (course.of_library < 0) {
            note_refused(course.member, reason);
        } else if (allowed_[at(course.of_library)] != 0) {
            strike_off(at(course.of_library), reason);
        }
    }

    void strike_off(std::size_t member, Rejection reason) {
        allowed_[member] = 0;
        rejection_[member] = reason;
        ++plan_.effort.rejections[static_cast<std::size_t>(reason)];
        plan_.effort.rejected_courses += reason == Rejection::Apart ? 0 : 1;
    }

    void put_in_order() {
        gather(courses_, library_size_, members_);
        std::vector<LaidCourse> laid;
        std::vector<double> lateness;
        for (const PlacedCourse& course : courses_) {
            laid.push_back(
                {static_cast<std::int32_t>(library_size_ + laid.size()), course.backward});
            lateness.push_back(character_of(mandrel_.surface, course.path).lateness());
        }
        const auto most = static_cast<std::size_t>(fibres());
        auto followed = order_to_follow(rules_, machine_, members_, laid, lateness, most);
        order_ = longest_fibres(members_, followed.courses, most);
        closed_ = std::move(followed.closed);
        plan_.effort.turns_refused = followed.turns_refused;
        plan_.effort.courses_out_of_reach =
            static_cast<int>(followed.courses.size() - order_.size());
    }

    // Whether a plan that covers so much is wound.
    [[nodiscard]] bool is_enough(double share) const {
        return share >= options_.least_covered * reached_share(library_.reached);
    }

    TriedPlan too_bare(const std::string& words) {
        plan_.coverage.reachable = reached_share(library_.reached);
        plan_.coverage.joinable = reached_share(joinable_);
        return fail(words + percent(plan_.coverage.fraction, 1) + " of the wall where " +
                    percent(plan_.coverage.reachable, 1) + " is in reach");
    }

    // Joins the courses, winds the whole, and plans again without the courses that the machine
    // refuses in their place. Where putting others there leads nowhere they are only left out; if
    // all is in vain, the plan with the fewest of them stands.
    void make_it_hold() {
        std::vector<PlacedCourse> best;
        std::size_t least = 0;
        int in_vain = 0;
        for (int attempt = 0; attempt < kMostAttempts && !courses_.empty(); ++attempt) {
            join_to_fibres();
            lay_out(rules_, members_, order_, plan_);
            trial_ = wind_all();
            if (!trial_ || trial_->refused.empty()) {
                return;
            }
            const auto refused = refused_courses(*trial_, plan_, order_, closed_, library_size_);
            trial_.reset();
            const bool better = best.empty() || refused.size() < least;
            in_vain += better ? 0 : 1;
            if (better) {
                best = courses_;
                least = refused.size();
            }
            give_up(refused);
            if (in_vain < kMostInVain && attempt + kAttemptsWithoutOthers < kMostAttempts) {
                replace_lost();
            }
        }
        courses_ = std::move(best);
        put_in_order();
        lay_out(rules_, members_, order_, plan_);
    }

    // Null where there is no machine, or nothing to wind.
    [[nodiscard]] std::unique_ptr<TrialWinding> wind_all() const {
        return machine_ != nullptr && !order_.empty() ? machine_->wind_all(plan_) : nullptr;
    }

    void give_up(const std::vector<std::pair<std::size_t, Rejection>>& refused) {
        for (std::size_t k = refused.size(); k-- > 0;) {
            const auto& [index, reason] = refused[k];
            const PlacedCourse course = std::move(courses_[index]);
            courses_.erase(courses_.begin() + static_cast<std::ptrdiff_t>(index));
            refuse(course, reason);
            if (course.link >= 0) {
                replace_link(course.link);
            }
        }
    }

    // The next course that holds in place of the link between two stages that did not.
    void replace_link(std::int32_t link) {
        std::vector<LaidCourse>& spares = spare_links_[at(link)];
        for (std::size_t tried = 0; !spares.empty() && tried < kMostSpares; ++tried) {
            PlacedCourse course = placed(spares.back().member, spares.back().backward);
            spares.pop_back();
            course.link = link;
            if (prover_.prove_and_wind(course) == Rejection::None) {
                courses_.push_back(std::move(course));
                return;
            }
        }
    }

    void measure() {
        layers_.assign(samples_.size(), 0);
        for (const OrderedCourse& laid : order_) {
            for (const std::int32_t sample : members_[at(laid.course.member)].footprint) {
                library_.reached[at(sample)] = joinable_[at(sample)] = 1;
                ++layers_[at(sample)];
            }
        }
        plan_.coverage = measure_coverage(layers_, library_.reached);
        plan_.coverage.reachable = reached_share(library_.reached);
        plan_.coverage.joinable = reached_share(joinable_);
        describe_uncovered();
        plan_.face_layers = layers_per_face(mandrel_.surface, samples_, layers_);
        describe_courses(mandrel_.surface, options_.tow.width_mm, options_.angle_rad, plan_);
    }

    // Of a stage of a wall it is the wall that says where it is thin.
    void describe_uncovered() {
        if (options_.stage != nullptr) {
            plan_.reached = library_.reached;
            plan_.joinable = joinable_;
            return;
        }
        layers_.resize(samples_.size(), 0);
        members_.resize(rejection_.size());
        for (auto& [footprint, reason] : refused_) {
            members_.emplace_back().footprint = std::move(footprint);
            rejection_.push_back(reason);
        }
        refused_.clear();
        plan_.uncovered = uncovered_wall(mandrel_.surface, samples_, library_, rejection_, layers_);
    }

    const Mandrel& mandrel_;
    const CoverOptions& options_;
    const Windability* machine_;
    StageAsk stage_;
    SelectOptions select_;
    CoverageSamples samples_;
    FootprintFinder footprints_;
    LiftedWall lifted_;
    CourseRules rules_;
    CourseProver prover_;
    ReachProver reach_prover_;
    Library library_;
    std::vector<Member>& members_ = library_.members;  // then the courses of the plan
    std::size_t library_size_ = 0;
    std::optional<AnnealGround> ground_;
    std::vector<char> allowed_;                         // per member
    std::vector<char> joinable_;                        // per sample: in reach of the fibres
    std::vector<Rejection> rejection_;                  // per member: why it is not allowed
    std::vector<PlacedCourse> courses_;                 // the plan, not in order
    std::vector<FibreRoute> routes_;                    // one for each fibre
    std::vector<std::vector<LaidCourse>> spare_links_;  // per link: in its place, the best last
    CourseJoiner joiner_;
    std::vector<OrderedCourse> order_;  // of the pool
    ClosedTurns closed_;                // found while that was looked for
    std::vector<std::int32_t> layers_;  // per sample
    std::uint64_t annealings_ = 0;
    std::mutex refused_mutex_;
    std::vector<std::pair<std::vector<std::int32_t>, Rejection>>
        refused_;  // footprints of courses that did not hold, in any order
    Plan plan_;
    std::unique_ptr<TrialWinding> trial_;  // of the plan as it is
};

}  // namespace

TriedPlan plan_cover(const Mandrel& mandrel, const RayQuery& obstacles, const CoverOptions& options,
                     const Windability* machine) {
    if (mandrel.rims.empty()) {
        TriedPlan tried;
        tried.plan.planner = Planner::Cover;
        tried.plan.failure =
            "the mandrel has no rim: courses have nowhere to turn back (a closed body needs a "
            "polar opening or an open end)";
        return tried;
    }
    return CoverPlanner(mandrel, obstacles, options, machine).run();
}

}  // namespace meshwind
