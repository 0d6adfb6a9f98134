/// Texts below the options of each command's --help: its purpose with examples, and notes common to
/// all commands. docs/make_reference.py makes the command-line reference, the manual page and the
/// completion of bash from it.
#pragma once

namespace meshwind {

/// Below the options of a command.
constexpr const char* kCommonHelp =
    "Options of every command: --units, --seed, --threads, --json, --quiet, --force; see meshwind "
    "--help.\n"
    "Exit codes: 0 done, 1 a check failed, 2 bad input or usage, 3 internal error.";

constexpr const char* kMainHelp =
    "The main job plans a fibre, turns it into a program, winds that again from its text, and "
    "writes\n"
    "it to the output folder if every check passed. report.html there shows the plan, report.json\n"
    "has all figures. Lengths are mm, angles degrees, times s, the fibre's speed m/min.\n"
    "\n"
    "Examples:\n"
    "  meshwind tee.stl --machine six_axis.json\n"
    "    winds the tee that meshwind brings along; the program is meshwind-out/program.ngc\n"
    "  meshwind part.stl --units mm --machine my_machine.json --job my_job.json -o out\n"
    "    winds a part of one's own as its job says; look at it first: meshwind inspect part.stl\n"
    "\n"
    "meshwind COMMAND --help has the options of a command and its own examples. A bare name that "
    "is\n"
    "not in the current folder is looked up in data (meshes, materials) and machines of the "
    "checkout or "
    "of\n"
    "the installation, or of $MESHWIND_HOME where that is set.\n"
    "\n"
    "Exit codes:\n"
    "  0  done, and every check passed\n"
    "  1  a check failed: the report is written, the program is not (--force writes it)\n"
    "  2  bad input or usage: one line names the file, the place and the mend\n"
    "  3  internal error, or standard output cannot be written\n"
    "  128 + N  ended by signal N, as 130 by Ctrl-C; nothing unfinished is left";

constexpr const char* kWindHelp =
    "Examples:\n"
    "  meshwind wind tee.stl --machine six_axis.json -o out\n"
    "  meshwind wind tee.stl --machine six_axis.json --effort 4 --seed 7 -o other\n"
    "The files of the output folder are described in docs/files.md, the keys of a job in\n"
    "docs/reference/job.md.";

constexpr const char* kPostHelp =
    "The table has columns x_mm,y_mm,z_mm (or x,y,z in the units of the mandrel's file), perhaps\n"
    "course, nx,ny,nz (normal) and tx,ty,tz (direction); its rows are in winding order. The "
    "points\n"
    "are laid on the mandrel, courses that do not meet are joined over it, and from there on all "
    "is\n"
    "as in the main job: the same checks, the same output folder, exit code 1 and no program "
    "where\n"
    "a check fails.\n"
    "\n"
    "Examples:\n"
    "  meshwind post points.csv --mandrel tee.stl --machine six_axis.json\n"
    "  meshwind post meshwind-out/path.csv --frame mandrel --mandrel tee.stl --machine "
    "five_axis.json -o five";

constexpr const char* kVerifyHelp =
    "Nothing but the program, the machine and the mandrel says where the fibre goes. Programs by\n"
    "meshwind name both in their head, and have the job there. The fibre is then\n"
    "checked for slip, bridging, collisions, free length, axis limits and pay-out, and with "
    "--plan\n"
    "compared with what was planned: exit code 1 and the first wrong block where anything fails.\n"
    "\n"
    "Examples:\n"
    "  meshwind verify meshwind-out/program.ngc --plan meshwind-out\n"
    "  meshwind verify other.ngc --mandrel part.stl --machine my_machine.json --job my_job.json "
    "--tie-on 50,0,-120 -o laid";

constexpr const char* kResumeHelp =
    "After a torn fibre, a stop or a power cut: the rest of the program as a program of its own.\n"
    "Its head brings every axis to where the block ended and says where the fibre lies there, to\n"
    "be tied on. It is wound again, and must lay what the whole program lays from there on.\n"
    "\n"
    "Examples:\n"
    "  meshwind resume meshwind-out/program.ngc --block 3120\n"
    "  meshwind resume other.ngc --mandrel part.stl --machine my_machine.json --line 5340 -o "
    "rest.ngc";

constexpr const char* kDryRunHelp =
    "The same increments from a start farther out, so that nothing can meet the part: for the "
    "first\n"
    "run on a machine, without fibre. What is wrong in the machine file, as the sign of an axis, "
    "is\n"
    "seen there.\n"
    "\n"
    "Examples:\n"
    "  meshwind dry-run meshwind-out/program.ngc\n"
    "  meshwind dry-run meshwind-out/program.ngc --clearance 150 -o air.ngc";

constexpr const char* kRepeatHelp =
    "The head of a program says of what mandrel, by what job, machine file, seed and effort it "
    "was\n"
    "made. All of it is done again; the same version of meshwind gives the same blocks. A value "
    "of\n"
    "the job, the mandrel or the machine may be another one.\n"
    "\n"
    "Examples:\n"
    "  meshwind repeat meshwind-out/program.ngc\n"
    "  meshwind repeat meshwind-out/program.ngc --set tow.width=12 -o wider";

constexpr const char* kShowHelp =
    "Of a run: its report.html where that is, else what its first program lays. Of a program: "
    "what\n"
    "it lays, and where it first goes wrong. Of a mesh: what is read from it, as inspect --page.\n"
    "\n"
    "Examples:\n"
    "  meshwind show meshwind-out\n"
    "  meshwind show meshwind-out/program.ngc -o laid.html\n"
    "  meshwind show part.stl";

constexpr const char* kInspectHelp =
    "Prints what is read from the file and what can be done with it: unit and size, repairs,\n"
    "regions with what would be wound of them, rims, how the spindle axis was found, whether it "
    "is\n"
    "a body of revolution or a tube, and how accurate paths on this mesh are.\n"
    "\n"
    "Examples:\n"
    "  meshwind inspect tee.stl\n"
    "  meshwind inspect part.stl --units in --json\n"
    "  meshwind inspect part.stl --page part.html\n"
    "  meshwind inspect coarse.stl --refine 2 -o fine.stl";

constexpr const char* kMakeHelp =
    "meshwind make KIND --help lists the sizes of a kind with their defaults.\n"
    "\n"
    "Examples:\n"
    "  meshwind make cylinder --radius 40 --length 300 -o pipe.stl\n"
    "  meshwind make tee --branch-radius 25 --lean 20 --edge 4 -o lateral.stl";

constexpr const char* kTraceHelp =
    "The path starts at --start and goes on as a geodesic, or with the slip ratio of --lambda, "
    "until\n"
    "it meets a rim or has its length; with --to it is the path that ends there. The table has\n"
    "place, normal, direction, curvatures, slip and bridging of each point.\n"
    "\n"
    "Examples:\n"
    "  meshwind trace tee.stl --start 0,-50,0 --angle 45 -o path.csv\n"
    "  meshwind trace tee.stl --start 0,-50,-100 --to 0,-50,100 --lambda 0.1 -o path.csv";

constexpr const char* kMachinesHelp =
    "A name of the list is enough for --machine; docs/how-to/own_machine.md tells how to write a\n"
    "file for your own.\n"
    "\n"
    "Example:\n"
    "  meshwind machines";

constexpr const char* kProfilesHelp =
    "A profile is a file with keys of a job, for what the job itself leaves out: a material\n"
    "(tow width, thickness, density, price_per_kg) or a process (friction, speed, tolerances). A\n"
    "name of the list is enough for --profile; of several the last one counts.\n"
    "\n"
    "Examples:\n"
    "  meshwind profiles\n"
    "  meshwind part.stl --profile glass_2400tex --profile wet_winding";

constexpr const char* kValidateHelp =
    "A file with a key \"schema\" or \"eye_chain\" is read as a machine, any other as a job. Of a\n"
    "machine its class is told, its axes, and whether the main job can be run with it.\n"
    "\n"
    "Examples:\n"
    "  meshwind validate six_axis.json\n"
    "  meshwind validate --schema machine > machine.schema.json\n"
    "  meshwind validate my_job.json && meshwind part.stl --job my_job.json";

constexpr const char* kDesignHelp =
    "A cylinder with isotensoid domes: dome, and for each winding angle turn and length of its\n"
    "geodesics, circuits and layers for the wanted wall or pressure (without either one layer of\n"
    "each hand), fibre, mass and the thickest place of the dome. Angles that no geodesic can keep\n"
    "are named with the slip that they would need. With -o mesh and job of the angle that takes\n"
    "the least fibre are written, as the main job winds them.\n"
    "\n"
    "Examples:\n"
    "  meshwind design vessel --radius 40 --opening 15 --length 80 --e1 132 --e2 10.3 --nu12 0.25\n"
    "  meshwind design vessel --radius 150 --opening 40 --length 600 --pressure 70 --strength "
    "1200\n"
    "  meshwind design vessel --radius 40 --opening 15 --length 80 --wall 1 -o vessel";

constexpr const char* kCarryHelp =
    "The head stands still; the robot moves a slender frame through its two rings, which turn "
    "about\n"
    "one axis and lay tows around the frame: the first ring on the way forth, the second on the "
    "way\n"
    "back. The table has the points of the frame's axis, columns x_mm,y_mm,z_mm, and perhaps "
    "tx,ty,tz\n"
    "(direction), rx,ry,rz (what is to meet the head's reference) and turn_deg (turn about the "
    "axis);\n"
    "a mesh gives axis and radius by itself. Written are NAME.src and NAME_back.src (KUKA KRL, "
    "only if\n"
    "every check passed), rings.csv for the drives of the rings, fibre.csv with the fibre that "
    "they\n"
    "lay, motion.csv and report.json.\n"
    "\n"
    "Examples:\n"
    "  meshwind carry l_frame_axis.csv\n"
    "  meshwind carry frame.stl --tow-width 6 --friction 0.4\n"
    "  meshwind carry axis.csv --machine my_robot.json --tool 0,0,120,0,0,0 --speed 30";

constexpr const char* kCaseHelp =
    "Winds the mandrel of one row of a table, as the main job does, into DIR/ID; then DIR/ID.json\n"
    "says how that ended. Columns: id, a folder's name; mandrel; machine [six_axis.json]; job; "
    "and\n"
    "any key of a job, whose cell, if not empty, is put over it. Rows do not know of each other:\n"
    "they run at the same time, on one computer or on many with a common disk.\n"
    "\n"
    "Examples:\n"
    "  meshwind study cases cases.csv --row 7 -o out\n"
    "  parallel meshwind --quiet study cases cases.csv --row {} -o out ::: 1 2 3 4\n";

constexpr const char* kMergeHelp =
    "Writes DIR/cases.csv: a line for each row, with its outcome, inputs and figures. Rows "
    "without\n"
    "an end, or whose inputs have changed since, are missing. Exit code 1 where rows failed or "
    "are\n"
    "missing.\n"
    "\n"
    "Examples:\n"
    "  meshwind study merge cases.csv -o out\n"
    "  sbatch --array=$(meshwind study merge cases.csv -o out --left) cases.sh\n";

constexpr const char* kExportFeHelp =
    "Every triangle of the mandrel is a shell with the plies that a run lays on it (layup.json).\n"
    "The deck is ready to be run: material, supports that hold the body and strain nothing, and\n"
    "loads in balance. Pressure pulls at the rims as lids over them would.\n"
    "\n"
    "Examples:\n"
    "  meshwind export fe meshwind-out --format abaqus -o tee.inp\n"
    "  meshwind export fe meshwind-out --format nastran --axial 10000 --rims 1,2\n";

constexpr const char* kStrengthHelp =
    "Computes the deck of export fe with CalculiX (Debian: calculix-ccx), and judges the stresses\n"
    "of every ply by the criterion of Tsai and Wu: by how much the load can grow until the first\n"
    "ply fails, where, and which.\n"
    "\n"
    "Examples:\n"
    "  meshwind strength meshwind-out --pressure 4\n"
    "  meshwind strength meshwind-out --material my_glass.json --moment 0,250000,0 -o bent\n";

constexpr const char* kMeshSizeHelp =
    "Lays the same random fibres on ever finer meshes of known surfaces and compares them with "
    "the\n"
    "exact fibres: the path's end, the winding angle and the slip; then, with the fibre's "
    "direction\n"
    "taken from the landing points by chord (P1-P2), central chord (P1-P3), parabola or tracer, "
    "the\n"
    "spindle angle C and the eye point. An error that falls by 2^k when the edges are halved is "
    "of\n"
    "order k.\n"
    "Cylinders are compared with closed forms; torus, ellipsoid and tee with the differential\n"
    "equation of their exact surface; a CAD part with its exact faces; another file with itself,\n"
    "coarsened: choose edges well above its own, and mind that what its own mesh has wrong is not\n"
    "seen.\n"
    "To choose a mesh for a part: take the row of the surface most like it, and the edge length "
    "at\n"
    "which the error that matters is small enough.\n"
    "\n"
    "Examples:\n"
    "  meshwind study mesh-size\n"
    "  meshwind study mesh-size --mandrel cylinder --radius 35 --edges 8,4,2,1 -o pipe\n"
    "  meshwind study mesh-size --mandrel part.stl --edges 12,8,6";

}  // namespace meshwind
