#include "postproc/tables/path_csv.h"

#include <gtest/gtest.h>

#include "postproc/tables/plan_tables.h"

namespace meshwind {
namespace {

Piece piece_of(PieceKind kind, double x) {
    Piece piece;
    piece.kind = kind;
    for (int i = 0; i < 2; ++i) {
        PathPoint p;
        p.position_mm = {x, -0.00001, 2.5 * i};
        p.normal = {1.0, 0.0, 0.0};
        p.tangent = {0.0, 0.6, -0.8};
        p.s_mm = 2.5 * i;
        p.kn_per_mm = 0.0125;
        p.kg_per_mm = -0.0025;
        piece.path.push_back(p);
        piece.slip.push_back(0.2);
        piece.string.gap_mm.push_back(0.125 * i);
        piece.string.slope.push_back(0.0);
    }
    return piece;
}

// Exact text: the header is a contract, and no cell reads "-0.0000".
TEST(PathCsv, IsOneRowPerStationInWindingOrder) {
    const std::vector<Piece> pieces{piece_of(PieceKind::Course, 50.0),
                                    piece_of(PieceKind::Transition, -51.25)};
    EyePath path;
    for (std::int32_t p = 0; p < 2; ++p) {
        for (std::int32_t i = 0; i < 2; ++i) {
            EyePoint eye;
            eye.piece = p;
            eye.point = i;
            eye.s_mm = 2.5 * (p + i);
            eye.free_length_mm = 200.0;
            path.push_back(eye);
        }
    }
    EXPECT_EQ(path_csv(pieces, path),
              "course,kind,point,s_mm,x_mm,y_mm,z_mm,nx,ny,nz,tx,ty,tz,kn_per_mm,kg_per_mm,slip,"
              "bridge_mm,free_length_mm\n"
              "0,course,0,0.0000,50.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,"
              "0.6000000,-0.8000000,0.01250000,-0.00250000,0.20000,0.0000,200.0000\n"
              "0,course,1,2.5000,50.0000,0.0000,2.5000,1.0000000,0.0000000,0.0000000,0.0000000,"
              "0.6000000,-0.8000000,0.01250000,-0.00250000,0.20000,0.1250,200.0000\n"
              "1,transition,0,2.5000,-51.2500,0.0000,0.0000,1.0000000,0.0000000,0.0000000,"
              "0.0000000,0.6000000,-0.8000000,0.01250000,-0.00250000,0.20000,0.0000,200.0000\n"
              "1,transition,1,5.0000,-51.2500,0.0000,2.5000,1.0000000,0.0000000,0.0000000,"
              "0.0000000,0.6000000,-0.8000000,0.01250000,-0.00250000,0.20000,0.1250,200.0000\n");
}

// Where a pin holds the fibre, of a fibre that turns on pins.
TEST(PathCsv, SaysWherePinsHoldTheFibre) {
    const std::vector<Piece> pieces{piece_of(PieceKind::Transition, 50.0)};
    EyePath path(2);
    path[1].point = 1;
    for (EyePoint& eye : path) {
        eye.on_pins = true;
    }
    path[1].held = true;
    const PlannedFibre fibre = read_path_csv(path_csv(pieces, path), "path.csv");
    ASSERT_EQ(fibre.size(), 2U);
    EXPECT_FALSE(fibre[0].held);
    EXPECT_TRUE(fibre[1].held);
}

TEST(PathCsv, OfNoPiecesIsTheHeader) {
    const std::string text = path_csv({}, {});
    EXPECT_EQ(text.find('\n'), text.size() - 1);
}

}  // namespace
}  // namespace meshwind
