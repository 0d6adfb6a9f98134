#include "winding/cover/cover_courses.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <set>

#include "core/index.h"
#include "core/margins.h"
#include "core/parallel.h"
#include "core/random.h"
#include "winding/cover/anneal.h"
#include "winding/cover/order_to_follow.h"
#include "winding/cover/placed_course.h"
#include "winding/cover/rim_joints.h"
#include "winding/cover/select_courses.h"

namespace meshwind {
namespace {

// So many others are tried in place of a course that leads from stage to stage. It takes 20 ms
// each, and without one a stage is lost.
constexpr std::size_t kMaxSpares = 200;

// What does not hold of the courses that fill thin places makes room for others so many times.
constexpr int kMaxFills = 10;

// Rounds in which the courses that fill thin places and the others settle.
constexpr int kSettlings = 3;

// Proposals at an effort of 1: of an annealing, of a round of settling, and where a few courses had
// to be given up.
constexpr double kProposals = 30'000.0;
constexpr double kSettlingProposals = 10'000.0;
constexpr std::int64_t kMendingProposals = 4'000;

// What a fibre too many costs where courses lead on to a stage from which none leads back: then it
// cannot be mended by joining.
constexpr double kDearFibre = 6.0;

// What a layer short of the target costs, of AnnealOptions: in the last stage of a wall, and in
// those whose thin places are filled later.
constexpr double kLastBare = 2.0;
constexpr double kEarlyBare = 0.3;

// The same in the first round of settling. From round to round it is so many times more where too
// much lacks, and else as many times less.
constexpr double kSettlingBare = 2.0;
constexpr double kSettlingStep = 2.0;

// Courses that come of the bound are moved, but not thrown about, and keep short turns: values of
// AnnealOptions. Its own are for a wanted winding angle, which takes other courses.
constexpr double kStartedHot = 0.02;
constexpr double kStartedTurnShare = 6.0;

CourseRules rules_of(const Mandrel& mandrel, const RayQuery& obstacles,
                     const FootprintFinder& footprints, const LiftedWall& lifted,
                     const CoverOptions& options) {
    CourseRules rules{mandrel,
                      obstacles,
                      footprints,
                      options.tow,
                      options.turns,
                      options.free_fibre,
                      max_half_length_mm(mandrel.surface)};
    rules.turns.rule.friction = options.tow.friction;
    rules.turns.rule.band_mm = options.tow.width_mm;
    rules.angle_rad = options.angle_rad;
    rules.lifted = &lifted;
    rules.free_fibre.clearance_mm += margin::kCandidates_mm;
    return rules;
}

// What courses are annealed for.
enum class AnnealAim {
    Evenness,
    Settling,  // thin places have just been filled
    Mending    // a few courses are missing
};

std::int64_t proposals_for(AnnealAim aim, double effort) {
    switch (aim) {
        case AnnealAim::Settling:
            return std::llround(effort * kSettlingProposals);
        case AnnealAim::Mending:
            return kMendingProposals;
        default:
            return std::llround(effort * kProposals);
    }
}

// How much courses are annealed, and at what prices; what is specific to a plan is left open.
// \param bare what a layer short of the target costs more
AnnealOptions annealing_prices(const CoverTask& task, const PlanRoutes& routes, AnnealAim aim,
                               double bare) {
    AnnealOptions annealing;
    annealing.bare_hot *= bare;
    annealing.bare_cold *= bare;
    if (!task.options.angle_rad.has_value()) {
        annealing.hot = kStartedHot;
        annealing.turn_share = kStartedTurnShare;
    }
    annealing.fibre_share = routes.has_fibres_to_spare() ? kDearFibre : annealing.fibre_share;
    annealing.proposals = proposals_for(aim, task.options.context.effort);
    if (aim != AnnealAim::Evenness) {
        annealing.hot = annealing.cold;
        annealing.bare_hot = annealing.bare_cold;
    }
    return annealing;
}

// The others are refused. \param prove thread-safe
std::vector<PlacedCourse> those_that_hold(const CoverTask& task, std::vector<PlacedCourse> courses,
                                          const std::function<CourseFault(PlacedCourse&)>& prove,
                                          ProvenLibrary& library) {
    task.report_progress("prove", 0.0);
    std::vector<CourseFault> found(courses.size(), CourseFault::None);
    parallel_for(courses.size(), 1,
                 [&](std::size_t i, std::size_t) { found[i] = prove(courses[i]); });
    std::vector<PlacedCourse> holding;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (found[i] == CourseFault::None) {
            holding.push_back(std::move(courses[i]));
        } else {
            library.refuse(courses[i], found[i]);
        }
    }
    return holding;
}

// Which of these hold; the others are struck off the library. \param proven what holds, kept
std::vector<char> which_hold(const CoverTask& task, std::span<const DirectedCourse> courses,
                             ProvenLibrary& library,
                             std::map<DirectedCourse, PlacedCourse>& proven) {
    std::set<DirectedCourse> unknown;
    std::copy_if(courses.begin(), courses.end(), std::inserter(unknown, unknown.end()),
                 [&](const DirectedCourse& course) { return !proven.contains(course); });
    std::vector<PlacedCourse> tried;
    tried.reserve(unknown.size());
    for (const DirectedCourse& course : unknown) {
        tried.push_back(library.placed(course));
    }
    const auto prove = [&task](PlacedCourse& course) { return task.prover.prove(course); };
    for (PlacedCourse& course : those_that_hold(task, std::move(tried), prove, library)) {
        proven.emplace(DirectedCourse{course.of_library, course.backward}, std::move(course));
    }
    std::vector<char> holds;
    for (const DirectedCourse& course : courses) {
        holds.push_back(proven.contains(course));
    }
    return holds;
}

void anneal_proven(const CoverTask& task, const AnnealGround& ground, const PlanRoutes& routes,
                   AnnealAim aim, double bare, ProvenLibrary& library, PlanCourses& courses) {
    const CoverOptions& options = task.options;
    const bool mending = aim == AnnealAim::Mending;
    AnnealOptions annealing = annealing_prices(task, routes, aim, bare);
    annealing.select = task.select;
    annealing.select.targets = task.stage.weighed.layers;
    annealing.beyond_layers = task.stage.beyond_layers;
    annealing.fibres = routes.fibres();
    annealing.seed =
        seed_of(Stream::Annealing, options.context.seed) + (++courses.annealings << 32U);
    annealing.progress = [&task](double share) { task.report_progress("anneal", share); };
    annealing.way = [&routes](const NodePair& nodes) { return routes.hold(nodes); };
    annealing.verify = [&task, &library, &courses, mending](PlacedCourse& course) {
        const CourseFault rejection =
            mending ? prove_to_stay(task, courses, course) : task.prover.prove(course);
        if (rejection != CourseFault::None) {
            // On the samples of the plan, not on those of the annealing.
            FootprintFinder::Scratch scratch = task.footprints.make_scratch();
            library.note_refused(task.footprints.footprint(course.path, scratch), rejection);
        }
        return rejection == CourseFault::None;
    };
    const AnnealEffort effort = anneal(task.rules, ground, library.members_and_placed(),
                                       library.allowed(), courses.placed, annealing);
    library.effort().proposals += effort.proposals;
    library.effort().taken += effort.accepted;
}

void fill_where_thin(const CoverTask& task, const std::vector<char>& joinable,
                     ProvenLibrary& library, PlanCourses& courses) {
    const auto prove = [&](PlacedCourse& course) { return prove_to_stay(task, courses, course); };
    for (int round = 0; round < kMaxFills; ++round) {
        const std::vector<std::int32_t> members = fill_thin_places(
            library.members(), library.allowed(), joinable,
            layers_of(courses.placed, task.samples.size()), task.select, task.stage.filled_to);
        if (members.empty()) {
            return;
        }
        RimJoints joints(task.nodes(), courses.placed);
        std::vector<PlacedCourse> filling;
        for (const std::int32_t i : members) {
            const LibraryCourse& member = library.members()[at(i)];
            const bool backward = joints.evener_backward(member);
            joints.add(member, backward, 1);
            filling.push_back(library.placed({i, backward}));
        }
        filling = those_that_hold(task, std::move(filling), prove, library);
        std::move(filling.begin(), filling.end(), std::back_inserter(courses.placed));
    }
}

double bare_price(const CoverTask& task) {
    return task.is_last_stage() ? kLastBare : kEarlyBare;
}

// Fibre of the courses, with what it takes to join them: a course for each fibre too many.
double fibre_mm(const CoverTask& task, std::span<const PlacedCourse> courses) {
    double sum_mm = 0.0;
    for (const PlacedCourse& course : courses) {
        sum_mm += course.member.length_mm + course.member.turn_mm;
    }
    const int joining =
        std::max(0, RimJoints(task.nodes(), courses).fibres() - task.options.fibres);
    const auto number = static_cast<double>(std::max<std::size_t>(1, courses.size()));
    return sum_mm * (1.0 + joining / number);
}

// Fills thin places, and lets all courses settle: some of those that lay there are needed no more,
// and others lie better a little beside. Of all rounds the courses with the least fibre stay.
void fill_and_settle(const CoverTask& task, const AnnealGround& ground, const FibreReach& reach,
                     ProvenLibrary& library, PlanCourses& courses) {
    const auto lacking = [&] {
        return lacking_share(layers_of(courses.placed, task.samples.size()), reach.joinable,
                             task.select);
    };
    fill_where_thin(task, reach.joinable, library, courses);
    const double most_lacking = std::max(lacking(), task.stage.filled_to);
    std::vector<PlacedCourse> best = courses.placed;
    double least_mm = fibre_mm(task, best);
    double bare = kSettlingBare;
    for (int round = 0; round < kSettlings && task.stage.stages_left > 0; ++round) {
        anneal_proven(task, ground, reach.routes, AnnealAim::Settling, bare, library, courses);
        bare *= lacking() > task.stage.filled_to ? kSettlingStep : 1.0 / kSettlingStep;
        fill_where_thin(task, reach.joinable, library, courses);
        if (const double now_mm = fibre_mm(task, courses.placed);
            now_mm < least_mm && lacking() <= most_lacking) {
            best = courses.placed;
            least_mm = now_mm;
        }
    }
    courses.placed = std::move(best);
}

// The next course that holds in place of the link between two stages that did not.
void replace_link(const CoverTask& task, const ProvenLibrary& library, std::int32_t link,
                  PlanCourses& courses) {
    std::vector<DirectedCourse>& spares = courses.spare_links[at(link)];
    for (std::size_t tried = 0; !spares.empty() && tried < kMaxSpares; ++tried) {
        PlacedCourse course = library.placed(spares.back());
        spares.pop_back();
        course.link = link;
        if (prove_to_stay(task, courses, course) == CourseFault::None) {
            courses.placed.push_back(std::move(course));
            return;
        }
    }
}

}  // namespace

