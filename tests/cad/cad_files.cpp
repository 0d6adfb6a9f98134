/// CAD files of simple parts, and geodesics on the exact faces, for the tests of what reads them:
///
///     cad_files make KIND UNIT FILE        pipe, torus, tee, elbow, wye, vessel, two; mm, m or
///     inch; .step, .igs or .brep cad_files geodesic FILE LENGTH_MM STEP_MM < START
///
/// START: x y z tx ty tz, mm; prints the end. The path is that of the equation of motion on the
/// exact faces, by Runge and Kutta's fourth-order steps, each brought back onto the nearest face.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepOffsetAPI_MakePipe.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <gp_Circ.hxx>
#include <gp_Trsf.hxx>

namespace {

constexpr double kPi = 3.14159265358979323846;

TopoDS_Shape cylinder(const gp_Pnt& root, const gp_Dir& along, double radius, double length) {
    return BRepPrimAPI_MakeCylinder(gp_Ax2(root, along), radius, length).Shape();
}

// Fillets of the edges at which two faces meet at an angle from inside: of a crotch.
TopoDS_Shape with_crotch(const TopoDS_Shape& shape, double radius, double within_mm) {
    BRepFilletAPI_MakeFillet fillet(shape);
    TopTools_IndexedMapOfShape edges;
    TopExp::MapShapes(shape, TopAbs_EDGE, edges);
    for (int i = 1; i <= edges.Extent(); ++i) {
        const TopoDS_Edge& edge = TopoDS::Edge(edges(i));
        if (BRep_Tool::Degenerated(edge)) {
            continue;
        }
        double first = 0.0;
        double last = 0.0;
        const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, first, last);
        const gp_Pnt middle = curve->Value(0.5 * (first + last));
        if (curve->DynamicType()->Name() != std::string("Geom_Line") &&
            curve->DynamicType()->Name() != std::string("Geom_Circle") &&
            middle.Distance(gp_Pnt()) < within_mm) {
            fillet.Add(radius, edge);
        }
    }
    return fillet.Shape();
}

TopoDS_Shape unified(const TopoDS_Shape& shape) {
    ShapeUpgrade_UnifySameDomain unify(shape);
    unify.Build();
    return unify.Shape();
}

TopoDS_Shape tee() {
    const TopoDS_Shape run = cylinder({0, 0, -150}, {0, 0, 1}, 50, 300);
    const TopoDS_Shape branch = cylinder({0, 0, 0}, {1, 0, 0}, 40, 150);
    return with_crotch(unified(BRepAlgoAPI_Fuse(run, branch).Shape()), 15.0, 80.0);
}

TopoDS_Shape wye() {
    const TopoDS_Shape run = cylinder({0, 0, -160}, {0, 0, 1}, 50, 320);
    const double lean = 60.0 * kPi / 180.0;
    const TopoDS_Shape branch = cylinder({0, 0, 0}, {std::sin(lean), 0, std::cos(lean)}, 40, 190);
    return with_crotch(unified(BRepAlgoAPI_Fuse(run, branch).Shape()), 15.0, 110.0);
}

// A quarter bend between two pipes.
TopoDS_Shape elbow() {
    const double bend = 120.0;
    const gp_Pnt a(0, 0, -80);
    const gp_Pnt b(0, 0, 0);
    const gp_Pnt middle(bend - bend * std::cos(kPi / 4), 0, bend * std::sin(kPi / 4));
    const gp_Pnt c(bend, 0, bend);
    const gp_Pnt d(bend + 80, 0, bend);
    BRepBuilderAPI_MakeWire spine;
    spine.Add(BRepBuilderAPI_MakeEdge(a, b).Edge());
    spine.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(b, middle, c).Value()).Edge());
    spine.Add(BRepBuilderAPI_MakeEdge(c, d).Edge());
    const gp_Circ ring(gp_Ax2(a, gp_Dir(0, 0, 1)), 40.0);
    const TopoDS_Face disc =
        BRepBuilderAPI_MakeFace(
            BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(ring).Edge()).Wire())
            .Face();
    return BRepOffsetAPI_MakePipe(spine.Wire(), disc).Shape();
}

