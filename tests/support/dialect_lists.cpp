#include "tests/support/dialect_lists.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

#include "core/error.h"
#include "tests/support/block_lists.h"

namespace meshwind::test {
namespace {

using Lines = std::vector<std::string>;

std::string without_comment(const std::string& line) {
    std::string code;
    bool inside = false;
    for (const char c : line) {
        if (c == ';') {
            break;
        }
        inside = inside || c == '(';
        code += inside ? "" : std::string(1, c);
        inside = inside && c != ')';
    }
    return code.substr(0, code.find_last_not_of(' ') + 1);
}

// The lines that are run, calls and repeats written out.
class Unroller {
public:
    explicit Unroller(const std::string& text) {
        for (const std::string& line : split_lines(text)) {
            lines_.push_back(without_comment(line));
        }
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            place_[lines_[i]] = i;
        }
    }

    Lines run() {
        unroll(0, lines_.size());
        return run_;
    }

private:
    // Until the end of the program or of the subprogram.
    void unroll(std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
            const std::string& line = lines_[i];
            if (line == "M2" || line == "M30" || line == "M99") {
                return;
            }
            int p = 0;
            int l = 1;
            char a[64];
            char b[64];
            if (std::sscanf(line.c_str(), "M98 P%d L%d", &p, &l) >= 1) {
                for (int k = 0; k < l; ++k) {
                    unroll(place_.at("O" + std::to_string(p)) + 1, lines_.size());
                }
            } else if (std::sscanf(line.c_str(), "REPEAT %63s %63s P=%d", a, b, &p) == 3) {
                for (int k = 0; k < p; ++k) {
                    unroll(place_.at(std::string(a) + ":"), place_.at(std::string(b) + ":"));
                }
            } else if (!line.empty()) {
                run_.push_back(line);
            }
        }
    }

    Lines lines_;
    std::map<std::string, std::size_t> place_;
    Lines run_;
};

// As GRBL 1.1 reads a number: eight digits as an integer, then hundredths and tenths in floats.
float grbl_number(const std::string& text) {
    unsigned long digits = 0;
    int count = 0;
    int power = 0;
    bool point = false;
    for (const char c : text) {
        point = point || c == '.';
        if (c < '0' || c > '9') {
            continue;
        }
        if (++count <= 8) {
            digits = 10 * digits + static_cast<unsigned long>(c - '0');
            power -= point ? 1 : 0;
        } else {
            power += point ? 0 : 1;
        }
    }
    auto value = static_cast<float>(digits);
    for (; power <= -2; power += 2) {
        value *= 0.01F;
    }
    value *= power == -1 ? 0.1F : 1.0F;
    for (; power > 0; --power) {
        value *= 10.0F;
    }
    return text[0] == '-' ? -value : value;
}

}  // namespace

