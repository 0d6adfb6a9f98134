/// Finds repeated circuits and writes them once, as subprograms.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "postproc/motion/block.h"

namespace meshwind {

/// A stretch of a program as it is written.
struct ProgramPart {
    enum class Kind { Blocks, Call };
    Kind kind = Kind::Blocks;
    std::size_t first =
        0;                 ///< Blocks: first..last of the list; Call: the block that it begins with
    std::size_t last = 0;  ///< Blocks
    std::size_t subprogram = 0;  ///< Call: index
    std::int64_t times = 1;      ///< Call

    friend bool operator==(const ProgramPart&, const ProgramPart&) = default;
};

/// Layout of the blocks of a list in a program. Without subprograms, `main` is empty and every
/// block has its line.
struct ProgramLayout {
    std::vector<ProgramPart> main{};
    /// A subprogram calls none before its own place in this order, so each stands behind its calls.
    std::vector<std::vector<ProgramPart>> subprograms{};
    /// For each axis, the largest distance of the blocks from those planned, 1e-9 mm or deg.
    std::vector<std::int64_t> drift_nano{};

    /// Lines of calls, those in subprograms included.
    [[nodiscard]] std::size_t calls() const;
};

/// The blocks that a program really runs, and its layout.
struct FoldedProgram {
    BlockList list;
    ProgramLayout layout;
};

/// Largest distance of an axis from its planned position by repetition. A repeated circuit is
/// rounded once and so loses up to half a step each time: half a step over all repeats, which
/// blocks written out keep, is impossible. The defaults are a tenth of the lateral precision of the
/// best winding machines (0.1 mm; 0.01 deg are 0.02 mm at a radius of 100 mm). An axis whose
/// resolution is coarser has one step of it instead.
struct RepeatTolerance {
    double linear_mm = 0.01;   ///< >= 0
    double rotary_deg = 0.01;  ///< >= 0
};

/// Least repetitions of a circuit for a subprogram.
inline constexpr std::size_t kMinCircuits = 3;

/// Least lines that a subprogram has to save, about a page: below that it hurts readability more
/// than it saves.
inline constexpr std::size_t kMinLinesSaved = 40;

/// Repeats are folded only if the program then has at most this share of its lines: with less
/// saved, it is easier to follow written out.
inline constexpr double kFoldedShare = 0.5;

/// Folds runs of equal circuits. A circuit is a stretch after which the linear axes, having moved,
/// are back where they were; circuits are equal when all increments agree to within a step (the
/// rounding of positions) and all durations to within six digits.
///
/// The circuit is closed in steps: its offsets are the means over the run, rounded, the same each
/// time. The remainder of the true circuit adds up until it would pass the tolerance. Then the
/// first block of the next circuit is written out, to its planned position, and a second subprogram
/// has the rest of the circuit; so no correction takes a block or time of its own. The block after
/// a run is written to its planned position, too; where a run ends the program, its last circuit
/// begins so that it ends exactly as planned. So the tolerance holds in between and nothing is off
/// at the end.
///
/// \return the list unchanged, with an empty layout, when nothing repeats or it does not pay.
/// Otherwise as many blocks with the same pieces and points, positions within the tolerance (or a
/// step) of those given, durations within six digits. Time grows linearly with the number of
/// blocks. Accuracy: Repeats.* in tests/postproc/nc/repeats_test.cpp.
[[nodiscard]] FoldedProgram fold_repeats(BlockList list, const RepeatTolerance& tolerance = {});

}  // namespace meshwind
