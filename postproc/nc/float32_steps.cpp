#include "postproc/nc/float32_steps.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/text/text_number.h"

namespace meshwind {
namespace {

constexpr int kFinestBinary = 9;
// Whole numbers up to 2^24 are exact in a float.
constexpr std::int64_t kExactSteps = std::int64_t{1} << 24;
// Firmwares differ in the last bit of a number that they read, so the model may use half of what is
// allowed.
constexpr double kModelShare = 0.5;

double units(std::int64_t nano) {
    return static_cast<double>(nano) / static_cast<double>(kNanoPerUnit);
}

std::int64_t binary_nano(int power) {
    return kNanoPerUnit / (std::int64_t{1} << power);
}

std::int64_t ten_to(int power) {
    std::int64_t value = 1;
    for (int i = 0; i < power; ++i) {
        value *= 10;
    }
    return value;
}

// As GRBL reads a number: all digits as an integer, then hundredths and tenths in floats.
float by_hundreds(std::int64_t nano, int decimals) {
    const std::int64_t digits = std::abs(nano) / ten_to(9 - decimals);
    auto value = static_cast<float>(digits);
    int power = decimals;
    for (; power >= 2; power -= 2) {
        value *= 0.01F;
    }
    value *= power == 1 ? 0.1F : 1.0F;
    return nano < 0 ? -value : value;
}

float as_float(std::int64_t nano, int decimals, Float32Text text) {
    return text == Float32Text::ByHundreds ? by_hundreds(nano, decimals)
                                           : static_cast<float>(units(nano));
}

// Halves are rounded away from zero.
std::int64_t nearest_multiple(std::int64_t nano, std::int64_t step) {
    const std::int64_t size = std::abs(nano);
    const std::int64_t rounded = (size / step + (size % step * 2 >= step ? 1 : 0)) * step;
    return nano < 0 ? -rounded : rounded;
}

// Increments of so many decimals must stay below it; 0: any are read.
std::int64_t most_nano(int decimals, std::size_t most_digits) {
    const int whole = static_cast<int>(most_digits) - decimals;
    return most_digits == 0 ? 0 : whole > 0 ? kNanoPerUnit * ten_to(whole) : kNanoPerUnit;
}

class AxisSteps {
public:
    AxisSteps(const BlockList& list, std::size_t axis, const NcFlavour& flavour)
        : axis_(list.axes[axis]), flavour_(flavour) {
        error_ = float32_error(list, axis, flavour.float32);
        for (std::size_t b = 0; b < list.blocks.size(); ++b) {
            reach_ = std::max(reach_, std::abs(list.row(b)[axis]));
            longest_ =
                b == 0 ? 0
                       : std::max(longest_, std::abs(list.row(b)[axis] - list.row(b - 1)[axis]));
        }
    }

    // The power of the step that the axis needs, if any.
    [[nodiscard]] std::optional<int> power() const {
        const bool exact = error_ <= kModelShare * 0.5 * units(axis_.resolution_nano);
        const bool too_long = axis_.resolution_nano % kFinestBinary_nano == 0 &&
                              !is_short(decimals_of(axis_.resolution_nano));
        if (exact && !too_long) {
            return std::nullopt;
        }
        int power = flavour_.finest_binary;
        while (power > kCoarsestBinary && !(is_reached(power) && is_short(power))) {
            --power;
        }
        if (!exact && !is_reached(power)) {
            throw InputError("dialect.float32", std::string("axis ") + axis_.letter,
                             "reaches " + fixed(units(reach_), 0) + " mm or deg, but " +
                                 std::string(flavour_.controller) +
                                 " adds in 32-bit floats and is exact up to " +
                                 fixed(units(kExactSteps * binary_nano(power)), 0) +
                                 "; wind layer by layer, homing between");
        }
        const bool helps = (too_long && binary_nano(power) > axis_.resolution_nano) ||
                           (!exact && error_ > 0.5 * units(binary_nano(power)));
        return helps ? std::optional<int>(power) : std::nullopt;
    }

private:
    [[nodiscard]] bool is_reached(int power) const {
        return reach_ / binary_nano(power) < kExactSteps;
    }

    // Rounding may add a step to an increment.
    [[nodiscard]] bool is_short(int decimals) const {
        const std::int64_t most = most_nano(decimals, flavour_.most_digits);
        return most == 0 || longest_ + 2 * binary_nano(kCoarsestBinary) < most;
    }

