// What `inspect --page` shows, against closed forms and against the mandrel's own surface.
#include "report/inspection.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/units.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/mandrel/remarks.h"
#include "mesh/shapes/make.h"
#include "report/part_data.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

constexpr double kTow_mm = 6.0;

// The data as a page reads it.
class Data {
public:
    explicit Data(const Inspection& found) : bytes_(part_data(found)) {
        std::uint32_t length = 0;
        std::memcpy(&length, bytes_.data(), sizeof length);
        header_ = json::parse(bytes_.substr(sizeof length, length));
        begin_ = sizeof length + length;
    }

    [[nodiscard]] const json& header() const { return header_; }

    template <typename T>
    [[nodiscard]] std::vector<T> array(const std::string& name) const {
        const json& table = header_.at("arrays").at(name);
        const std::size_t at = begin_ + table.at("offset").get<std::size_t>();
        EXPECT_EQ(at % 8, 0U);
        std::vector<T> values(table.at("count").get<std::size_t>() *
                              table.at("width").get<std::size_t>());
        if (!values.empty()) {
            std::memcpy(values.data(), bytes_.data() + at, values.size() * sizeof(T));
        }
        return values;
    }

    [[nodiscard]] std::vector<Vector3d> points(const std::string& name) const {
        const std::vector<float> flat = array<float>(name);
        std::vector<Vector3d> points;
        for (std::size_t i = 0; i + 2 < flat.size(); i += 3) {
            points.emplace_back(flat[i], flat[i + 1], flat[i + 2]);
        }
        return points;
    }

    // Of each triangle.
    [[nodiscard]] std::vector<double> areas_mm2(const std::string& what) const {
        const std::vector<Vector3d> p = points(what + "/points");
        const std::vector<std::uint32_t> faces = array<std::uint32_t>(what + "/faces");
        std::vector<double> areas;
        for (std::size_t i = 0; i + 2 < faces.size(); i += 3) {
            const Vector3d& a = p[faces[i]];
            areas.push_back(0.5 * (p[faces[i + 1]] - a).cross(p[faces[i + 2]] - a).norm());
        }
        return areas;
    }

private:
    std::string bytes_;
    json header_;
    std::size_t begin_ = 0;
};

Inspection inspected(const TriangleSoup& soup) {
    return inspect(build_mandrel(soup, "part.stl", {.unit_mm = 1.0}), kTow_mm);
}

Inspection lettered_elbow() {
    return inspect(
        load_mandrel(std::string(MESHWIND_SOURCE_DIR) + "/data/meshes/cad/lettered_elbow.stl",
                     {.unit_mm = 1000.0}),
        kTow_mm);
}

std::map<std::string, double> areas_by_kind(const Data& data) {
    std::map<std::string, double> sums;
    const json& regions = data.header()["inspection"]["mandrel"]["regions"];
    const std::vector<std::int32_t> region = data.array<std::int32_t>("part/region");
    const std::vector<double> areas = data.areas_mm2("part");
    for (std::size_t f = 0; f < areas.size(); ++f) {
        sums[regions.at(static_cast<std::size_t>(region[f]))["kind"]] += areas[f];
    }
    return sums;
}

// Pipe of 30 x 120 with a wall of 5 mm. 38 chords around are short of their circle by
// (pi / 38)^2 / 6 = 0.11 %, the end faces by four times as much.
TEST(PartPage, ASolidPipeHasTheAreasOfItsRegions) {
    const Data data(inspected(make_cylinder({.radius_mm = 30.0, .length_mm = 120.0},
                                            {.edge_mm = 5.0, .solid = true, .wall_mm = 5.0})));
    const auto sums = areas_by_kind(data);
    ASSERT_EQ(sums.size(), 3U);
    const auto near = [](double value, double closed_form) {
        return std::abs(value - closed_form) < 0.006 * closed_form;
    };
    EXPECT_TRUE(near(sums.at("outer-wall"), 2.0 * kPi * 30.0 * 120.0)) << sums.at("outer-wall");
    EXPECT_TRUE(near(sums.at("bore"), 2.0 * kPi * 25.0 * 120.0)) << sums.at("bore");
    EXPECT_TRUE(near(sums.at("end-cap"), 2.0 * kPi * (900.0 - 625.0))) << sums.at("end-cap");
    EXPECT_TRUE(data.header()["refused"].is_null());
    EXPECT_TRUE(data.areas_mm2("details").empty());
}

