#include "winding/cover/cover.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "core/margins.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "winding/cover/anneal.h"
#include "winding/cover/fibre_routes.h"
#include "winding/cover/grow.h"
#include "winding/cover/lay_out.h"
#include "winding/cover/order_to_follow.h"
#include "winding/cover/prove_ways.h"
#include "winding/cover/uncovered.h"
#include "winding/cover/what_if.h"
#include "winding/laminate/course_character.h"
#include "winding/laminate/coverage.h"
#include "winding/laminate/families.h"
#include "winding/laminate/wound_angle.h"

namespace meshwind {
namespace {

// Samples per band width: a gap of a quarter band is seen. With 2.5 what is covered on samples that
// were planned on is 0.7 % more than what is covered on others, with 4 it is 0.25 %.
constexpr double kSamplesPerBand = 4.0;

// On a wall so large that this would take more samples, they lie further apart.
constexpr double kMaxSamples = 6e5;

// Proposals of the annealing at an effort of 1, and of each that follows where courses had to be
// given up.
constexpr std::int64_t kProposals = 30'000;
constexpr std::int64_t kMendingProposals = 4'000;

// Times that courses are added to join the others, each time some that the machine refuses.
constexpr int kMaxJoins = 200;

// Routes of so many fibres are looked for, at most.
constexpr std::size_t kRoutesLookedFor = 9;

// What a fibre too many costs where courses lead on to a stage from which none leads back: then it
// cannot be mended by joining.
constexpr double kDearFibre = 6.0;

// So many others are tried in place of a course that leads from stage to stage. It takes 20 ms
// each, and without one a stage is lost.
constexpr std::size_t kMostSpares = 200;

// Where courses reach less of the wall nothing is planned: what comes of it is no part.
constexpr double kWorthPlanning = 0.5;

// Attempts that refuse as many courses as before, or more, before no others are put there.
constexpr int kMostInVain = 2;

std::size_t at(std::int32_t i) {
    return static_cast<std::size_t>(i);
}

class CoverPlanner {
public:
    CoverPlanner(const Mandrel& mandrel, const RayQuery& obstacles, const CoverOptions& options,
                 const Windability* machine)
        : mandrel_(mandrel),
          options_(options),
          machine_(machine),
          samples_(sample_surface(mandrel.surface, sample_spacing_mm(mandrel, options),
                                  seed_of(Stream::Sampling, options.context.seed))),
          footprints_(mandrel.surface, samples_, options.tow.width_mm),
          lifted_(mandrel.surface),
          rules_{mandrel,
                 obstacles,
                 footprints_,
                 options.tow,
                 options.turn,
                 options.free_fibre,
                 max_half_length_mm(mandrel.surface)} {
        rules_.turn.friction = options.tow.friction;
        rules_.turn.band_mm = options.tow.width_mm;
        rules_.angle_rad = options.angle_rad;
        rules_.lifted = &lifted_;
        rules_.free_fibre.clearance_mm += margin::kCandidates_mm;
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
        ground_.emplace(rules_, samples_, sample_spacing_mm(mandrel_, options_), members_,
                        seed_of(Stream::Ground, options_.context.seed));
        library_size_ = members_.size();
        allowed_.assign(members_.size(), 1);
        rejection_.assign(members_.size(), Rejection::None);
        find_routes();
        choose();
        anneal_proven(false);
        keep_what_winds();
        if (!covers_enough()) {
            return fail("courses cover only " + fixed(100.0 * plan_.coverage.fraction, 1) +
                        " % of the wall where " + fixed(100.0 * plan_.coverage.reachable, 1) +
                        " % is in reach");
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

    static double sample_spacing_mm(const Mandrel& mandrel, const CoverOptions& options) {
        const double area = area_mm2({mandrel.surface.position_mm, mandrel.surface.face});
        return std::max(options.tow.width_mm / kSamplesPerBand, std::sqrt(area / kMaxSamples));
    }

    void tell(const char* step, double share) const {
        options_.context.report_progress(step, share);
    }

    [[nodiscard]] std::string hardly_reachable() const {
        return "courses reach only " + fixed(100.0 * reached_share(library_.reached), 1) +
               " % of the wall, under " + fixed(100.0 * kWorthPlanning, 0) +
               " % nothing is planned; refused most often, " + refused_most(plan_.effort);
    }

    Rejection prove(PlacedCourse& course) const { return prove_course(rules_, machine_, course); }

    // Of a proven course that is to stay its own program is wound.
    Rejection wind(PlacedCourse& course) const {
        if (machine_ != nullptr && !course.wound) {
            const Piece piece = piece_of(rules_, course.member, course.backward);
            const Rejection rejection = machine_->wind_alone({&piece, 1});
            course.wound = rejection == Rejection::None;
            return rejection;
        }
        return Rejection::None;
    }

    Rejection prove_and_wind(PlacedCourse& course) const {
        const Rejection rejection = prove(course);
        return rejection == Rejection::None ? wind(course) : rejection;
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
            members_, ways, [this](PlacedCourse& course) { return prove(course); },
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
    [[nodiscard]] bool fibres_to_spare() const {
        return static_cast<std::size_t>(options_.fibres) > std::max<std::size_t>(1, routes_.size());
    }

    [[nodiscard]] int fibres() const {
        return fibres_to_spare() ? options_.fibres : std::max(1, static_cast<int>(routes_.size()));
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
            if (!member.windable_forward && !member.windable_backward) {
                strike_off(i, Rejection::Apart);
            }
        }
    }

    // The members of the library that cover best and hold.
    void choose() {
        const Selection first =
            select_courses(members_, allowed_, samples_.size(), options_.select, {});
        for (const std::int32_t i : first.chosen) {
            courses_.push_back(placed(i, !members_[at(i)].windable_forward));
        }
        keep_proven();
    }

    [[nodiscard]] PlacedCourse placed(std::int32_t member, bool backward) const {
        const Member& course = members_[at(member)];
        return {course, trace_both_ways(rules_, course.candidate, TraceMethod::Walk), backward,
                false};
    }

    void keep_proven() {
        std::vector<Rejection> found(courses_.size());
        tell("prove", 0.0);
        parallel_for(courses_.size(), 1,
                     [&](std::size_t i, std::size_t) { found[i] = prove(courses_[i]); });
        std::vector<PlacedCourse> proven;
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (found[i] == Rejection::None) {
                proven.push_back(std::move(courses_[i]));
            } else {
                note_refused(courses_[i].member, found[i]);
            }
        }
        courses_ = std::move(proven);
    }

    void anneal_proven(bool mending) {
        AnnealOptions annealing;
        annealing.select = options_.select;
        annealing.fibres = fibres();
        annealing.fibre_share = fibres_to_spare() ? kDearFibre : annealing.fibre_share;
        annealing.seed = seed_of(Stream::Annealing, options_.context.seed) + (++annealings_ << 32U);
        annealing.proposals = mending ? kMendingProposals : options_.context.effort * kProposals;
        if (mending) {
            annealing.hot = annealing.cold;
            annealing.bare_hot = annealing.bare_cold;
        }
        annealing.progress = [this](double share) { tell("anneal", share); };
        annealing.way = [this](const NodePair& nodes) { return on_a_route(nodes); };
        annealing.verify = [this, mending](PlacedCourse& course) {
            const Rejection rejection = mending ? prove_and_wind(course) : prove(course);
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

    // Replaces the courses whose own programs do not lay them as planned.
    void keep_what_winds() {
        tell("prove", 0.0);
        std::vector<Rejection> found(courses_.size(), Rejection::None);
        parallel_for(courses_.size(), 1,
                     [&](std::size_t i, std::size_t) { found[i] = wind(courses_[i]); });
        std::vector<std::pair<std::size_t, Rejection>> refused;
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (found[i] != Rejection::None) {
                refused.emplace_back(i, found[i]);
            }
        }
        if (!refused.empty()) {
            give_up(refused);
            anneal_proven(true);
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

    // The courses of the plan behind those of the library.
    void gather() {
        members_.resize(library_size_);
        for (const PlacedCourse& course : courses_) {
            members_.push_back(course.member);
        }
    }

    // Adds proven members of the library until as many courses arrive as depart, wherever there is
    // a way.
    void join(int fibres) {
        for (int attempt = 0; attempt < kMaxJoins; ++attempt) {
            gather();
            std::vector<char> allowed = allowed_;
            allowed.resize(members_.size(), 0);
            Selection selection;
            selection.layers = layers_of(courses_);
            for (std::size_t i = library_size_; i < members_.size(); ++i) {
                selection.chosen.push_back(static_cast<std::int32_t>(i));
            }
            const std::vector<LaidCourse> laid = balance_courses(
                members_, allowed, mandrel_.rims.size(), options_.select, fibres, selection);
            if (take_proven(laid)) {
                return;
            }
        }
    }

    // The courses become what is laid, if all that is new holds; else what does not is struck off
    // the library.
    bool take_proven(const std::vector<LaidCourse>& laid) {
        std::vector<PlacedCourse> taken(laid.size());
        std::vector<Rejection> found(laid.size(), Rejection::None);
        parallel_for(laid.size(), 1, [&](std::size_t i, std::size_t) {
            const auto& [member, backward] = laid[i];
            if (at(member) >= library_size_) {
                taken[i] = courses_[at(member) - library_size_];
            } else if (const auto before = joining_.find({member, backward});
                       before != joining_.end()) {
                taken[i] = before->second;
            } else {
                taken[i] = placed(member, backward);
                found[i] = prove_and_wind(taken[i]);
            }
        });
        for (std::size_t i = 0; i < laid.size(); ++i) {
            const auto& [number, backward] = laid[i];
            if (at(number) >= library_size_) {
                continue;
            }
            if (found[i] == Rejection::None) {
                joining_.try_emplace({number, backward}, taken[i]);
                continue;
            }
            Member& member = members_[at(number)];
            (backward ? member.windable_backward : member.windable_forward) = false;
            if (!member.windable_forward && !member.windable_backward &&
                allowed_[at(number)] != 0) {
                strike_off(at(number), found[i]);
            }
        }
        const bool all = std::all_of(found.begin(), found.end(),
                                     [](Rejection r) { return r == Rejection::None; });
        if (all) {
            courses_ = std::move(taken);
        }
        return all;
    }

    void strike_off(std::size_t member, Rejection reason) {
        allowed_[member] = 0;
        rejection_[member] = reason;
        ++plan_.effort.rejections[static_cast<std::size_t>(reason)];
        plan_.effort.rejected_courses += reason == Rejection::Apart ? 0 : 1;
    }

    void put_in_order() {
        gather();
        std::vector<LaidCourse> laid;
        std::vector<double> lateness;
        for (const PlacedCourse& course : courses_) {
            laid.push_back(
                {static_cast<std::int32_t>(library_size_ + laid.size()), course.backward});
            lateness.push_back(character_of(mandrel_.surface, course.path).lateness());
        }
        const auto most = static_cast<std::size_t>(fibres());
        const auto followed = order_to_follow(rules_, machine_, members_, laid, lateness, most);
        order_ = longest_fibres(members_, followed.courses, most);
        plan_.effort.turns_refused = followed.turns_refused;
        plan_.effort.courses_out_of_reach =
            static_cast<int>(followed.courses.size() - order_.size());
    }

    // Whether the courses cover enough to be wound.
    bool covers_enough() {
        std::vector<std::int32_t> layers = layers_of(courses_);
        Coverage coverage = measure_coverage(layers);
        coverage.reachable = reached_share(library_.reached);
        if (coverage.fraction >= options_.least_covered * coverage.reachable) {
            return true;
        }
        layers_ = std::move(layers);
        plan_.coverage = coverage;
        return false;
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
            const auto refused = refused_courses(*trial_);
            trial_.reset();
            const bool better = best.empty() || refused.size() < least;
            in_vain += better ? 0 : 1;
            if (better) {
                best = courses_;
                least = refused.size();
            }
            give_up(refused);
            if (in_vain < kMostInVain) {
                anneal_proven(true);
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

    // The courses that the machine refuses, or whose turn it refuses; in order, each once.
    [[nodiscard]] std::vector<std::pair<std::size_t, Rejection>> refused_courses(
        const TrialWinding& trial) const {
        std::vector<std::pair<std::size_t, Rejection>> courses;
        const std::vector<std::size_t> course_of = courses_of(plan_.pieces);
        for (const std::size_t piece : trial.refused) {
            const std::size_t course = course_of[piece];
            courses.emplace_back(at(order_[course].course.member) - library_size_,
                                 Rejection::InItsPlace);
        }
        std::sort(courses.begin(), courses.end());
        courses.erase(std::unique(courses.begin(), courses.end()), courses.end());
        return courses;
    }

    void give_up(const std::vector<std::pair<std::size_t, Rejection>>& refused) {
        for (std::size_t k = refused.size(); k-- > 0;) {
            const auto& [index, reason] = refused[k];
            const PlacedCourse course = std::move(courses_[index]);
            courses_.erase(courses_.begin() + static_cast<std::ptrdiff_t>(index));
            note_refused(course.member, reason);
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
            if (prove_and_wind(course) == Rejection::None) {
                courses_.push_back(std::move(course));
                return;
            }
        }
    }

    [[nodiscard]] std::vector<std::int32_t> layers_of(
        const std::vector<PlacedCourse>& courses) const {
        std::vector<std::int32_t> layers(samples_.size(), 0);
        for (const PlacedCourse& course : courses) {
            for (const std::int32_t sample : course.member.footprint) {
                ++layers[at(sample)];
            }
        }
        return layers;
    }

    void measure() {
        layers_.assign(samples_.size(), 0);
        for (const OrderedCourse& laid : order_) {
            for (const std::int32_t sample : members_[at(laid.course.member)].footprint) {
                library_.reached[at(sample)] = 1;
                ++layers_[at(sample)];
            }
        }
        plan_.coverage = measure_coverage(layers_, library_.reached);
        plan_.coverage.reachable = reached_share(library_.reached);
        describe_uncovered();
        plan_.face_layers = layers_per_face(mandrel_.surface, samples_, layers_);
        std::vector<const SurfacePath*> courses;
        for (const Piece& piece : plan_.pieces) {
            if (piece.kind == PieceKind::Course) {
                courses.push_back(&piece.path);
            }
        }
        plan_.places = places_of(mandrel_.surface, courses);
        plan_.family = families_of(courses, options_.tow.width_mm);
        plan_.angle = wound_angles(mandrel_.surface, courses, options_.angle_rad);
    }

    void describe_uncovered() {
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
    CoverageSamples samples_;
    FootprintFinder footprints_;
    LiftedWall lifted_;
    CourseRules rules_;
    Library library_;
    std::vector<Member>& members_ = library_.members;  // then the courses of the plan
    std::size_t library_size_ = 0;
    std::optional<AnnealGround> ground_;
    std::vector<char> allowed_;                         // per member
    std::vector<Rejection> rejection_;                  // per member: why it is not allowed
    std::vector<PlacedCourse> courses_;                 // the plan, not in order
    std::vector<FibreRoute> routes_;                    // one for each fibre
    std::vector<std::vector<LaidCourse>> spare_links_;  // per link: in its place, the best last
    std::map<std::pair<std::int32_t, bool>, PlacedCourse>
        joining_;  // members that have been proven to join others, by direction
    std::vector<OrderedCourse> order_;  // of the pool
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
