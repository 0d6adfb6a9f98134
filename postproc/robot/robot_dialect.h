/// What the languages of robots have in common as dialects.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "postproc/nc/dialect.h"
#include "postproc/nc/linuxcnc_words.h"
#include "postproc/robot/robot_axes.h"
#include "postproc/robot/robot_head.h"

namespace meshwind {

struct RobotLanguage {
    const char* name;       ///< in a machine file
    const char* extension;  ///< with the point
    const char* title;      ///< in messages
    NcComments comments;
    std::array<const char*, kMaxExternalAxes> external;  ///< names of the external axes
    const char* not_in_comments = "";                    ///< characters with a meaning even there
    char stand_in = '?';                                 ///< written in their place
};

/// A language whose blocks have absolute positions of all axes and a time. The controller reads
/// numbers into 32-bit floats; the head says what that takes off an axis that has turned far.
/// \throws InputError dialect.robot_axes besides what a dialect throws
class RobotDialect : public Dialect {
public:
    [[nodiscard]] std::string name() const final { return language_.name; }
    [[nodiscard]] std::string extension() const final { return language_.extension; }
    [[nodiscard]] std::vector<double> run_times_s(const Machine& machine,
                                                  const BlockList& list) const final;
    [[nodiscard]] BlockList prepare(BlockList list) const final;
    using Dialect::write;
    [[nodiscard]] std::string write(const Machine& machine, const BlockList& list,
                                    const ProgramLayout& layout,
                                    const ProgramHeader& header) const final;

protected:
    /// \param language outlives this
    explicit RobotDialect(const RobotLanguage& language) : language_(language) {}

private:
    /// The duration of a block as the language can say it, never shorter.
    [[nodiscard]] virtual double sayable_s(double duration_s) const { return duration_s; }
    /// The program. \param source checked
    [[nodiscard]] virtual std::string text_of(const RobotSource& source) const = 0;

    const RobotLanguage& language_;
};

}  // namespace meshwind