    BlockAxis axis_;
    const NcFlavour& flavour_;
    double error_ = 0.0;
    std::int64_t reach_ = 0;
    std::int64_t longest_ = 0;  // increment
};

// Steps that move no axis go with the next that does, at the end with the last.
BlockList without_rests(const BlockList& list) {
    BlockList kept;
    kept.axes = list.axes;
    kept.tie_on_mm = list.tie_on_mm;
    double waiting_s = 0.0;
    for (std::size_t b = 0; b < list.blocks.size(); ++b) {
        const auto row = list.row(b);
        waiting_s += list.blocks[b].duration_s;
        if (b > 0 && std::equal(row.begin(), row.end(), kept.row(kept.blocks.size() - 1).begin())) {
            continue;
        }
        kept.blocks.push_back(list.blocks[b]);
        kept.blocks.back().duration_s = waiting_s;
        kept.nano.insert(kept.nano.end(), row.begin(), row.end());
        waiting_s = 0.0;
    }
    if (kept.blocks.size() > 1) {
        kept.blocks.back().duration_s += waiting_s;
    }
    return kept;
}

}  // namespace

double float32_error(const BlockList& list, std::size_t axis, Float32Text text) {
    if (list.blocks.empty() || text == Float32Text::None) {
        return 0.0;
    }
    const int decimals = decimals_of(list.axes[axis].resolution_nano);
    float position = as_float(list.row(0)[axis], decimals, text);
    double worst = std::abs(static_cast<double>(position) - list.value(0, axis));
    for (std::size_t b = 1; b < list.blocks.size(); ++b) {
        const std::int64_t step = list.row(b)[axis] - list.row(b - 1)[axis];
        if (step != 0) {
            position += as_float(step, decimals, text);
            worst = std::max(worst, std::abs(static_cast<double>(position) - list.value(b, axis)));
        }
    }
    return worst;
}

BlockList with_binary_steps(BlockList list, const NcFlavour& flavour) {
    bool any = false;
    for (std::size_t a = 0; a < list.axes.size() && !list.blocks.empty(); ++a) {
        const std::optional<int> power = AxisSteps(list, a, flavour).power();
        if (!power) {
            continue;
        }
        any = true;
        list.axes[a].resolution_nano = binary_nano(*power);
        for (std::size_t b = 0; b < list.blocks.size(); ++b) {
            std::int64_t& nano = list.nano[b * list.axes.size() + a];
            nano = nearest_multiple(nano, binary_nano(*power));
        }
    }
    return any ? without_rests(list) : list;
}

BlockList split_long_numbers(BlockList list, std::size_t most_digits) {
    if (most_digits == 0) {
        return list;
    }
    std::vector<std::int64_t> most;  // per axis: an increment must stay below it
    for (const BlockAxis& axis : list.axes) {
        most.push_back(most_nano(decimals_of(axis.resolution_nano), most_digits));
    }
    BlockList split;
    split.axes = list.axes;
    split.tie_on_mm = list.tie_on_mm;
    for (std::size_t b = 0; b < list.blocks.size(); ++b) {
        std::int64_t parts = 1;
        for (std::size_t a = 0; b > 0 && a < most.size(); ++a) {
            // Rounding may add a step to a part, which must not be split again.
            const std::int64_t size =
                std::abs(list.row(b)[a] - list.row(b - 1)[a]) + list.axes[a].resolution_nano;
            const std::int64_t room = most[a] - 3 * list.axes[a].resolution_nano;
            parts = std::max(parts, size < most[a] ? 1 : size / room + 1);
        }
        for (std::int64_t part = 1; part <= parts; ++part) {
            split.blocks.push_back(list.blocks[b]);
            split.blocks.back().duration_s /= static_cast<double>(parts);
            for (std::size_t a = 0; a < most.size(); ++a) {
                const std::int64_t to = list.row(b)[a];
                const std::int64_t from = b > 0 ? list.row(b - 1)[a] : to;
                const std::int64_t steps = (to - from) / list.axes[a].resolution_nano;
                const std::int64_t done =
                    part == parts ? steps : steps / parts * part + steps % parts * part / parts;
                split.nano.push_back(part == parts ? to
                                                   : from + done * list.axes[a].resolution_nano);
            }
        }
    }
    return split;
}

void set_binary_steps(BlockList& list) {
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        const auto on = [&](std::int64_t step) {
            for (std::size_t b = 0; b < list.blocks.size(); ++b) {
                if (list.row(b)[a] % step != 0) {
                    return false;
                }
            }
            return true;
        };
        int power = kCoarsestBinary;
        if (!on(list.axes[a].resolution_nano)) {
            while (power < kFinestBinary && !on(binary_nano(power))) {
                ++power;
            }
            list.axes[a].resolution_nano = binary_nano(power);
        }
    }
}

}  // namespace meshwind
