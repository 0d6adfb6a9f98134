#include "winding/cover/prove_courses.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/index.h"
#include "core/parallel.h"
#include "winding/cover/balance_courses.h"
#include "winding/cover/fit_course.h"
#include "winding/cover/lay_out_plan.h"

namespace meshwind {
namespace {

// Of the courses between two nodes so many are proven to know whether the way is open, and where
// none of them holds, so many.
constexpr std::size_t kProvenForWay = 6;
constexpr std::size_t kProvenForScarceWay = 48;

// An open way is taken for one with courses in plenty where the library has so many.
constexpr std::size_t kAbound = 8;

// A place is scarce where no more members pass: of those near a limit, as in a sharp crotch, hardly
// any holds.
constexpr std::size_t kScarcePassing = 20;

// Where more pass so many are tried, spread over all of them, until one holds. In a sharp crotch
// none of hundreds may.
constexpr std::size_t kTriedAtPlace = 40;

// An end as near to where a pin takes hold of it is there.
constexpr double kAtPin_mm = 0.004;

// A course comes to pins by a few moves, each as far off as the square of the one before.
constexpr int kMovesToPins = 4;

// Follows a course accurately. Where fibre turns on pins, one beside it that ends at pins.
CourseFault follow_to_pins(const CourseRules& rules, Candidate candidate, LibraryCourse& member,
                           TracedCourse& followed) {
    for (int moves = 0;; ++moves) {
        switch (follow_course(rules, candidate, member, followed)) {
            case CandidateFault::None:
                break;
            case CandidateFault::Slips:
                return CourseFault::Slip;
            default:
                return CourseFault::Path;
        }
        if (ends_at_pins(rules, member, kAtPin_mm)) {
            return CourseFault::None;
        }
        const PlacedCourse placed{member, followed.path};
        const auto move = move_to_pins(rules, placed);
        if (!move || moves == kMovesToPins) {
            return CourseFault::Path;
        }
        candidate = moved(rules, placed, seed_station(placed), *move);
    }
}

// Which way a windable member is wound from the first node to the second.
bool leads_backward(const LibraryCourse& member, const NodePair& nodes) {
    return !(member.windable_forward && nodes_of(member, false) == nodes);
}

void mark(const LibraryCourse& member, std::vector<char>& reached) {
    for (const std::int32_t sample : member.footprint) {
        reached[at(sample)] = 1;
    }
}

// In both directions that are windable yet; the last refusal.
CourseFault prove_both_ways(const std::function<CourseFault(PlacedCourse&)>& prove,
                            LibraryCourse& member) {
    CourseFault last = CourseFault::None;
    PlacedCourse course{member, {}};
    for (const bool backward : {false, true}) {
        bool& windable = backward ? member.windable_backward : member.windable_forward;
        if (!windable) {
            continue;
        }
        course.backward = backward;
        const CourseFault rejection = prove(course);
        windable = rejection == CourseFault::None;
        last = windable ? last : rejection;
    }
    if (is_windable(member)) {
        member.footprint = std::move(course.member.footprint);
    }
    return last;
}

}  // namespace

CourseFault prove_course(const CourseRules& rules, const Windability* machine,
                         PlacedCourse& course) {
    const bool backward = course.backward;
    LibraryCourse exact;
    TracedCourse followed;
    if (const CourseFault rejection =
            follow_to_pins(rules, course.member.candidate, exact, followed);
        rejection != CourseFault::None) {
        return rejection;
    }
    if (nodes_of(exact, backward) != nodes_of(course.member, backward)) {
        return CourseFault::Path;
    }
    if (machine == nullptr && !is_windable(rules, followed, backward)) {
        return CourseFault::FreeLength;
    }
    SurfacePath path = followed.path;
    std::vector<Piece> pieces;
    pieces.push_back(piece_of(rules, std::move(followed), exact, backward));
    add_half_turns(rules, exact, backward, pieces);
    if (const CourseFault rejection =
            machine != nullptr ? machine->follow(pieces) : CourseFault::None;
        rejection != CourseFault::None) {
        return rejection;
    }
    FootprintFinder::Scratch scratch = rules.footprints.make_scratch();
    exact.footprint = rules.footprints.footprint(path, scratch);
    exact.windable_forward = !backward;
    exact.windable_backward = backward;
    course.member = std::move(exact);
    course.path = std::move(path);
    return CourseFault::None;
}

CourseFault CourseProver::wind(PlacedCourse& course) const {
    if (machine_ == nullptr || course.wound) {
        return CourseFault::None;
    }
    const Piece piece = piece_of(rules_, course.member, course.backward);
    const CourseFault rejection = machine_->wind_alone({&piece, 1});
    course.wound = rejection == CourseFault::None;
    return rejection;
}

std::vector<std::pair<std::size_t, CourseFault>> CourseProver::wind_all(
    std::span<PlacedCourse> courses) const {
    std::vector<CourseFault> found(courses.size(), CourseFault::None);
    parallel_for(courses.size(), 1,
                 [&](std::size_t i, std::size_t) { found[i] = wind(courses[i]); });
    std::vector<std::pair<std::size_t, CourseFault>> refused;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (found[i] != CourseFault::None) {
            refused.emplace_back(i, found[i]);
        }
    }
    return refused;
}

