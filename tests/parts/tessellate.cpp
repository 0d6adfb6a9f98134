#include "tessellate.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>

#include <BRepBuilderAPI_Copy.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Quaternion.hxx>
#include <gp_Vec.hxx>

namespace cad_part {
namespace {

constexpr double kSeam = 1e-5;  // mm, between faces that do not meet to the last bit
constexpr double kFlat = 0.05;  // mm, how far a facet's corner may be off a leg's wall or end

using Key = std::array<double, 3>;

Key key_of(const gp_Pnt& p) {
    return {p.X() + 0.0, p.Y() + 0.0, p.Z() + 0.0};
}

// Even on the sphere of rotations.
gp_Quaternion any_turn(Random& random) {
    std::array<double, 4> q{};
    double length = 0.0;
    do {
        length = 0.0;
        for (double& value : q) {
            value = random.uniform(-1.0, 1.0);
            length += value * value;
        }
    } while (length > 1.0 || length < 0.01);
    gp_Quaternion turn(q[0], q[1], q[2], q[3]);
    turn.Normalize();
    return turn;
}

double along_leg(const gp_Ax2& frame, const gp_Pnt& p) {
    return gp_Vec(frame.Location(), p).Dot(gp_Vec(frame.Direction()));
}

double off_axis(const gp_Ax2& frame, const gp_Pnt& p) {
    return gp_Vec(frame.Location(), p).Crossed(gp_Vec(frame.Direction())).Magnitude();
}

template <typename Value>
void write_raw(std::ostream& out, const Value& value) {
    std::array<char, sizeof(Value)> raw{};
    std::memcpy(raw.data(), &value, sizeof(Value));
    out.write(raw.data(), raw.size());
}

void write_vector(std::ostream& out, const gp_XYZ& v) {
    for (int i = 1; i <= 3; ++i) {
        write_raw(out, static_cast<float>(v.Coord(i)));
    }
}

}  // namespace

ExportOptions draw_export(Random& random) {
    ExportOptions options;
    options.relative = random.chance(0.2);
    options.linear_mm =
        options.relative ? random.logarithmic(0.001, 0.01) : random.logarithmic(0.01, 0.2);
    options.angular_rad = random.uniform(0.1, 0.5);
    options.seams = random.chance(0.15);
    options.inverted = random.chance(0.05);
    options.moved = random.chance(0.5);
    if (options.moved) {
        options.motion.SetRotation(any_turn(random));
        gp_Trsf shift;
        const double x = random.uniform(-200.0, 200.0);
        const double y = random.uniform(-200.0, 200.0);
        const double z = random.uniform(-200.0, 200.0);
        shift.SetTranslation(gp_Vec(x, y, z));
        options.motion = shift * options.motion;
    }
    const double unit = random.uniform(0.0, 1.0);
    if (unit < 0.08) {
        options.unit = "in";
        options.unit_mm = 25.4;
    } else if (unit < 0.16) {
        options.unit = "m";
        options.unit_mm = 1000.0;
    }
    return options;
}

std::vector<Triangle> tessellated(const Built& built, const ExportOptions& options) {
    const BRepMesh_IncrementalMesh mesher(built.shape, options.linear_mm, options.relative,
                                          options.angular_rad, Standard_False);
    std::vector<Triangle> triangles;
    int number = 0;
    for (TopExp_Explorer it(built.shape, TopAbs_FACE); it.More(); it.Next(), ++number) {
        const TopoDS_Face face = TopoDS::Face(it.Current());
        TopLoc_Location location;
        const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, location);
        if (mesh.IsNull()) {
            return {};
        }
        const bool reversed = face.Orientation() == TopAbs_REVERSED;
        for (int i = 1; i <= mesh->NbTriangles(); ++i) {
            int a = 0;
            int b = 0;
            int c = 0;
            mesh->Triangle(i).Get(a, b, c);
            if (reversed) {
                std::swap(b, c);
            }
            Triangle triangle{.corner = {mesh->Node(a), mesh->Node(b), mesh->Node(c)},
                              .face = number};
            for (gp_Pnt& corner : triangle.corner) {
                corner.Transform(location.Transformation());
            }
            triangles.push_back(triangle);
        }
    }
    return triangles;
}

