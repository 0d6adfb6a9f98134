#include "winding/laminate/plies.h"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/parallel.h"
#include "core/small_linear.h"
#include "winding/laminate/footprint.h"
#include "winding/laminate/measure_plan.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kFaceChunk = 256;

// A course that is further along by so many bands is on its next pass, as for footprints.
constexpr double kNextPass_bands = 2.0;

Vector3d normal_of(const Surface& surface, std::size_t face) {
    const auto& [a, b, c] = surface.face[face];
    const Vector3d& p = surface.position_mm[at(a)];
    return (surface.position_mm[at(b)] - p).cross(surface.position_mm[at(c)] - p).normalized();
}

// From one plane to another by the shortest way, so that a direction keeps its angle to the axis of
// a pipe.
Vector3d rolled(const Vector3d& from_normal, const Vector3d& to_normal, const Vector3d& along) {
    return shortest_turn(from_normal, to_normal) * along;
}

// A sample under a band. There may be millions, so they are kept small.
struct Contact {
    std::int32_t sample = -1;
    std::int32_t piece = -1;
    float s_mm = 0.0F;
    Eigen::Vector3f along;  // of the path beside the sample, in the sample's triangle
};

// A contact with the share of the triangle that it stands for.
struct Weighed {
    Contact contact;
    double weight = 0.0;
};

// Where the path passes a sample, from the station of the footprint on.
Contact beside_sample(const SurfacePath& path, std::size_t station, const Vector3d& place_mm,
                      const Vector3d& normal) {
    std::size_t i = station;
    while (i + 2 < path.size() &&
           (place_mm - path[i + 1].position_mm).dot(path[i + 1].tangent) > 0.0) {
        ++i;
    }
    const PathPoint& from = path[i];
    const PathPoint& to = path[i + 1];
    const CubicPlace place =
        beside(from.position_mm, from.tangent, to.position_mm, to.tangent, place_mm);
    const Vector3d under =
        ((1.0 - place.share) * from.normal + place.share * to.normal).normalized();
    Contact contact;
    contact.s_mm = static_cast<float>(from.s_mm + place.share * (to.s_mm - from.s_mm));
    contact.along = rolled(under, normal, place.tangent).cast<float>();
    return contact;
}

// All samples under the band of each course, in winding order.
std::vector<std::vector<Contact>> contacts_of(const Surface& surface,
                                              const CoverageSamples& samples,
                                              const FootprintFinder& footprints,
                                              std::span<const Piece> pieces,
                                              const PliesOptions& options) {
    std::vector<std::vector<Contact>> contacts(pieces.size());
    parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
        FootprintFinder::Scratch scratch = footprints.make_scratch();
        for (std::size_t i = begin; i < end; ++i) {
            if (pieces[i].kind != PieceKind::Course) {
                continue;
            }
            const SurfacePath path = options.over_rims
                                         ? course_with_ends(pieces, i, options.tow_width_mm)
                                         : pieces[i].path;
            const Strip strip = footprints.strip(path, scratch);
            for (std::size_t k = 0; k < strip.sample.size(); ++k) {
                const std::size_t sample = at(strip.sample[k]);
                Contact contact =
                    beside_sample(path, at(strip.station[k]), samples.position_mm[sample],
                                  normal_of(surface, at(samples.at[sample].face)));
                contact.sample = strip.sample[k];
                contact.piece = static_cast<std::int32_t>(i);
                contacts[i].push_back(contact);
            }
        }
    });
    return contacts;
}

// Contacts by the triangle of their sample.
class ContactsByFace {
public:
    ContactsByFace(const Surface& surface, const CoverageSamples& samples,
                   const std::vector<std::vector<Contact>>& contacts)
        : surface_(surface),
          faces_(sampled_faces(surface, samples)),
          begin_(surface.face.size() + 1, 0) {
        const auto face_of = [&](const Contact& contact) {
            return at(samples.at[at(contact.sample)].face);
        };
        for (const std::vector<Contact>& of_course : contacts) {
            for (const Contact& contact : of_course) {
                ++begin_[face_of(contact) + 1];
            }
        }
        for (std::size_t f = 0; f < surface.face.size(); ++f) {
            begin_[f + 1] += begin_[f];
        }
        contact_.resize(begin_.back());
        std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
        for (const std::vector<Contact>& of_course : contacts) {
            for (const Contact& contact : of_course) {
                contact_[next[face_of(contact)]++] = contact;
            }
        }
    }

