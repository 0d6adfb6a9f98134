#include "postproc/verify/verify.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/text/text_number.h"
#include "postproc/verify/check_finding.h"
#include "postproc/verify/laid_checks.h"
#include "postproc/verify/motion_checks.h"
#include "postproc/verify/roller_check.h"
#include "postproc/verify/verify_head.h"

namespace meshwind {
namespace {

// What fails before the first block is no matter of blocks: only the first wrong one is noted.
CheckFinding head_finding(Check check, std::size_t block) {
    CheckFinding finding(std::move(check));
    if (!finding.check.ok) {
        finding.first_wrong_block = block;
    }
    return finding;
}

// Checks on the head of a program that was read from a text.
std::vector<CheckFinding> head_findings(const VerifyTask& task, const LaidPath& laid) {
    std::vector<CheckFinding> findings;
    if (!task.program.head) {
        return findings;
    }
    findings.push_back(head_finding(tie_on_check(task, laid.path.front().position_mm), 0));
    if (task.program.head->has_approach) {
        findings.push_back(head_finding(approach_check(task), 0));
        PathModeFinding mode = path_mode_check(task);
        findings.push_back(head_finding(std::move(mode.check), mode.block));
    }
    return findings;
}

void keep_once(std::vector<std::size_t>& blocks) {
    std::sort(blocks.begin(), blocks.end());
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
}

// Moves the checks into the verification, with all blocks at which they fail.
void add_findings(Verification& verification, std::vector<CheckFinding>&& findings) {
    std::vector<std::size_t>& wrong = verification.wrong_blocks;
    std::vector<std::size_t>& coarse = verification.coarse_blocks;
    std::optional<std::size_t>& first = verification.first_wrong_block;
    for (CheckFinding& finding : findings) {
        verification.checks.push_back(std::move(finding.check));
        wrong.insert(wrong.end(), finding.wrong_blocks.begin(), finding.wrong_blocks.end());
        coarse.insert(coarse.end(), finding.coarse_blocks.begin(), finding.coarse_blocks.end());
        if (finding.first_wrong_block) {
            first =
                std::min(*finding.first_wrong_block, first.value_or(*finding.first_wrong_block));
        }
    }
    keep_once(wrong);
    keep_once(coarse);
}

void append_cells(std::string& text, const Eigen::Vector3d& v, int decimals) {
    for (const double x : v) {
        text += ',';
        append_fixed(text, x, decimals);
    }
}

}  // namespace

Eigen::Vector3d tie_on_of(const BlockList& program) {
    if (!program.tie_on_mm) {
        throw InputError("verify.tie_on", "",
                         "the program does not say where the fibre is tied on; give --tie-on "
                         "X,Y,Z in the mandrel's frame");
    }
    return *program.tie_on_mm;
}

Verification verify(const VerifyTask& task) {
    const Eigen::Vector3d tie_on_mm = tie_on_of(task.program);
    Verification found;
    found.laid = lay_down(task.wall, task.machine, task.program, tie_on_mm, task.rules.simulation);
    const LaidPath& laid = found.laid;
    found.fibre_length_mm = laid.path.back().s_mm;
    found.duration_s = task.program.duration_s();
    std::vector<CheckFinding> findings = head_findings(task, laid);
    if (!task.plan.empty()) {
        found.deviation = compare(laid, task.plan, task.rules.laydown);
    }
    findings.push_back(laydown_finding(task, laid, found.deviation));
    found.slip = station_slip(task, laid);
    findings.push_back(slip_finding(task, laid, found.slip));
    findings.push_back(bridging_finding(task, laid));
    findings.push_back(collision_finding(task, laid));
    const FreeLengthRange range = free_length_range(laid);
    found.shortest_free_mm = range.shortest_mm;
    found.longest_free_mm = range.longest_mm;
    findings.push_back(free_length_finding(task, laid, range));
    const RollerFinding roller = find_roller(task.machine, laid);
    found.turned_over = roller.turned_over;
    findings.push_back(roller_finding(task, laid, roller));
    findings.push_back(limits_finding(task, laid));
    LaidPayout payout = find_payout(laid, task.machine.fibre);
    findings.push_back(payout_finding(task, laid, payout));
    found.fast_blocks = std::move(payout.fast_blocks);
    add_findings(found, std::move(findings));
    return found;
}

std::string laid_csv(const Verification& verification, const BlockList& program) {
    const LaidPath& laid = verification.laid;
    std::string text =
        "block,line,s_mm,x_mm,y_mm,z_mm,nx,ny,nz,tx,ty,tz,kn_per_mm,slip,bridge_mm\n";
    for (std::size_t i = 0; i < laid.path.size(); ++i) {
        const PathPoint& station = laid.path[i];
        text += std::to_string(laid.at[i].block);
        text += ',' + std::to_string(program.blocks[laid.at[i].block].line) + ',';
        append_fixed(text, station.s_mm, 4);
        append_cells(text, station.position_mm, 4);
        append_cells(text, station.normal, 7);
        append_cells(text, station.tangent, 7);
        text += ',';
        append_fixed(text, station.kn_per_mm, 8);
        text += ',';
        append_fixed(text, verification.slip[i], 5);
        text += ',';
        append_fixed(text, laid.at[i].gap_mm, 4);
        text += '\n';
    }
    return text;
}

}  // namespace meshwind
