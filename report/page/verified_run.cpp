#include "report/page/verified_run.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "winding/laminate/measure_plan.h"

namespace meshwind {
namespace {

// Stations of a laid path, both included.
struct Stretch {
    std::size_t first = 0;
    std::size_t last = 0;
};

// Between course marks; each begins with the last station of the one before.
std::vector<Stretch> stretches_of(const BlockList& blocks, const LaidPath& laid) {
    const auto mark = [&](std::size_t i) { return blocks.blocks[laid.at[i].block].piece; };
    std::vector<Stretch> stretches;
    for (std::size_t i = 1; i < laid.path.size(); ++i) {
        const bool same = !stretches.empty() && mark(i) == mark(stretches.back().last);
        if (same) {
            stretches.back().last = i;
        } else {
            stretches.push_back({i - 1, i});
        }
    }
    return stretches;
}

Piece piece_of(const Verification& found, const Stretch& stretch) {
    Piece piece;
    const SurfacePath& path = found.laid.path;
    for (std::size_t i = stretch.first; i <= stretch.last; ++i) {
        piece.path.push_back(path[i]);
        piece.path.back().s_mm -= path[stretch.first].s_mm;
        const LaidAt& at = found.laid.at[i];
        piece.string.gap_mm.push_back(at.lifted ? at.gap_mm : 0.0);
        piece.string.slope.push_back(0.0);
        const bool known = i < found.slip.size() && std::isfinite(found.slip[i]);
        piece.slip.push_back(known ? found.slip[i] : 0.0);
    }
    const auto worst = std::max_element(piece.string.gap_mm.begin(), piece.string.gap_mm.end());
    piece.string.worst_gap_mm = *worst;
    piece.string.worst_station = static_cast<std::size_t>(worst - piece.string.gap_mm.begin());
    piece.worst_slip = *std::max_element(piece.slip.begin(), piece.slip.end());
    return piece;
}

// Of each station of the pieces; blocks are told the last one that they lay.
EyePath eyes_of(const LaidPath& laid, const std::vector<Stretch>& stretches, BlockList& blocks) {
    EyePath eyes;
    std::size_t sample = 0;
    std::size_t block = 0;
    for (std::size_t p = 0; p < stretches.size(); ++p) {
        for (std::size_t i = stretches[p].first; i <= stretches[p].last; ++i) {
            while (sample + 1 < laid.samples.size() &&
                   laid.samples[sample].s_mm < laid.path[i].s_mm) {
                ++sample;
            }
            EyePoint& eye = eyes.emplace_back(laid.samples[sample]);
            eye.piece = static_cast<std::int32_t>(p);
            eye.point = static_cast<std::int32_t>(i - stretches[p].first);
            eye.s_mm = laid.path[i].s_mm;
            eye.landing_mm = laid.path[i].position_mm +
                             (laid.at[i].lifted ? laid.at[i].gap_mm : 0.0) * laid.path[i].normal;
            for (; block < blocks.blocks.size() && block < laid.at[i].block; ++block) {
                blocks.blocks[block].piece = eyes.size() > 1 ? eyes[eyes.size() - 2].piece : 0;
                blocks.blocks[block].point = eyes.size() > 1 ? eyes[eyes.size() - 2].point : 0;
            }
        }
    }
    for (; block < blocks.blocks.size() && !eyes.empty(); ++block) {
        blocks.blocks[block].piece = eyes.back().piece;
        blocks.blocks[block].point = eyes.back().point;
    }
    return eyes;
}

}  // namespace

Run run_of(VerifyOutcome outcome, std::string text, std::uint64_t seed) {
    Run run;
    run.seed = seed;
    run.complete = true;
    run.usable = true;
    run.checks = outcome.checks;
    if (outcome.blocks.head) {
        run.remarks = outcome.blocks.head->remarks;
    }
    WoundLayer& layer = run.layers.emplace_back();
    layer.checks = outcome.checks;
    layer.setup = std::move(outcome.setup);
    const Verification& found = outcome.verification;
    const std::vector<Stretch> stretches = stretches_of(outcome.blocks, found.laid);
    if (stretches.empty() || found.laid.samples.empty()) {
        layer.plan.failure = "the program lays no fibre on the part";
        return run;
    }
    Plan& plan = layer.plan;
    plan.planner = Planner::Imported;
    for (const Stretch& stretch : stretches) {
        plan.pieces.push_back(piece_of(found, stretch));
        plan.worst_slip = std::max(plan.worst_slip, plan.pieces.back().worst_slip);
        plan.worst_bridge_mm =
            std::max(plan.worst_bridge_mm, plan.pieces.back().string.worst_gap_mm);
    }
    plan.pieces.front().starts_fibre = true;
    plan.fibres = 1;
    plan.courses = static_cast<int>(plan.pieces.size());
    plan.fibre_length_mm = found.fibre_length_mm;
    measure_plan(layer.setup.mandrel.surface, layer.setup.wall->surface(),
                 layer.setup.job.tow.width_mm, seed, {}, plan);
    FibreProgram& program = layer.programs.emplace_back();
    program.file = outcome.program;
    program.text = std::move(text);
    PieceProgram& made = program.made;
    made.read = outcome.blocks;
    made.blocks = std::move(outcome.blocks);
    made.eyes.path = eyes_of(found.laid, stretches, made.blocks);
    made.eyes.shortest_mm = found.shortest_free_mm;
    made.eyes.longest_mm = found.longest_free_mm;
    made.duration_s = found.duration_s;
    made.verification = std::move(outcome.verification);
    return run;
}

}  // namespace meshwind