ProvenLibrary::ProvenLibrary(Library library, PlanEffort& effort)
    : library_(std::move(library)),
      size_(library_.members.size()),
      allowed_(size_, 1),
      rejection_(size_, CourseFault::None),
      effort_(effort) {}

void ProvenLibrary::strike_off(std::size_t member, CourseFault reason) {
    allowed_[member] = 0;
    rejection_[member] = reason;
    ++effort_.rejections[static_cast<std::size_t>(reason)];
    effort_.rejected_courses += reason == CourseFault::Apart ? 0 : 1;
}

void ProvenLibrary::strike_off_all(CourseFault reason) {
    allowed_.assign(size_, 0);
    rejection_.assign(size_, reason);
}

void ProvenLibrary::note_refused(std::vector<std::int32_t> footprint, CourseFault reason) {
    const std::lock_guard lock(refused_mutex_);
    refused_.emplace_back(std::move(footprint), reason);
    ++effort_.rejections[static_cast<std::size_t>(reason)];
    ++effort_.rejected_courses;
}

void ProvenLibrary::refuse(const PlacedCourse& course, CourseFault reason) {
    if (course.of_library < 0) {
        note_refused(course.member.footprint, reason);
    } else if (allowed_[at(course.of_library)] != 0) {
        strike_off(at(course.of_library), reason);
    }
}

void ProvenLibrary::append_refused() {
    library_.members.resize(rejection_.size());
    for (auto& [footprint, reason] : refused_) {
        library_.members.emplace_back().footprint = std::move(footprint);
        rejection_.push_back(reason);
    }
    refused_.clear();
}

ProvenWays prove_ways(std::span<const LibraryCourse> members, const Ways& ways,
                      const std::function<CourseFault(PlacedCourse&)>& prove,
                      const std::function<void(double share)>& progress) {
    struct Trial {
        NodePair nodes;
        PlacedCourse course;
        std::int32_t member;
        CourseFault rejection = CourseFault::None;
    };
    ProvenWays proven;
    for (const std::size_t most : {kProvenForWay, kProvenForScarceWay}) {
        std::vector<Trial> trials;
        for (const auto& [nodes, way] : ways) {
            const std::size_t count = std::min(most, way.windable.size());
            for (std::size_t k = 0; !proven.known.contains(nodes) && k < count; ++k) {
                const std::int32_t i = way.windable[k * way.windable.size() / count];
                const LibraryCourse& member = members[at(i)];
                trials.push_back({nodes, {member, {}, leads_backward(member, nodes)}, i});
            }
        }
        progress(most == kProvenForWay ? 0.0 : 0.5);
        parallel_for(trials.size(), 1, [&](std::size_t i, std::size_t) {
            trials[i].rejection = prove(trials[i].course);
        });
        for (const Trial& trial : trials) {
            if (trial.rejection != CourseFault::None) {
                proven.refused.emplace_back(trial.member, trial.rejection);
            } else {
                proven.known[trial.nodes].proven.push_back({trial.member, trial.course.backward});
            }
        }
    }
    for (auto& [nodes, way] : proven.known) {
        way.abounds = ways.at(nodes).windable.size() >= kAbound;
    }
    return proven;
}

