#include "tests/fuzz/spoilt_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"

namespace meshwind::fuzz {
namespace {

constexpr std::size_t kMaxFaces = 200;  // a mandrel of so many takes milliseconds

class Bytes {
public:
    explicit Bytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    [[nodiscard]] bool left() const { return at_ < bytes_.size(); }
    std::size_t below(std::size_t count) { return left() ? bytes_[at_++] % count : 0; }

    // Numbers that meet each other, nearly meet, or are of quite another size.
    double number() {
        static constexpr std::array<double, 10> kSizes = {1.0,  1.0,   1.0, 10.0, 0.1,
                                                          1e-7, 1e-30, 1e6, 1e8,  1e30};
        const double size = kSizes[below(kSizes.size())];
        return size * (static_cast<double>(below(17)) - 8.0);
    }
    Eigen::Vector3d point() { return {number(), number(), number()}; }

private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

std::int32_t index(std::size_t i) {
    return static_cast<std::int32_t>(i);
}

// A tube, tapered and bent as the bytes say.
TriangleSoup tube_of(Bytes& bytes) {
    const std::size_t around = 3 + bytes.below(10);
    const std::size_t along = 1 + bytes.below(5);
    const double taper = static_cast<double>(bytes.below(5)) / 4.0;
    const double bend = static_cast<double>(bytes.below(4)) * kPi / 4.0;
    TriangleSoup soup;
    for (std::size_t j = 0; j <= along; ++j) {
        const double share = static_cast<double>(j) / static_cast<double>(along);
        for (std::size_t i = 0; i < around; ++i) {
            const double turn = 2.0 * kPi * static_cast<double>(i) / static_cast<double>(around);
            const double radius = 20.0 * (1.0 - taper * share);
            const double across = 60.0 + radius * std::cos(turn);
            soup.points_mm.emplace_back(
                across * std::cos(bend * share), radius * std::sin(turn),
                bend > 0.0 ? across * std::sin(bend * share) : 80.0 * share);
        }
    }
    for (std::size_t j = 0; j < along; ++j) {
        for (std::size_t i = 0; i < around; ++i) {
            const std::size_t a = j * around + i;
            const std::size_t b = j * around + (i + 1) % around;
            soup.faces.push_back({index(a), index(b), index(b + around)});
            soup.faces.push_back({index(a), index(b + around), index(a + around)});
        }
    }
    return soup;
}

TriangleSoup soup_of(Bytes& bytes) {
    TriangleSoup soup;
    for (std::size_t n = 3 + bytes.below(30); n > 0; --n) {
        soup.points_mm.push_back(bytes.point());
    }
    const std::size_t count = soup.points_mm.size();
    for (std::size_t n = 1 + bytes.below(60); n > 0; --n) {
        soup.faces.push_back(
            {index(bytes.below(count)), index(bytes.below(count)), index(bytes.below(count))});
    }
    return soup;
}

// A triangle whose edges are half of others': their middles are no corners of these.
void add_quarter(TriangleSoup& soup, const std::array<std::int32_t, 3>& face) {
    const std::int32_t first = index(soup.points_mm.size());
    for (std::size_t i = 0; i < 3; ++i) {
        const auto a = static_cast<std::size_t>(face[i]);
        const auto b = static_cast<std::size_t>(face[(i + 1) % 3]);
        soup.points_mm.emplace_back(0.5 * (soup.points_mm[a] + soup.points_mm[b]));
    }
    soup.faces.push_back({first, first + 1, first + 2});
}

void spoil(TriangleSoup& soup, Bytes& bytes) {
    enum Way { Hole, Turn, Double, DoubleTurned, Move, Join, Quarter, Split, New, Shrink, kWays };
    const std::size_t way = bytes.below(kWays);
    const std::size_t f = bytes.below(soup.faces.size());
    std::array<std::int32_t, 3>& face = soup.faces[f];
    const std::size_t v = bytes.below(soup.points_mm.size());
    switch (way) {
        case Hole:
            if (soup.faces.size() > 1) {
                soup.faces.erase(soup.faces.begin() + index(f));
            }
            break;
        case Turn:
            std::swap(face[0], face[1]);
            break;
        case Double:
            soup.faces.push_back(std::array(face));
            break;
        case DoubleTurned:
            soup.faces.push_back({face[1], face[0], face[2]});
            break;
        case Move:
            soup.points_mm[v] = bytes.point();
            break;
        case Join:
            soup.points_mm[v] = soup.points_mm[bytes.below(soup.points_mm.size())];
            break;
        case Quarter:
            add_quarter(soup, std::array(face));
            break;
        case Split:
            soup.points_mm.push_back(soup.points_mm[static_cast<std::size_t>(face[0])]);
            face[0] = index(soup.points_mm.size() - 1);
            break;
        case New:
            soup.faces.push_back({face[0], face[1], index(v)});
            break;
        default:
            soup.points_mm[v] *= bytes.number();
    }
}

}  // namespace

TriangleSoup spoilt_mesh(std::span<const std::uint8_t> bytes) {
    Bytes input(bytes);
    TriangleSoup soup = input.below(3) == 0 ? soup_of(input) : tube_of(input);
    const double unit = std::pow(10.0, static_cast<double>(input.below(7)) - 3.0);
    while (input.left() && soup.faces.size() < kMaxFaces) {
        spoil(soup, input);
    }
    for (Eigen::Vector3d& p : soup.points_mm) {
        p *= unit;
    }
    return soup;
}

}  // namespace meshwind::fuzz
