/// A path of circuits that repeat, cut down to a few of them, and what is chosen for these put to
/// all.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "postproc/eye/eye_path.h"

namespace meshwind {

/// Of a path with more stations than that (200 m of fibre, whose motion takes half a minute)
/// circuits that repeat are given one choice.
inline constexpr std::size_t kManyStations = 50'000;

/// If the few circuits have no more than this share of its stations.
inline constexpr double kFewShare = 0.5;

/// Circuits of a run that are kept. The one in the middle is what the others repeat; those to
/// either side keep the run's ends away from it.
inline constexpr std::size_t kKeptCircuits = 5;

/// Landing points of two circuits are the same, one turned about the spindle, to so much: a
/// twentieth of what laid fibre may be off the plan.
inline constexpr double kSameLanding_mm = 0.01;

/// And their directions to so much, 0.006 deg.
inline constexpr double kSameDirection = 1e-4;

/// On a body of revolution each circuit of a pattern is the one before turned about Z. A circuit is
/// here a run of up to eight pieces (courses and turns); circuits repeat where each point of one,
/// turned, is that of the next, by kSameLanding_mm and kSameDirection. What is chosen for one of
/// them then serves all, up to what the mesh is off the body, which is for the checks of the whole
/// path to find.
class RepeatedPath {
public:
    /// \param path with its turns and free lengths: the motion that the few begin with
    /// \param ahead_mm per point of the path
    RepeatedPath(const EyePath& path, std::span<const double> ahead_mm);

    /// The path with runs of more than kKeptCircuits circuits cut down to that many: what comes
    /// behind is turned back about Z to where they end, with the mandrel's turn. Pieces and points
    /// keep their numbers. The path as it is where nothing repeats so often.
    [[nodiscard]] const EyePath& few() const { return few_; }
    [[nodiscard]] const std::vector<double>& few_ahead_mm() const { return few_ahead_mm_; }

    /// The point of the few that stands for a point of the path.
    [[nodiscard]] std::size_t few_of(std::size_t point) const;

    /// The path with free lengths and turns as chosen for the few: circuits that were left out have
    /// those of the middle one of their run, with the mandrel turned on. What that one's ends
    /// differ by, which is next to nothing where the choice has settled, is spread evenly along it.
    /// \param path the one given first \param chosen few() with other lengths and turns
    [[nodiscard]] EyePath all(EyePath path, const EyePath& chosen) const;

private:
    static constexpr std::size_t kNoRun = static_cast<std::size_t>(-1);

    struct Piece {
        std::size_t first = 0;      ///< point of the path
        std::size_t few_first = 0;  ///< point of the few that stands for it
        double turn_rad = 0.0;      ///< of the mandrel, more than there
        std::size_t run = kNoRun;   ///< in runs_
        bool repeats = false;       ///< one of the circuits that repeat the middle one
    };
    struct Run {
        std::size_t middle = 0;  ///< points of the few: where the circuit begins that is repeated,
        std::size_t after = 0;   ///< where the next one does,
        std::size_t end = 0;     ///< and where that one ends
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