TEST(PartPage, EveryTriangleOfThePartIsThereWithItsRegion) {
    const Inspection found = inspected(make_tee({}, {.edge_mm = 8.0, .solid = true}));
    const Data data(found);
    const std::vector<std::int32_t> region = data.array<std::int32_t>("part/region");
    ASSERT_EQ(region.size(), found.mandrel.winding_mesh.file_triangles);
    std::map<std::int32_t, int> count;
    for (const std::int32_t id : region) {
        ++count[id];
    }
    for (const Region& r : found.mandrel.regions) {
        EXPECT_EQ(count[r.id], r.triangles) << r.id;
    }
}

TEST(PartPage, LoopsOfRimsLieOnTheirCircles) {
    const Data data(inspected(make_elbow({}, {.edge_mm = 6.0})));
    const json& rims = data.header()["inspection"]["mandrel"]["rims"];
    ASSERT_EQ(rims.size(), 2U);
    for (const json& rim : rims) {
        const auto vector = [&](const char* key) {
            return Vector3d(rim[key][0], rim[key][1], rim[key][2]);
        };
        const auto loop = data.points("rim" + std::to_string(rim["id"].get<int>()) + "/loop");
        EXPECT_EQ(loop.size(), rim["points"].get<std::size_t>());
        for (const Vector3d& point : loop) {
            const Vector3d arm = point - vector("centre");
            EXPECT_NEAR(arm.dot(vector("axis")), 0.0, 1e-3);
            EXPECT_NEAR(arm.norm(), rim["radius"].get<double>(), 1e-3);
        }
    }
}

// The share that the remark tells is that of the triangles marked, all of them on the wall; those
// lie where branch and run meet: outside of neither pipe.
TEST(PartPage, ASharpCrotchIsMarkedWhereItIs) {
    const TeeShape tee{.blend_radius_mm = 0.5};
    const Inspection found = inspected(make_tee(tee, {.edge_mm = 5.0}));
    const Data data(found);
    const std::vector<char> sharp = data.array<char>("part/sharp");
    const std::vector<double> areas = data.areas_mm2("part");
    double marked = 0.0;
    double all = 0.0;
    for (std::size_t f = 0; f < areas.size(); ++f) {
        all += areas[f];
        marked += sharp[f] != 0 ? areas[f] : 0.0;
    }
    std::ostringstream share;
    share.precision(1);
    share << std::fixed << 100.0 * marked / all << " %";
    const std::vector<std::string>& remarks = found.mandrel.remarks;
    const auto remark = std::find_if(remarks.begin(), remarks.end(), [](const std::string& words) {
        return words.find("mandrel.blend=6.0") != std::string::npos;
    });
    ASSERT_NE(remark, remarks.end());
    EXPECT_NE(remark->find(share.str()), std::string::npos) << *remark << share.str();
    const json& places = data.header()["inspection"]["mandrel"]["places"];
    ASSERT_GE(places.size(), 2U);
    for (const json& place : places) {
        EXPECT_EQ(place["remark"], remark - remarks.begin());
        // The spindle is the run's axis, and the branch stands along X.
        const Vector3d at(place["at"][0], place["at"][1], place["at"][2]);
        EXPECT_NEAR(at.head<2>().norm(), tee.run_radius_mm, kTow_mm);
        EXPECT_NEAR(std::hypot(at.y(), at.z()), tee.branch_radius_mm, kTow_mm);
    }
    EXPECT_TRUE(inspected(make_cylinder({}, {.edge_mm = 8.0})).sharp.empty());
}