std::vector<std::string> split_lines(const std::string& text) {
    std::istringstream stream(text);
    Lines lines;
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

std::vector<double> end_of_program(const std::string& text, const Machine& machine,
                                   Summation summation) {
    std::vector<long double> exact(machine.axis_count(), 0.0L);
    std::vector<float> floats(machine.axis_count(), 0.0F);
    bool incremental = false;
    for (const std::string& line : Unroller(text).run()) {
        incremental = (incremental || line.find("G91") != std::string::npos) &&
                      line.find("G90") == std::string::npos;
        const bool moves = line.find("G0") != std::string::npos ||
                           line.find("G1 ") != std::string::npos ||
                           line.find("G1X") != std::string::npos;
        std::size_t i = 0;
        while (moves && i < line.size()) {
            const char letter = line[i];
            const std::size_t end = line.find_first_not_of("-.0123456789", i + 1);
            const std::string number = line.substr(i + 1, end - i - 1);
            const auto axis = machine.joint_of(letter);
            if (axis && !number.empty()) {
                const float read = summation == Summation::GrblFloats
                                       ? grbl_number(number)
                                       : std::strtof(number.c_str(), nullptr);
                exact[*axis] =
                    (incremental ? exact[*axis] : 0.0L) + std::strtold(number.c_str(), nullptr);
                floats[*axis] = (incremental ? floats[*axis] : 0.0F) + read;
            }
            i = std::min(end, line.size());
            i = std::min(line.find_first_not_of(' ', i), line.size());
        }
    }
    std::vector<double> end(machine.axis_count());
    for (std::size_t a = 0; a < end.size(); ++a) {
        end[a] = summation == Summation::Exact ? static_cast<double>(exact[a])
                                               : static_cast<double>(floats[a]);
    }
    return end;
}

bool is_robots(const std::string& dialect) {
    return dialect == "rapid" || dialect == "krl" || dialect == "tp";
}

Machine machine_for(const std::string& dialect) {
    Machine machine = is_robots(dialect) ? robot_winder() : six_axis();
    machine.controller.dialect = dialect;
    machine.controller.header.clear();
    machine.controller.feed = dialect == "marlin" ? FeedMode::PerMinute : FeedMode::InverseTime;
    return machine;
}

BlockList small_program(const Machine& machine) {
    // There and back at 45 degrees on a pipe, then circuits. A table of ticks would be long.
    BlockList list = empty_list(machine);
    const double pace = machine.controller.dialect == "pulses" ? 0.05 : 1.0;
    const auto block = [&](double c, double z, double x, double duration_s, int piece) {
        std::vector<double> place{c, z, 0.0, x};
        place.resize(list.axes.size(), 0.0);
        std::vector<std::int64_t> steps;
        for (std::size_t a = 0; a < list.axes.size(); ++a) {
            steps.push_back(std::llround(place[a] * static_cast<double>(kNanoPerUnit) /
                                         static_cast<double>(list.axes[a].resolution_nano)));
        }
        add(list, steps, pace * duration_s, piece);
    };
    block(-70.529, 81.421, 150.0, 0.0, 0);
    block(-160.529, 159.961, 150.0, 3.0, 0);
    block(-174.0, 160.0, 152.5, 0.25, 0);
    block(-264.0, 81.421, 150.0, 3.0, 1);
    for (int circuit = 0; circuit < 12; ++circuit) {
        const double c = -264.0 - 100.0 * std::sqrt(2.0) * circuit;
        for (int i = 1; i <= 8; ++i) {
            const double z = 81.421 + 10.0 * (i <= 4 ? i : 8 - i);
            block(c - 100.0 * std::sqrt(2.0) * i / 8.0, z, i == 4 ? 151.0 : 150.0, 0.35,
                  2 + circuit);
        }
    }
    return list;
}

bool reads_otherwise(const Dialect& dialect, const Machine& machine, const std::string& changed,
                     const BlockList& whole) {
    try {
        const BlockList read = dialect.read(changed, "p", machine);
        bool same = read.nano == whole.nano && read.blocks.size() == whole.blocks.size() &&
                    read.head->stop_line > 0;
        for (std::size_t b = 0; same && b < read.blocks.size(); ++b) {
            same = read.blocks[b].duration_s == whole.blocks[b].duration_s;
        }
        return !same;
    } catch (const InputError&) {
        return true;
    }
}

ManyCircuits many_circuits(const Machine& machine, double circuit_deg) {
    constexpr int kCircuits = 10'000;
    ManyCircuits many;
    many.list = empty_list(machine);
    for (int i = 0; i <= 4 * kCircuits; ++i) {
        const double c = circuit_deg * i / 4.0;
        const double place[] = {c, 10.0 * (i % 4 == 2 ? 2 : i % 2), 0.0, 120.0, 0.0, 0.0};
        std::vector<std::int64_t> steps;
        for (std::size_t a = 0; a < machine.axis_count(); ++a) {
            steps.push_back(std::llround(place[a] * static_cast<double>(kNanoPerUnit) /
                                         static_cast<double>(many.list.axes[a].resolution_nano)));
        }
        add(many.list, steps, i == 0 ? 0.0 : 0.2, i / 4);
    }
    many.end_deg = circuit_deg * kCircuits;
    return many;
}

}  // namespace meshwind::test
