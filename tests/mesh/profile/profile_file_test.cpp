#include "mesh/profile/profile_file.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "mesh/mandrel/load_mandrel.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;

std::string table(const std::vector<Vector2d>& xr, const std::string& head = "x,r") {
    std::string text = head + "\n";
    for (const Vector2d& p : xr) {
        char line[80];
        std::snprintf(line, sizeof line, "%.12g,%.12g\n", p.x(), p.y());
        text += line;
    }
    return text;
}

// Quarter of an ellipse about the origin of the axis, from (0, radius) to the angle.
std::vector<Vector2d> dome(double radius, double height, double to_rad, int chords) {
    std::vector<Vector2d> points;
    for (int i = 0; i <= chords; ++i) {
        const double t = to_rad * i / chords;
        points.emplace_back(height * std::sin(t), radius * std::cos(t));
    }
    return points;
}

// Largest distance of a meridian from a curve |f| = 0 whose gradient is about 1, by dense places.
double worst_off(const Meridian& meridian, const std::function<double(double r, double x)>& off) {
    double worst = 0.0;
    for (int i = 0; i <= 5000; ++i) {
        const MeridianPlace place = meridian.at(meridian.length_mm() * i / 5000.0);
        worst = std::max(worst, std::abs(off(place.radius_mm, place.z_mm)));
    }
    return worst;
}

double off_ellipse(double r, double x, double radius, double height) {
    const double u = r / radius;
    const double v = x / height;
    const double gradient = 2.0 * std::hypot(u / radius, v / height);
    return (u * u + v * v - 1.0) / gradient;
}

std::string code_of(const std::function<void()>& call, std::string* place = nullptr) {
    try {
        call();
    } catch (const InputError& error) {
        if (place != nullptr) {
            *place = error.place();
        }
        EXPECT_FALSE(error.words().empty());
        EXPECT_EQ(error.words().find('\n'), std::string::npos);
        return error.code();
    }
    return "";
}

// Of a dome of 100 x 60 mm by 40 chords or more, 2.5 mm: h^4 / R^3 / 200 with R = 60^2 / 100 at its
// narrow end, ten times that as its end is free (mesh/revolution/meridian.h).
constexpr double kSplineOff_mm = 4e-5;

// Splines through points of an ellipse: 4th order, also where it goes on in a line of two points.
TEST(ProfileCsv, ADomeBesideALineOfTwoPointsIsOfFourthOrder) {
    std::vector<double> worst;
    for (const int chords : {12, 24, 48}) {
        std::vector<Vector2d> points = {{-300.0, 100.0}};
        for (const Vector2d& p : dome(100.0, 60.0, 1.3, chords)) {
            points.push_back(p);
        }
        const ProfileFile profile = read_profile_csv(table(points), "vessel.csv");
        ASSERT_TRUE(profile.nodes.front().straight);
        for (const MeridianNode& node : profile.nodes) {
            EXPECT_FALSE(node.crease);
        }
        const Meridian meridian(profile.nodes);
        worst.push_back(worst_off(meridian, [](double r, double x) {
            return x < 0.0 ? r - 100.0 : off_ellipse(r, x, 100.0, 60.0);
        }));
    }
    EXPECT_LT(worst[2], kSplineOff_mm);
    EXPECT_GT(std::log2(worst[0] / worst[1]), 3.5);
    EXPECT_GT(std::log2(worst[1] / worst[2]), 3.5);
}

TEST(ProfileCsv, StepsAndConesHaveCreases) {
    const std::vector<Vector2d> steps = {{0, 50},   {100, 50}, {130, 30},
                                         {200, 30}, {200, 20}, {260, 20}};
    const ProfileFile profile = read_profile_csv(table(steps), "steps.csv");
    const Meridian meridian(profile.nodes);
    EXPECT_EQ(meridian.creases_mm().size(), 4U);
    EXPECT_NEAR(meridian.length_mm(), 100 + std::hypot(30, 20) + 70 + 10 + 60, 1e-9);
}

TEST(ProfileCsv, ColumnsSayWhatIsNotToBeGuessed) {
    const std::string smooth = table({{0, 50}, {10, 49.9}, {20, 49.6}, {30, 49.1}});
    for (const MeridianNode& node : read_profile_csv(smooth, "a.csv").nodes) {
        EXPECT_FALSE(node.crease || node.straight);
    }
    const std::string told = "x,r,crease,line\n0,50,0,1\n10,49.9,1,0\n20,49.6,0,0\n30,49.1,0,0\n";
    const std::vector<MeridianNode> nodes = read_profile_csv(told, "a.csv").nodes;
    EXPECT_TRUE(nodes[0].straight);
    EXPECT_TRUE(nodes[1].crease);
    EXPECT_FALSE(nodes[2].crease);
    // From the other end: the line is between the same two points.
    const std::string back = "x,r,crease,line\n30,49.1,0,0\n20,49.6,0,0\n10,49.9,1,1\n0,50,0,0\n";
    const std::vector<MeridianNode> turned = read_profile_csv(back, "a.csv").nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        EXPECT_EQ(turned[i].radius_mm, nodes[i].radius_mm);
        EXPECT_EQ(turned[i].straight, nodes[i].straight) << i;
        EXPECT_EQ(turned[i].crease, nodes[i].crease) << i;
    }
}

