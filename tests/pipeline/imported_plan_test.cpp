// Landing points that were made elsewhere, against exact paths on a pipe.
#include "pipeline/imported_plan.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/text/text_number.h"
#include "core/units.h"
#include "pipeline/plan_layer.h"
#include "postproc/tables/path_csv.h"
#include "tests/support/any_machine.h"
#include "tests/support/exact_winding.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using test::kPipeRadius_mm;
using test::Refused;

// The mesh's patches are off the ideal pipe by fourth order in edges of 6 mm.
constexpr double kOnWall_mm = 0.01;

// Directions by parabolas through points h apart are off by h^2 / 3 of the third derivative at the
// ends of a path, sin(a)^3 / R^2 of a helix: 16 * 5e-4 / 3.
constexpr double kTangent = 2.7e-3;

const meshwind::Setup& pipe_setup() {
    static const meshwind::Setup setup =
        make_setup(test::small_pipe(), test::shipped("six_axis"), test::pipe_job());
    return setup;
}

// What joins courses looks for the shortest way over all facets of the wall: few are enough.
meshwind::Setup with_short_extensions(double friction = 0.2) {
    Job job = test::pipe_job();
    job.mandrel.extension_mm = 2.0;
    job.tow.friction = friction;
    return make_setup(test::made_cylinder(kPipeRadius_mm, 120.0, 10.0), test::shipped("six_axis"),
                      job);
}

