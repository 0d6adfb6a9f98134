/// What is wound: courses and the turns that join them, in order, with what they cover.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geodesic/measure.h"
#include "mesh/centre_line.h"
#include "winding/arrange.h"
#include "winding/library.h"
#include "winding/pattern.h"
#include "winding/pattern_wish.h"
#include "winding/pin.h"
#include "winding/wound_angle.h"

namespace meshwind {

enum class PieceKind { Course, Transition };

/// Where the straight free fibre begins that leads to the eye, when that is not where the fibre is
/// laid: on the flank of a pin ahead (pin_turn.h).
struct FreeStart {
    Eigen::Vector3d from_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit
    bool held = false;  ///< a pin says where the fibre is laid, not the eye
};

/// A stretch of the fibre in winding order. Stations are in the direction of travel, mandrel frame.
struct Piece {
    PieceKind kind = PieceKind::Course;
    SurfacePath path;
    TautString string;  ///< where the fibre is over the path
    std::vector<double>
        slip;  ///< per station, |kg / kn|: measured on courses, exact on transitions
    double worst_slip = 0.0;
    std::vector<FreeStart> free_start{};  ///< per station of a turn on pins; else empty
    std::int32_t start_rim = -1;
    std::int32_t end_rim = -1;
    bool starts_fibre = false;  ///< tied on before this piece
};

/// Keeps stations at least `step_mm` apart, both ends, both sides of a feature edge, and where the
/// fibre leaves the wall or meets it again the stations on either side of that place.
void thin_out(Piece& piece, double step_mm);

/// Why a course that the library admits is not laid after all, or not in one direction.
enum class Rejection : std::uint8_t {
    None,
    Path,  ///< followed accurately it bridges, or ends where it cannot be turned
    Slip,
    FreeLength,
    AxisTravel,
    FibreHit,
    HeadHit,
    Laydown,     ///< wound again its program does not lay it as planned
    InItsPlace,  ///< the machine refuses it, or a turn next to it, between its neighbours
    Apart,       ///< no single fibre joins it to the others
    NotPlanned,  ///< too little of the wall is in reach
};
inline constexpr std::size_t kRejections = 11;

/// Words for a report: "the free fibre hits something", ...
[[nodiscard]] const char* name_of(Rejection rejection);

/// How the wall is covered, measured on the coverage samples.
struct Coverage {
    double fraction = 0.0;   ///< share of the wall under at least one layer
    double reachable = 0.0;  ///< share that an admissible course of the library passes
    double mean_layers = 0.0;
    int max_layers = 0;
    double cv = 0.0;  ///< standard deviation of the layers over their mean
    /// The same where a pattern is regular, of the layers averaged over a tow width.
    std::optional<double> regular_cv{};
    std::optional<double> thinnest_layers{};  ///< so averaged, and where it is regular
    std::optional<double> thickest_layers{};
};

/// Bare wall with the rule that keeps it bare.
struct Uncovered {
    std::int32_t region = -1;
    double area_mm2 = 0.0;
    std::string reason;  ///< the rule, and of how many courses it is the reason
    std::string rule;
};

/// A rule that keeps wall bare, loosened: what courses would reach then.
struct WhatIf {
    enum class Rule { Friction, Bridging, Extension } rule = Rule::Friction;
    double factor = 1.0;     ///< on the rule's number
    double reachable = 0.0;  ///< share of the wall
};

/// What the turns of a plan ask of one rim's extension.
struct TurnsAtRim {
    int turns = 0;
    double extension_mm = 0.0;  ///< axial length that they and the band need
    double dwell_rad = 0.0;     ///< wound along hoops, in all
};

/// A pattern as it is laid.
struct LaidPattern {
    Pattern pattern;
    double angle_rad = 0.0;       ///< winding angle at the widest place
    double slip_ratio = 0.0;      ///< with which the courses are steered
    double closure_rad = 0.0;     ///< how far off its start the fibre ends, about the spindle
    double band_offset_mm = 0.0;  ///< between neighbouring bands, at the widest place
    Interlacing interlacing{};
    /// Per circuit, in winding order: where it begins, from the first one, 0 .. 2 pi. N of them, of
    /// lattices N for each series and ply.
    std::vector<double> starts_rad{};
    std::optional<LaidLattice> lattice{};
};

/// What becomes of the lines on a leg of an elbow, see winding/elbow_lines.h.
struct LaidElbowLeg {
    double length_mm = 0.0;
    double run_mm = 0.0;     ///< over which they are steered, from the bend on
    double angle_rad = 0.0;  ///< to the leg's axis beyond that
    double even = 0.0;       ///< 1: one angle and even distances there
    double slip_ratio = 0.0;
    double widest_mm = 0.0;  ///< largest distance of neighbours
    double closed_mm = 0.0;  ///< from the bend on, without gaps
};

/// The lines of an elbow as they are laid.
struct LaidElbow {
    int lines = 0;           ///< of either hand
    int needed_by_bend = 0;  ///< dimovski_2018_elbows, eq. (18); more are for the legs
    double angle_rad = 0.0;  ///< to the tube's axis at the outer equator
    double inner_angle_rad = 0.0;
    double theta_cycle_rad = 0.0;
    double thinnest_layers = 0.0;       ///< on the bend, of both hands: at the outer equator
    double thickest_layers = 0.0;       ///< at the inner one
    std::array<LaidElbowLeg, 2> leg{};  ///< at the tube's first and second rim
    std::optional<CentreLine> line{};   ///< of the tube, from the first rim to the second
};

/// What planning took; for reports.
struct PlanEffort {
    std::uint64_t seed = 0;
    int effort = 0;  ///< asked for
    std::int64_t candidates = 0;
    std::array<std::int64_t, kRefusals> refusals{};
    std::int64_t proposals = 0;    ///< weighed while the courses were annealed
    std::int64_t taken = 0;        ///< of these
    int courses_out_of_reach = 0;  ///< chosen, but no fibre joins them; left out
    int rejected_courses = 0;      ///< refused by the measured slip or by the machine
    std::array<std::int64_t, kRejections> rejections{};  ///< members of the library, by reason
};

struct Plan {
    std::string planner;  ///< "cover", "pattern", "imported"
    std::vector<Piece> pieces;
    int courses = 0;
    int fibres = 0;  ///< continuous fibres, one after the other
    /// Share of the wall that courses of one fibre reach, of two, ... as far as more reach more.
    std::vector<double> reach_of_fibres;
    double fibre_length_mm = 0.0;
    double worst_slip = 0.0;
    double worst_bridge_mm = 0.0;
    double worst_joint_mm =
        0.0;  ///< largest step between the end of a piece and the start of the next
    Coverage coverage;
    std::vector<Uncovered> uncovered;
    std::vector<double> face_layers;     ///< per face of the surface: mean layers
    std::vector<WhatIf> what_if;         ///< where wall is out of reach, the most useful first
    std::vector<TurnsAtRim> turns;       ///< per rim
    std::vector<PinRing> pins{};         ///< that the turns need, at most one ring per rim
    std::vector<std::int32_t> family;    ///< per course in winding order (families.h)
    WoundAngles angle;                   ///< of the courses
    Places places;                       ///< of junctions and hoops in the winding order
    std::optional<LaidPattern> pattern;  ///< of the pattern planner's circuits
    std::optional<LaidElbow> elbow;      ///< of the elbow planner's lines
    PlanEffort effort;
    bool goes_on = false;     ///< begins where the fibre of the layer before ends
    std::string cut_because;  ///< in words why it does not, where there is a layer before
    std::string failure;      ///< empty, or in words why nothing can be wound
};

/// Per piece the number of its course in winding order: its own, or of the one before the turn.
[[nodiscard]] std::vector<std::size_t> courses_of(std::span<const Piece> pieces);

/// The rejection that counts most.
[[nodiscard]] Rejection commonest_rejection(const PlanEffort& effort);

/// In words, "123 of 456 candidates: reaches no rim" and "12 of 34: the head would come too near".
[[nodiscard]] std::string refused_most(const PlanEffort& effort);
[[nodiscard]] std::string rejected_most(const PlanEffort& effort);

/// The pieces of each fibre, in order.
[[nodiscard]] std::vector<std::span<const Piece>> fibres_of(std::span<const Piece> pieces);

}  // namespace meshwind
