/// The winding job: layers, tow, tolerances and turns. docs/files.md describes the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "mesh/mandrel.h"
#include "pipeline/job/turn_kinds.h"
#include "postproc/eye/eye_rules.h"
#include "winding/plan/figures.h"
#include "winding/revolution/pattern_constraints.h"
#include "winding/turn/pin.h"

namespace meshwind {

/// Length of a unit of the mandrel's file. Auto: what the file states, else mm, else metres for a
/// part under 10 units.
enum class LengthUnit { Auto, Micrometre, Millimetre, Centimetre, Metre, Inch };

enum class LayerKind { Auto, Helical, Hoop, Polar, Cover, Imported, Lattice, Wall };

/// Rule for the mandrel's turn where several are possible (redundancy); docs/post.md.
enum class RedundancyRule { CentralAngle, Hold, Oscillate, Optimal };

/// Constraints on the pattern of a layer; omitted values are free
/// (winding/revolution/pattern_constraints.h).
struct PatternJob {
    std::int64_t circuits = 0;  ///< > 0: the number of circuits; not of lattices
    std::int64_t starts = 0;    ///< > 0: the pattern number
    std::optional<BandOrder> lead{};
    std::optional<double> most_overlap{};    ///< 0 .. 1, share of the bands' distance
    double dwell_deg = 0.0;                  ///< >= 0: least dwell at each rim
    std::optional<double> most_dwell_deg{};  ///< >= dwell_deg, at each rim
    double band_offset_mm = 0.0;             ///< > 0: distance of bands; 0: the tow's width
};

/// Least thickness of a wall: one of both.
struct WallAmount {
    std::optional<double> layers{};        ///< > 0, of the tow
    std::optional<double> thickness_mm{};  ///< > 0
};

/// A part of a wall with its own thickness: one of the places is set.
struct WallPart {
    struct Box {
        Eigen::Vector3d least;
        Eigen::Vector3d most;
    };
    std::optional<std::int32_t> region{};
    std::optional<std::string> cad_face{};   ///< as is_named()
    std::optional<Box> box{};                ///< in the file's frame and units
    std::optional<Eigen::Vector3d> point{};  ///< in the file's frame and units
    std::optional<std::int32_t> rim{};
    std::optional<double> within_mm{};  ///< of the point or rim
    WallAmount amount{};
};

struct WallJob {
    WallAmount amount{};
    std::vector<WallPart> parts{};  ///< where several contain a place, the last one counts
};

/// A table of landing points (postproc/tables/landing_csv.h).
struct LandingText {
    std::filesystem::path file;  ///< named in messages
    std::string text;
};

/// One layer; each kind reads the keys that concern it.
struct LayerJob {
    LayerKind kind = LayerKind::Auto;
    std::optional<double> angle_deg;  ///< 0 (axial) .. 90 (hoop), from the local axial direction
    double target_layers = 1.0;       ///< > 0; number of times each place is to be covered
    std::optional<PatternJob> pattern{};          ///< Helical, Polar and Lattice layers only
    std::optional<LatticeConstraints> lattice{};  ///< set for Lattice layers and no others
    std::optional<WallJob> wall{};                ///< set for Wall layers and no others
    std::string file;      ///< landing points of an Imported layer; empty for all others
    LandingText points{};  ///< content of that file, once read (pipeline/load_inputs.h)
};

/// Limit of fibres: each further one has to be cut and tied on by hand.
inline constexpr int kMaxFibres = 9;

struct Job {
    struct MandrelAxis {
        Eigen::Vector3d origin;     ///< in the file's frame and units
        Eigen::Vector3d direction;  ///< not zero, any length
    };
    struct MandrelJob {
        LengthUnit units = LengthUnit::Auto;     ///< as `meshwind inspect` reads the part
        std::optional<MandrelAxis> axis;         ///< none: found
        std::vector<std::int32_t> keep_regions;  ///< region ids; empty: the outer wall
        std::vector<std::string> keep_faces;  ///< of a CAD file, as is_named(); empty: by regions
        std::optional<double> cut_ends_mm;    ///< >= 0; none: all that is no part of an end's leg
        std::optional<double> remove_details_mm;  ///< >= 0; none: lettering
        std::optional<double> blend_mm = 0.0;  ///< 0: crotches and steps stay sharp; none: by trial
        MandrelOptions::Mesh mesh = MandrelOptions::Mesh::Even;
        std::string solid{};              ///< of a CAD file; empty: the only one
        std::optional<double> edge_mm{};  ///< > 0, over a CAD file's faces; none: by its size
        double extension_mm = 100.0;      ///< >= 0; room for turns beyond each rim
        bool extension_given = false;     ///< by the job's author; else it may be made longer
        TurnKind turn = TurnKind::Friction;
        bool turn_given = false;  ///< by the job's author; else pins may be tried
        PinConstraints pins{};    ///< read where the kind of turn does (turn_kinds.h)
    };
    struct TowJob {
        double width_mm = 6.0;       ///< > 0
        double thickness_mm = 0.25;  ///< > 0
        double friction = 0.2;       ///< >= 0; dry carbon on a moulded surface, on the safe side
        std::optional<double> friction_on_fibre{};  ///< >= 0; of layers above the first
        double bridging_tolerance_mm = 0.5;  ///< >= 0; gap that resin and the next layer close
        std::optional<double> most_twist_per_m{};  ///< >= 0; turns of the band a metre; none: any
        double density_g_cm3 = 1.55;  ///< > 0; of the laid tow: carbon in epoxy, 60 % fibres
        std::optional<double> price_per_kg{};  ///< >= 0; of the laid tow, in the user's currency
    };
    struct ToleranceJob {
        double laydown_mm = 0.2;         ///< > 0; laid fibre against planned fibre, sideways
        double laydown_angle_deg = 0.3;  ///< > 0; and in direction
        double clearance_mm = 5.0;       ///< >= 0; machine and free fibre against mandrel
        double bare = kMaxBelow;  ///< 0 .. 1; share of the wall in reach that may lack layers
    };
    struct SpeedJob {
        double fibre_m_min = 30.0;  ///< > 0
    };

