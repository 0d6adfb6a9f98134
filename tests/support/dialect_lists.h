/// Machines and small programs for every dialect, for tests.
#pragma once

#include <string>
#include <vector>

#include "machines/machine.h"
#include "postproc/motion/block.h"
#include "postproc/nc/dialect.h"

namespace meshwind::test {

/// Whether it is a language of robots, with absolute positions.
[[nodiscard]] bool is_robots(const std::string& dialect);

/// machines/six_axis.json for a dialect, for a robot's robot_winder.json, without header lines and
/// with a feed that it takes.
[[nodiscard]] Machine machine_for(const std::string& dialect);

/// A helix of two strokes and twelve circuits that repeat, as data/programs/ has it.
[[nodiscard]] BlockList small_program(const Machine& machine);

/// Whether a changed program is refused, or read as other motions, times or stops than the whole.
[[nodiscard]] bool reads_otherwise(const Dialect& dialect, const Machine& machine,
                                   const std::string& changed, const BlockList& whole);

/// 10,000 circuits there and back, four blocks each, in which C turns by `circuit_deg`; and the
/// exact angle in the end.
struct ManyCircuits {
    BlockList list;
    double end_deg = 0.0;
};
[[nodiscard]] ManyCircuits many_circuits(const Machine& machine, double circuit_deg);

/// Where the words of an incremental program lead, added up as the controller does it: the axes'
/// positions at the end by letter, mm or deg.
enum class Summation { Exact, GrblFloats, MarlinFloats };
[[nodiscard]] std::vector<double> end_of_program(const std::string& text, const Machine& machine,
                                                 Summation summation);

/// Lines of a text.
[[nodiscard]] std::vector<std::string> split_lines(const std::string& text);

}  // namespace meshwind::test
