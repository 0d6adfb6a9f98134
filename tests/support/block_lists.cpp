#include "tests/support/block_lists.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <random>
#include <sstream>
#include <string>

#include "core/units.h"
#include "machines/machine_json.h"

namespace meshwind::test {

Machine six_axis() {
    return read_machine(std::string(MESHWIND_SOURCE_DIR) + "/machines/six_axis.json");
}

Machine robot_winder() {
    return read_machine(std::string(MESHWIND_SOURCE_DIR) + "/machines/robot_winder.json");
}

BlockList empty_list(const Machine& machine) {
    BlockList list;
    for (std::size_t a = 0; a < machine.axis_count(); ++a) {
        const Axis& axis = machine.axis(a);
        list.axes.push_back({axis.letter, axis.type, axis.resolution_nano});
    }
    return list;
}

void add(BlockList& list, const std::vector<std::int64_t>& steps, double duration_s, int piece) {
    list.blocks.push_back({.duration_s = duration_s, .piece = piece});
    for (std::size_t a = 0; a < steps.size(); ++a) {
        list.nano.push_back(steps[a] * list.axes[a].resolution_nano);
    }
}

BlockList random_list(const Machine& machine, unsigned seed, int n) {
    std::mt19937 engine(seed);
    std::uniform_int_distribution<int> step(-20'000, 20'000);
    std::uniform_int_distribution<int> still(0, 2);
    std::uniform_real_distribution<double> exponent(-3.0, 1.5);
    BlockList list = empty_list(machine);
    std::vector<std::int64_t> steps(machine.axis_count(), 0);
    add(list, steps, 0.0);
    for (int i = 0; i < n; ++i) {
        for (std::int64_t& value : steps) {
            value += still(engine) == 0 ? step(engine) : 0;
        }
        steps[0] += 1;  // never a block without motion
        add(list, steps, std::pow(10.0, exponent(engine)), i / 100);
    }
    return list;
}

std::string as_ours(std::string text, char opens) {
    const std::string comment = opens == '(' ? " (meshwind 1.0)" : " ; meshwind 1.0";
    const std::size_t from = text.rfind("%\n", 0) == 0 ? 2 : 0;
    return text.empty() ? text : text.insert(std::min(text.find('\n', from), text.size()), comment);
}

std::string foreign_program(const Machine& machine, unsigned seed, int n) {
    std::mt19937 random(seed);
    const auto below = [&](unsigned count) { return static_cast<unsigned>(random() % count); };
    std::ostringstream text;
    text << std::fixed << std::setprecision(6) << "G21 G90 G94\nG0 X1\nG1 F3000\n";
    const auto some_axes = [&] {
        const std::size_t at_least = below(static_cast<unsigned>(machine.axis_count()));
        for (std::size_t a = 0; a < machine.axis_count(); ++a) {
            if (a == at_least || below(2) == 0) {
                text << ' ' << machine.axis(a).letter
                     << 0.2 * (static_cast<double>(below(10'000)) / 7.0 - 700.0);
            }
        }
        text << '\n';
    };
    constexpr std::array kIdle = {"G4 P0.1", "M8", "G17", "S200 M3", "M9", "(a comment)"};
    for (int line = 0; line < n; ++line) {
        switch (below(12)) {
            case 0:
                text << (below(2) == 0 ? "G90\n" : "G91\n");
                break;
            case 1:
                text << (below(2) == 0 ? "G20\n" : "G21\n");
                break;
            case 2:
                text << "G92 C0 X" << 0.01 * below(10'000) << '\n';
                break;
            case 3:
                text << "G92.1\n";
                break;
            case 4:
                text << kIdle[below(kIdle.size())] << '\n';
                break;
            case 5:
                text << "G0";
                some_axes();
                break;
            default:
                text << "G1 F" << 100 + below(5000);
                some_axes();
        }
    }
    text << "M2\n";
    return text.str();
}

BlockList pattern(const Machine& machine, const PatternOptions& options) {
    BlockList list = empty_list(machine);
    const auto block = [&](double c, double z, double x, double a, double duration_s, int piece) {
        const double place[] = {c, z, 0.0, x, a, 0.0};
        std::vector<std::int64_t> steps;
        for (std::size_t i = 0; i < list.axes.size(); ++i) {
            steps.push_back(std::llround(place[i] * static_cast<double>(kNanoPerUnit) /
                                         static_cast<double>(list.axes[i].resolution_nano)));
        }
        add(list, steps, duration_s, piece);
    };
    const int blocks = options.circuits * options.length;
    double z0 = 0.0;
    for (int i = -options.lead; i <= blocks + options.lead; ++i) {
        const bool leads = i < 0 || i > blocks;
        const double t = static_cast<double>(i) / options.length;  // circuits
        const double phase = 2.0 * kPi * (t - std::floor(t));
        const double z = 300.0 - 300.0 * std::cos(phase);
        z0 += leads ? 0.1 * (1 + i % 3) : 0.0;
        block(options.advance_deg * (t + 0.02 * std::sin(phase)), z + (leads ? z0 : 0.0),
              120.0 + 20.0 * std::sin(phase), 40.0 * std::sin(phase),
              i == -options.lead ? 0.0
              : leads            ? 0.05 + 0.001 * (i & 15)
                                 : 0.02 + 0.01 * std::abs(std::sin(0.5 * phase)),
              static_cast<int>(std::floor(2.0 * t)) + 2);
    }
    return list;
}

}  // namespace meshwind::test