    // Of a triangle; where it has no sample those that speak for it.
    [[nodiscard]] std::vector<Weighed> about(std::size_t face) const {
        const std::array<std::int32_t, 3>& speaks = faces_.speaks[face];
        const auto count = std::count_if(speaks.begin(), speaks.end(),
                                         [](std::int32_t f) { return f != kNoFace; });
        std::vector<Weighed> contacts;
        const Vector3d normal = normal_of(surface_, face);
        for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
            const std::size_t near = at(speaks[k]);
            const std::size_t first = contacts.size();
            add(near, 1.0 / static_cast<double>(count), contacts);
            for (std::size_t i = first; near != face && i < contacts.size(); ++i) {
                Eigen::Vector3f& along = contacts[i].contact.along;
                along =
                    rolled(normal_of(surface_, near), normal, along.cast<double>()).cast<float>();
            }
        }
        return contacts;
    }

    [[nodiscard]] const std::vector<std::int32_t>& samples() const { return faces_.samples; }

private:
    void add(std::size_t face, double share, std::vector<Weighed>& contacts) const {
        for (std::size_t i = begin_[face]; i < begin_[face + 1]; ++i) {
            contacts.push_back({contact_[i], share / faces_.samples[face]});
        }
    }

    const Surface& surface_;
    SampledFaces faces_;
    std::vector<std::size_t> begin_;  // per face
    std::vector<Contact> contact_;
};

double covered_by(std::vector<Weighed> contacts) {
    std::sort(contacts.begin(), contacts.end(), [](const Weighed& a, const Weighed& b) {
        return a.contact.sample < b.contact.sample;
    });
    double covered = 0.0;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        const bool again = i > 0 && contacts[i].contact.sample == contacts[i - 1].contact.sample;
        covered += again ? 0.0 : contacts[i].weight;
    }
    return std::min(1.0, covered);
}

// Contacts of one pass become one ply. \param normal of the triangle
std::vector<Ply> plies_from(std::vector<Weighed> contacts, const Vector3d& normal,
                            double tow_width_mm) {
    std::stable_sort(contacts.begin(), contacts.end(), [](const Weighed& a, const Weighed& b) {
        return std::pair(a.contact.piece, a.contact.s_mm) <
               std::pair(b.contact.piece, b.contact.s_mm);
    });
    std::vector<Ply> plies;
    std::vector<std::int32_t> seen;  // samples of the ply
    double last_mm = 0.0;
    for (const auto& [contact, weight] : contacts) {
        const bool same_ply = !plies.empty() && plies.back().piece == contact.piece &&
                              contact.s_mm - last_mm <= kNextPass_bands * tow_width_mm &&
                              std::find(seen.begin(), seen.end(), contact.sample) == seen.end();
        if (!same_ply) {
            plies.push_back({contact.piece, 0.0, Vector3d::Zero()});
            seen.clear();
        }
        plies.back().share += weight;
        plies.back().along += weight * contact.along.cast<double>();
        seen.push_back(contact.sample);
        last_mm = contact.s_mm;
    }
    for (Ply& ply : plies) {
        ply.along = (ply.along - normal * normal.dot(ply.along)).normalized();
    }
    return plies;
}

}  // namespace

Plies plies_of(const Surface& surface, const Surface& wall, std::span<const Piece> pieces,
               const PliesOptions& options) {
    const CoverageSamples samples = plan_samples(surface, options.tow_width_mm, options.seed);
    const FootprintFinder footprints(wall, samples, options.tow_width_mm);
    const ContactsByFace contacts(surface, samples,
                                  contacts_of(surface, samples, footprints, pieces, options));
    Plies plies;
    plies.samples = contacts.samples();
    plies.covered.resize(surface.face.size());
    std::vector<std::vector<Ply>> rows(surface.face.size());
    parallel_for(surface.face.size(), kFaceChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            std::vector<Weighed> about = contacts.about(f);
            plies.covered[f] = covered_by(about);
            rows[f] = plies_from(std::move(about), normal_of(surface, f), options.tow_width_mm);
        }
    });
    plies.begin.push_back(0);
    for (const std::vector<Ply>& row : rows) {
        plies.ply.insert(plies.ply.end(), row.begin(), row.end());
        plies.begin.push_back(plies.ply.size());
    }
    return plies;
}

}  // namespace meshwind
