#include "postproc/tables/fibre_lines.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace meshwind {
namespace {

using Eigen::Vector3d;

Piece piece_of(PieceKind kind, const std::vector<Vector3d>& points_mm) {
    Piece piece;
    piece.kind = kind;
    double s_mm = 0.0;
    for (const Vector3d& point : points_mm) {
        s_mm += piece.path.empty() ? 0.0 : (point - piece.path.back().position_mm).norm();
        PathPoint& station = piece.path.emplace_back();
        station.position_mm = point;
        station.s_mm = s_mm;
    }
    return piece;
}

std::vector<Vector3d> helix(double radius_mm, double step_rad, int n) {
    std::vector<Vector3d> points;
    for (int i = 0; i < n; ++i) {
        const double turn = step_rad * i;
        points.emplace_back(radius_mm * std::cos(turn), radius_mm * std::sin(turn), 20.0 * turn);
    }
    return points;
}

double distance_mm(const Vector3d& point, const std::vector<Vector3d>& line) {
    double least = 1e300;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const Vector3d step = line[i + 1] - line[i];
        const double share = std::clamp((point - line[i]).dot(step) / step.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (point - line[i] - share * step).norm());
    }
    return least;
}

TEST(FibreLines, AStraightPieceHasTwoPoints) {
    const std::vector<Piece> fibre{
        piece_of(PieceKind::Course, {{0, 0, 0}, {0, 0.005, 4}, {0, -0.005, 8}, {0, 0, 12}})};
    const std::vector<FibreLine> lines = fibre_lines(fibre);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0].name, "course_0");
    EXPECT_EQ(lines[0].points_mm, (std::vector<Vector3d>{{0, 0, 0}, {0, 0, 12}}));
}

// A chord of c over a helix of curvature k bulges by k c^2 / 8: within the tolerance chords are at
// most sqrt(8 e / k) long, and thinning by halves leaves none below half a third of that.
TEST(FibreLines, StationsLieWithinTheChordAndFewAreLeft) {
    constexpr double kRadius_mm = 40.0;
    const std::vector<Vector3d> stations = helix(kRadius_mm, 0.01, 2000);
    const std::vector<Piece> fibre{piece_of(PieceKind::Course, stations)};
    const double curvature_per_mm = kRadius_mm / (kRadius_mm * kRadius_mm + 20.0 * 20.0);
    for (const double chord_mm : {0.01, 0.1, 1.0}) {
        const std::vector<FibreLine> lines = fibre_lines(fibre, chord_mm);
        const std::vector<Vector3d>& points = lines.at(0).points_mm;
        EXPECT_EQ(points.front(), stations.front());
        EXPECT_EQ(points.back(), stations.back());
        for (const Vector3d& station : stations) {
            EXPECT_LE(distance_mm(station, points), chord_mm);
        }
        const double longest_mm = std::sqrt(8.0 * chord_mm / curvature_per_mm);
        const double length_mm = fibre[0].path.back().s_mm;
        EXPECT_LE(static_cast<double>(points.size()), 1.0 + 6.0 * length_mm / longest_mm);
        EXPECT_GE(static_cast<double>(points.size()), 0.9 * length_mm / longest_mm);
    }
}

TEST(FibreLines, NumbersArePlacesInTheFibre) {
    const std::vector<Piece> fibre{piece_of(PieceKind::Course, {{0, 0, 0}, {0, 0, 1}}),
                                   piece_of(PieceKind::Transition, {{0, 0, 1}, {0, 0, 1}}),
                                   piece_of(PieceKind::Transition, {{0, 0, 1}, {1, 0, 1}}),
                                   piece_of(PieceKind::Course, {{1, 0, 1}, {1, 0, 0}})};
    const std::vector<FibreLine> lines = fibre_lines(fibre);
    ASSERT_EQ(lines.size(), 3U);  // one has no length
    EXPECT_EQ(lines[1].name, "transition_2");
    EXPECT_EQ(lines[2].name, "course_3");
}

