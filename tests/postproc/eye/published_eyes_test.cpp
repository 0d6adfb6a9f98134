// Eye positions and programs that papers print, by the rules and axes of this project.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "machines/machine_json.h"
#include "postproc/eye/eye_rules.h"
#include "postproc/motion/block.h"
#include "postproc/motion/joint_path.h"
#include "postproc/motion/time_law.h"
#include "tests/support/synthetic_paths.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::json;

const std::string kSource = MESHWIND_SOURCE_DIR;

Json reference(const std::string& name) {
    std::ifstream in(kSource + "/data/reference/" + name);
    return Json::parse(in);
}

PathPoint station(double radius_mm, double turn_rad, double z_mm, const Vector3d& tangent,
                  double s_mm) {
    const Eigen::AngleAxisd turned(turn_rad, Vector3d::UnitZ());
    PathPoint point;
    point.position_mm = turned * Vector3d(radius_mm, 0.0, z_mm);
    point.tangent = turned * tangent;
    point.normal = (turned * Vector3d::UnitX()).cross(point.tangent).cross(point.tangent) * -1.0;
    point.normal.normalize();
    point.s_mm = s_mm;
    return point;
}

Piece piece_through(SurfacePath path) {
    Piece piece;
    piece.slip.assign(path.size(), 0.0);
    piece.string.gap_mm.assign(path.size(), 0.0);
    piece.string.slope.assign(path.size(), 0.0);
    piece.path = std::move(path);
    return piece;
}

EyePath on_cylinder(const std::vector<Piece>& pieces, double radius_mm) {
    EyeLaw law;
    law.rule = EyeRule::Cylinder;
    law.radius_mm = radius_mm;
    FreeFibreRule range;
    range.min_mm = 1.0;
    range.max_mm = 1e4;
    const EyePathResult eyes = strict_eye_path(pieces, law, range);
    EXPECT_TRUE(eyes.blocked.empty());
    return eyes.path;
}

// A cylinder wound at 45 deg whose ends are turned at by constant slip, in closed form: from the
// regular part the fibre turns hoop over zeta = 0 .. l_t (Table 3's symbols).
class SlipCylinder : public testing::Test {
protected:
    const Json ref_ = reference("seed001.json");
    const double radius_mm_ = ref_["radius_mm"];
    const double slip_ = ref_["slip_ratio"];
    const double beta_ = rad_from_deg(ref_["beta_deg"]);
    const double run_mm_ = radius_mm_ / slip_ * (1.0 / std::sin(beta_) - 1.0);
    const double regular_mm_ = ref_["program"]["l_c_mm"]["value"];
    const double length_mm_ = regular_mm_ + 2.0 * run_mm_;

    // One over the sine of the winding angle.
    [[nodiscard]] double f(double zeta) const {
        return std::max(1.0, 1.0 / std::sin(beta_) - slip_ * zeta / radius_mm_);
    }
    [[nodiscard]] double turn_rad(double zeta) const {
        return (std::acosh(f(0.0)) - std::acosh(f(zeta))) / slip_;
    }
    // Fibre from zeta = 0 on.
    [[nodiscard]] double fibre_mm(double zeta) const {
        const auto cot = [&](double z) { return std::sqrt(f(z) * f(z) - 1.0); };
        return radius_mm_ / slip_ * (cot(0.0) - cot(zeta));
    }

    // The stroke from z = 0 to the other end, n stations in each transition.
    [[nodiscard]] SurfacePath stroke(int n) const {
        SurfacePath path;
        const double half_turn = turn_rad(run_mm_);
        const double half_fibre = fibre_mm(run_mm_);
        const double regular_turn = regular_mm_ * std::tan(beta_) / radius_mm_;
        const double regular_fibre = regular_mm_ / std::cos(beta_);
        const auto add = [&](double zeta, double turn, double z, double s) {
            const double sine = 1.0 / f(zeta);
            path.push_back(station(radius_mm_, turn, z,
                                   {0.0, sine, std::sqrt(std::max(0.0, 1.0 - sine * sine))}, s));
        };
        for (int k = 0; k <= n; ++k) {
            const double zeta = run_mm_ * (n - k) / n;
            add(zeta, half_turn - turn_rad(zeta), run_mm_ - zeta, half_fibre - fibre_mm(zeta));
        }
        for (int k = 0; k <= n; ++k) {
            const double zeta = run_mm_ * k / n;
            add(zeta, half_turn + regular_turn + turn_rad(zeta), run_mm_ + regular_mm_ + zeta,
                half_fibre + regular_fibre + fibre_mm(zeta));
        }
        return path;
    }

    [[nodiscard]] double turns_of_stroke_rad() const {
        return 2.0 * turn_rad(run_mm_) + regular_mm_ * std::tan(beta_) / radius_mm_;
    }

