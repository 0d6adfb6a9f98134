/// Share of each limit that a stage may use up. The rest is for the stages after it, so that the
/// fibre, wound again from the program, keeps what the job asks for. docs/theory.md has these rows
/// as a table.
#pragma once

namespace meshwind::margin {

// Friction. verify holds the laid fibre to the job's friction; planners get kPlannedFriction of it
// as their own, and the shares below it are of that.

/// Plans, and joins of imported ones: the rest is for what the blocks of a program add.
inline constexpr double kPlannedFriction = 0.96;
/// Steered courses of a cover: the rest is for the error of measuring slip on the mesh.
inline constexpr double kCoverSteering = 0.92;
/// Passes of a pattern and legs of an elbow, steered all along: the rest is for bridges over hollow
/// edges and for jumps of curvature, which the laid fibre evens out.
inline constexpr double kPatternSteering = 0.9;
/// Connecting passes between layers: over the steps that other layers leave, the normal curvature
/// changes within a few mm.
inline constexpr double kConnectingSteering = 0.7;
/// Hoops that turn into a helix and back: a few mm of fibre, steered gently.
inline constexpr double kHoopSteering = 0.5;
/// A turn on an extension that is long enough: less would waste fibre, more leaves nothing for a
/// wet or worn surface.
inline constexpr double kEasyTurn = 0.85;
/// A turn on a short extension: the rest is for the error of measuring.
inline constexpr double kFullTurn = 0.98;
/// Share of the job's friction for plan and blocks together: the rest is for the error of
/// measuring.
inline constexpr double kLaidFriction = 0.995;

// Bridging.

/// Share of the tolerance for a course of a cover: its stations are some way apart.
inline constexpr double kCoverBridging = 0.98;

// Clearance of the head, on top of the job's.

/// Where free lengths are chosen: between the ends of a block the axes cut the corner of the eye's
/// curve by up to this much.
inline constexpr double kBetweenBlocks_mm = 0.5;
/// Further on top while candidates are tried at a few stations, so that a course still fits when
/// every station is tried.
inline constexpr double kCandidates_mm = 0.3;
/// Share of the head's spare clearance that blocks may use: between two points it may be less.
inline constexpr double kBlocksOfRoom = 0.5;
/// Blocks cut the corner by at most this much, however much room there is.
inline constexpr double kMaxBetweenBlocks_mm = 2.0;
/// Blocks are not made shorter for less than this: the plan is refused.
inline constexpr double kMinBetweenBlocks_mm = 0.1;
/// Further room in the first motion of least time: its clearance is looked up at points a few mm
/// apart. Less makes more places to mend, more a longer way round; on tees both cost time.
inline constexpr double kFirstMotion_mm = 2.0;
/// Added, each time, where the head is found too near between stations: a free length that grows by
/// 3 mm per mm of fibre moves the head by up to 12 mm between two.
inline constexpr double kMended_mm = 1.0;

// Laid fibre against the plan.

/// Share of the tolerance for the choice of blocks. The rest is for errors it does not see:
/// rounding to the axes' resolution (0.005 mm at 300 mm from the spindle) and the first order.
inline constexpr double kBlocksOfDeviation = 0.75;
/// Share of their previous tolerance for blocks that the simulation finds too coarse.
inline constexpr double kTighterBlocks = 0.5;
/// Largest error of the free length against the planned one between the ends of blocks
/// (choose_blocks.h).
inline constexpr double kFreeLength_mm = 2.0;

// Speed.

/// Share of the fibre's speed that the machine can pay out. A block pays out its fibre evenly only
/// to first order; wound again, its fastest stretch is up to 0.3 % faster (words_test.py winds such
/// a pipe). Blocks that are faster still get more time.
inline constexpr double kPaidOutSpeed = 0.995;

}  // namespace meshwind::margin
