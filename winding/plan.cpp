#include "winding/plan.h"

#include <algorithm>
#include <numeric>

namespace meshwind {
namespace {

// The first reason is none.
std::size_t commonest(std::span<const std::int64_t> counts) {
    return static_cast<std::size_t>(std::max_element(counts.begin() + 1, counts.end()) -
                                    counts.begin());
}

}  // namespace

const char* name_of(Rejection rejection) {
    switch (rejection) {
        case Rejection::None:
            return "accepted";
        case Rejection::Path:
            return "followed accurately the course bridges or cannot be turned";
        case Rejection::Slip:
            return "the slip measured on the finished course exceeds the friction";
        case Rejection::FreeLength:
            return "no free length of the fibre is clear all along the course";
        case Rejection::AxisTravel:
            return "an axis of the machine would pass its end";
        case Rejection::FibreHit:
            return "the free fibre would hit something";
        case Rejection::HeadHit:
            return "the head would come too near";
        case Rejection::Laydown:
            return "wound again, its program does not lay the course as planned";
        case Rejection::InItsPlace:
            return "the machine refuses the course or a turn next to it";
        case Rejection::Apart:
            return "one fibre cannot join the course to the others";
        case Rejection::NotPlanned:
            return "nothing is planned where so little of the wall is in reach";
    }
    return "";
}

std::vector<std::size_t> courses_of(std::span<const Piece> pieces) {
    std::vector<std::size_t> courses;
    std::size_t begun = 0;
    for (const Piece& piece : pieces) {
        begun += piece.kind == PieceKind::Course ? 1 : 0;
        courses.push_back(begun - 1);
    }
    return courses;
}

Rejection commonest_rejection(const PlanEffort& effort) {
    return static_cast<Rejection>(commonest(effort.rejections));
}

std::string refused_most(const PlanEffort& effort) {
    const std::size_t most = commonest(effort.refusals);
    return std::to_string(effort.refusals[most]) + " of " + std::to_string(effort.candidates) +
           " candidates: " + name_of(static_cast<Refusal>(most));
}

std::string rejected_most(const PlanEffort& effort) {
    const std::size_t most = commonest(effort.rejections);
    const std::int64_t all =
        std::accumulate(effort.rejections.begin(), effort.rejections.end(), std::int64_t{0});
    return std::to_string(effort.rejections[most]) + " of " + std::to_string(all) + ": " +
           name_of(static_cast<Rejection>(most));
}

std::vector<std::span<const Piece>> fibres_of(std::span<const Piece> pieces) {
    std::vector<std::span<const Piece>> fibres;
    for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
        end = begin + 1;
        while (end < pieces.size() && !pieces[end].starts_fibre) {
            ++end;
        }
        fibres.push_back(pieces.subspan(begin, end - begin));
    }
    return fibres;
}

void thin_out(Piece& piece, double step_mm) {
    std::vector<std::size_t> kept{0};
    const std::size_t last = piece.path.size() - 1;
    for (std::size_t i = 1; i <= last; ++i) {
        const double s = piece.path[i].s_mm;
        const bool crease =
            s <= piece.path[i - 1].s_mm || (i < last && piece.path[i + 1].s_mm <= s);
        const bool lifted = piece.string.gap_mm[i] > 0.0;
        const bool contact = lifted != (piece.string.gap_mm[i - 1] > 0.0) ||
                             (i < last && lifted != (piece.string.gap_mm[i + 1] > 0.0));
        const bool room = piece.path[last].s_mm - s >= step_mm;
        if (i == last || crease || contact ||
            (room && s - piece.path[kept.back()].s_mm >= step_mm)) {
            kept.push_back(i);
        }
    }
    for (std::size_t k = 0; k < kept.size(); ++k) {
        piece.path[k] = piece.path[kept[k]];
        piece.slip[k] = piece.slip[kept[k]];
        piece.string.gap_mm[k] = piece.string.gap_mm[kept[k]];
        piece.string.slope[k] = piece.string.slope[kept[k]];
    }
    piece.path.resize(kept.size());
    piece.slip.resize(kept.size());
    piece.string.gap_mm.resize(kept.size());
    piece.string.slope.resize(kept.size());
}

}  // namespace meshwind
