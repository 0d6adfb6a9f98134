// One change in a released program is seen, and its block named. MESHWIND_COUNT random changes of
// each program (40), from MESHWIND_SEED (1): of increments, sign, digits, F, blocks deleted,
// doubled, exchanged, cut off, run as absolute, words dropped; and every change of the head listed
// here.
//
// What counts as a change is decided here on the numbers of the text, not by what is tested. The
// digest in the head is taken out first, so that it is not what sees them; with it in place every
// one of them must be seen without a plan as well. Where the text already fails its comparison with
// the plan nothing is wound: `verify` would only add to what has failed.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/text/text_file.h"
#include "machines/machine_json.h"
#include "mesh/mandrel/load_mandrel.h"
#include "tests/support/fixtures.h"
#include "tests/support/released_program.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

using test::Lines;

const std::string kSource = MESHWIND_SOURCE_DIR;

// A number behind a letter: where its text stands.
struct Word {
    char letter;
    std::size_t first;
    std::size_t size;
};

std::vector<Word> words_of(const std::string& line) {
    std::vector<Word> words;
    for (std::size_t i = 0; i < line.size();) {
        const char letter = line[i++];
        const std::size_t end = std::min(line.find_first_not_of("-.0123456789", i), line.size());
        if (letter >= 'A' && letter <= 'Z' && end > i) {
            words.push_back({letter, i, end - i});
        }
        i = std::max(i, end);
    }
    return words;
}

bool is_axis(char letter) {
    return std::string("XYZABCUVW").find(letter) != std::string::npos;
}

// F that differs by such a share counts as another: the shortest blocks last some 8 ms, of which
// this is more than the 2 us that are the last digit of the plan's times.
constexpr double kOtherFeed = 1e-3;

// What a block line asks for: letters and numbers; the natural logarithm of F, infinite without.
struct Meaning {
    std::set<std::pair<char, double>> words;
    double log_feed = HUGE_VAL;
};

Meaning meaning_of(const std::string& line) {
    Meaning meaning;
    for (const Word& word : words_of(line)) {
        const double value = std::strtod(line.substr(word.first, word.size).c_str(), nullptr);
        if (word.letter == 'F') {
            meaning.log_feed = std::log(value);
        } else if (!is_axis(word.letter) || value != 0.0) {
            meaning.words.insert({word.letter, value});
        }
    }
    return meaning;
}

bool differ(const std::string& a, const std::string& b) {
    const Meaning first = meaning_of(a);
    const Meaning second = meaning_of(b);
    return first.words != second.words ||
           (first.log_feed != second.log_feed &&
            !(std::abs(first.log_feed - second.log_feed) <= kOtherFeed));
}

struct Released : test::ReleasedProgram {
    std::vector<std::size_t> blocks{};  // lines that are blocks
    std::vector<std::int32_t> run{};    // line of each block, from 1, as it is run
};

struct Part {
    std::string name{};
    std::string kind{};  // of `meshwind make`; empty: data/tee.stl
    MakeValues sizes{};
    std::string machine{};
    std::string dialect{};  // empty: the machine's own
    std::string job{};
};

// The machine with another dialect, which takes no header lines of LinuxCNC.
Machine machine_of(const Part& part) {
    Machine machine = read_machine(kSource + "/machines/" + part.machine + ".json");
    if (!part.dialect.empty()) {
        machine.controller.dialect = part.dialect;
        machine.controller.header = {part.dialect == "siemens" ? "G64" : ""};
    }
    return machine;
}

Mandrel mandrel_of(const Part& part) {
    return part.kind.empty() ? load_mandrel(kSource + "/data/tee.stl")
                             : test::made(part.kind, part.sizes, 6.0);
}

Released release(const Part& part) {
    const Mandrel mandrel = mandrel_of(part);
    const Machine machine = machine_of(part);
    const Job job = part.job.empty() ? Job{} : parse_job(part.job, "job.json");
    SCOPED_TRACE(part.name);
    Released released{test::released_program(mandrel, machine, job)};
    for (std::size_t i = 0; i < released.lines.size(); ++i) {
        const std::string& line = released.lines[i];
        if (line.substr(0, 2) == "G1" && line.size() > 2 && !words_of(line).empty()) {
            released.blocks.push_back(i);
        }
    }
    const BlockList list = released.setup.dialect->read(test::text_of(released.lines),
                                                        released.file, released.setup.machine);
    for (const Block& block : list.blocks) {
        released.run.push_back(block.line);
    }
    return released;
}