TEST(ProfileCsv, RefusesInTheLine) {
    struct Case {
        std::string text;
        std::string code;
        std::string place;
    };
    for (const Case& one : std::vector<Case>{
             {"", "profile.column", "a.csv:1"},
             {"x,y\n0,1\n", "profile.column", "a.csv:1"},
             {"x,r\n0,1\n1\n", "profile.number", "a.csv:3"},
             {"x,r\n0,1\n1,one\n", "profile.number", "a.csv:3"},
             {"x,r\n0,1\n1,nan\n", "profile.number", "a.csv:3"},
             {"x,r\n0,1\n", "profile.points", "a.csv"},
             {"x,r\n0,1\n1,-2\n", "profile.radius", "a.csv:3"},
             {"x,r\n0,1\n1,0\n2,1\n", "profile.radius", "a.csv:3"},
             {"x,r\n0,1\n1,2\n1,2\n", "profile.same_point", "a.csv:4"},
             {"x,r\n0,1\n1,2\n0,2\n", "profile.ends", "a.csv"},
             {"x,r,line\n0,1,2\n", "profile.number", "a.csv:2"},
         }) {
        std::string place;
        EXPECT_EQ(code_of([&] { (void)read_profile_csv(one.text, "a.csv"); }, &place), one.code)
            << one.text;
        EXPECT_EQ(place, one.place) << one.text;
    }
}

// Points that lie on no smooth curve, found by the fuzzer: the spline through them is 1e65 long.
TEST(ProfileCsv, RefusesWhatIsNoSmoothCurve) {
    const ProfileFile wild = read_profile_csv(table({{-2020, 54.9871},
                                                     {-203.1266, 46.4749},
                                                     {-2.0164, 43.5324},
                                                     {-206.9808, 31.224},
                                                     {-207.569, 28.1765},
                                                     {-2204, 92485},
                                                     {-204.8477, 40.5426},
                                                     {-205.6193, 37.5088},
                                                     {-206.3306, 34.4343},
                                                     {-206.9808, 31.224},
                                                     {-207.569, 28.1765},
                                                     {-208, 92485}}),
                                              "a.csv");
    EXPECT_EQ(code_of([&] { (void)swept_profile(wild, "a.csv"); }), "profile.smooth");
}

using Pairs = std::vector<std::pair<int, std::string>>;

std::string dxf(const std::vector<Pairs>& entities, const std::string& before = "") {
    std::string text = before + "  0\nSECTION\n  2\nENTITIES\n";
    for (const Pairs& entity : entities) {
        for (const auto& [code, value] : entity) {
            text += std::to_string(code) + "\r\n" + value + "\r\n";
        }
    }
    return text + "  0\nENDSEC\n  0\nEOF\n";
}

Pairs line(const char* x1, const char* y1, const char* x2, const char* y2) {
    return {{0, "LINE"}, {8, "0"}, {10, x1}, {20, y1}, {30, "0"}, {11, x2}, {21, y2}, {31, "0"}};
}

Pairs arc(const char* x, const char* y, const char* radius, const char* from, const char* to) {
    return {{0, "ARC"}, {10, x}, {20, y}, {30, "0"}, {40, radius}, {50, from}, {51, to}};
}

double off_capsule(double r, double x) {
    return x < 0.0 ? r - 50.0 : std::hypot(r, x) - 50.0;
}

// A cylinder and half a sphere, to what is left of a spline through places 2.5 degrees apart.
TEST(ProfileDxf, LinesAndArcsInAnyOrder) {
    const std::vector<Pairs> pieces = {arc("0", "0", "50", "0", "90"),
                                       line("-100", "50", "0", "50"), line("-100", "0", "50", "0")};
    for (const bool turned : {false, true}) {
        std::vector<Pairs> drawn = pieces;
        if (turned) {
            drawn = {line("0", "50", "-100", "50"), pieces[2], pieces[0]};
        }
        const Meridian meridian(read_profile_dxf(dxf(drawn), "cap.dxf").nodes);
        EXPECT_TRUE(meridian.creases_mm().empty());
        EXPECT_LT(worst_off(meridian, off_capsule), 2e-6);
        EXPECT_NEAR(meridian.length_mm(), 100.0 + 25.0 * kPi, 1e-5);
        EXPECT_NEAR(meridian.at(meridian.length_mm()).radius_mm, 0.0, 1e-12);
    }
}