// On the exact pipe from the height z in steps of 4 mm, at 50 degrees to its axis where it begins.
std::vector<Vector3d> path_on_pipe(double z_mm, double length_mm, double slip_ratio = 0.0,
                                   double azimuth_rad = 0.0) {
    const double angle_rad = rad_from_deg(test::kPipeAngle_deg);
    const Vector3d out(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
    const Vector3d around = Vector3d::UnitZ().cross(out);
    const test::CurveState start{
        kPipeRadius_mm * out + z_mm * Vector3d::UnitZ(),
        std::sin(angle_rad) * around + std::cos(angle_rad) * Vector3d::UnitZ()};
    const test::ExactCurve curve =
        test::exact_curve(test::ExactCylinder{kPipeRadius_mm}, start, slip_ratio, 4.0, length_mm);
    std::vector<Vector3d> points;
    for (const test::CurveState& state : curve.states) {
        points.push_back(state.position_mm);
    }
    return points;
}

constexpr const char* kHead = "course,x_mm,y_mm,z_mm\n";

std::string rows(const std::string& course, const std::vector<Vector3d>& points) {
    std::string text;
    for (const Vector3d& p : points) {
        text +=
            course + ',' + fixed(p.x(), 6) + ',' + fixed(p.y(), 6) + ',' + fixed(p.z(), 6) + '\n';
    }
    return text;
}

struct Imported {
    Plan plan;
    ImportFit fit;
};

Imported imported(const std::string& text, bool mandrel_frame = true,
                  const meshwind::Setup& setup = pipe_setup()) {
    Imported found;
    found.plan =
        import_plan(setup, {.points = {"tables/points.csv", text}, .mandrel_frame = mandrel_frame},
                    1, found.fit);
    return found;
}

Refused refused(const std::string& text, const meshwind::Setup& setup = pipe_setup()) {
    return test::refusal_of([&] { (void)imported(text, true, setup); });
}

Refused at_line(const std::string& code, int line) {
    return {code, "tables/points.csv:" + std::to_string(line)};
}

std::vector<Vector3d> backwards(std::vector<Vector3d> points) {
    std::reverse(points.begin(), points.end());
    return points;
}

TEST(ImportedPlan, AGeodesicIsLaidWithoutSlip) {
    const std::vector<Vector3d> points = path_on_pipe(-40.0, 120.0);
    const auto [plan, fit] = imported(kHead + rows("a", points));
    EXPECT_EQ(plan.failure, "");
    EXPECT_EQ(plan.planner, Planner::Imported);
    EXPECT_EQ(plan.courses, 1);
    EXPECT_EQ(plan.fibres, 1);
    ASSERT_EQ(plan.pieces.size(), 1U);
    EXPECT_TRUE(plan.pieces.front().starts_fibre);
    const SurfacePath& path = plan.pieces.front().path;
    ASSERT_EQ(path.size(), points.size());
    for (std::size_t i = 0; i < path.size(); ++i) {
        EXPECT_LT((path[i].position_mm - points[i]).norm(), kOnWall_mm);
        EXPECT_NEAR(path[i].tangent.z(), std::cos(rad_from_deg(test::kPipeAngle_deg)), kTangent);
    }
    EXPECT_NEAR(plan.fibre_length_mm, 120.0, kOnWall_mm);
    // Curvature from neighbours that are off by kOnWall_mm: 4 off / h^2 over chords of the tow's
    // width, against sin(a)^2 / R.
    EXPECT_LT(plan.worst_slip, 0.02);
    EXPECT_EQ(plan.worst_bridge_mm, 0.0);
    EXPECT_EQ(fit.file, "points.csv");
    EXPECT_EQ(fit.points, points.size());
    EXPECT_EQ(fit.repeated, 0U);
    EXPECT_EQ(fit.joins, 0U);
    EXPECT_LT(fit.worst_mm, kOnWall_mm);
    EXPECT_LE(fit.mean_mm, fit.worst_mm);
    EXPECT_EQ(fit.limit_mm, 1.0);
    EXPECT_TRUE(fit.mandrel_frame);
}

// A path that is steered with kg = k kn needs the friction k.
TEST(ImportedPlan, TheSlipIsThatOfThePath) {
    for (const double ratio : {0.1, -0.15, 0.3}) {
        const auto [plan, fit] = imported(kHead + rows("a", path_on_pipe(-40.0, 100.0, ratio)));
        const Piece& course = plan.pieces.front();
        // Ends are measured from one side only.
        for (std::size_t i = 3; i + 3 < course.slip.size(); ++i) {
            EXPECT_NEAR(course.slip[i], std::abs(ratio), 0.02);
            EXPECT_GT(course.path[i].kg_per_mm * ratio, 0.0);
        }
        EXPECT_GE(plan.worst_slip, std::abs(ratio) - 0.02);
    }
}

TEST(ImportedPlan, TellsTheRowThatIsFarthestOff) {
    std::vector<Vector3d> points = path_on_pipe(-40.0, 120.0);
    points[12] += 0.5 * Vector3d(points[12].x(), points[12].y(), 0.0).normalized();
    points.insert(points.begin() + 20, points[20]);
    const auto [plan, fit] = imported(kHead + rows("a", points));
    EXPECT_NEAR(fit.worst_mm, 0.5, kOnWall_mm);
    EXPECT_EQ(fit.worst_line, 14);  // after the head
    EXPECT_EQ(fit.repeated, 1U);
    EXPECT_EQ(fit.points, points.size());
    EXPECT_NEAR(fit.mean_mm, 0.5 / static_cast<double>(fit.points), kOnWall_mm);
    // The point is laid below where it is.
    EXPECT_LT((plan.pieces.front().path[12].position_mm - path_on_pipe(-40.0, 120.0)[12]).norm(),
              2.0 * kOnWall_mm);
    points[12] += 1.0 * Vector3d(points[12].x(), points[12].y(), 0.0).normalized();
    EXPECT_EQ(refused(kHead + rows("a", points)), at_line("import.too_far", 14));
}

// Two stretches of one helix: the way between them is the helix itself.
TEST(ImportedPlan, CoursesThatDoNotMeetAreJoined) {
    const meshwind::Setup setup = with_short_extensions();
    const std::vector<Vector3d> whole = path_on_pipe(-50.0, 140.0);
    const std::vector<Vector3d> first(whole.begin(), whole.begin() + 16);  // 60 mm
    const std::vector<Vector3d> second(whole.begin() + 20, whole.end());   // from 80 mm on
    const auto [plan, fit] = imported(kHead + rows("a", first) + rows("b", second), true, setup);
    EXPECT_EQ(fit.joins, 1U);
    ASSERT_EQ(plan.pieces.size(), 3U);
    EXPECT_EQ(plan.pieces[1].kind, PieceKind::Transition);
    EXPECT_EQ(plan.courses, 2);
    EXPECT_NEAR(plan.pieces[1].path.back().s_mm, 20.0, 2.0 * kOnWall_mm);
    EXPECT_NEAR(plan.fibre_length_mm, 140.0, 4.0 * kOnWall_mm);
    for (const PathPoint& at : plan.pieces[1].path) {
        // A patch of edges of 10 mm is off the pipe by fourth order: eight times that of 6 mm.
        EXPECT_NEAR(at.position_mm.head<2>().norm(), kPipeRadius_mm, 8.0 * kOnWall_mm);
    }
    EXPECT_LT(plan.worst_slip, setup.job.tow.friction);
    // Where they meet nothing is added.
    const std::vector<Vector3d> rest(whole.begin() + 15, whole.end());
    const Imported met = imported(kHead + rows("a", first) + rows("b", rest), true, setup);
    EXPECT_EQ(met.fit.joins, 0U);
    EXPECT_EQ(met.plan.pieces.size(), 2U);
    EXPECT_LT(met.plan.worst_joint_mm, 2.0 * kOnWall_mm);
}

TEST(ImportedPlan, CoursesThatCannotBeJoinedAreRefused) {
    // Back on the same line: no fibre turns on the spot.
    const std::vector<Vector3d> up = path_on_pipe(-40.0, 80.0);
    EXPECT_EQ(refused(kHead + rows("a", up) + rows("b", backwards(up))),
              at_line("import.not_joined", 2 + static_cast<int>(up.size())));
    // 1 mm up the pipe, 1 sin(50 deg) = 0.77 mm aside, within 40 mm: two arcs of kg = 4 * 0.77 /
    // 40^2 = 0.0019 per mm against kn = sin(50 deg)^2 / 30 = 0.0196 need a friction of 0.1.
    const std::vector<Vector3d> whole = path_on_pipe(-40.0, 120.0);
    const std::vector<Vector3d> first(whole.begin(), whole.begin() + 6);
    std::vector<Vector3d> aside;
    for (std::size_t i = 15; i < whole.size(); ++i) {
        aside.emplace_back(whole[i] + Vector3d::UnitZ());
    }
    const std::string table = kHead + rows("a", first) + rows("b", aside);
    EXPECT_EQ(refused(table, with_short_extensions(0.15)), Refused{});
    EXPECT_EQ(refused(table, with_short_extensions(0.05)), at_line("import.not_joined", 8));
}

TEST(ImportedPlan, TablesThatCannotBeReadAreRefusedWithTheirLine) {
    EXPECT_EQ(refused("course,x_mm,y_mm\na,1,2\n"), at_line("import.column", 1));
    EXPECT_EQ(refused(""), at_line("import.column", 1));
    EXPECT_EQ(refused(std::string(kHead) + "a,30,0,0\na,30,zero,4\n"), at_line("import.number", 3));
    EXPECT_EQ(refused(kHead).code, "import.empty");
    EXPECT_EQ(refused(std::string(kHead) + "a,30,0,0\n").code, "import.empty");
    // Points a quarter of the way around apart: a hoop turns by 90 degrees from one to the next.
    EXPECT_EQ(refused(std::string(kHead) + "a,30,0,0\na,0,30,0\na,-30,0,0\na,0,-30,0\n").code,
              "import.sparse");
}

// A part in cm whose spindle is the x axis of its file.
TEST(ImportedPlan, TablesInTheFrameOfTheFileAreTheSame) {
    const MandrelOptions::Axis along_x{Vector3d::Zero(), Vector3d::UnitX()};
    TriangleSoup soup =
        make_mandrel("cylinder", {{"radius", kPipeRadius_mm}, {"length", 120.0}}, {.edge_mm = 6.0});
    Eigen::Matrix3d turned;
    turned << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // z to x, x to y, y to z
    for (Vector3d& p : soup.points_mm) {
        p = turned * p / 10.0;
    }
    Job job = test::pipe_job();
    const meshwind::Setup setup =
        make_setup(build_mandrel(soup, "pipe.stl", {.unit_mm = 10.0, .axis = along_x}),
                   test::shipped("six_axis"), job);
    std::vector<Vector3d> in_file_mm = path_on_pipe(-40.0, 120.0);
    for (Vector3d& p : in_file_mm) {
        p = turned * p;
    }
    std::vector<Vector3d> in_file_cm = in_file_mm;
    for (Vector3d& p : in_file_cm) {
        p /= 10.0;
    }
    const Imported mm = imported(kHead + rows("a", in_file_mm), false, setup);
    const Imported cm = imported("course,x,y,z\n" + rows("a", in_file_cm), false, setup);
    for (const Imported& found : {mm, cm}) {
        EXPECT_LT(found.fit.worst_mm, kOnWall_mm);
        EXPECT_NEAR(found.plan.fibre_length_mm, 120.0, 2.0 * kOnWall_mm);
        EXPECT_FALSE(found.fit.mandrel_frame);
        for (const PathPoint& at : found.plan.pieces.front().path) {
            EXPECT_NEAR(at.tangent.z(), std::cos(rad_from_deg(test::kPipeAngle_deg)), kTangent);
        }
    }
    EXPECT_LT((mm.plan.pieces.front().path.back().position_mm -
               cm.plan.pieces.front().path.back().position_mm)
                  .norm(),
              1e-4);  // decimals of the table, in cm
}

// What is planned, written as path.csv and given back: the same fibre.
TEST(ImportedPlan, APlanGivenBackIsTheSameFibre) {
    LayerJob layer;
    layer.kind = LayerKind::Helical;
    layer.angle_deg = test::kPipeAngle_deg;
    const Plan plan = plan_layer(pipe_setup(), layer, test::AnyMachine()).plan;
    ASSERT_EQ(plan.failure, "");
    const auto [again, fit] = imported(path_csv(plan.pieces, landing_points(plan.pieces).path));
    EXPECT_EQ(again.courses, plan.courses);
    EXPECT_EQ(again.fibres, 1);
    EXPECT_EQ(fit.joins, 0U);
    EXPECT_LT(fit.worst_mm, kOnWall_mm);
    ASSERT_EQ(again.pieces.size(), plan.pieces.size());
    for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
        EXPECT_EQ(again.pieces[i].kind, plan.pieces[i].kind);
        const SurfacePath& was = plan.pieces[i].path;
        const SurfacePath& is = again.pieces[i].path;
        EXPECT_NEAR(is.back().s_mm, was.back().s_mm, kOnWall_mm);
        EXPECT_LT((is.front().position_mm - was.front().position_mm).norm(), kOnWall_mm);
        EXPECT_LT((is.back().position_mm - was.back().position_mm).norm(), kOnWall_mm);
    }
    EXPECT_NEAR(again.fibre_length_mm, plan.fibre_length_mm,
                kOnWall_mm * static_cast<double>(plan.pieces.size()));
    // Measured instead of exact.
    EXPECT_NEAR(again.worst_slip, plan.worst_slip, 0.02);
    // Both are measured on the samples of one seed. Bands of courses that are given end squarely
    // at the rim, those of planned ones run on into the turns: at each end a triangle of (w / 2)^2
    // tan(a) / 2 makes the difference.
    const double triangle_mm2 = 0.125 * test::kPipeTow_mm * test::kPipeTow_mm *
                                std::tan(rad_from_deg(test::kPipeAngle_deg));
    const double wall_mm2 = 2.0 * kPi * kPipeRadius_mm * test::kPipeLength_mm;
    EXPECT_NEAR(again.coverage.mean_layers,
                plan.coverage.mean_layers - 2.0 * plan.courses * triangle_mm2 / wall_mm2, 0.02);
}

}  // namespace
}  // namespace meshwind
