/// Finds repeated circuits of a path, cuts it down to a few of them, and copies their motion to
/// all.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "postproc/eye/eye_path.h"

namespace meshwind {

/// In a path with more stations than this (200 m of fibre, whose motion takes half a minute)
/// repeated circuits share one choice.
inline constexpr std::size_t kManyStations = 50'000;

/// This holds only if the few circuits have at most this share of its stations.
inline constexpr double kFewShare = 0.5;

/// Circuits of a run that are kept. The one in the middle is what the others repeat; those to
/// either side keep the run's ends away from it.
inline constexpr std::size_t kKeptCircuits = 5;

/// Landing points of two circuits, one turned about the spindle, are the same within this: a
/// twentieth of the tolerance of laid fibre against the plan.
inline constexpr double kSameLanding_mm = 0.01;

/// Their directions are the same within this, 0.006 deg.
inline constexpr double kSameDirection = 1e-4;

/// On a body of revolution each circuit of a pattern is the one before turned about Z. A circuit is
/// here a run of up to eight pieces (courses and turns); circuits repeat where each point of one,
/// turned, is that of the next, by kSameLanding_mm and kSameDirection. The choice for one of them
/// then serves all, up to the deviation of the mesh from the body, which the checks of the whole
/// path find.
class RepeatedPath {
public:
    /// \param path with its turns and free lengths: the motion that the few begin with
    /// \param ahead_mm per point of the path
    RepeatedPath(const EyePath& path, std::span<const double> ahead_mm);

    /// The path with runs of more than kKeptCircuits circuits cut down to that many: the rest of
    /// the path is turned back about Z to where they end, with the mandrel's turn. Pieces and
    /// points keep their numbers. The path unchanged where nothing repeats so often.
    [[nodiscard]] const EyePath& few() const { return few_; }
    [[nodiscard]] const std::vector<double>& few_ahead_mm() const { return few_ahead_mm_; }

    /// The point of the few that stands for a point of the path.
    [[nodiscard]] std::size_t few_of(std::size_t point) const;

    /// The path with free lengths and turns as chosen for the few: circuits that were left out have
    /// those of the middle one of their run, with the mandrel turned on. The difference between
    /// that one's ends, next to nothing where the choice has settled, is spread evenly along it.
    /// \param path the one given first \param chosen few() with other lengths and turns
    [[nodiscard]] EyePath all(EyePath path, const EyePath& chosen) const;

private:
    static constexpr std::size_t kNoRun = static_cast<std::size_t>(-1);

    struct Piece {
        std::size_t first = 0;      ///< point of the path
        std::size_t few_first = 0;  ///< point of the few that stands for it
        double turn_rad = 0.0;      ///< of the mandrel, in addition to that of few_first
        std::size_t run = kNoRun;   ///< in runs_
        bool repeats = false;       ///< one of the circuits that repeat the middle one
    };
    struct Run {
        std::size_t middle = 0;  ///< points of the few: start of the repeated circuit,
        std::size_t after = 0;   ///< start of the next one,
        std::size_t end = 0;     ///< end of that one
        double turn_rad = 0.0;   ///< of the mandrel from one circuit to the next
    };
    class Finder;

    EyePath few_;
    std::vector<double> few_ahead_mm_;
    std::vector<Piece> pieces_;
    std::vector<Run> runs_;
};

/// A path of more than kManyStations whose few have no more than kFewShare of them.
[[nodiscard]] std::optional<RepeatedPath> repetition_of(const EyePath& path,
                                                        std::span<const double> ahead_mm);

}  // namespace meshwind