    // A stroke on from a place: turned, and seen from the other end where it leads back.
    [[nodiscard]] SurfacePath moved(const SurfacePath& path, double turn, bool back) const {
        SurfacePath other = path;
        const Eigen::AngleAxisd turned(turn, Vector3d::UnitZ());
        for (PathPoint& point : other) {
            for (Vector3d* v : {&point.position_mm, &point.tangent, &point.normal}) {
                v->z() = back ? -v->z() : v->z();
                *v = turned * *v;
            }
            point.position_mm.z() += back ? length_mm_ : 0.0;
        }
        return other;
    }
};

// The printed numbers have two decimals; two of them are cut instead of rounded, one is rounded
// twice.
constexpr double kPrinted = 0.0051;
constexpr double kCut = 0.01;

TEST_F(SlipCylinder, EyesAreThoseOfTableA1) {
    const EyePath eyes = on_cylinder({piece_through(stroke(10))}, ref_["eye_radius_mm"]);
    const std::vector<double> turns = spindle_turns(eyes, RedundancyPolicy::CentralAngle);
    const double z0 = run_mm_ + regular_mm_;  // of zeta = 0 at the end of the stroke
    for (std::size_t k = 0; k <= 10; ++k) {
        const Json& row = ref_["forward"][k];
        const EyePoint& eye = eyes[11 + k];
        EXPECT_NEAR(eye.landing_mm.z() - z0, row["zeta"].get<double>(), 1e-9);
        const double x = deg_from_rad(-(turns[11 + k] - turns[11]));
        EXPECT_NEAR(x, row["X"].get<double>(), 1e-8);
        EXPECT_NEAR(eye.eye_mm.z() - z0, row["Y"].get<double>(), 1e-8);
        EXPECT_NEAR(x, std::stod(row["X_printed"].get<std::string>()), kCut);
        EXPECT_NEAR(eye.eye_mm.z() - z0, std::stod(row["Y_printed"].get<std::string>()), kPrinted);
    }
    // Back: the stroke from the other end, seen from there; X counts back from its end.
    const EyePath back =
        on_cylinder({piece_through(moved(stroke(10), 0.0, true))}, ref_["eye_radius_mm"]);
    const std::vector<double> back_turns = spindle_turns(back, RedundancyPolicy::CentralAngle);
    for (std::size_t k = 0; k <= 10; ++k) {
        const Json& row = ref_["reverse"][k];
        const double x = deg_from_rad(back_turns[k] - back_turns[10]);
        const double y = back[k].eye_mm.z() - z0;
        EXPECT_NEAR(back[k].landing_mm.z() - z0, row["zeta"].get<double>(), 1e-9);
        EXPECT_NEAR(x, row["X"].get<double>(), 1e-8);
        EXPECT_NEAR(y, row["Y"].get<double>(), 1e-8);
        EXPECT_NEAR(x, std::stod(row["X_printed"].get<std::string>()), kCut);
        EXPECT_NEAR(y, std::stod(row["Y_printed"].get<std::string>()), kPrinted);
    }
}

// The print has differences of rounded rows: off by up to a unit of the last digit.
TEST_F(SlipCylinder, IncrementsAreThoseOfTableA2) {
    const EyePath eyes = on_cylinder({piece_through(stroke(10))}, ref_["eye_radius_mm"]);
    const std::vector<double> turns = spindle_turns(eyes, RedundancyPolicy::CentralAngle);
    for (const auto& [name, first] : {std::pair{"section_1", 0U}, std::pair{"section_3", 11U}}) {
        for (std::size_t k = 0; k < 10; ++k) {
            const Json& row = ref_[name][k];
            const std::size_t i = first + k;
            const double x = deg_from_rad(-(turns[i + 1] - turns[i]));
            const double y = eyes[i + 1].eye_mm.z() - eyes[i].eye_mm.z();
            EXPECT_NEAR(x, row["X"].get<double>(), 1e-8) << name << k;
            EXPECT_NEAR(y, row["Y"].get<double>(), 1e-8) << name << k;
            EXPECT_NEAR(x, std::stod(row["X_printed"].get<std::string>()), 0.0101) << name << k;
            EXPECT_NEAR(y, std::stod(row["Y_printed"].get<std::string>()), 0.0101) << name << k;
        }
    }
    const double regular = deg_from_rad(-(turns[11] - turns[10]));
    EXPECT_NEAR(regular, std::remainder(ref_["program"]["Phi_c_deg"]["value"].get<double>(), 360.0),
                1e-8);  // one step of nearly a whole turn, seen as the rest of it
}