TEST(FibreLines, AClosedPieceKeepsItsShape) {
    const std::vector<Piece> fibre{
        piece_of(PieceKind::Course, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0}})};
    EXPECT_EQ(fibre_lines(fibre).at(0).points_mm.size(), 5U);
}

const std::vector<FibreLine> kTwo{{"course_0", {{1, 2, 3}, {-0.00001, 2.5, 3}}},
                                  {"it's", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}}};

TEST(FibreObj, HasAnObjectAndALineEach) {
    EXPECT_EQ(fibre_obj(kTwo),
              "# Fibre by meshwind, mandrel frame, mm\n"
              "o course_0\nv 1.0000 2.0000 3.0000\nv 0.0000 2.5000 3.0000\nl 1 2\n"
              "o it's\nv 0.0000 0.0000 0.0000\nv 1.0000 0.0000 0.0000\nv 1.0000 1.0000 0.0000\n"
              "l 3 4 5\n");
}

TEST(FibreStep, HasACurveSetForEachLine) {
    const std::string text = fibre_step(kTwo, "fibre", "1.2");
    const auto has = [&](const std::string& part) { return text.find(part) != std::string::npos; };
    EXPECT_EQ(text.find("ISO-10303-21;\nHEADER;\n"), 0U);
    EXPECT_TRUE(has("'meshwind 1.2'"));
    EXPECT_TRUE(has("=CARTESIAN_POINT('',(0.0000,2.5000,3.0000));"));
    EXPECT_TRUE(has("=POLYLINE('course_0',("));
    EXPECT_TRUE(has("=GEOMETRIC_CURVE_SET('it''s',("));
    EXPECT_EQ(text.rfind("END-ISO-10303-21;\n"), text.size() - 18);
    EXPECT_EQ(text, fibre_step(kTwo, "fibre", "1.2"));
}

// ISO 10303-21: characters by their code points, beyond the basic plane with eight digits.
TEST(FibreFiles, StepNamesAreUnicode) {
    const auto head_of = [](const char* name) { return fibre_step(kTwo, name, "1"); };
    EXPECT_NE(head_of("Rohr \xe5\xb7\xbb \xf0\x9f\xa7\xb5")
                  .find("FILE_NAME('Rohr \\X2\\5DFB\\X0\\ \\X4\\0001F9F5\\X0\\',"),
              std::string::npos);
    // What is no UTF-8 is taken for Latin-1.
    for (const char* name : {"\xe4", "\xe4-", "\xe4\xb7"}) {
        EXPECT_NE(head_of(name).find("FILE_NAME('\\X2\\00E4\\X0\\"), std::string::npos);
    }
}

TEST(FibreFiles, HostileNamesStayNames) {
    const std::vector<FibreLine> lines{{"a'); #1=X('\n\\ \xc3\xa4", {{0, 0, 0}, {1, 0, 0}}},
                                       {"o\nv 1 2 3 #", {{0, 0, 0}, {1, 0, 0}}}};
    EXPECT_EQ(fibre_obj(lines),
              "# Fibre by meshwind, mandrel frame, mm\n"
              "o a');__1=X('_____\nv 0.0000 0.0000 0.0000\nv 1.0000 0.0000 0.0000\nl 1 2\n"
              "o o_v_1_2_3__\nv 0.0000 0.0000 0.0000\nv 1.0000 0.0000 0.0000\nl 3 4\n");
    const std::string text = fibre_step(lines, "*/ 'ENDSEC;'", "1");
    EXPECT_NE(text.find("POLYLINE('a''); #1=X(''\\X2\\000A\\X0\\\\\\ \\X2\\00E4\\X0\\',("),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("FILE_NAME('*/ ''ENDSEC;''',"), std::string::npos);
    for (const char c : text) {
        EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~'));
    }
}

}  // namespace
}  // namespace meshwind