struct Mutation {
    std::string name;
    std::string what;
    Lines lines;
    std::size_t line = 0;                // that was changed, from 0
    std::optional<std::size_t> other{};  // and the one it was exchanged with
};

// Random changes of one block each.
class Mutator {
public:
    Mutator(const Released& program, unsigned seed) : program_(program), random_(seed) {}

    Mutation next(std::size_t number) {
        static const std::vector<std::pair<std::string, bool (Mutator::*)()>> kKinds = {
            {"increment", &Mutator::increment},
            {"small", &Mutator::small},
            {"delete", &Mutator::erase},
            {"double", &Mutator::twice},
            {"exchange", &Mutator::exchange},
            {"sign", &Mutator::sign},
            {"feed", &Mutator::feed},
            {"cut", &Mutator::cut},
            {"absolute", &Mutator::absolute},
            {"digits", &Mutator::digits},
            {"drop", &Mutator::drop}};
        const auto& [name, change] = kKinds[number % kKinds.size()];
        for (;;) {
            mutation_ = {name, "", program_.lines, pick(program_.blocks), std::nullopt};
            if ((this->*change)()) {
                return mutation_;
            }
        }
    }

private:
    template <typename T>
    const T& pick(const std::vector<T>& from) {
        return from[std::uniform_int_distribution<std::size_t>(0, from.size() - 1)(random_)];
    }
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    std::string& line() { return mutation_.lines[mutation_.line]; }

    // The line is now that; true where it asks for something else.
    bool becomes(const std::string& now) {
        mutation_.what = line() + " -> " + now;
        const bool differs = differ(line(), now);
        line() = now;
        return differs;
    }

    std::optional<Word> a_word(const std::function<bool(char)>& wanted) {
        std::vector<Word> words;
        for (const Word& word : words_of(line())) {
            if (wanted(word.letter)) {
                words.push_back(word);
            }
        }
        return words.empty() ? std::nullopt : std::optional(pick(words));
    }

    bool add_to_axis(double most, double least) {
        const auto word = a_word(is_axis);
        if (!word) {
            return false;
        }
        const std::string number = line().substr(word->first, word->size);
        // In steps of the text's last digit, so that it is one of the axis' as well.
        const std::size_t point = number.find('.');
        const std::size_t decimals = point == std::string::npos ? 0 : number.size() - point - 1;
        const double step = std::max(std::pow(10.0, -static_cast<double>(decimals)), 1e-3);
        const double by = (random_() % 2 == 0 ? 1.0 : -1.0) *
                          std::max(1.0, std::round(between(least, most) / step)) * step;
        char text[40];
        (void)std::snprintf(text, sizeof text, "%.*f",
                            static_cast<int>(std::max<std::size_t>(decimals, 1)),
                            std::strtod(number.c_str(), nullptr) + by);
        return becomes(line().substr(0, word->first) + text +
                       line().substr(word->first + word->size));
    }
    bool increment() { return add_to_axis(5.0, 0.5); }
    bool small() { return add_to_axis(0.5, 0.001); }