TEST(ProfileDxf, PolylinesHaveBulges) {
    // tan(90 / 4 deg): a quarter of a circle, clockwise.
    const std::string quarter = "-0.41421356237309503";
    const Pairs light = {{0, "LWPOLYLINE"}, {90, "3"},  {70, "0"},     {10, "-100"}, {20, "50"},
                         {10, "0"},         {20, "50"}, {42, quarter}, {10, "50"},   {20, "0"}};
    const std::vector<Pairs> old = {{{0, "POLYLINE"}, {66, "1"}, {70, "0"}, {10, "0"}, {20, "0"}},
                                    {{0, "VERTEX"}, {10, "-100"}, {20, "50"}},
                                    {{0, "VERTEX"}, {10, "0"}, {20, "50"}, {42, quarter}},
                                    {{0, "VERTEX"}, {10, "50"}, {20, "0"}},
                                    {{0, "SEQEND"}}};
    for (const std::string& text : {dxf({light}), dxf(old)}) {
        const Meridian meridian(read_profile_dxf(text, "cap.dxf").nodes);
        EXPECT_LT(worst_off(meridian, off_capsule), 2e-6);
        EXPECT_TRUE(meridian.creases_mm().empty());
    }
}

TEST(ProfileDxf, CreasesBelowTheAxisAndUnits) {
    const std::string header = "  9\n$INSUNITS\n 70\n     1\n";
    const std::string text =
        dxf({line("0", "-2", "4", "-2"), line("4", "-2", "6", "-1"), line("6", "-1", "9", "-1")},
            "  0\nSECTION\n  2\nHEADER\n" + header + "  0\nENDSEC\n");
    const ProfileFile profile = read_profile_dxf(text, "inch.dxf");
    EXPECT_EQ(profile.stated_unit_mm, 25.4);
    EXPECT_EQ(Meridian(profile.nodes).creases_mm().size(), 2U);
    EXPECT_EQ(profile.nodes.front().radius_mm, 2.0);
    EXPECT_EQ(read_profile_dxf(text + "\n \n", "inch.dxf").stated_unit_mm, 25.4);
    std::string no_unit = text;
    no_unit.replace(no_unit.find("     1"), 6, "1e300");
    EXPECT_EQ(read_profile_dxf(no_unit, "inch.dxf").stated_unit_mm, 0.0);
}

TEST(ProfileDxf, Refuses) {
    struct Case {
        std::string text;
        std::string code;
    };
    const Pairs run = line("0", "5", "9", "5");
    for (const Case& one : std::vector<Case>{
             {"", "profile.drawing"},
             {"solid cube\nfacet\n", "profile.drawing"},
             {"AutoCAD Binary DXF\r\n", "profile.drawing"},
             {"0\nSECTION\n2", "profile.drawing"},
             {dxf({{{0, "SPLINE"}, {10, "0"}, {20, "1"}}}), "profile.drawing"},
             {dxf({{{0, "LINE"}, {10, "0"}, {20, "1"}, {11, "3"}}}), "profile.drawing"},
             {dxf({{{0, "LINE"}, {10, "zero"}}}), "profile.drawing"},
             {dxf({arc("0", "0", "-5", "0", "90")}), "profile.drawing"},
             {dxf({}), "profile.drawing"},
             {dxf({{{0, "TEXT"}, {10, "0"}, {20, "0"}, {1, "outside"}}}), "profile.points"},
             {dxf({line("0", "0", "9", "0")}), "profile.points"},
             {dxf({run, line("9.1", "5", "12", "5")}), "profile.chain"},
             {dxf({run, line("9", "5", "12", "5"), line("9", "5", "9", "2")}), "profile.chain"},
             {dxf({line("0", "5", "9", "5"), line("9", "5", "4", "9"), line("4", "9", "0", "5")}),
              "profile.chain"},
             {dxf({run, line("9", "5", "12", "-5")}), "profile.radius"},
             {dxf({line("3", "5", "3", "9")}), "profile.ends"},
         }) {
        EXPECT_EQ(code_of([&] { (void)read_profile_dxf(one.text, "a.dxf"); }), one.code)
            << one.text;
    }
}

// From the file to the mandrel: rims, axis and unit are those of the drawing.
TEST(ProfileMandrel, IsTheBodyOfItsOutline) {
    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / "meshwind-profile";
    std::filesystem::create_directories(folder);
    const std::filesystem::path file = folder / "vessel.csv";
    std::vector<Vector2d> points;
    for (const Vector2d& p : dome(100.0, 60.0, 1.3, 40)) {
        points.insert(points.begin(), Vector2d(-100.0 - p.x(), p.y()));
        points.push_back({100.0 + p.x(), p.y()});
    }
    std::ofstream(file) << table(points, "x_mm,r_mm");
    const Mandrel mandrel = load_mandrel(file, {});
    EXPECT_EQ(mandrel.unit_rule, "file");
    ASSERT_EQ(mandrel.rims.size(), 2U);
    for (const Rim& rim : mandrel.rims) {
        EXPECT_NEAR(rim.radius_mm, 100.0 * std::cos(1.3), 1e-9);
        EXPECT_NEAR(std::abs(rim.centre_mm.z()), 100.0 + 60.0 * std::sin(1.3), 1e-6);
    }
    double worst = 0.0;
    for (const Eigen::Vector3d& p : mandrel.surface.position_mm) {
        const double r = p.head<2>().norm();
        const double x = std::abs(p.z()) - 100.0;
        worst = std::max(worst, std::abs(x < 0.0 ? r - 100.0 : off_ellipse(r, x, 100.0, 60.0)));
    }
    EXPECT_LT(worst, kSplineOff_mm);
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace meshwind