CoverTask::CoverTask(const Mandrel& part, const RayQuery& obstacles, const CoverOptions& asked,
                     const Windability* winder)
    : mandrel(part),
      options(asked),
      machine(winder),
      stage(asked.stage != nullptr
                ? *asked.stage
                : whole_cover(part.surface, asked.tow.width_mm, asked.context.seed,
                              asked.select.target_layers, asked.most_bare)),
      select(asked.select),
      samples(samples_at(part.surface, stage.measured.at)),
      footprints(part.surface, samples, asked.tow.width_mm),
      lifted(part.surface),
      rules(rules_of(part, obstacles, footprints, lifted, asked)),
      prover(rules, winder) {
    select.targets = stage.measured.layers;
}

std::optional<double> choose_courses(const CoverTask& task, const std::vector<char>& joinable,
                                     ProvenLibrary& library, PlanCourses& courses) {
    const auto prove = [&task](PlacedCourse& course) { return task.prover.prove(course); };
    courses.placed = those_that_hold(task, std::move(courses.placed), prove, library);
    std::map<DirectedCourse, PlacedCourse> proven;
    const FirstChoice first = choose_first(library.members(), library.allowed(), joinable,
                                           task.samples.position_mm, task.nodes(), task.select,
                                           task.stage, [&](std::span<const DirectedCourse> some) {
                                               return which_hold(task, some, library, proven);
                                           });
    for (const DirectedCourse& course : first.courses) {
        courses.placed.push_back(proven.at(course));
    }
    return first.least_fibre_mm;
}

