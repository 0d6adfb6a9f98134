#include "solids.h"

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>

namespace cad_part {
namespace {

TopTools_ListOfShape listed(const std::vector<TopoDS_Shape>& shapes) {
    TopTools_ListOfShape list;
    for (const TopoDS_Shape& shape : shapes) {
        list.Append(shape);
    }
    return list;
}

int solids_of(const TopoDS_Shape& shape) {
    int count = 0;
    for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) {
        ++count;
    }
    return count;
}

bool sound(const TopoDS_Shape& shape, int solids) {
    if (shape.IsNull()) {
        return false;
    }
    const int count = solids_of(shape);
    if (count == 0 || (solids != 0 && count != solids)) {
        return false;
    }
    return BRepCheck_Analyzer(shape).IsValid() && volume_mm3(shape) > 0.0;
}

template <typename Operation>
bool run(Operation& operation, const TopoDS_Shape& shape, const std::vector<TopoDS_Shape>& tools) {
    TopTools_ListOfShape arguments;
    arguments.Append(shape);
    operation.SetArguments(arguments);
    operation.SetTools(listed(tools));
    operation.Build();
    return operation.IsDone() && !operation.HasErrors();
}

}  // namespace

std::optional<Union> united(const TopoDS_Shape& shape, const std::vector<TopoDS_Shape>& with) {
    try {
        BRepAlgoAPI_Fuse fuse;
        if (!run(fuse, shape, with) || !sound(fuse.Shape(), 1)) {
            return std::nullopt;
        }
        Union result{.shape = fuse.Shape(), .crossings = {}};
        for (const TopoDS_Shape& edge : fuse.SectionEdges()) {
            result.crossings.push_back(TopoDS::Edge(edge));
        }
        return result;
    } catch (const Standard_Failure&) {
        return std::nullopt;
    }
}

std::optional<TopoDS_Shape> common_of(const TopoDS_Shape& a, const TopoDS_Shape& b) {
    try {
        BRepAlgoAPI_Common common;
        if (!run(common, a, {b}) || !sound(common.Shape(), 0)) {
            return std::nullopt;
        }
        return common.Shape();
    } catch (const Standard_Failure&) {
        return std::nullopt;
    }
}

std::optional<TopoDS_Shape> without(const TopoDS_Shape& shape,
                                    const std::vector<TopoDS_Shape>& tools, int solids) {
    try {
        BRepAlgoAPI_Cut cut;
        if (!run(cut, shape, tools) || !sound(cut.Shape(), solids)) {
            return std::nullopt;
        }
        return cut.Shape();
    } catch (const Standard_Failure&) {
        return std::nullopt;
    }
}

std::optional<TopoDS_Shape> filleted(const TopoDS_Shape& shape,
                                     const std::vector<TopoDS_Edge>& edges, double radius_mm) {
    if (edges.empty()) {
        return std::nullopt;
    }
    try {
        BRepFilletAPI_MakeFillet fillet(shape);
        for (const TopoDS_Edge& edge : edges) {
            if (!BRep_Tool::Degenerated(edge)) {
                fillet.Add(radius_mm, edge);
            }
        }
        fillet.Build();
        if (!fillet.IsDone() || !sound(fillet.Shape(), 1)) {
            return std::nullopt;
        }
        const double before = volume_mm3(shape);
        const double after = volume_mm3(fillet.Shape());
        if (after <= before || after > 1.3 * before) {
            return std::nullopt;
        }
        return fillet.Shape();
    } catch (const Standard_Failure&) {
        return std::nullopt;
    }
}

double volume_mm3(const TopoDS_Shape& shape) {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(shape, properties);
    return properties.Mass();
}

}  // namespace cad_part