std::vector<char> ReachProver::prove(std::span<LibraryCourse> members) {
    tried_.resize(members.size(), 0);
    refused_.clear();
    std::vector<char> reached(samples_, 0);
    std::vector<std::vector<std::int32_t>> passing(samples_);
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (!is_windable(members[i])) {
            continue;
        }
        for (const std::int32_t sample : members[i].footprint) {
            passing[at(sample)].push_back(static_cast<std::int32_t>(i));
        }
        if (tried_[i] != 0) {
            mark(members[i], reached);
        }
    }
    std::set<std::int32_t> scarce;
    for (const std::vector<std::int32_t>& here : passing) {
        if (here.size() <= kScarcePassing) {
            scarce.insert(here.begin(), here.end());
        }
    }
    try_out(members, std::vector<std::int32_t>(scarce.begin(), scarce.end()), reached);
    for (std::size_t attempt = 0; attempt < kTriedAtPlace; ++attempt) {
        // One for each place, but where one that is tried for another place passes as well.
        std::vector<char> passed = reached;
        std::vector<std::int32_t> some;
        for (std::size_t sample = 0; sample < samples_; ++sample) {
            const std::vector<std::int32_t>& here = passing[sample];
            const std::size_t most = std::min(kTriedAtPlace, here.size());
            if (passed[sample] != 0 || attempt >= most) {
                continue;
            }
            const std::int32_t i = here[attempt * here.size() / most];
            if (tried_[at(i)] == 0) {
                some.push_back(i);
                mark(members[at(i)], passed);
            }
        }
        try_out(members, some, reached);
    }
    return reached;
}

void ReachProver::try_out(std::span<LibraryCourse> members, std::span<const std::int32_t> some,
                          std::vector<char>& reached) {
    std::vector<CourseFault> found(some.size(), CourseFault::None);
    parallel_for(some.size(), 1, [&](std::size_t k, std::size_t) {
        const std::size_t i = at(some[k]);
        found[k] = tried_[i] == 0 ? prove_both_ways(prove_, members[i]) : CourseFault::None;
    });
    for (std::size_t k = 0; k < some.size(); ++k) {
        const std::size_t i = at(some[k]);
        tried_[i] = 1;
        if (is_windable(members[i])) {
            mark(members[i], reached);
        } else {
            refused_.emplace_back(some[k], found[k]);
        }
    }
}

std::vector<DirectedCourse> spare_links(std::span<const LibraryCourse> members, const Ways& ways,
                                        const KnownWays& known, const FibreRoute& route,
                                        std::size_t stage) {
    const auto from = static_cast<int>(stage);
    const std::int32_t link = route.links[stage].member;
    std::vector<DirectedCourse> proven;
    std::vector<DirectedCourse> others;
    for (const auto& [nodes, way] : ways) {
        if (route.stage[nodes.first] != from || route.stage[nodes.second] != from + 1) {
            continue;
        }
        const auto held = known.find(nodes);
        for (const std::int32_t i : way.windable) {
            const bool holds =
                held != known.end() &&
                std::any_of(held->second.proven.begin(), held->second.proven.end(),
                            [&](const DirectedCourse& course) { return course.member == i; });
            if (i != link) {
                (holds ? proven : others).push_back({i, leads_backward(members[at(i)], nodes)});
            }
        }
    }
    proven.insert(proven.end(), others.begin(), others.end());
    std::reverse(proven.begin(), proven.end());
    return proven;
}

}  // namespace meshwind
