// Programs read by LinuxCNC's own interpreter against the plan and against our reader.
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "core/text/text_file.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "machines/machine_json.h"
#include "postproc/nc/linuxcnc.h"
#include "postproc/tables/motion_csv.h"
#include "tests/support/block_lists.h"
#include "tests/support/dialect_lists.h"
#include "tests/support/synthetic_paths.h"

namespace meshwind {
namespace {

const std::string kSource = MESHWIND_SOURCE_DIR;
constexpr int kUnavailable = 77;

int run(const std::string& command) {
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void save(const std::filesystem::path& file, const std::string& text) {
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    ASSERT_TRUE(stream.flush());
}

class LinuxCncOracle : public testing::Test {
protected:
    void SetUp() override {
        if (run(kSource + "/tests/tools/run_rs274.sh --setup") == kUnavailable) {
            GTEST_SKIP() << "LinuxCNC's interpreter is unavailable; see tests/tools/run_rs274.sh";
        }
        folder_ = std::filesystem::temp_directory_path() /
                  ("meshwind-oracle-" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }

    void TearDown() override {
        if (!folder_.empty()) {
            std::filesystem::remove_all(folder_);
        }
    }

    // Writes program and table, compares ours and theirs; then the same with repeats folded.
    // Returns whether there were any.
    bool check(const std::string& machine_file, const BlockList& blocks) {
        const LinuxCnc dialect;
        const BlockList prepared = dialect.prepare(blocks);
        check_text(machine_file, {prepared, {}});
        const FoldedProgram folded = dialect.fold(prepared);
        if (!folded.layout.main.empty()) {
            check_text(machine_file, folded);
        }
        return !folded.layout.main.empty();
    }

    void check_text(const std::string& machine_file, const FoldedProgram& program) {
        const Machine machine = read_machine(machine_file);
        const LinuxCnc dialect;
        const std::string text = dialect.write(
            machine, program.list, program.layout,
            {.version = "test", .mandrel = "synthetic (no file)", .tie_on_mm = {{70.0, 0.0, 1.5}}});
        EXPECT_EQ(dialect.read(text, "program.ngc", machine).nano, program.list.nano);
        compare(machine_file, text, program.list);
    }

    // Their reading of the program against the blocks.
    void compare(const std::string& machine_file, const std::string& text,
                 const BlockList& blocks) {
        save(folder_ / "program.ngc", text);
        save(folder_ / "motion.csv", motion_csv(read_machine(machine_file), blocks));
        const int code =
            run(kSource + "/tests/tools/check_program.py " + (folder_ / "program.ngc").string() +
                " " + (folder_ / "motion.csv").string() + " " + machine_file);
        if (code == kUnavailable) {
            GTEST_SKIP() << "LinuxCNC's interpreter is unavailable";
        }
        EXPECT_EQ(code, 0) << text.substr(0, 2000);
    }

    // Their reading of the program against ours.
    void compare(const std::string& machine_file, const std::string& text) {
        compare(machine_file, text,
                LinuxCnc().read(text, "program.ngc", read_machine(machine_file)));
    }

    static BlockList plan(const std::string& machine_file, const EyePath& path) {
        const Machine machine = read_machine(machine_file);
        const JointPath joints = solve_joints(machine, path, RedundancyPolicy::CentralAngle);
        EXPECT_TRUE(joints.violations.empty());
        return make_blocks(machine, path, joints, fibre_moved_mm(path)).list;
    }

    std::string six_axis_ = kSource + "/machines/six_axis.json";
    std::string five_axis_ = kSource + "/data/conformance/machine/valid/five_axis_roll_only.json";
    std::filesystem::path folder_;
};

TEST_F(LinuxCncOracle, ProgramWrittenByHand) {
    compare(six_axis_, read_text_file(kSource + "/data/programs/pipe_helix.ngc"));
}

// Absolute and incremental words in mm and inches, G92 among them, rapid moves with the fibre on,
// digits finer than the axes' steps: programs as others write them.
TEST_F(LinuxCncOracle, ProgramsOfOthers) {
    const Machine machine = read_machine(six_axis_);
    for (unsigned seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE(seed);
        const std::string text = test::foreign_program(machine, seed, 400);
        const BlockList ours = LinuxCnc().read(text, "program.ngc", machine);
        save(folder_ / "program.ngc", text);
        ASSERT_EQ(run(kSource + "/tests/tools/run_rs274.sh " + (folder_ / "program.ngc").string() +
                      " > " + (folder_ / "moves.csv").string()),
                  0);
        std::map<std::int32_t, std::array<double, 9>> theirs;  // by line: x y z a b c u v w
        std::istringstream rows(read_text_file(folder_ / "moves.csv"));
        std::string row;
        std::getline(rows, row);
        while (std::getline(rows, row)) {
            std::istringstream cells(row);
            std::string cell;
            std::getline(cells, cell, ',');
            std::array<double, 9>& place = theirs[std::stoi(cell)];
            std::getline(cells, cell, ',');  // kind
            std::getline(cells, cell, ',');  // feed
            for (double& value : place) {
                std::getline(cells, cell, ',');
                value = std::stod(cell);
            }
        }
        ASSERT_GT(ours.blocks.size(), 100u);
        for (std::size_t i = 1; i < ours.blocks.size(); ++i) {
            const auto& place = theirs.at(ours.blocks[i].line);
            for (std::size_t a = 0; a < ours.axes.size(); ++a) {
                const BlockAxis& axis = ours.axes[a];
                const double step = static_cast<double>(axis.resolution_nano) / kNanoPerUnit;
                EXPECT_NEAR(ours.value(i, a), place[std::string("XYZABCUVW").find(axis.letter)],
                            0.5 * step + 1e-6)
                    << axis.letter << " in line " << ours.blocks[i].line;
            }
        }
    }
}

TEST_F(LinuxCncOracle, HelixForwardAndReturn) {
    const EyePath path = test::strokes(70.0, 200.0, 2.0, 600.0, 8);
    check(six_axis_, plan(six_axis_, path));
    check(five_axis_, plan(five_axis_, path));
}

TEST_F(LinuxCncOracle, BodyWithoutRotationalSymmetry) {
    check(six_axis_, plan(six_axis_, test::elliptic_helix(5000)));
}

TEST_F(LinuxCncOracle, HundredThousandBlocks) {
    check(six_axis_, plan(six_axis_, test::helix(70.0, rad_from_deg(89.0), 200.0, 1.0, 100'001)));
}

TEST_F(LinuxCncOracle, LongTurnBesideATinyLinearMove) {
    BlockList list = plan(six_axis_, test::helix(70.0, rad_from_deg(45.0), 200.0, 5.0, 1));
    std::vector<std::int64_t> row(list.row(0).begin(), list.row(0).end());
    for (int i = 0; i < 20; ++i) {
        row[0] += 360 * kNanoPerUnit;
        row[3] += 1'000'000 * (i % 4);
        list.blocks.push_back({.duration_s = 0.7 + i, .piece = 0, .point = i + 1});
        list.nano.insert(list.nano.end(), row.begin(), row.end());
    }
    check(six_axis_, list);
}

TEST_F(LinuxCncOracle, RandomBlocks) {
    for (const unsigned seed : {1u, 2u, 3u}) {
        check(six_axis_, test::random_list(read_machine(six_axis_), seed, 20'000));
    }
}

// Steps that are not powers of ten, and controller lines of one's own.
TEST_F(LinuxCncOracle, OtherMachineFiles) {
    std::ifstream stream(six_axis_);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    const auto replace = [&](const std::string& from, const std::string& to) {
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        text.replace(at, from.size(), to);
    };
    replace("\"resolution\": 0.001", "\"resolution\": 0.015625");
    replace("\"resolution\": 0.001", "\"resolution\": 0.0005");
    replace("G64 P2 Q0.01", "G91 G64 P0.05 (a mode that the start must not inherit)");
    const std::string file = (folder_ / "machine.json").string();
    save(file, text);
    const Machine machine = read_machine(file);
    EXPECT_EQ(machine.mandrel_chain[0].resolution_nano, 15'625'000);
    check(file, test::random_list(machine, 4, 5000));
    EXPECT_TRUE(check(file, test::pattern(machine, {.circuits = 60, .advance_deg = 777.773})));
}

TEST_F(LinuxCncOracle, RepeatedCircuits) {
    const Machine machine = read_machine(six_axis_);
    EXPECT_TRUE(check(six_axis_, test::pattern(machine, {.advance_deg = 1234.56746})));
    EXPECT_TRUE(check(six_axis_, test::pattern(machine, {.circuits = 50, .advance_deg = 1234.5})));
    EXPECT_TRUE(
        check(six_axis_, test::pattern(machine, {.circuits = 500, .length = 4, .lead = 1})));
}

// LinuxCNC takes Fanuc's form as well: header, points, subprograms between % and %.
TEST_F(LinuxCncOracle, FanucPrograms) {
    const Machine machine = test::machine_for("fanuc");
    const Fanuc fanuc;
    for (const BlockList& planned :
         {test::random_list(machine, 6, 5000), test::small_program(machine),
          test::pattern(machine, {.advance_deg = 1234.56746}),
          test::pattern(machine, {.circuits = 50, .advance_deg = 1234.5, .lead = 0})}) {
        const BlockList list = LinuxCnc().prepare(planned);  // for the feed floor
        const FoldedProgram folded = fanuc.fold(list);
        compare(six_axis_, fanuc.write(machine, list, {}, {.mandrel = "pipe (1).stl"}), list);
        compare(six_axis_, fanuc.write(machine, folded.list, folded.layout, {}), folded.list);
    }
}

// And GRBL's, as long as nothing is lost in floats.
TEST_F(LinuxCncOracle, GrblPrograms) {
    const Machine machine = test::machine_for("grbl");
    const BlockList list = LinuxCnc().prepare(Grbl().prepare(test::random_list(machine, 6, 5000)));
    compare(six_axis_, Grbl().write(machine, list, {}, {.mandrel = "pipe (1).stl"}), list);
}

TEST_F(LinuxCncOracle, FormsThatTheReaderTakes) {
    const std::string start = "G21 G90\nG0 A0 B0 C0\nG0 X100 Y0 Z0\nM0\nG91 G93\n";
    for (const std::string& text :
         {std::string(
              "%\n(head)\r\nN10 g21 g90 ; words\nG0A0B0C0\nG0 X 100.000000000000 Y-.5 Z+7.\n"
              "M1\nG91 G93\nG1X1.5F60\n(course 4) x-1.25 c-360 f30\nG90 X100 F120\n"
              "G94 G91 G1 Z3 Y4 F300\nC90 F900\nM30\nX9\n"),
          start +
              "G1 X1 F60\nG94 F600\nX3 Y4 C1\nA3 B4\nX0.001 C90\nG90 X100 C0\nG93 X101 F20\nM2\n",
          "O7 (title)\no<one> sub\nG1 X1 F60\no<One>endsub\n" + start +
              "o1 repeat[ 3 ]\no<o ne> call\no1 endrepeat ; three\nm98p0100l2\nM2\nO0100\n"
              "N5 G94\nG1 X3 C9 F900\nG93\nM99 (back)\n",
          "%\n" + start +
              "M98 P7. L2.\nG1 Y1 F30\nM30\nO7\no5 repeat [2]\nG1 Z1 F60\n"
              "o5 endrepeat\nM98 P8\nM99\nO8\nG1 B1 F60\nM99\n%\n"}) {
        compare(six_axis_, text);
    }
}

// Random programs of subprograms in both forms and of repeats, calling only what comes later in
// their own order, so that none calls itself. Each repeat has its own number.
class RandomProgram {
public:
    explicit RandomProgram(unsigned seed) : engine_(seed) {}

    std::string text() {
        const int subs = number(0, 4);
        by_number_.resize(static_cast<std::size_t>(subs));
        std::string before;
        std::string behind;
        for (int s = subs - 1; s >= 0; --s) {
            const bool numbered = number(0, 1) == 0;
            by_number_[static_cast<std::size_t>(s)] = numbered;
            const std::string body = stretch(s + 1, 0);
            if (numbered) {
                behind.insert(0, "O" + label(s) + " (course " + label(s) + ")\n" + body + "M99\n");
            } else {
                const std::string sub =
                    "o" + label(s) + " sub\n" + body + "o" + label(s) + " endsub\n";
                number(0, 1) == 0 ? before += sub : behind.insert(0, sub);
            }
        }
        return before + "G21 G90\nG0 A0 B0 C0\nG0 X100 Y0 Z0\nM0\nG91 G93\n" + move() +
               stretch(0, 0) + "M2\n" + behind;
    }

private:
    int number(int least, int most) {
        return std::uniform_int_distribution<int>(least, most)(engine_);
    }

    static std::string label(int sub) { return std::to_string(100 + sub); }

    std::string move() {
        static constexpr const char* kAxes[] = {"X", "Y", "Z", "A", "B", "C"};
        std::string line = "G1";
        const int first = number(0, 5);
        for (int a = first; a < number(first + 1, 6); ++a) {
            line += " " + std::string(kAxes[a]) + fixed(0.001 * number(100, 5000), 3);
        }
        return line + " F" + std::to_string(number(20, 400)) + "\n";
    }

    // In feed per minute and back, for G93 must have an F in every line.
    std::string per_minute() {
        return "G94\n" + move() + "G1 C" + std::to_string(number(1, 9)) + "\nG93\n";
    }

    std::string stretch(int first_sub, int depth) {
        std::string text;
        for (int i = number(0, 4); i >= 0; --i) {
            const int what = number(0, 5);
            const int subs = static_cast<int>(by_number_.size());
            if (what == 0 && depth < 3) {
                const std::string o = "o" + std::to_string(++repeats_);
                text += o + " repeat [" + std::to_string(number(0, 3)) + "]\n" +
                        stretch(first_sub, depth + 1) + o + " endrepeat\n";
            } else if (what < 3 && first_sub < subs) {
                const int sub = number(first_sub, subs - 1);
                text += by_number_[static_cast<std::size_t>(sub)]
                            ? "M98 P" + label(sub) + " L" + std::to_string(number(1, 3)) + "\n"
                            : "o" + label(sub) + " call\n";
            } else {
                text += what == 5 ? per_minute() : move();
            }
        }
        return text;
    }

    std::mt19937 engine_;
    std::vector<bool> by_number_;
    int repeats_ = 0;
};

TEST_F(LinuxCncOracle, SubprogramsAndRepeatsRunAsWeReadThem) {
    for (unsigned seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE(seed);
        compare(six_axis_, RandomProgram(seed).text());
    }
}

// The comparison itself must be able to fail: each program differs from its table in one thing.
TEST_F(LinuxCncOracle, ComparisonFindsWrongPrograms) {
    const std::string start = "G21 G90\nG0 A0 B0 C0\nG0 X100 Y0 Z0\nG91 G93\n";
    save(folder_ / "motion.csv",
         "block,time_s,C,Z,Y,X,A,B,ex_mm,ey_mm,ez_mm,rx,ry,rz,course,point\n"
         "0,0.0,0,0,0,100,0,0,0,0,0,0,0,1,0,0\n1,1.0,360,0,0,100.001,0,0,0,0,0,0,0,1,0,1\n"
         "2,2.0,360,1,0,100.001,0,0,0,0,0,0,0,1,0,2\n");
    const auto verdict = [&](const std::string& moves) {
        save(folder_ / "program.ngc", start + moves);
        return run(kSource + "/tests/tools/check_program.py " + (folder_ / "program.ngc").string() +
                   " " + (folder_ / "motion.csv").string() + " " + six_axis_);
    };
    const int faster = verdict("G1 X0.001 C360 F120\nG1 Z1 F60\nM2\n");
    if (faster == kUnavailable) {
        GTEST_SKIP() << "LinuxCNC's interpreter is unavailable";
    }
    EXPECT_EQ(faster, 1);                                          // twice as fast
    EXPECT_EQ(verdict("G1 X0.001 C360 F60\nG1 Z1 F60\nM2\n"), 1);  // caught by the feed floor
    EXPECT_EQ(verdict("G1 C360 F60\nG1 Z1 F60\nM2\n"), 1);         // X one step off
    EXPECT_EQ(verdict("G1 X0.001 C360 F60\nM2\n"), 1);             // a block less
    EXPECT_EQ(verdict("G1 X0.001 C360\nG1 Z1 F60\nM2\n"), 1);      // refused: no F
    EXPECT_EQ(verdict("G1 X0.001 C360 F60\nG1 Z1 F60\n"), 1);      // cut off
}

}  // namespace
}  // namespace meshwind
