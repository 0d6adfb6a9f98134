#include "postproc/eye/repeated_path.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Geometry>

#include "core/units.h"

namespace meshwind {
namespace {

// Most pieces of a circuit: two courses and two turns, as often as lattices of two series need.
constexpr std::size_t kMaxPieces = 8;

// About Z, from the points of one stretch to those of another: that with the least squares.
double turned_rad(std::span<const EyePoint> from, std::span<const EyePoint> to) {
    double sine = 0.0;
    double cosine = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        const Eigen::Vector3d& a = from[i].landing_mm;
        const Eigen::Vector3d& b = to[i].landing_mm;
        sine += a.x() * b.y() - a.y() * b.x();
        cosine += a.x() * b.x() + a.y() * b.y();
    }
    return std::atan2(sine, cosine);
}

// The same without the turns of the mandrel being counted: with them as of the first points.
double mandrel_turn_rad(std::span<const EyePoint> from, std::span<const EyePoint> to) {
    const double turn = -turned_rad(from, to);
    const double counted = to.front().turn_rad - from.front().turn_rad;
    return turn + 2.0 * kPi * std::round((counted - turn) / (2.0 * kPi));
}

bool same_turned(std::span<const EyePoint> a, std::span<const EyePoint> b) {
    if (a.size() != b.size()) {
        return false;
    }
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(turned_rad(a, b), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double at = (a[i].s_mm - a.front().s_mm) - (b[i].s_mm - b.front().s_mm);
        if (std::abs(at) > kSameLanding_mm || a[i].on_pins != b[i].on_pins ||
            a[i].held != b[i].held ||
            (turn * a[i].landing_mm - b[i].landing_mm).norm() > kSameLanding_mm ||
            (turn * a[i].tangent - b[i].tangent).norm() > kSameDirection ||
            (turn * a[i].binormal - b[i].binormal).norm() > kSameDirection) {
            return false;
        }
    }
    return true;
}

// Share of the way from one point to another along the fibre.
double share_of(const EyePoint& point, const EyePoint& from, const EyePoint& to) {
    const double length = to.s_mm - from.s_mm;
    return length > 0.0 ? std::clamp((point.s_mm - from.s_mm) / length, 0.0, 1.0) : 0.0;
}

}  // namespace

// Cuts runs of circuits out of a path.
class RepeatedPath::Finder {
public:
    Finder(RepeatedPath& found, const EyePath& path, std::span<const double> ahead_mm)
        : found_(found), path_(path), ahead_mm_(ahead_mm) {}

    void run() {
        for (std::size_t i = 0; i < path_.size(); ++i) {
            if (i == 0 || path_[i].piece != path_[i - 1].piece) {
                first_.push_back(i);
            }
        }
        first_.push_back(path_.size());
        name_kinds();
        count_equal();
        for (std::size_t piece = 0; piece < kind_.size();) {
            piece = take_run(piece);
        }
    }

private:
    [[nodiscard]] std::span<const EyePoint> points(std::size_t piece) const {
        return std::span(path_).subspan(first_[piece], first_[piece + 1] - first_[piece]);
    }

    // Pieces that are each other turned are of one kind.
    void name_kinds() {
        std::map<std::size_t, std::vector<std::size_t>> of_size;  // firsts of their kinds
        for (std::size_t piece = 0; piece + 1 < first_.size(); ++piece) {
            std::vector<std::size_t>& known = of_size[points(piece).size()];
            const auto same = std::find_if(known.begin(), known.end(), [&](std::size_t other) {
                return same_turned(points(other), points(piece));
            });
            kind_.push_back(same == known.end() ? piece : *same);
            if (kind_.back() == piece) {
                known.push_back(piece);
            }
        }
    }

    // Per length of circuits and piece: how many pieces from it on are of the kind of those a
    // circuit later.
    void count_equal() {
        const std::size_t n = kind_.size();
        equal_.assign(kMaxPieces + 1, std::vector<std::size_t>(n + 1, 0));
        for (std::size_t length = 1; length <= kMaxPieces; ++length) {
            for (std::size_t i = n > length ? n - length : 0; i-- > 0;) {
                equal_[length][i] = kind_[i] == kind_[i + length] ? equal_[length][i + 1] + 1 : 0;
            }
        }
    }

    // The run from a piece on that saves most, or the piece as it is. Returns the next piece.
    std::size_t take_run(std::size_t piece) {
        std::size_t best_length = 0;
        std::size_t best_circuits = 0;
        std::size_t most = 0;
        for (std::size_t length = 1; length <= kMaxPieces; ++length) {
            const std::size_t circuits = equal_[length][piece] / length + 1;
            const std::size_t saved =
                circuits > kKeptCircuits ? (circuits - kKeptCircuits) * length : 0;
            if (saved > most) {
                most = saved;
                best_length = length;
                best_circuits = circuits;
            }
        }
        if (most == 0) {
            keep(piece);
            return piece + 1;
        }
        fold(piece, best_length, best_circuits);
        return piece + best_length * best_circuits;
    }