    bool erase() {
        mutation_.what = "without " + line();
        mutation_.lines.erase(mutation_.lines.begin() +
                              static_cast<std::ptrdiff_t>(mutation_.line));
        return true;
    }
    bool twice() {
        mutation_.what = "twice " + line();
        mutation_.lines.insert(
            mutation_.lines.begin() + static_cast<std::ptrdiff_t>(mutation_.line), line());
        return true;
    }
    bool exchange() {
        const auto here = std::find(program_.blocks.begin(), program_.blocks.end(), mutation_.line);
        if (here + 1 == program_.blocks.end()) {
            return false;
        }
        mutation_.other = *(here + 1);
        std::string& other = mutation_.lines[*mutation_.other];
        mutation_.what = line() + " <> " + other;
        std::swap(line(), other);
        return differ(line(), other);
    }
    bool sign() {
        const auto word = a_word(is_axis);
        if (!word) {
            return false;
        }
        const bool minus = line()[word->first] == '-';
        return becomes(line().substr(0, word->first) + (minus ? "" : "-") +
                       line().substr(word->first + (minus ? 1 : 0)));
    }
    bool feed() {
        const auto word = a_word([](char letter) { return letter == 'F'; });
        if (!word) {
            return false;
        }
        static const std::vector<double> kTimes = {0.1, 0.5, 0.8, 0.99, 1.01, 1.25, 2.0, 10.0};
        char text[40];
        (void)std::snprintf(
            text, sizeof text, "%.4f",
            std::strtod(line().substr(word->first, word->size).c_str(), nullptr) * pick(kTimes));
        return becomes(line().substr(0, word->first) + std::string(text).substr(0, 8));
    }
    bool cut() {
        return line().size() > 4 && becomes(line().substr(0, 3 + random_() % (line().size() - 3)));
    }
    bool absolute() {
        mutation_.what = "G90 " + line();
        line() = "G90 " + line();
        return a_word(is_axis).has_value();
    }
    bool digits() {
        std::vector<std::size_t> places;
        for (std::size_t i = 2; i + 1 < line().size(); ++i) {
            if (std::isdigit(line()[i]) != 0 && std::isdigit(line()[i + 1]) != 0 &&
                line()[i] != line()[i + 1]) {
                places.push_back(i);
            }
        }
        if (places.empty()) {
            return false;
        }
        std::string now = line();
        const std::size_t at = pick(places);
        std::swap(now[at], now[at + 1]);
        return becomes(now);
    }
    bool drop() {
        const auto word = a_word(is_axis);
        return word && words_of(line()).size() > 3 &&
               becomes(line().substr(0, word->first - 1) + line().substr(word->first + word->size));
    }

    const Released& program_;
    std::mt19937 random_;
    Mutation mutation_;
};

// The line itself, or that of a block which is run right before or behind it; deleting and doubling
// moves lines by one.
bool is_beside(const Released& program, std::size_t changed, std::int32_t named) {
    const auto line = static_cast<std::int32_t>(changed) + 1;
    const auto near = [&](std::int32_t other) { return std::abs(named - other) <= 1; };
    if (near(line)) {
        return true;
    }
    for (std::size_t b = 0; b < program.run.size(); ++b) {
        if (program.run[b] == line && ((b > 0 && near(program.run[b - 1])) ||
                                       (b + 1 < program.run.size() && near(program.run[b + 1])))) {
            return true;
        }
    }
    return false;
}

void expect_random_changes_seen(const Released& program) {
    const unsigned seed = test::from_environment("MESHWIND_SEED", 1);
    const unsigned count = test::from_environment("MESHWIND_COUNT", 40);
    EXPECT_FALSE(test::answer_of(program, test::text_of(program.lines)).seen);
    EXPECT_FALSE(test::digest_sees(program, test::text_of(program.lines)));
    Mutator mutator(program, seed);
    std::size_t seen = 0;
    std::size_t named = 0;
    for (unsigned i = 0; i < count; ++i) {
        const Mutation mutation = mutator.next(i);
        const test::Answer answer = test::answer_of(program, test::text_of(mutation.lines));
        seen += answer.seen ? 1 : 0;
        const bool beside = is_beside(program, mutation.line, answer.line) ||
                            (mutation.other && is_beside(program, *mutation.other, answer.line));
        named += beside ? 1 : 0;
        EXPECT_TRUE(answer.seen && beside)
            << "seed " << seed << ", change " << i << ", " << mutation.name << " in line "
            << mutation.line + 1 << ": " << mutation.what << "; seen by " << answer.by
            << ", which names line " << answer.line;
        EXPECT_TRUE(test::digest_sees(program, test::text_of(mutation.lines))) << mutation.what;
    }
    std::printf("seed %u: %zu of %u seen, %zu named\n", seed, seen, count, named);
}

