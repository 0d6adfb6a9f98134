#include "postproc/ringhead/ring_drive.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/text/csv_table.h"
#include "core/text/text_number.h"
#include "core/units.h"

namespace meshwind {
namespace {

constexpr CsvErrors kErrors{"rings.column", "rings.number",
                            "take the table as meshwind carry writes it"};
// Microseconds: a ring of 100 rev/min turns by 6e-4 deg meanwhile.
constexpr int kTimeDecimals = 6;
constexpr int kPlaceDecimals = 4;
constexpr int kTurnDecimals = 5;

}  // namespace

std::vector<RingPassage> ring_passages(const RingHead& head, const RingPassageTask& task) {
    std::vector<RingPassage> passages;
    for (int pass = 0; pass < task.passes; ++pass) {
        for (const int ring : {0, 1}) {
            RingPassage passage;
            passage.pass = pass;
            passage.ring = ring;
            passage.back = ring == 1 && !task.at_once;
            passage.right_handed = ring == 0 || passage.back;
            passage.phase_rad = pass * task.offset_rad;
            // How far ahead of the centre, as the frame comes, fibres land.
            const bool first = ring == 0 || passage.back;
            const double ahead_mm = (first ? 0.5 : -0.5) * head.ring_distance_mm - task.lag_mm;
            const double tie_mm = std::max(0.0, ahead_mm);
            const double end_mm = std::min(task.length_mm, task.length_mm + ahead_mm);
            passage.wait_mm = std::max(0.0, -ahead_mm);
            passage.tie_s_mm = passage.back ? task.length_mm - tie_mm : tie_mm;
            passage.end_s_mm = passage.back ? task.length_mm - end_mm : end_mm;
            passages.push_back(passage);
        }
    }
    return passages;
}

KrlProgram back_program(const KrlProgram& forth, const std::string& name,
                        const std::array<std::int64_t, 6>& start_nano) {
    assert(forth.moves.size() >= 2);
    KrlProgram back = forth;
    back.name = name;
    back.start_nano = start_nano;
    const std::size_t last = forth.moves.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
        // The move to a point goes at the speeds of the one that left it.
        back.moves[i] = forth.moves[i == 0 ? 0 : last - i + 1];
        back.moves[i].to = forth.moves[last - i].to;
    }
    return back;
}

std::vector<RingRow> drive_ring(const RingPassage& passage, const KrlProgram& program,
                                const std::vector<double>& s_mm, const RingHead& head,
                                double turns_per_mm) {
    assert(s_mm.size() == program.moves.size());
    const std::vector<double> duration_s = durations_s(program);
    const double per_mm = (passage.right_handed ? 2.0 : -2.0) * kPi * turns_per_mm;
    std::vector<RingRow> rows = {{0.0, s_mm.front(), 0.0}};
    double frame_rad = 0.0;
    for (std::size_t i = 1; i < s_mm.size(); ++i) {
        const double step_rad =
            frame_turn_rad(head, pose_of(program.moves[i - 1].to), pose_of(program.moves[i].to));
        const double before_mm = std::abs(s_mm[i - 1] - s_mm.front());
        const double after_mm = std::abs(s_mm[i] - s_mm.front());
        const RingRow from = rows.back();
        if (before_mm < passage.wait_mm && passage.wait_mm < after_mm) {
            const double share = (passage.wait_mm - before_mm) / (after_mm - before_mm);
            rows.push_back({from.time_s + share * duration_s[i],
                            s_mm[i - 1] + share * (s_mm[i] - s_mm[i - 1]),
                            frame_rad + share * step_rad});
        }
        frame_rad += step_rad;
        rows.push_back({from.time_s + duration_s[i], s_mm[i],
                        frame_rad + per_mm * std::max(0.0, after_mm - passage.wait_mm)});
    }
    return rows;
}

std::string rings_csv(const std::vector<RingPassage>& passages,
                      const std::vector<std::vector<RingRow>>& rows) {
    assert(passages.size() == rows.size());
    std::string text = "pass,ring,time_s,s_mm,ring_deg\n";
    for (std::size_t i = 0; i < passages.size(); ++i) {
        const std::string head =
            std::to_string(passages[i].pass + 1) + ',' + std::to_string(passages[i].ring + 1) + ',';
        for (const RingRow& row : rows[i]) {
            text += head;
            append_fixed(text, row.time_s, kTimeDecimals);
            text += ',';
            append_fixed(text, row.s_mm, kPlaceDecimals);
            text += ',';
            append_fixed(text, deg_from_rad(row.ring_rad), kTurnDecimals);
            text += '\n';
        }
    }
    return text;
}

std::vector<RingKnot> read_rings_csv(std::string_view text, const std::string& file,
                                     const RingPassage& passage) {
    CsvTable table(text, file, kErrors);
    const std::size_t pass = table.column("pass");
    const std::size_t ring = table.column("ring");
    const std::size_t time = table.column("time_s");
    const std::size_t turn = table.column("ring_deg");
    std::vector<RingKnot> knots;
    while (table.next()) {
        if (std::lround(table.number(pass)) != passage.pass + 1 ||
            std::lround(table.number(ring)) != passage.ring + 1) {
            continue;
        }
        const double turn_rad = rad_from_deg(table.number(turn));
        const double time_s = table.number(time);
        if (!knots.empty() && time_s < knots.back().time_s) {
            table.fail("rings.number", "the time goes back; sort the rows");
        }
        knots.push_back({time_s, {turn_rad, turn_rad}});
    }
    if (knots.empty()) {
        table.fail("rings.number", "there is no row for this pass and ring");
    }
    return knots;
}

}  // namespace meshwind