// Cycles of two strokes and two dwells, in the steps of the axes: 4 turns and 300 degrees each, the
// carriage where it was; 6 cycles and Phi_w are a series, 29 turns and 7.09 degrees.
TEST_F(SlipCylinder, ProgramClosesInSteps) {
    const Json& program = ref_["program"];
    const double dwell_rad = rad_from_deg(program["Phi_f_deg"]["value"]);
    const int cycles = program["cycles"];
    std::vector<Piece> pieces;
    double turn = 0.0;
    const auto add_dwell = [&](double angle_rad, double z_mm) {
        SurfacePath dwell;
        for (int k = 0; k <= 4; ++k) {
            const double share = k / 4.0;
            dwell.push_back(station(radius_mm_, turn + share * angle_rad, z_mm, {0.0, 1.0, 0.0},
                                    share * angle_rad * radius_mm_));
        }
        pieces.push_back(piece_through(std::move(dwell)));
        turn += angle_rad;
    };
    for (int cycle = 0; cycle < cycles; ++cycle) {
        for (const bool back : {false, true}) {
            pieces.push_back(piece_through(moved(stroke(200), turn, back)));
            // Regular parts as a fibre that can be followed from station to station.
            Piece& piece = pieces.back();
            const std::size_t middle = 200;
            SurfacePath dense(piece.path.begin(), piece.path.begin() + middle + 1);
            const PathPoint from = piece.path[middle];
            const double whole_turn = regular_mm_ * std::tan(beta_) / radius_mm_;
            for (int k = 1; k < 50; ++k) {
                const double share = k / 50.0;
                PathPoint point = from;
                const Eigen::AngleAxisd turned(share * whole_turn, Vector3d::UnitZ());
                point.position_mm = turned * from.position_mm;
                point.position_mm.z() += (back ? -1.0 : 1.0) * share * regular_mm_;
                point.tangent = turned * from.tangent;
                point.normal = turned * from.normal;
                point.s_mm += share * regular_mm_ / std::cos(beta_);
                dense.push_back(point);
            }
            dense.insert(dense.end(), piece.path.begin() + middle + 1, piece.path.end());
            piece = piece_through(std::move(dense));
            turn += turns_of_stroke_rad();
            add_dwell(dwell_rad, back ? 0.0 : length_mm_);
        }
    }
    add_dwell(rad_from_deg(program["Phi_w_deg"]["value"]), 0.0);

    const Machine machine = read_machine(kSource + "/machines/six_axis.json");
    const EyePath eyes = on_cylinder(pieces, ref_["eye_radius_mm"]);
    const JointPath joints = solve_joints(machine, eyes, RedundancyPolicy::CentralAngle);
    std::vector<double> fibre_mm{0.0};
    for (std::size_t i = 1; i < eyes.size(); ++i) {
        fibre_mm.push_back(eyes[i].s_mm - eyes[i - 1].s_mm);
    }
    const BlockList list = make_blocks(machine, eyes, joints, fibre_mm, {}).list;
    const std::size_t c = *machine.joint_of('C');
    const std::size_t z = *machine.joint_of('Z');
    constexpr std::int64_t kThousandth = 1'000'000;  // of a degree, in 1e-9
    std::vector<std::size_t> ends;                   // the last block of every cycle, and of all
    for (std::size_t b = 0; b < list.blocks.size(); ++b) {
        const bool last =
            b + 1 == list.blocks.size() || list.blocks[b + 1].piece / 4 != list.blocks[b].piece / 4;
        if (last) {
            ends.push_back(b);
        }
    }
    const auto nano = [&](std::size_t block, std::size_t axis) {
        return list.nano[block * list.axes.size() + axis];
    };
    ASSERT_EQ(ends.size(), static_cast<std::size_t>(cycles) + 1);
    for (int k = 0; k < cycles; ++k) {
        EXPECT_EQ(nano(ends[static_cast<std::size_t>(k)], c) - nano(0, c),
                  -(k + 1) * program["cycle_deg"].get<std::int64_t>() * 1000 * kThousandth);
        EXPECT_EQ(nano(ends[static_cast<std::size_t>(k)], z), nano(0, z));
    }
    // 29 turns and Phi_w, which 9 series make less than one cycle's step of 60 degrees.
    EXPECT_EQ(nano(ends.back(), c) - nano(0, c), -(29 * 360'000 + 7'090) * kThousandth);
    EXPECT_GE(program["series"].get<int>() * program["Phi_w_deg"]["value"].get<double>(), 60.0);
}