void make_courses_even(const CoverTask& task, const AnnealGround& ground, const FibreReach& reach,
                       ProvenLibrary& library, PlanCourses& courses) {
    if (task.stage.stages_left > 0) {
        anneal_proven(task, ground, reach.routes, AnnealAim::Evenness, bare_price(task), library,
                      courses);
    }
    if (task.is_last_stage()) {
        fill_and_settle(task, ground, reach, library, courses);
    }
}

CourseFault prove_to_stay(const CoverTask& task, const PlanCourses& courses, PlacedCourse& course) {
    if (const CourseFault fault = task.prover.prove(course); fault != CourseFault::None) {
        return fault;
    }
    return can_be_turned(task.rules, task.machine, course, courses.turned_with)
               ? task.prover.wind(course)
               : CourseFault::InItsPlace;
}

void give_up_courses(const CoverTask& task,
                     const std::vector<std::pair<std::size_t, CourseFault>>& refused,
                     ProvenLibrary& library, PlanCourses& courses) {
    for (std::size_t k = refused.size(); k-- > 0;) {
        const auto& [index, reason] = refused[k];
        const PlacedCourse course = std::move(courses.placed[index]);
        courses.placed.erase(courses.placed.begin() + static_cast<std::ptrdiff_t>(index));
        library.refuse(course, reason);
        if (course.link >= 0) {
            replace_link(task, library, course.link, courses);
        }
    }
}

void replace_lost_courses(const CoverTask& task, const AnnealGround& ground,
                          const FibreReach& reach, ProvenLibrary& library, PlanCourses& courses) {
    if (task.is_last_stage()) {
        // Annealing would take out again what fills thin places.
        fill_where_thin(task, reach.joinable, library, courses);
    } else {
        anneal_proven(task, ground, reach.routes, AnnealAim::Mending, bare_price(task), library,
                      courses);
    }
}

void keep_courses_that_wind(const CoverTask& task, const AnnealGround& ground,
                            const FibreReach& reach, ProvenLibrary& library, PlanCourses& courses) {
    task.report_progress("prove", 0.0);
    const auto refused = task.prover.wind_all(courses.placed);
    if (!refused.empty()) {
        give_up_courses(task, refused, library, courses);
        replace_lost_courses(task, ground, reach, library, courses);
    }
}

}  // namespace meshwind
