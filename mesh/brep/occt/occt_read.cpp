#include "mesh/brep/occt/occt_read.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPConstruct_Styles.hxx>
#include <STEPControl_Reader.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepVisual_Colour.hxx>
#include <StepVisual_StyledItem.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_AsciiString.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include "core/error.h"
#include "core/text/text_number.h"
#include "mesh/io/import.h"

namespace meshwind {
namespace {

// Edges of faces that are no farther apart are one: what modellers take for the same place, mm.
constexpr double kSewing_mm = 1e-3;

constexpr std::size_t kNamedSolids = 8;

struct Solid {
    TopoDS_Shape shape;
    std::string name;
};

struct Read {
    TopoDS_Shape shape;
    double unit_mm = 1.0;
    std::vector<Solid> solids;
    FaceColours colours;
};

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& kind) {
    throw InputError("mesh.not_cad", file.string(),
                     "is no " + kind + " file, or a damaged one; export the part again");
}

std::vector<Solid> solids_of(const TopoDS_Shape& shape) {
    std::vector<Solid> solids;
    for (TopExp_Explorer at(shape, TopAbs_SOLID); at.More(); at.Next()) {
        solids.push_back({at.Current(), {}});
    }
    return solids;
}

double mm_of(const std::string& unit) {
    static constexpr std::pair<const char*, double> kUnits[] = {
        {"millimetre", 1.0}, {"centimetre", 10.0}, {"metre", 1000.0}, {"inch", 25.4},
        {"foot", 304.8},     {"micrometre", 1e-3}, {"MM", 1.0},       {"INCH", 25.4}};
    for (const auto& [name, mm] : kUnits) {
        if (unit == name) {
            return mm;
        }
    }
    return 1.0;
}

// The name that the file has for what became a solid.
std::string name_of(const Handle(Transfer_TransientProcess) & process, const TopoDS_Shape& solid) {
    for (int i = 1; i <= process->NbMapped(); ++i) {
        const Handle(StepRepr_RepresentationItem) item =
            Handle(StepRepr_RepresentationItem)::DownCast(process->Mapped(i));
        if (!item.IsNull() && !item->Name().IsNull() &&
            TransferBRep::ShapeResult(process, item).IsPartner(solid)) {
            return item->Name()->ToCString();
        }
    }
    return {};
}

// A face's own colour comes before that of what it belongs to.
FaceColours colours_of(const Handle(XSControl_WorkSession) & session) {
    FaceColours colours;
    STEPConstruct_Styles styles(session);
    if (!styles.LoadStyles()) {
        return colours;
    }
    const auto process = session->TransferReader()->TransientProcess();
    for (const bool own : {false, true}) {
        for (int i = 1; i <= styles.NbStyles(); ++i) {
            const Handle(StepVisual_StyledItem) style = styles.Style(i);
            if (style.IsNull() || style->Item().IsNull()) {
                continue;
            }
            const TopoDS_Shape styled = TransferBRep::ShapeResult(process, style->Item());
            Handle(StepVisual_Colour) surface, border, curve, rendered;
            double clear = 0.0;
            bool component = false;
            Quantity_Color colour;
            if (styled.IsNull() || (styled.ShapeType() == TopAbs_FACE) != own ||
                !styles.GetColors(style, surface, border, curve, rendered, clear, component) ||
                surface.IsNull() || !STEPConstruct_Styles::DecodeColor(surface, colour)) {
                continue;
            }
            TCollection_AsciiString hex = Quantity_Color::ColorToHex(colour);
            hex.LowerCase();
            for (TopExp_Explorer at(styled, TopAbs_FACE); at.More(); at.Next()) {
                colours[at.Current().TShape().get()] = hex.ToCString();
            }
        }
    }
    return colours;
}

Read read_step(const std::filesystem::path& file) {
    STEPControl_Reader reader;
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) {
        fail(file, "STEP");
    }
    Read read;
    TColStd_SequenceOfAsciiString lengths;
    TColStd_SequenceOfAsciiString angles;
    TColStd_SequenceOfAsciiString solid_angles;
    reader.FileUnits(lengths, angles, solid_angles);
    read.unit_mm = lengths.IsEmpty() ? 1.0 : mm_of(lengths.First().ToCString());
    reader.TransferRoots();
    read.shape = reader.OneShape();
    if (!read.shape.IsNull()) {
        read.solids = solids_of(read.shape);
        const auto process = reader.WS()->TransferReader()->TransientProcess();
        for (Solid& solid : read.solids) {
            solid.name = name_of(process, solid.shape);
        }
        read.colours = colours_of(reader.WS());
    }
    return read;
}

