#include "postproc/tables/landing_csv.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace meshwind {
namespace {

std::string error_of(const std::string& text, const char* code) {
    try {
        (void)read_landing_csv(text, "points.csv");
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), code) << text;
        return error.what();
    }
    ADD_FAILURE() << "accepted: " << text;
    return "";
}

TEST(LandingCsv, ReadsTheLeastThatIsNeeded) {
    const LandingTable table = read_landing_csv("x,y,z\n1,2,3\n4,5,6.5\n", "points.csv");
    EXPECT_FALSE(table.in_mm);
    ASSERT_EQ(table.courses.size(), 1U);
    const LandingCourse& course = table.courses[0];
    EXPECT_EQ(course.name, "1");
    EXPECT_FALSE(course.transition);
    ASSERT_EQ(course.rows.size(), 2U);
    EXPECT_EQ(course.rows[1].position, Eigen::Vector3d(4.0, 5.0, 6.5));
    EXPECT_EQ(course.rows[1].line, 3);
    EXPECT_FALSE(course.rows[1].normal.has_value());
}

TEST(LandingCsv, ReadsEveryColumnInAnyOrderAmongOthers) {
    const LandingTable table = read_landing_csv(
        "\xEF\xBB\xBFz_mm, y_mm ,x_mm,nx,ny,nz,kind,what,course\r\n"
        "3,2,1,0,0,1,course,a b,A\r\n"
        "\r\n"
        "6, 5 ,4e0,0,0,1,course,,A\r\n"
        "6,5,4,0,1,0,transition,,B\r\n"
        "7,5,4,0,1,0,transition,,B\r\n"
        "8,5,4,0,1,0,course,,A\r\n"
        "9,5,4,0,1,0,course,,A\r\n\r\n",
        "points.csv");
    EXPECT_TRUE(table.in_mm);
    ASSERT_EQ(table.courses.size(), 3U);
    EXPECT_EQ(table.courses[0].name, "A");
    EXPECT_EQ(table.courses[0].rows[0].position, Eigen::Vector3d(1.0, 2.0, 3.0));
    EXPECT_EQ(table.courses[0].rows[1].line, 4);
    EXPECT_EQ(table.courses[0].rows[1].normal, Eigen::Vector3d(0.0, 0.0, 1.0));
    EXPECT_TRUE(table.courses[1].transition);
    EXPECT_EQ(table.courses[2].name, "A");
    EXPECT_FALSE(table.courses[2].transition);
    EXPECT_FALSE(table.courses[0].rows[0].tangent.has_value());
    EXPECT_EQ(read_landing_csv("x,y,z,tx,ty,tz\n1,2,3,0,2,0\n1,3,3,0,2,0\n", "points.csv")
                  .courses[0]
                  .rows[1]
                  .tangent,
              Eigen::Vector3d(0.0, 2.0, 0.0));
}

TEST(LandingCsv, SaysWhatIsWrongAndWhere) {
    EXPECT_EQ(error_of("1,2,3\n4,5,6\n", "import.column"),
              "points.csv:1: has no column 'x'; its first line names the columns, commas between: "
              "x_mm,y_mm,z_mm or x,y,z, and perhaps course, nx,ny,nz and tx,ty,tz");
    error_of("", "import.column");
    error_of("x_mm,y,z\n1,2,3\n4,5,6\n", "import.column");
    error_of("x,y,z,nx,ny\n1,2,3,0,0\n4,5,6,0,0\n", "import.column");
    EXPECT_EQ(error_of("x,y,z\n1,2,3\n4,5\n", "import.number"),
              "points.csv:3: has 2 cells, its first line 3; write the table again");
    EXPECT_EQ(error_of("x,y,z\n1,2,3\n4,5m,6\n", "import.number"),
              "points.csv:3: '5m' in column y is not a number");
    error_of("x,y,z\n1,2,nan\n4,5,6\n", "import.number");
    error_of("x,y,z\n1,2,inf\n4,5,6\n", "import.number");
    error_of("x,y,z\n1,,3\n4,5,6\n", "import.number");
    error_of("x,y,z,nx,ny,nz\n1,2,3,0,0,0\n4,5,6,0,0,1\n", "import.number");
    EXPECT_EQ(error_of("x,y,z\n", "import.empty"),
              "points.csv:1: has no landing points; give two at least");
    error_of("x,y,z\n1,2,3\n", "import.empty");
    EXPECT_EQ(error_of("course,x,y,z\n1,1,2,3\n2,1,2,3\n2,1,2,4\n", "import.empty"),
              "points.csv:3: course 1 has one landing point before this line; give two at least");
}

}  // namespace
}  // namespace meshwind
