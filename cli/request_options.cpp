// Options of the commands that take many numbers: made meshes, studies, carried frames, vessels.
#include "cli/options.h"

namespace meshwind {
namespace {

void add_number(CLI::App& app, const char* name, const char* unit, double& value,
                const char* help) {
    app.add_option(name, value, help)->type_name(unit)->capture_default_str();
}

// What stands for a parameter's value in the help.
std::string name_of_unit(const MakeParameter& parameter) {
    switch (parameter.unit) {
        case MakeUnit::Angle:
            return "DEG";
        case MakeUnit::Ratio:
            return "RATIO";
        default:
            return "MM";
    }
}

void add_carried_frame(CLI::App& app, CarryArguments& text) {
    app.add_option("axis", text.axis,
                   "table of points along the frame's axis, CSV, columns below; or the frame's "
                   "mesh: .stl, .obj, .ply, .off")
        ->type_name("FILE")
        ->required();
    app.add_flag("--from-end", text.from_the_end, "of a mesh: begin at its other end");
    app.add_option("--bend-turn", text.bend_turn_deg,
                   "of a mesh: turn of the frame about its axis over each bend, degrees")
        ->type_name("DEG")
        ->capture_default_str();
    app.add_option("--machine", text.machine,
                   "machine file, JSON: a robot whose eye stands still, in the head's centre")
        ->type_name("FILE")
        ->capture_default_str();
    app.add_option("--tool", text.tool,
                   "X,Y,Z,A,B,C of the table's coordinates on the robot's flange, mm and degrees")
        ->type_name("X,Y,Z,A,B,C")
        ->capture_default_str();
}

void add_carried_motion(CLI::App& app, CarryRequest& request) {
    add_number(app, "--speed", "MM/S", request.speed_mm_s,
               "speed of the frame through the head, mm/s");
    add_number(app, "--tolerance", "MM", request.tolerance_mm,
               "how far the axis may be off the head's centre, mm");
    add_number(app, "--tolerance-angle", "DEG", request.tolerance_deg,
               "how far the frame's turn may be off, degrees");
}

void add_rings(CLI::App& app, CarryRequest& request) {
    app.add_option("--tube-radius", request.tube_radius_mm,
                   "radius of the frame's tube, mm; without it that of the mesh, or 20")
        ->type_name("MM");
    add_number(app, "--ring-radius", "MM", request.ring_radius_mm,
               "radius of the rings' clear opening, mm");
    add_number(app, "--ring-distance", "MM", request.ring_distance_mm,
               "distance between the two rings, mm");
    add_number(app, "--clearance", "MM", request.clearance_mm,
               "distance to keep between the frame and the bodies on the machine's base, mm");
    add_number(app, "--angle", "DEG", request.angle_deg,
               "wanted angle of the rings' fibres from the axis, degrees");
    app.add_option("--tows", request.tows, "tows on each ring")
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--tow-width", request.tow_width_mm,
                   "mm; without it the narrowest that covers the tube in one pass")
        ->type_name("MM");
}

void add_ring_winding(CLI::App& app, CarryWindingOptions& winding) {
    app.add_option("--passes", winding.passes,
                   "passes of each ring; 0: as few as cover the tube with tows of that width")
        ->type_name("N")
        ->check(CLI::Range(0, 100))
        ->capture_default_str();
    app.add_flag("--at-once", winding.at_once,
                 "both rings wind on the way forth, instead of one on each way");
    app.add_option("--spool-radius", winding.spool_radius_mm,
                   "radius of the circle where fibres leave a ring, mm; without it its opening")
        ->type_name("MM");
    add_number(app, "--angle-tolerance", "DEG", winding.angle_tolerance_deg,
               "how far laid fibre may be off the angle on regular arms, degrees");
    app.add_option("--friction", winding.friction,
                   "of fibre on the tube: no more may be needed; without it the need is told")
        ->type_name("RATIO");
    app.add_option("--tow-tex", winding.tow_tex, "mass of the tow, g per km, to tell the fibre's")
        ->type_name("TEX");
}

// The moduli are one ply, all three of them.
void add_ply(CLI::App& app, DesignRequest& request) {
    auto* ke = app.add_option("--ke", request.ke,
                              "E2 (1 + nu12) / (E1 (1 + nu21)) of the ply; 0: fibres alone [0.1]")
                   ->type_name("RATIO");
    const auto modulus = [&](const char* name, const char* unit, double PlyStiffness::*member,
                             const char* help) {
        return app
            .add_option_function<double>(
                name,
                [&request, member](const double& value) {
                    request.ply = request.ply.value_or(PlyStiffness{});
                    (*request.ply).*member = value;
                },
                help)
            ->type_name(unit)
            ->excludes(ke);
    };
    auto* e1 = modulus("--e1", "GPA", &PlyStiffness::e1_gpa, "stiffness along the fibres, GPa");
    auto* e2 = modulus("--e2", "GPA", &PlyStiffness::e2_gpa, "stiffness across them, GPa");
    auto* nu12 =
        modulus("--nu12", "RATIO", &PlyStiffness::nu12, "Poisson's ratio for a pull along them");
    e1->needs(e2)->needs(nu12);
    e2->needs(e1);
    nu12->needs(e1);
}

}  // namespace

