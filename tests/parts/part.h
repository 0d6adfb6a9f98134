/// A part as it is drawn: legs that meet in a body, and what a modeller puts onto them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <TopoDS_Shape.hxx>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>

#include "profile.h"
#include "random.h"

namespace cad_part {

/// The leg goes on with another radius.
struct Step {
    double at_mm = 0.0;      ///< from the leg's root
    double change_mm = 0.0;  ///< of the radius, signed
    double slope_mm = 0.0;   ///< along the leg; 0: a sharp step
};

/// A thicker ring at the leg's end.
struct Socket {
    double thickness_mm = 0.0;  ///< beyond the leg's radius
    double length_mm = 0.0;
    double slope_mm = 0.0;  ///< of the chamfer before it; 0: a sharp step
    bool widened = false;   ///< the bore has the leg's outer radius here, for a pipe to go in
};

enum class EndEdge { Sharp, Lip, Chamfer };

struct Leg {
    gp_Ax2 frame;            ///< root and direction to the end; X points to where letters may stand
    double radius_mm = 0.0;  ///< at the root
    double length_mm = 0.0;  ///< from the root to the end face
    double free_from_mm = 0.0;       ///< from the root on: what other legs leave alone
    double letter_turn_deg = 180.0;  ///< to either side of X there is room for letters
    std::optional<Step> step{};
    std::optional<Socket> socket{};
    EndEdge edge = EndEdge::Sharp;
    double edge_mm = 0.0;
    bool tabs = false;

    [[nodiscard]] double behind_socket_mm() const {
        return radius_mm + (step ? step->change_mm : 0.0);
    }
    [[nodiscard]] double end_radius_mm() const {
        return behind_socket_mm() + (socket ? socket->thickness_mm : 0.0);
    }
    /// To where the pipe has its radius at the root.
    [[nodiscard]] double free_to_mm() const {
        if (step) {
            return step->at_mm;
        }
        return length_mm - (socket ? socket->length_mm + socket->slope_mm : edge_mm);
    }
};

struct Bend {
    gp_Ax1 axis;  ///< from the root of leg 0 to that of leg 1
    double angle_rad = 0.0;
};

/// What a modeller would have meant; drawn before anything is made.
struct Part {
    std::string kind;
    std::vector<Leg> legs{};
    bool coaxial = false;  ///< legs 0 and 1 are one body of revolution with what is between them
    /// Outline between their roots, both included, for a wall that much further in; along leg 1.
    std::function<std::vector<Corner>(double)> middle{};
    std::optional<Bend> bend{};
    std::optional<double> ball_mm{};  ///< radius of the ball at the node of the legs
    std::optional<gp_Ax1> axis{};     ///< the spindle, where there is no doubt
    std::optional<double> wall_mm{};  ///< hollow
    std::optional<double> fillet_mm{};
    bool letters = false;
    bool skin = false;  ///< only the outer wall is exported
    std::vector<std::string> details{};
    std::string cause{};  ///< why it cannot be wound; empty: no reason
    int victim = 0;       ///< leg with the cause
};

/// What is left out of the mesh of a part: facets of a leg's wall.
struct MissingFace {
    gp_Ax2 frame;
    double radius_mm = 0.0;
    double from_mm = 0.0;
    double to_mm = 0.0;
    double middle_rad = 0.0;  ///< about the frame's direction, from its X
    double half_rad = 0.0;
};

struct Built {
    TopoDS_Shape shape;
    std::optional<MissingFace> missing{};
};

/// A part of a kind drawn at random, legs bare.
[[nodiscard]] Part draw_kind(Random& random);

/// Adds up to four details, and in one of ten parts a cause of refusal.
void draw_details(Part& part, Random& random);

/// None where the kernel fails with what no part can do without. What else it does not make is no
/// detail of the part any more.
[[nodiscard]] std::optional<Built> build(Part& part, Random& random);

/// Raised letters on one of the legs. None where there is no room or the kernel fails.
[[nodiscard]] std::optional<TopoDS_Shape> with_letters(const Part& part, const TopoDS_Shape& shape,
                                                       Random& random);

/// Small blocks on the end faces of the legs that have tabs.
[[nodiscard]] std::optional<TopoDS_Shape> with_tabs(const Part& part, const TopoDS_Shape& shape,
                                                    Random& random);

/// The cause of refusal put into the finished shape. \pre part.cause is not empty
[[nodiscard]] std::optional<Built> spoilt(const Part& part, const TopoDS_Shape& shape,
                                          Random& random);

void drop_detail(Part& part, const std::string& detail);

}  // namespace cad_part