TEST(PartPage, LettersTakenOffAreShownWhereTheyWere) {
    const Inspection found = lettered_elbow();
    const Data data(found);
    double area = 0.0;
    for (const double face : data.areas_mm2("details")) {
        area += face;
    }
    const WindingMeshReport& mesh = found.mandrel.winding_mesh;
    EXPECT_EQ(mesh.details, 2);
    EXPECT_NEAR(area, mesh.details_mm2, 1e-3 * area);
    const double height = data.header()["details_mm"];
    for (const Vector3d& p : data.points("details/points")) {
        double nearest = 1e9;
        for (const Vector3d& wall : found.mandrel.surface.position_mm) {
            nearest = std::min(nearest, (wall - p).norm());
        }
        EXPECT_LE(nearest, height + found.mandrel.surface.mean_edge_mm);
    }
}

TEST(PartPage, EachPlaceIsOneOfItsRemark) {
    const Inspection found = lettered_elbow();
    const std::vector<std::string>& remarks = found.mandrel.remarks;
    ASSERT_FALSE(found.mandrel.places.empty());
    for (const RemarkPlace& place : found.mandrel.places) {
        ASSERT_LT(place.remark, remarks.size());
        const std::string& words = remarks[place.remark];
        EXPECT_TRUE(words.find("is cut ") != std::string::npos ||
                    words.find("lettering") != std::string::npos)
            << words;
        if (words.starts_with("rim 0 is cut")) {
            const Rim& rim = found.mandrel.rims[0];
            EXPECT_NEAR((place.at_mm - rim.centre_mm).norm(), rim.radius_mm,
                        rim.circularity_mm + 1e-6);
        }
    }
}

// Half of a pipe: its one rim is no circle.
TEST(PartPage, WhatTheMainJobRefusesIsSaid) {
    TriangleSoup half = make_cylinder({.radius_mm = 30.0, .length_mm = 120.0}, {.edge_mm = 5.0});
    half.faces.erase(
        std::remove_if(half.faces.begin(), half.faces.end(),
                       [&](const auto& face) {
                           return half.points_mm[static_cast<std::size_t>(face[0])].x() < 0.0;
                       }),
        half.faces.end());
    const Inspection found = inspected(half);
    EXPECT_NE(found.refused.find("is no circle"), std::string::npos) << found.refused;
    EXPECT_FALSE(found.refused.starts_with("part.stl"));
    ASSERT_EQ(found.mandrel.places.size(), 1U);
    EXPECT_NE(found.mandrel.remarks[found.mandrel.places[0].remark].find("is no circle"),
              std::string::npos);
}

TEST(PartPage, ThePageHasTheWordsThatArePrinted) {
    const Inspection found = inspected(make_cylinder({}, {.edge_mm = 8.0}));
    std::ostringstream printed;
    print_inspection(printed, found);
    const Data data(found);
    EXPECT_EQ(data.header()["text"], printed.str());
    EXPECT_EQ(data.header()["inspection"], inspection_report(found));
}

TEST(PartPage, GroupsBeginWithTheFirstPointAndTheLargestComesFirst) {
    const std::vector<Vector3d> points = {
        {0.0, 0.0, 0.0}, {10.0, 0.0, 0.0}, {11.0, 0.0, 0.0}, {12.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
    const std::vector<Vector3d> middles = middles_of_groups(points, 5.0);
    ASSERT_EQ(middles.size(), 2U);
    EXPECT_EQ(middles[0], Vector3d(11.0, 0.0, 0.0));
    EXPECT_EQ(middles[1], Vector3d(0.0, 0.0, 0.0));
    EXPECT_TRUE(middles_of_groups({}, 5.0).empty());
}

TEST(PartPage, OnlyANameOfAPageIsTaken) {
    check_part_page("");
    for (const char* name : {"part.stl", "html", "page.htm"}) {
        try {
            check_part_page(name);
            ADD_FAILURE() << name;
        } catch (const InputError& error) {
            EXPECT_EQ(error.code().substr(0, 8), "cli.page") << name;
        }
    }
}

}  // namespace
}  // namespace meshwind