// A drum with round ends and a boss at each.
TopoDS_Shape vessel() {
    const gp_Pnt a(0, 0, -140);
    const gp_Pnt b(20, 0, -140);
    const gp_Pnt c(20, 0, -60 - std::sqrt(80.0 * 80.0 - 20.0 * 20.0));
    const double half = 0.5 * (std::atan2(20.0, std::sqrt(80.0 * 80.0 - 20.0 * 20.0)) + kPi / 2);
    const gp_Pnt cd(80 * std::sin(half), 0, -60 - 80 * std::cos(half));
    const gp_Pnt d(80, 0, -60);
    const auto up = [](const gp_Pnt& p) { return gp_Pnt(p.X(), 0, -p.Z()); };
    BRepBuilderAPI_MakeWire outline;
    outline.Add(BRepBuilderAPI_MakeEdge(a, b).Edge());
    outline.Add(BRepBuilderAPI_MakeEdge(b, c).Edge());
    outline.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(c, cd, d).Value()).Edge());
    outline.Add(BRepBuilderAPI_MakeEdge(d, up(d)).Edge());
    outline.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(up(d), up(cd), up(c)).Value()).Edge());
    outline.Add(BRepBuilderAPI_MakeEdge(up(c), up(b)).Edge());
    outline.Add(BRepBuilderAPI_MakeEdge(up(b), up(a)).Edge());
    outline.Add(BRepBuilderAPI_MakeEdge(up(a), a).Edge());
    return BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(outline.Wire()).Face(),
                                 gp_Ax1(gp_Pnt(), gp_Dir(0, 0, 1)))
        .Shape();
}

TopoDS_Shape two() {
    BRep_Builder builder;
    TopoDS_Compound both;
    builder.MakeCompound(both);
    builder.Add(both, cylinder({0, 0, -100}, {0, 0, 1}, 30, 200));
    builder.Add(both, cylinder({200, 0, -50}, {0, 0, 1}, 20, 100));
    return both;
}

TopoDS_Shape made(const std::string& kind) {
    if (kind == "pipe") {
        const TopoDS_Shape outside = cylinder({0, 0, -150}, {0, 0, 1}, 50, 300);
        return BRepAlgoAPI_Cut(outside, cylinder({0, 0, -151}, {0, 0, 1}, 45, 302)).Shape();
    }
    if (kind == "torus") {
        return BRepPrimAPI_MakeTorus(200.0, 50.0, kPi / 2).Shape();
    }
    if (kind == "tee") {
        return tee();
    }
    if (kind == "elbow") {
        return elbow();
    }
    if (kind == "wye") {
        return wye();
    }
    if (kind == "vessel") {
        return vessel();
    }
    return kind == "two" ? two() : TopoDS_Shape();
}