// A head at a constant distance from the axis, on the cylinder and on the dome. The closed form of
// the axial way that the paper means holds too.
TEST(GasCylinder, HeadIsWhereTheCorrectedFormHasIt) {
    const Json ref = reference("seed000.json");
    std::vector<Json> rows = ref["dome"];
    rows.push_back(ref["cylinder"]);
    ASSERT_GE(rows.size(), 5U);
    const double head = ref["head_x"];
    for (const Json& row : rows) {
        const double rho = row["rho"];
        const std::vector<double> t = row["tangent"];
        const Vector3d tangent(t[0], t[1], t[2]);
        const Piece piece = piece_through(
            {station(rho, 0.0, 0.0, tangent, 0.0), station(rho, 0.1, 1.0, tangent, 1.0)});
        FreeFibreRule range;
        range.min_mm = 0.01;
        EyeLaw law;
        law.rule = EyeRule::Cylinder;
        law.radius_mm = head;
        const EyePoint eye = strict_eye_path({&piece, 1}, law, range).path.front();
        const double theta = std::atan2(eye.eye_mm.y(), eye.eye_mm.x());
        EXPECT_NEAR(eye.free_length_mm, row["d"].get<double>(), 1e-8) << row;
        EXPECT_NEAR(deg_from_rad(theta), row["theta_deg"].get<double>(), 1e-7) << row;
        EXPECT_NEAR(eye.eye_mm.z(), row["d_z"].get<double>(), 1e-8) << row;
        if (t[0] != 0.0) {
            EXPECT_NEAR(eye.eye_mm.z(), (head * std::cos(theta) - rho) * t[2] / t[0], 1e-8) << row;
        }
    }
}

// fu_2009_post_processing: the machine sees the mandrel's points turned back by the sum of the
// steps of C, and A is the fibre's slope against the hoop there. The sample is
// data/reference/seed004.json.
TEST(MeshPostProcessing, SampleProgramAndMachineTransform) {
    const Json ref = reference("seed004.json");
    const Machine machine =
        read_machine(kSource + "/data/conformance/machine/valid/five_axis_roll_only.json");
    const auto at = [&](const JointPath& joints, std::size_t i, char letter) {
        return joints.row(i)[*machine.joint_of(letter)];
    };
    const EyePath helix = test::helix(70.0, rad_from_deg(45.0), 200.0, 5.0, 400);
    const JointPath homed = solve_joints(machine, helix, RedundancyPolicy::CentralAngle);
    const JointPath still = solve_joints(machine, helix, std::vector<double>(helix.size(), 0.0));
    const std::string letters = "XYZCA";
    for (std::size_t k = 0; k < letters.size(); ++k) {
        const double sense = letters[k] == 'C' ? -1.0 : 1.0;  // C counts the eye around the mandrel
        const double start = ref["sample_code"]["start"][k];
        const double home = ref["sample_code_home"]["start"][k];
        const double step = ref["sample_code"]["increment"][k];
        if (letters[k] == 'C') {
            EXPECT_NEAR(at(homed, 0, 'C'), -start, 1e-9);
        } else {
            EXPECT_NEAR(at(still, 0, letters[k]), start, 1e-9);
            EXPECT_NEAR(at(homed, 0, letters[k]), home, 1e-9);
        }
        for (std::size_t i = 1; i < helix.size(); ++i) {
            ASSERT_NEAR(sense * (at(homed, i, letters[k]) - at(homed, i - 1, letters[k])), step,
                        1e-9);
        }
    }
    // On a body that is not round, with the free length going from 200 to 250 mm.
    const EyePath path = test::elliptic_helix(2000);
    const JointPath joints = solve_joints(machine, path, RedundancyPolicy::CentralAngle);
    double sum = std::atan2(path[0].eye_mm.y(), path[0].eye_mm.x());  // homed: C_1 = 0
    for (std::size_t i = 0; i < path.size(); ++i) {
        const auto central = [&](std::size_t k) {
            return std::atan2(path[k].eye_mm.y(), path[k].eye_mm.x());
        };
        sum += i == 0 ? 0.0 : std::remainder(central(i) - central(i - 1), 2.0 * kPi);
        const Eigen::AngleAxisd back(-sum, Vector3d::UnitZ());
        const Vector3d eye = back * path[i].eye_mm;
        const Vector3d tau = back * path[i].tangent;
        ASSERT_NEAR(at(joints, i, 'X'), eye.x(), 1e-9);
        ASSERT_NEAR(at(joints, i, 'Y'), eye.y(), 1e-9);
        ASSERT_NEAR(at(joints, i, 'Z'), eye.z(), 1e-9);
        ASSERT_NEAR(at(joints, i, 'C'), -sum, 1e-9);
        ASSERT_NEAR(std::remainder(at(joints, i, 'A') - std::atan2(tau.z(), tau.y()), kPi), 0.0,
                    1e-9);
    }
}

}  // namespace
}  // namespace meshwind