// One subcommand per kind, with an option for each of its parameters.
void add_make(CLI::App& app, MakeRequest& request) {
    app.require_subcommand(1);
    app.fallthrough();
    app.add_option("-o,--out", request.output, "mesh file to write: .stl, .obj, .ply or .off")
        ->type_name("FILE");
    app.add_option("--edge", request.options.edge_mm, "edge length, mm")
        ->type_name("MM")
        ->capture_default_str();
    app.add_flag("--irregular", request.options.irregular,
                 "jittered vertices and random diagonals");
    app.add_flag("--solid", request.options.solid, "with inner wall and end faces");
    app.add_option("--wall", request.options.wall_mm, "wall thickness of a solid, mm")
        ->type_name("MM")
        ->capture_default_str();
    for (const MakeKind& kind : make_kinds()) {
        CLI::App* sub = app.add_subcommand(std::string(kind.name), std::string(kind.meaning));
        sub->fallthrough();
        sub->callback([&request, sub] { request.kind = sub->get_name(); });
        for (const MakeParameter& parameter : kind.parameters) {
            const std::string name(parameter.name);
            sub->add_option_function<double>(
                   "--" + name,
                   [&request, name](const double& value) { request.shown_values[name] = value; },
                   help_of(parameter))
                ->type_name(name_of_unit(parameter));
        }
    }
}

void add_mesh_size(CLI::App& app, StudyArguments& request) {
    MeshSizeOptions& options = request.options;
    request.out = "study-mesh-size";
    app.add_option(
           "--mandrel", request.mandrels,
           "cylinder, torus, ellipsoid, tee, or a mesh file; several may be named [all four]")
        ->type_name("NAME");
    app.add_option("--radius", request.radii_mm, "radii of the cylinders, mm")
        ->type_name("MM")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--edges", options.edges_mm, "edge lengths of the meshes, mm")
        ->type_name("MM")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--lambda", options.slip_ratios,
                   "slip ratios kg / kn to steer with; the eye is shown for the first")
        ->type_name("RATIO")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--paths", options.paths, "fibres on each mesh")
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--length", options.length_mm, "length of a fibre unless it meets a rim, mm")
        ->type_name("MM")
        ->capture_default_str();
    app.add_option("--free-length", options.free_length_mm, "from landing point to eye, mm")
        ->type_name("MM")
        ->capture_default_str();
    app.add_flag("--irregular,!--regular", options.irregular,
                 "jittered vertices and random diagonals, as scans and CAD give them [irregular]");
    app.add_flag("--timing", options.timing,
                 "measure the cost of tracing too, one mesh at a time; writes timing.csv");
    app.add_option("-o,--out", request.out, "output folder")
        ->type_name("DIR")
        ->capture_default_str();
}

void add_carry(CLI::App& app, CarryArguments& text) {
    CarryRequest& request = text.request;
    add_carried_frame(app, text);
    add_carried_motion(app, request);
    add_rings(app, request);
    add_ring_winding(app, request.winding);
    app.add_option("--name", request.name, "name of the program")
        ->type_name("NAME")
        ->capture_default_str();
    app.add_option("-o,--out", text.out, "output folder")->type_name("DIR")->capture_default_str();
}

void add_design_vessel(CLI::App& app, DesignArguments& arguments) {
    DesignRequest& request = arguments.request;
    VesselDesign& design = request.design;
    app.add_option("--radius", design.radius_mm, "radius of the cylinder, mm")
        ->type_name("MM")
        ->required();
    app.add_option("--opening", design.opening_radius_mm, "radius of the polar openings, mm")
        ->type_name("MM")
        ->required();
    app.add_option("--length", design.cylinder_length_mm, "length of the cylinder, mm")
        ->type_name("MM")
        ->required();
    add_ply(app, request);
    add_number(app, "--design-radius", "MM", design.design_radius_mm,
               "Clairaut radius of the geodesics the domes are made for, mm; 0: the opening's");
    request.angles_deg = {10, 15, 20, 25, 30, 35, 40, 45, 50, 55};
    app.add_option("--angles", request.angles_deg, "winding angles on the cylinder, degrees")
        ->type_name("DEG")
        ->delimiter(',')
        ->capture_default_str();
    add_number(app, "--band", "MM", design.band_mm, "width of the band, mm");
    add_number(app, "--thickness", "MM", design.ply_mm, "thickness of the band, mm");
    add_number(app, "--density", "KG/M3", design.density_kg_m3, "of the band, kg/m3");
    app.add_option("--wall", design.wall_mm, "wanted thickness on the cylinder, mm")
        ->type_name("MM");
    app.add_option("--pressure", design.pressure_mpa, "wanted pressure, MPa; needs --strength")
        ->type_name("MPA");
    app.add_option("--strength", design.strength_mpa,
                   "of the band along its fibres, MPa, safety taken off")
        ->type_name("MPA");
    app.add_option("-o,--out", arguments.out,
                   "folder for vessel.stl and job.json, of the angle that takes the least fibre")
        ->type_name("DIR");
}

}  // namespace meshwind
