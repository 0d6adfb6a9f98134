/// Modal state of a G-code program, and its changes by the codes of a line.
#pragma once

#include <optional>
#include <string>

#include "postproc/nc/foreign_notes.h"
#include "postproc/nc/linuxcnc_words.h"
#include "postproc/nc/nc_flavour.h"

namespace meshwind {

enum class NcMotion { None, Rapid, Feed };

/// Modes that last from line to line.
struct NcModes {
    NcMotion motion = NcMotion::None;
    bool incremental = false;
    bool inverse_time = false;
    bool inches = false;
    double feed_per_minute = 0.0;  ///< 0: none was said, or not in this mode
    bool feed_in_inches = false;
    bool ended = false;
};

/// Content of one line, without the values of axes.
struct NcSaid {
    int motions = 0;                        ///< G0 and G1
    std::string parameters{};               ///< letters that belong to a harmless code
    const NcHarmless* path_code = nullptr;  ///< the last; null: none
    bool stops = false;                     ///< M0
    bool idles = false;                     ///< a pause, or an M word that is left out
    bool sets_place = false;                ///< G92
    bool clears_place = false;              ///< G92.1
    std::optional<double> feed{};           ///< F
    bool axes = false;                      ///< it has words of axes
};

/// A flavour, and whether the program is foreign: then more codes are taken.
struct NcLanguage {
    const NcFlavour& flavour;
    bool foreign = false;
};

/// Takes the codes of a line, in order, into the modes, and foreign ones that move no axis into the
/// notes. F and axes are left to be read. \throws InputError nc.not_understood, nc.number
[[nodiscard]] NcSaid take_codes(const NcLanguage& language, const NcLine& line, NcModes& modes,
                                ForeignNotes& notes);

}  // namespace meshwind
