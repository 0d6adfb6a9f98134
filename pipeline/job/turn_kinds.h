/// Kinds of turns beyond a rim, one row each with all their properties.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace meshwind {

struct Job;
class RimTurns;
struct Tow;

/// How the fibre turns round beyond a rim.
enum class TurnKind { Friction, Pins, Pole };

/// Properties of a kind. Words are for the user; empty: nothing to say.
struct TurnKindTraits {
    TurnKind kind = TurnKind::Friction;
    std::string_view word;            ///< in job files
    std::string_view meaning{};       ///< for the reference, where the word alone is not clear
    bool takes_run = false;           ///< along the extension, by friction (least_run_mm)
    bool reads_pins = false;          ///< the job's `pins` are for it
    std::string_view why_patterns{};  ///< why only patterns of bodies of revolution are wound
    /// Why a job cannot be wound with it. Null: every job can. \param points_given landing points
    /// made elsewhere are wound, and the job's layers not read
    std::string (*why_not)(const Job& job, bool points_given) = nullptr;
    /// Maker of the turns of patterns over rims (RimTurnsMaker); never null.
    std::unique_ptr<RimTurns> (*turns)(const Job& job, const Tow& tow,
                                       double extension_mm) = nullptr;
};

/// One row per kind, in the order of the enumerators.
[[nodiscard]] std::span<const TurnKindTraits> turn_kinds();

[[nodiscard]] const TurnKindTraits& traits_of(TurnKind kind);

}  // namespace meshwind