    MandrelJob mandrel;
    TowJob tow;
    std::vector<LayerJob> layers = {LayerJob{}};  ///< n >= 1, in winding order
    int fibres = 1;  ///< 1 .. kMaxFibres; most fibres, wound one after the other, cut in between
    bool fibres_given = false;  ///< by the job's author; else there may be more
    EyeLaw eye;
    RedundancyRule redundancy = RedundancyRule::Optimal;
    ToleranceJob tolerance;
    SpeedJob speed;
};

/// Millimetres per unit; 0 for Auto, which leaves the choice to the reader of the mandrel.
[[nodiscard]] double mm_per(LengthUnit unit);

/// The same for a unit's word in job files, "mm"; none where there is no such unit.
[[nodiscard]] std::optional<double> mm_per(std::string_view word);

/// The unit of `mm` millimetres; Auto where there is none.
[[nodiscard]] LengthUnit length_unit(double mm);

/// A value that overrides one of the job file: key layers.0.kind, value hoop.
struct JobSetting {
    std::string key;    ///< keys and indices, joined by dots
    std::string value;  ///< JSON; anything else is a word
};

/// Reads a job from text, then applies the settings; keys that both omit stay as in `base`.
/// \param name file name for messages \param base of a material or process, else the defaults
/// \throws InputError json.* (syntax, unknown or doubled key, type, range), job.zero_direction,
///         job.file_missing, job.file_unused, job.eye_unused, job.pattern_unused, job.turn_forced,
///         job.pins_unused, job.wall_amount, job.wall_place, job.wall_unused, json.no_such_place
///         (of a setting); each with file and JSON pointer
[[nodiscard]] Job parse_job(std::string_view text, const std::string& name,
                            std::span<const JobSetting> settings = {}, const Job& base = {});

/// `parse_job` of a file. \throws IoError io.cannot_read; InputError as parse_job
[[nodiscard]] Job read_job(const std::filesystem::path& file,
                           std::span<const JobSetting> settings = {}, const Job& base = {});

/// The job as a complete job file: every key present, always in the same order, so that equal jobs
/// give equal text. Reads back as the same job.
[[nodiscard]] std::string job_text(const Job& job);

/// The same without keys that equal those of an empty job file, unless the job's file gave them:
/// the content that a file needs for the same job.
[[nodiscard]] std::string told_job_text(const Job& job);

/// JSON Schema of job files; data/schema/job.schema.json holds it.
[[nodiscard]] std::string job_schema_text();

/// The word of the job file.
[[nodiscard]] std::string_view name_of(LayerKind kind);

}  // namespace meshwind