    void keep(std::size_t piece) {
        Piece kept;
        kept.first = first_[piece];
        kept.few_first = found_.few_.size();
        kept.turn_rad = -more_rad_;
        kept.run = kNoRun;
        found_.pieces_.push_back(kept);
        const Eigen::Matrix3d turn =
            Eigen::AngleAxisd(-more_rad_, Eigen::Vector3d::UnitZ()).toRotationMatrix();
        for (std::size_t i = first_[piece]; i < first_[piece + 1]; ++i) {
            EyePoint point = path_[i];
            if (more_rad_ != 0.0 || less_mm_ != 0.0) {
                point.s_mm = std::max(found_.few_.back().s_mm, point.s_mm - less_mm_);
                point.turn_rad += more_rad_;
                for (Eigen::Vector3d* const v :
                     {&point.landing_mm, &point.tangent, &point.binormal, &point.eye_mm}) {
                    *v = turn * *v;
                }
            }
            found_.few_.push_back(point);
            found_.few_ahead_mm_.push_back(ahead_mm_[i]);
        }
    }

    void fold(std::size_t piece, std::size_t length, std::size_t circuits) {
        const std::size_t middle = piece + kKeptCircuits / 2 * length;
        const std::size_t after = piece + (circuits - kKeptCircuits / 2) * length;
        Run run;
        for (std::size_t k = piece; k < middle; ++k) {
            keep(k);
        }
        run.middle = found_.few_.size();
        const std::size_t first = found_.pieces_.size();
        for (std::size_t k = middle; k < middle + length; ++k) {
            keep(k);
            found_.pieces_.back().run = found_.runs_.size();
            found_.pieces_.back().repeats = true;
        }
        for (std::size_t k = middle + length; k < after; ++k) {
            const std::size_t as = (k - middle) % length;
            Piece repeated = found_.pieces_[first + as];
            repeated.first = first_[k];
            repeated.turn_rad += mandrel_turn_rad(points(middle + as), points(k));
            found_.pieces_.push_back(repeated);
        }
        run.turn_rad = mandrel_turn_rad(points(middle), points(middle + length));
        more_rad_ -= mandrel_turn_rad(points(middle + length), points(after));
        less_mm_ += path_[first_[after]].s_mm - path_[first_[middle + length]].s_mm;
        run.after = found_.few_.size();
        for (std::size_t k = after; k < after + length; ++k) {
            keep(k);
            found_.pieces_.back().run = found_.runs_.size();
        }
        run.end = found_.few_.size();
        for (std::size_t k = after + length; k < piece + circuits * length; ++k) {
            keep(k);
        }
        found_.runs_.push_back(run);
    }

    RepeatedPath& found_;
    const EyePath& path_;
    std::span<const double> ahead_mm_;
    std::vector<std::size_t> first_;  // point of each piece, and the end
    std::vector<std::size_t> kind_;   // per piece: the first one of its kind
    std::vector<std::vector<std::size_t>> equal_;
    double more_rad_ = 0.0;  // that the mandrel is turned where circuits were left out before
    double less_mm_ = 0.0;   // of fibre
};

RepeatedPath::RepeatedPath(const EyePath& path, std::span<const double> ahead_mm) {
    Finder(*this, path, ahead_mm).run();
}

std::size_t RepeatedPath::few_of(std::size_t point) const {
    const auto behind =
        std::upper_bound(pieces_.begin(), pieces_.end(), point,
                         [](std::size_t i, const Piece& piece) { return i < piece.first; });
    const Piece& piece = *std::prev(behind);
    return piece.few_first + (point - piece.first);
}

EyePath RepeatedPath::all(EyePath path, const EyePath& chosen) const {
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
        const Piece& piece = pieces_[p];
        const std::size_t end = p + 1 < pieces_.size() ? pieces_[p + 1].first : path.size();
        for (std::size_t i = piece.first; i < end; ++i) {
            const EyePoint& from = chosen[piece.few_first + (i - piece.first)];
            double turn = from.turn_rad;
            double length = from.free_length_mm;
            if (piece.run != kNoRun) {
                const Run& run = runs_[piece.run];
                const EyePoint& middle = chosen[run.middle];
                const EyePoint& after = chosen[run.after];
                const double share = piece.repeats
                                         ? share_of(from, middle, after)
                                         : 1.0 - share_of(from, after, chosen[run.end - 1]);
                turn -= share * (after.turn_rad - middle.turn_rad - run.turn_rad);
                length -= share * (after.free_length_mm - middle.free_length_mm);
            }
            path[i].turn_rad = turn + piece.turn_rad;
            set_eye(path[i], length);
        }
    }
    return path;
}

std::optional<RepeatedPath> repetition_of(const EyePath& path, std::span<const double> ahead_mm) {
    if (path.size() <= kManyStations) {
        return std::nullopt;
    }
    RepeatedPath repeated(path, ahead_mm);
    if (static_cast<double>(repeated.few().size()) > kFewShare * static_cast<double>(path.size())) {
        return std::nullopt;
    }
    return repeated;
}

}  // namespace meshwind
