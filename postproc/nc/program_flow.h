/// Control flow of a program: the order in which a controller runs its lines, with calls of
/// subprograms and repeated stretches, whatever words the language has for them.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace meshwind {

/// Most lines that a program may run, repetitions counted each time. A larger program is refused
/// before the first line is run, for it would not fit in memory: 20 million blocks of six axes take
/// 1.5 GB, twice that while they grow.
inline constexpr std::int64_t kMaxLinesRun = 20'000'000;

/// Most repeated stretches within one another; no program has a use for more.
inline constexpr std::size_t kMaxOpenRepeats = 100;

/// A stretch of a program. Lines of the text are counted from 1.
struct FlowStep {
    enum class Kind {
        Lines,       ///< first..last, one after the other
        Call,        ///< in line first, of subprogram `name`
        Repeat,      ///< from the line first that opens to the line last that closes it
        Label,       ///< the line first names a place and does nothing
        Definition,  ///< first..last define subprogram `name`: skipped
    };
    Kind kind = Kind::Lines;
    std::int32_t first = 0;
    std::int32_t last = 0;
    std::string name{};
    std::int64_t times = 1;        ///< Call, Repeat: >= 0
    std::vector<FlowStep> body{};  ///< Repeat
};

struct Subprogram {
    std::int32_t first = 0;  ///< the line that names it
    std::int32_t last = 0;   ///< the line that returns from it
    std::vector<FlowStep> body{};
};

struct ProgramFlow {
    std::vector<FlowStep> main{};
    std::map<std::string, Subprogram> subprograms{};
    std::size_t levels = 10;  ///< of the main program and what it calls, as the controller has them
    /// The controller knows a subprogram once the program has passed its definition or called it,
    /// and finds one that it does not know only behind the call.
    bool searches_forward = true;
};

/// Kind of a line: code to execute, or the flow itself (call, opening, close), of which at most the
/// comments matter.
enum class FlowLine { Code, Control };

/// Gives `visit` each line in the order in which the controller comes to it, until it returns
/// false. Everything is checked before the first line.
/// \param file name used in messages
/// \throws InputError nc.no_subprogram, nc.recursion, nc.nesting, nc.too_many_lines; while it runs,
/// nc.subprogram_place
void run_flow(const ProgramFlow& flow, const std::string& file,
              const std::function<bool(std::int32_t line, FlowLine kind)>& visit);

}  // namespace meshwind
