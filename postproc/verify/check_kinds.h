/// All kinds of checks. A check is made with its row here, which gives its name, title, meaning and
/// limits in the summary, in report.json and on the page.
#pragma once

#include "postproc/verify/check.h"

namespace meshwind::check_kind {

// The plan.

inline constexpr CheckKind kPlan{"plan", "Plan", "courses that can be wound"};
inline constexpr CheckKind kContinuity{
    "continuity",
    "Continuity",
    "fibres that are tied on, and how well their pieces meet",
    {at_most("fibres", "limit", "fibres"), told("worst_joint_mm", "Widest joint")}};
inline constexpr CheckKind kCoverage{"coverage",
                                     "Coverage",
                                     "wall under at least one layer",
                                     {at_least("fraction", "limit", "of the wall")}};
inline constexpr CheckKind kWall{
    "wall",
    "Wall",
    "wall in reach that is as thick as asked for",
    {at_most("below", "limit", "too thin"), told("mean", "Mean, of what was asked for"),
     told("p1", "On 99 %")}};
inline constexpr CheckKind kImport{"import",
                                   "Import",
                                   "how far the landing points were from the mandrel",
                                   {at_most("worst_mm", "limit_mm", "worst"),
                                    told("mean_mm", "Mean"), told("worst_line", "Worst line")}};
inline constexpr CheckKind kEye{"eye",
                                "Eye",
                                "a free length that the rule allows everywhere",
                                {at_most("blocked_points", 0.0, "blocked points")}};

// The program's text.

inline constexpr CheckKind kRounding{"rounding",
                                     "Rounding",
                                     "the program read back is the motion that was planned",
                                     {told("blocks", "blocks")}};
inline constexpr CheckKind kProgram{
    "program", "Program", "the program is the planned one", {told("blocks", "blocks")}};
inline constexpr CheckKind kCode{"code", "Code", "the program as it was written"};
inline constexpr CheckKind kTieOn{"tie_on",
                                  "Tie on",
                                  "the fibre is tied on where it is laid from",
                                  {at_most("off_wall_mm", "limit_mm", "off the wall"),
                                   at_most("off_plan_mm", "limit_mm", "Off the plan")}};
inline constexpr CheckKind kApproach{
    "approach",
    "Approach",
    "rapid moves to the start within the axes and clear of the mandrel",
    {told("rapid_moves", "rapids"), told("stops", "Stops"), told("swept", "Swept")}};
inline constexpr CheckKind kPathMode{"path_mode",
                                     "Path mode",
                                     "the controller passes corners as the machine file asks",
                                     {told("changes", "changes")}};

// Fibre and motion, wound again.

inline constexpr CheckKind kLaydown{"laydown",
                                    "Laydown",
                                    "the fibre comes to lie where it was planned",
                                    {at_most("max_deviation_mm", "limit_mm", "off the plan"),
                                     at_most("max_angle_deg", "limit_deg", "Off its direction"),
                                     told("end_gap_mm", "Gap at the end")}};
inline constexpr CheckKind kSlip{
    "slip", "Slip", "friction holds it there", {at_most("worst", "limit", "")}};
inline constexpr CheckKind kBridging{"bridging",
                                     "Bridging",
                                     "gap under the fibre over hollows",
                                     {at_most("worst_mm", "limit_mm", "gap")}};
inline constexpr CheckKind kCollision{
    "collision",
    "Collision",
    "fibre and head clear of the mandrel",
    {told("min_clearance_mm", "clearance"), at_most("head_hits", 0.0, "Head touches"),
     at_most("fibre_hits", 0.0, "Fibre touches")}};
inline constexpr CheckKind kFreeLength{
    "free_length",
    "Free length",
    "fibre between mandrel and eye",
    {at_least("min_mm", "limit_min_mm", "shortest"), at_most("max_mm", "limit_max_mm", "Longest")}};
inline constexpr CheckKind kRoller{
    "roller",
    "Roller",
    "the fibre leaves the roller at a right angle",
    {at_most("worst_deg", "limit_deg", "worst"), told("mean_twist_deg", "Band twists"),
     told("worst_twist_deg", "At most"), at_most("twist_per_m", "limit_twist_per_m", "Turns"),
     told("turned_over", "Head turned over")}};
inline constexpr CheckKind kLimits{
    "limits",
    "Axis limits",
    "axes within travel, speed and acceleration",
    {at_most("velocity_ratio", 1.0, "speed"), at_most("acceleration_ratio", 1.0, "Acceleration"),
     at_most("corner_mm", "limit_corner_mm", "Corner cut")}};
inline constexpr CheckKind kPayout{"payout",
                                   "Pay-out",
                                   "speed of the fibre through the eye, and length taken back",
                                   {at_most("worst_mm", "limit_mm", "taken back"),
                                    at_most("max_speed_mm_s", "limit_mm_s", "Fibre speed")}};
inline constexpr CheckKind kClosure{"closure",
                                    "Closure",
                                    "the pattern's last circuit ends where its first began",
                                    {at_most("closure_deg", "limit_closure_deg", "off by"),
                                     told("drift_deg", "Drift in the program")}};

// A frame carried through a ring head.

inline constexpr CheckKind kRing{"ring",
                                 "Ring",
                                 "the frame clear of the rings",
                                 {at_most("reach_mm", "limit_mm", "reach"),
                                  told("offset_mm", "Offset"), told("tilt_deg", "Tilt")}};
inline constexpr CheckKind kReach{"reach",
                                  "Reach",
                                  "every pose within the robot's reach",
                                  {told("short_mm", "short"), told("short_deg", "Short")}};
inline constexpr CheckKind kWrist{
    "wrist",
    "Wrist",
    "no axis that jumps",
    {at_most("flips", 0.0, "flips"), told("least_singular", "Least singular value")}};
inline constexpr CheckKind kClearance{"clearance",
                                      "Clearance",
                                      "the frame clear of what stands on the base",
                                      {at_least("least_mm", "limit_mm", "least")}};
inline constexpr CheckKind kInterpolation{
    "interpolation",
    "Interpolation",
    "the axis in the middle of the head between the points",
    {at_most("distance_mm", "limit_mm", "off the centre"), at_most("turn_deg", "limit_deg", "Turn"),
     told("tilt_deg", "Tilt")}};
inline constexpr CheckKind kThickness{"thickness",
                                      "Thickness",
                                      "even layers where the winding is regular",
                                      {at_most("regular_cv", "limit", "scatter")}};

}  // namespace meshwind::check_kind
