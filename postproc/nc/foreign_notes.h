/// Reading of foreign programs, not by meshwind: their idle codes, and remarks on ambiguities.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "postproc/motion/block.h"
#include "postproc/nc/linuxcnc_words.h"

namespace meshwind {

/// Whether a comment in the first lines says so.
[[nodiscard]] bool is_by_meshwind(std::span<const std::string_view> lines);

/// Origin of a program, from the whole text before its lines are run.
struct ProgramOrigin {
    bool by_meshwind = false;
    bool feeds = false;  ///< it has G1; without one its rapid moves wind
    bool stops = false;  ///< it has M0; without one the first of those moves leads to the start
};

[[nodiscard]] ProgramOrigin origin_of(NcComments comments, std::span<const std::string_view> lines);

/// Whether a code of a foreign program moves no axis and is left out. \param tenths NcLine::code
[[nodiscard]] bool is_idle_g(int tenths);
[[nodiscard]] bool is_idle_m(int tenths);

/// G4, which makes the axes rest, in tenths.
inline constexpr int kPauseCode = 40;

/// Whether words of a letter concern no axis in a foreign program, where no axis has it: tools,
/// spindles, parameters of M words.
[[nodiscard]] bool is_idle_letter(char letter);

/// Counts the ambiguities of a program and its words beside the motion.
class ForeignNotes {
public:
    /// Number of occurrences, and the line of the first.
    struct Seen {
        std::size_t times = 0;
        std::int32_t line = 0;
    };

    void unplaced(char axis, std::int32_t line) { unplaced_.emplace(axis, line); }
    /// \param off_nano from the text's position to the axis' nearest step
    void rounded(const BlockAxis& axis, std::int64_t off_nano);
    /// \param by_feed whether the controller runs it at F
    void rapid_with_fibre(bool by_feed, std::int32_t line);
    void set_place(std::int32_t line) { see(set_place_, line); }
    void inches(std::int32_t line) { see(inches_, line); }
    void skipped(const NcWord& word);
    void no_end(const std::string& end_words) { no_end_ = end_words; }

    /// A remark for each kind. \param wound_by_rapids whether the program has no feed move
    [[nodiscard]] std::vector<std::string> words(bool wound_by_rapids) const;

private:
    struct Rounding {
        std::size_t times = 0;
        std::int64_t most_nano = 0;
        AxisType type = AxisType::Linear;
    };

    static void see(Seen& seen, std::int32_t line);

    std::map<char, std::int32_t> unplaced_;
    std::map<char, Rounding> rounded_;
    std::map<std::string, std::size_t> skipped_;
    Seen rapid_;
    bool rapid_by_feed_ = false;
    Seen set_place_;
    Seen inches_;
    std::string no_end_;
};

}  // namespace meshwind