// Changes before the first block.
std::vector<Mutation> head_changes(const Released& program) {
    std::vector<Mutation> all;
    const Lines& lines = program.lines;
    const auto find = [&](const std::string& words) {
        const auto at = std::find_if(lines.begin(), lines.end(), [&](const std::string& line) {
            return line.find(words) != std::string::npos;
        });
        return static_cast<std::size_t>(at - lines.begin());
    };
    const auto add = [&](const std::string& name, std::size_t line,
                         const std::vector<std::string>& by) {
        Mutation mutation{name, "", lines, line, std::nullopt};
        const auto at = mutation.lines.begin() + static_cast<std::ptrdiff_t>(line);
        mutation.lines.insert(mutation.lines.erase(at), by.begin(), by.end());
        all.push_back(std::move(mutation));
    };
    const std::size_t turn = find("G0 A");
    const std::size_t go = find("G0 X");
    const std::size_t stop = find("M0");
    const std::size_t mode = find("G64");
    const std::size_t place = find("tie on at X");
    const std::size_t middle = program.blocks[program.blocks.size() / 2];
    const bool points = program.setup.machine.controller.dialect == "fanuc";
    const std::string zero = points ? "0." : "0";
    add("no stop", stop, {});
    add("rapid through the part", turn,
        {lines[turn], "G90 G0 X-300" + zero.substr(1) + " Y" + zero + " Z" + zero});
    add("rapid of one axis", turn, {lines[turn], "G90 G0 X300" + zero.substr(1)});
    add("rapid past the stop", stop, {"M0", lines[go]});
    add("approach exchanged", turn, {lines[go]});
    all.back().lines[go] = lines[turn];
    if (mode < lines.size()) {
        for (const std::string other : {"", "G61", "G64 P50"}) {
            const bool known = other != "G64 P50" || lines[mode] == "G64 P2 Q0.01";
            if (known) {
                add("mode \"" + other + "\"", mode, {other});
            }
        }
    }
    if (program.setup.machine.controller.dialect != "grbl") {
        add("mode in the middle", middle, {mode < lines.size() ? "G60" : "G64", lines[middle]});
        if (lines[mode < lines.size() ? mode : 0].find("P2") != std::string::npos) {
            all.back().lines[middle] = "G64";
        }
    }
    const std::vector<Word> words = words_of(lines[place]);
    for (const double off : {0.5, 3.0}) {
        for (const Word& word : words) {
            std::string moved = lines[place];
            char text[40];
            (void)std::snprintf(
                text, sizeof text, "%.3f",
                std::strtod(moved.substr(word.first, word.size).c_str(), nullptr) + off);
            add(std::string("tie-on ") + word.letter, place,
                {moved.replace(word.first, word.size, text)});
        }
    }
    return all;
}

void expect_head_changes_seen(const Released& program) {
    for (const Mutation& mutation : head_changes(program)) {
        SCOPED_TRACE(mutation.name);
        EXPECT_TRUE(test::answer_of(program, test::text_of(mutation.lines)).seen);
        EXPECT_TRUE(test::digest_sees(program, test::text_of(mutation.lines)));
    }
}

const std::string kHelical = R"({"layers": [{"kind": "helical", "angle": 50}]})";

void expect_changes_seen(const Part& part) {
    const Released program = release(part);
    ASSERT_FALSE(program.blocks.empty());
    expect_head_changes_seen(program);
    expect_random_changes_seen(program);
}

Part pipe(const std::string& dialect) {
    return {.name = "pipe-" + dialect,
            .kind = "cylinder",
            .sizes = {{"radius", 40.0}, {"length", 200.0}},
            .machine = "six_axis",
            .dialect = dialect,
            .job = kHelical};
}

TEST(Mutations, PipeLinuxCncWithSubprograms) {
    expect_changes_seen(pipe(""));
}

TEST(Mutations, PipeFanuc) {
    expect_changes_seen(pipe("fanuc"));
}

TEST(Mutations, PipeSiemens) {
    expect_changes_seen(pipe("siemens"));
}

TEST(Mutations, PipeGrbl) {
    expect_changes_seen(pipe("grbl"));
}

// Plans for half a minute: asked for by name or by MESHWIND_COUNT.
TEST(Mutations, Tee) {
    if (test::from_environment("MESHWIND_COUNT", 0) == 0) {
        GTEST_SKIP() << "set MESHWIND_COUNT";
    }
    expect_changes_seen({.name = "tee", .machine = "six_axis"});
}

}  // namespace
}  // namespace meshwind
