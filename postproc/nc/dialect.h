/// Interface of a controller language (dialect): writes blocks as a program and reads them back.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "machines/machine.h"
#include "postproc/motion/block.h"
#include "postproc/nc/made_from.h"
#include "postproc/nc/repeats.h"

namespace meshwind {

/// Content of a program's head, for the operator; empty texts are left out.
struct ProgramHeader {
    std::string version{};         ///< of meshwind
    std::string mandrel{};         ///< file name
    std::string mandrel_digest{};  ///< e.g. "sha256/128 1f2e.."
    std::string machine_file{};    ///< its name; empty: there is none
    std::string job{};             ///< JSON; empty: not told
    std::string job_digest{};
    std::optional<MainJobRun> run{};  ///< none: the main job did not make it
    std::string code_digest{};        ///< of the program's code_of()
    double fibre_length_mm = 0.0;
    std::optional<Eigen::Vector3d> tie_on_mm{};  ///< first landing point, in the mandrel frame
    std::vector<PinRing> pins{};                 ///< on which the fibre turns
    /// File of the program whose fibre is continued; empty where the fibre is tied on. When
    /// continued, `tie_on_mm` is where it lies already.
    std::string goes_on_from{};
    bool in_the_air = false;           ///< no fibre is wound
    std::vector<std::string> notes{};  ///< a line each, e.g. that a failed check was overruled
};

/// One controller language. Stateless; positions survive write and read to the last digit,
/// durations to six digits.
class Dialect {
public:
    virtual ~Dialect() = default;

    [[nodiscard]] virtual std::string name() const = 0;
    /// With the point, e.g. ".ngc".
    [[nodiscard]] virtual std::string extension() const = 0;

    /// Path mode at corners that the machine's header lines set; no words where the language has
    /// none.
    [[nodiscard]] virtual PathMode path_mode(const Machine&) const { return {}; }
    /// Largest distance of the controller's way from the corners between blocks, mm of the linear
    /// axes, set by the machine's header lines; infinite when they set none, for then it keeps the
    /// feed.
    [[nodiscard]] double corner_tolerance_mm(const Machine& machine) const {
        return path_mode(machine).corner_mm;
    }
    /// Whether the controller slows down at corners by a junction deviation.
    [[nodiscard]] virtual bool has_junction_deviation() const { return false; }
    /// Run time of each block on the controller: its duration, and what is added where it meets the
    /// next. \pre list has the axes of the machine
    [[nodiscard]] virtual std::vector<double> run_times_s(const Machine& machine,
                                                          const BlockList& list) const = 0;
    /// The sum.
    [[nodiscard]] double run_time_s(const Machine& machine, const BlockList& list) const;
    /// Tick of the controller: blocks last whole ticks; 0: any time.
    [[nodiscard]] virtual double tick_s() const { return 0.0; }

    /// Checks the machine file's demands on the controller, before anything is planned for it.
    /// \throws InputError what `write` throws for letters, feed and header lines;
    /// dialect.junction_deviation where the controller has no such setting
    void check(const Machine& machine) const;

    /// The blocks as the controller needs them: blocks that it would execute wrongly are written in
    /// another way (more blocks, same positions). Tables beside the program are made from this
    /// result. prepare(prepare(list)) = prepare(list). Axes may get other steps; positions are then
    /// multiples of these. \throws InputError dialect.float32
    [[nodiscard]] virtual BlockList prepare(BlockList list) const = 0;

    /// Folds repeated circuits where the language has subprograms; here nothing.
    /// \param list a result of prepare()
    /// \return the blocks that the program will really run (tables are made from them), and its
    /// layout
    [[nodiscard]] virtual FoldedProgram fold(BlockList list) const { return {std::move(list), {}}; }

    /// The program of prepare(list), a line for each block.
    /// \pre list has the axes of the machine and at least one block
    /// \throws InputError dialect.axis_letter, dialect.feed, dialect.header_line,
    /// dialect.placeholder, dialect.duration, dialect.digits, dialect.long_line
    [[nodiscard]] std::string write(const Machine& machine, const BlockList& list,
                                    const ProgramHeader& header) const {
        return write(machine, prepare(list), {}, header);
    }

    /// The program of what fold() returned; the same errors.
    [[nodiscard]] virtual std::string write(const Machine& machine, const BlockList& list,
                                            const ProgramLayout& layout,
                                            const ProgramHeader& header) const = 0;

    /// Reads a program of the subset that `write` uses (and harmless codes besides): the blocks
    /// that the controller would run, one by one, repetitions expanded.
    /// \param file name used in messages
    /// \return positions and durations; `piece` from the course marks, `line` of each block, the
    /// tie-on of the head to three decimals
    /// \throws InputError nc.* with the place "file:line" for anything else
    [[nodiscard]] virtual BlockList read(std::string_view text, const std::string& file,
                                         const Machine& machine) const = 0;

    /// Normal form of a program, to detect changes: its code in lower case without blanks, line
    /// numbers and comments, and the comment that ties the fibre on; lines end in \n.
    /// \throws InputError nc.comment
    [[nodiscard]] virtual std::string code_of(std::string_view text,
                                              const std::string& file) const = 0;
};

}  // namespace meshwind