bool ends_with(const std::string& text, const std::string& end) {
    return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

int make(const std::string& kind, const std::string& unit, const std::string& file) {
    const TopoDS_Shape shape = made(kind);
    if (shape.IsNull()) {
        std::fprintf(stderr, "no part of the kind %s\n", kind.c_str());
        return 2;
    }
    if (ends_with(file, ".brep")) {
        return BRepTools::Write(shape, file.c_str()) ? 0 : 1;
    }
    const std::string word = unit == "inch" ? "INCH" : unit == "m" ? "M" : "MM";
    if (ends_with(file, ".igs")) {
        IGESControl_Controller::Init();
        IGESControl_Writer writer(word.c_str(), 0);
        writer.AddShape(shape);
        writer.ComputeModel();
        return writer.Write(file.c_str()) ? 0 : 1;
    }
    // Before the writer is made, or it has the unit of the one before.
    STEPControl_Controller::Init();
    Interface_Static::SetCVal("write.step.unit", word.c_str());
    STEPControl_Writer writer;
    writer.Transfer(shape, STEPControl_AsIs);
    return writer.Write(file.c_str()) == IFSelect_RetDone ? 0 : 1;
}

struct Face {
    TopoDS_Face face;
    BRepAdaptor_Surface surface;
    Handle(ShapeAnalysis_Surface) looked;
    bool known = false;
    gp_Pnt2d uv{};

    explicit Face(const TopoDS_Face& of)
        : face(of),
          surface(of, Standard_False),
          looked(new ShapeAnalysis_Surface(BRep_Tool::Surface(of))) {}

    // The nearest place; by hint where there is one.
    gp_Pnt2d place(const gp_Pnt& p) {
        constexpr double kTolerance = 1e-12;
        uv = known ? looked->NextValueOfUV(uv, p, kTolerance) : looked->ValueOfUV(p, kTolerance);
        known = true;
        return uv;
    }
    bool contains(const gp_Pnt2d& at) const {
        return BRepTopAdaptor_FClass2d(face, 1e-7).Perform(at) != TopAbs_OUT;
    }
};

struct Motion {
    gp_XYZ at;
    gp_XYZ along;
};

class Geodesic {
public:
    explicit Geodesic(const TopoDS_Shape& shape) {
        for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
            faces_.emplace_back(TopoDS::Face(at.Current()));
        }
    }

    Motion run(Motion motion, double length, double step) {
        const int steps = static_cast<int>(std::lround(length / step));
        const double h = length / steps;
        settle(motion);
        for (int i = 0; i < steps; ++i) {
            const gp_XYZ a1 = bend(motion);
            const Motion m2{motion.at + 0.5 * h * motion.along, motion.along + 0.5 * h * a1};
            const gp_XYZ a2 = bend(m2);
            const Motion m3{motion.at + 0.5 * h * m2.along, motion.along + 0.5 * h * a2};
            const gp_XYZ a3 = bend(m3);
            const Motion m4{motion.at + h * m3.along, motion.along + h * a3};
            const gp_XYZ a4 = bend(m4);
            motion.at += h / 6.0 * (motion.along + 2.0 * m2.along + 2.0 * m3.along + m4.along);
            motion.along += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
            settle(motion);
        }
        return motion;
    }

private:
    // Onto the face that is nearest among those within whose borders it lies.
    void settle(Motion& motion) {
        if (current_ != nullptr && on(*current_, motion)) {
            return;
        }
        double best = std::numeric_limits<double>::infinity();
        for (Face& face : faces_) {
            face.known = false;
            const gp_Pnt2d uv = face.place(motion.at);
            const double off = face.surface.Value(uv.X(), uv.Y()).Distance(motion.at);
            if (off < best && face.contains(uv)) {
                best = off;
                current_ = &face;
            }
        }
        leaving_ = true;
        on(*current_, motion);
        leaving_ = false;
    }

    bool on(Face& face, Motion& motion) const {
        const gp_Pnt2d uv = face.place(motion.at);
        if (!face.contains(uv)) {
            return false;
        }
        gp_Pnt p;
        gp_Vec u;
        gp_Vec v;
        face.surface.D1(uv.X(), uv.Y(), p, u, v);
        // A spline ends at its border: beyond, the nearest place stays there.
        constexpr double kBeside_mm = 1e-4;
        if (current_ == &face && p.Distance(motion.at) > kBeside_mm && !leaving_) {
            return false;
        }
        const gp_XYZ n = u.Crossed(v).Normalized().XYZ();
        motion.at = p.XYZ();
        motion.along -= n * n.Dot(motion.along);
        motion.along.Normalize();
        return true;
    }

    // The second derivative along the way: all of it along the normal.
    gp_XYZ bend(const Motion& motion) const {
        const gp_Pnt2d uv = current_->place(motion.at);
        gp_Pnt p;
        gp_Vec u, v, uu, vv, cross;
        current_->surface.D2(uv.X(), uv.Y(), p, u, v, uu, vv, cross);
        const gp_XYZ n = u.Crossed(v).Normalized().XYZ();
        const double e = u.Dot(u);
        const double f = u.Dot(v);
        const double g = v.Dot(v);
        const double bu = u.XYZ().Dot(motion.along);
        const double bv = v.XYZ().Dot(motion.along);
        const double det = e * g - f * f;
        const double du = (g * bu - f * bv) / det;
        const double dv = (e * bv - f * bu) / det;
        return n * (du * du * uu.XYZ().Dot(n) + 2.0 * du * dv * cross.XYZ().Dot(n) +
                    dv * dv * vv.XYZ().Dot(n));
    }

    std::vector<Face> faces_;
    Face* current_ = nullptr;
    bool leaving_ = false;  // for the face on which the next step begins, whatever it is off
};

int geodesic(const std::string& file, double length, double step) {
    STEPControl_Reader reader;
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) {
        return 2;
    }
    reader.TransferRoots();
    Geodesic walker(reader.OneShape());
    std::array<double, 6> start{};
    for (double& value : start) {
        if (std::scanf("%lf", &value) != 1) {
            return 2;
        }
    }
    const Motion end = walker.run(
        {gp_XYZ(start[0], start[1], start[2]), gp_XYZ(start[3], start[4], start[5])}, length, step);
    std::printf("%.12f %.12f %.12f %.12f %.12f %.12f\n", end.at.X(), end.at.Y(), end.at.Z(),
                end.along.X(), end.along.Y(), end.along.Z());
    return 0;
}

}  // namespace

int main(int count, char** arguments) {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    const std::string command = count > 1 ? arguments[1] : "";
    if (command == "make" && count == 5) {
        return make(arguments[2], arguments[3], arguments[4]);
    }
    if (command == "geodesic" && count == 5) {
        return geodesic(arguments[2], std::atof(arguments[3]), std::atof(arguments[4]));
    }
    std::fprintf(stderr,
                 "usage: cad_files make KIND UNIT FILE | geodesic FILE LENGTH_MM STEP_MM\n");
    return 2;
}
