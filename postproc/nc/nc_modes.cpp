#include "postproc/nc/nc_modes.h"

namespace meshwind {
namespace {

// Of a program of others: codes that say where an axis stands, units, and what moves no axis.
bool take_foreign_g_code(int tenths, const NcWord& word, std::int32_t line, NcModes& modes,
                         NcSaid& said, ForeignNotes& notes) {
    if (tenths == 920) {
        said.sets_place = true;
    } else if (tenths == 921) {
        notes.set_place(line);
        said.clears_place = true;
    } else if (tenths == 200 || tenths == 700) {
        modes.inches = true;
        notes.inches(line);
    } else if (is_idle_g(tenths)) {
        said.idles = said.idles || tenths == kPauseCode;
        notes.skipped(word);
    } else {
        return false;
    }
    return true;
}

void take_g_code(const NcLanguage& language, const NcLine& line, const NcWord& word, NcModes& modes,
                 NcSaid& said, ForeignNotes& notes) {
    const NcFlavour& flavour = language.flavour;
    const int tenths = line.code(word);
    said.motions += tenths == 0 || tenths == 10 ? 1 : 0;
    modes.inches = modes.inches && tenths != 210 && tenths != 710;
    const NcHarmless* known = find_harmless(flavour.harmless_g, tenths);
    if (known != nullptr) {
        said.parameters += known->parameters;
        said.path_code = known->path ? known : said.path_code;
    } else if (tenths == 0 || tenths == 10) {
        modes.motion = tenths == 0 ? NcMotion::Rapid : NcMotion::Feed;
    } else if (tenths == 800 && flavour.has_feed_modes) {
        modes.motion = NcMotion::None;
    } else if (tenths == 900 || tenths == 910) {
        modes.incremental = tenths == 910;
    } else if ((tenths == 930 || tenths == 940) && flavour.has_feed_modes) {
        modes.inverse_time = tenths == 930;
        modes.feed_per_minute = 0.0;  // a change of mode asks for a fresh F
    } else if (!language.foreign ||
               !take_foreign_g_code(tenths, word, line.number, modes, said, notes)) {
        line.not_understood(word);
    }
}

void take_m_code(const NcLanguage& language, const NcLine& line, const NcWord& word, NcModes& modes,
                 NcSaid& said, ForeignNotes& notes) {
    const NcFlavour& flavour = language.flavour;
    const int tenths = line.code(word);
    const NcHarmless* known = find_harmless(flavour.harmless_m, tenths);
    if (known != nullptr) {
        said.parameters += known->parameters;
    } else if ((tenths == 20 || tenths == 300) && !flavour.end.empty()) {
        modes.ended = true;
    } else if (tenths != 0 && tenths != 10 && language.foreign && is_idle_m(tenths)) {
        said.idles = said.idles || flavour.one_command;
        notes.skipped(word);
    } else if (tenths != 0 && tenths != 10) {
        line.not_understood(word);
    }
    said.stops = said.stops || tenths == 0;
}

}  // namespace

NcSaid take_codes(const NcLanguage& language, const NcLine& line, NcModes& modes,
                  ForeignNotes& notes) {
    NcSaid said;
    for (const NcWord& word : line.words) {
        if (word.letter == 'G') {
            take_g_code(language, line, word, modes, said, notes);
        } else if (word.letter == 'M') {
            take_m_code(language, line, word, modes, said, notes);
        }
    }
    return said;
}

}  // namespace meshwind