bool watertight(const std::vector<Triangle>& triangles) {
    std::map<Key, int> number;
    std::map<std::pair<int, int>, int> balance;
    for (const Triangle& triangle : triangles) {
        std::array<int, 3> id{};
        for (std::size_t i = 0; i < 3; ++i) {
            id[i] = number.try_emplace(key_of(triangle.corner[i]), static_cast<int>(number.size()))
                        .first->second;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const int from = id[i];
            const int to = id[(i + 1) % 3];
            if (from != to) {
                balance[std::minmax(from, to)] += from < to ? 1 : -1;
            }
        }
    }
    return !triangles.empty() && std::all_of(balance.begin(), balance.end(),
                                             [](const auto& entry) { return entry.second == 0; });
}

std::vector<Triangle> skin_of(const Part& part, const std::vector<Triangle>& triangles) {
    std::vector<Triangle> left;
    for (const Triangle& triangle : triangles) {
        const bool end = std::any_of(part.legs.begin(), part.legs.end(), [&](const Leg& leg) {
            return std::all_of(
                triangle.corner.begin(), triangle.corner.end(), [&](const gp_Pnt& p) {
                    return std::abs(along_leg(leg.frame, p) - leg.length_mm) < 1e-6 &&
                           off_axis(leg.frame, p) < leg.end_radius_mm() + kFlat;
                });
        });
        if (!end) {
            left.push_back(triangle);
        }
    }
    return left;
}

std::vector<Triangle> without_face(const std::vector<Triangle>& triangles,
                                   const MissingFace& face) {
    std::vector<Triangle> left;
    for (const Triangle& triangle : triangles) {
        // Facets of one row are as long as the wall: those that begin on it belong to it.
        bool gone = true;
        gp_XYZ middle;
        for (const gp_Pnt& p : triangle.corner) {
            const double along = along_leg(face.frame, p);
            gone = gone && std::abs(off_axis(face.frame, p) - face.radius_mm) < kFlat &&
                   along > face.from_mm && along < face.to_mm;
            middle += p.XYZ() / 3.0;
        }
        const gp_Vec out(face.frame.Location(), gp_Pnt(middle));
        const double angle = std::atan2(out.Dot(gp_Vec(face.frame.YDirection())),
                                        out.Dot(gp_Vec(face.frame.XDirection())));
        if (!gone ||
            std::abs(std::remainder(angle - face.middle_rad, 2.0 * M_PI)) > face.half_rad) {
            left.push_back(triangle);
        }
    }
    return left;
}

bool write_stl(const std::string& file, const std::vector<Triangle>& triangles,
               const ExportOptions& options, Random& random) {
    std::map<int, gp_XYZ> shift;
    std::ofstream out(file, std::ios::binary);
    out << std::string(80, ' ');
    write_raw(out, static_cast<std::uint32_t>(triangles.size()));
    for (const Triangle& triangle : triangles) {
        if (options.seams && !shift.contains(triangle.face)) {
            const double x = random.uniform(-kSeam, kSeam);
            const double y = random.uniform(-kSeam, kSeam);
            const double z = random.uniform(-kSeam, kSeam);
            shift[triangle.face] = gp_XYZ(x, y, z);
        }
        std::array<gp_XYZ, 3> corner;
        for (std::size_t i = 0; i < 3; ++i) {
            gp_XYZ p = triangle.corner[i].Transformed(options.motion).XYZ();
            if (options.seams) {
                p += shift[triangle.face];
            }
            corner[i] = p / options.unit_mm;
        }
        if (options.inverted) {
            std::swap(corner[1], corner[2]);
        }
        gp_XYZ normal = (corner[1] - corner[0]).Crossed(corner[2] - corner[0]);
        normal = normal.Modulus() > 0.0 ? normal / normal.Modulus() : normal;
        write_vector(out, normal);
        for (const gp_XYZ& p : corner) {
            write_vector(out, p);
        }
        write_raw(out, std::uint16_t{0});
    }
    out.close();
    return !out.fail();
}

bool write_step(const std::string& file, const TopoDS_Shape& shape, const ExportOptions& options) {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    STEPControl_Controller::Init();  // before the unit is set, or the writer has another
    Interface_Static::SetCVal("write.step.unit", options.unit_mm == 1000.0 ? "M"
                                                 : options.unit_mm == 25.4 ? "INCH"
                                                                           : "MM");
    // Without the triangles.
    TopoDS_Shape bare = BRepBuilderAPI_Copy(shape).Shape();
    BRepTools::Clean(bare);
    const TopoDS_Shape moved =
        options.moved ? BRepBuilderAPI_Transform(bare, options.motion, true).Shape() : bare;
    STEPControl_Writer writer;
    writer.Transfer(moved, STEPControl_AsIs);
    return writer.Write(file.c_str()) == IFSelect_RetDone;
}

}  // namespace cad_part