Read read_iges(const std::filesystem::path& file) {
    IGESControl_Reader reader;
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) {
        fail(file, "IGES");
    }
    Read read;
    const Handle(IGESData_IGESModel) model =
        Handle(IGESData_IGESModel)::DownCast(reader.WS()->Model());
    if (!model.IsNull() && !model->GlobalSection().UnitName().IsNull()) {
        read.unit_mm = mm_of(model->GlobalSection().UnitName()->ToCString());
    }
    reader.TransferRoots();
    read.shape = reader.OneShape();
    if (!read.shape.IsNull()) {
        read.solids = solids_of(read.shape);
    }
    return read;
}

Read read_brep(const std::filesystem::path& file) {
    Read read;
    BRep_Builder builder;
    if (!BRepTools::Read(read.shape, file.c_str(), builder)) {
        fail(file, "BREP");
    }
    if (!read.shape.IsNull()) {
        read.solids = solids_of(read.shape);
    }
    return read;
}

std::string words_of(const std::vector<Solid>& solids) {
    std::string words;
    for (std::size_t i = 0; i < std::min(kNamedSolids, solids.size()); ++i) {
        Bnd_Box box;
        BRepBndLib::Add(solids[i].shape, box);
        double low[3];
        double high[3];
        box.Get(low[0], low[1], low[2], high[0], high[1], high[2]);
        words += (i == 0 ? "" : ", ") + std::to_string(i + 1);
        words += solids[i].name.empty() ? "" : " \"" + solids[i].name + "\"";
        words += " (" + fixed(high[0] - low[0], 0) + " x " + fixed(high[1] - low[1], 0) + " x " +
                 fixed(high[2] - low[2], 0) + " mm)";
    }
    if (solids.size() > kNamedSolids) {
        words += " and " + std::to_string(solids.size() - kNamedSolids) + " more";
    }
    return words;
}

TopoDS_Shape choose(const Read& read, const std::filesystem::path& file,
                    const std::string& wanted) {
    const std::vector<Solid>& solids = read.solids;
    if (wanted.empty()) {
        if (solids.size() > 1) {
            throw InputError("mesh.several_solids", file.string(),
                             "holds " + std::to_string(solids.size()) +
                                 " solids: " + words_of(solids) +
                                 "; name the one to be wound, by name or number, in the job, "
                                 "\"mandrel\": {\"solid\": \"1\"}");
        }
        return solids.empty() ? read.shape : solids.front().shape;
    }
    for (std::size_t i = 0; i < solids.size(); ++i) {
        if (solids[i].name == wanted || std::to_string(i + 1) == wanted) {
            return solids[i].shape;
        }
    }
    throw InputError("mesh.no_such_solid", file.string(),
                     "has no solid \"" + wanted + "\"" +
                         (solids.empty() ? std::string("; it has none, only faces")
                                         : "; its solids are " + words_of(solids)));
}

// Edges that bound one face, once.
int open_edges(const TopoDS_Shape& shape) {
    TopTools_IndexedDataMapOfShapeListOfShape faces_of;
    TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces_of);
    int open = 0;
    for (int i = 1; i <= faces_of.Extent(); ++i) {
        const TopoDS_Edge& edge = TopoDS::Edge(faces_of.FindKey(i));
        const bool single = faces_of(i).Extent() == 1;
        open += single && !BRep_Tool::Degenerated(edge) &&
                        !BRep_Tool::IsClosed(edge, TopoDS::Face(faces_of(i).First()))
                    ? 1
                    : 0;
    }
    return open;
}

}  // namespace

OcctPart read_occt(const std::filesystem::path& file, const std::string& solid) {
    const std::string ending = lower_ending(file);
    const bool step = ending == ".step" || ending == ".stp";
    const Read read = step                ? read_step(file)
                      : ending == ".brep" ? read_brep(file)
                                          : read_iges(file);
    if (read.shape.IsNull() || !TopExp_Explorer(read.shape, TopAbs_FACE).More()) {
        throw InputError("mesh.empty_cad", file.string(),
                         "holds no face; export the part as a solid, not as a sketch or an "
                         "assembly of links");
    }
    OcctPart part{choose(read, file, solid), read.unit_mm, 0, read.colours};
    const int open = open_edges(part.shape);
    if (open > 0) {
        BRepBuilderAPI_Sewing sewing(kSewing_mm);
        sewing.Add(part.shape);
        sewing.Perform();
        const TopoDS_Shape sewn = sewing.SewedShape();
        if (!sewn.IsNull() && open_edges(sewn) < open) {
            part.sewn_edges = open - open_edges(sewn);
            part.shape = sewn;
        }
    }
    return part;
}

}  // namespace meshwind
