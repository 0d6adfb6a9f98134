#include "mesh/brep/cad_mesh.h"

#include <cstring>
#include <type_traits>
#include <utility>

#include "core/error.h"

namespace meshwind {
namespace {

constexpr std::string_view kMagic = "meshwind CAD mesh 2\n";

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

// What is written of each, in this order.
template <class Visitor, class Face>
requires std::is_same_v<std::remove_const_t<Face>, CadFace>
void visit(Face& face, Visitor& visitor) {
    visitor.add(face.kind);
    visitor.add(face.radius_mm);
    visitor.add(face.area_mm2);
    visitor.add(face.solid);
    visitor.add(face.colour);
    visitor.add(face.axis_point_mm);
    visitor.add(face.axis_direction);
}

template <class Visitor, class Fit>
requires std::is_same_v<std::remove_const_t<Fit>, Jet>
void visit(Fit& jet, Visitor& visitor) {
    visitor.add(jet.height.frame);
    visitor.add(jet.height.coefficient);
    visitor.add(jet.normal);
    visitor.add(jet.shape_operator_per_mm);
    visitor.add(jet.terms);
}

template <class Visitor, class Mesh>
requires std::is_same_v<std::remove_const_t<Mesh>, CadMesh>
void visit(Mesh& mesh, Visitor& visitor) {
    visitor.add(mesh.soup.points_mm);
    visitor.add(mesh.soup.faces);
    visitor.add(mesh.face);
    visitor.add(mesh.jet);
    visitor.add(mesh.jets);
    visitor.add(mesh.faces);
    visitor.add(mesh.unit_mm);
    visitor.add(mesh.off_face_mm);
    visitor.add(mesh.open_edges);
    visitor.add(mesh.sewn_edges);
}

class Writer {
public:
    Writer() : bytes_(kMagic) {}

    template <Plain T>
    void add(const T& value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void add(const std::string& text) {
        add(text.size());
        bytes_ += text;
    }
    template <int R, int C>
    void add(const Eigen::Matrix<double, R, C>& matrix) {
        for (const double value : matrix.reshaped()) {
            add(value);
        }
    }
    template <class T, std::size_t N>
    void add(const std::array<T, N>& values) {
        for (const T& value : values) {
            add(value);
        }
    }
    void add(const CadFace& face) { visit(face, *this); }
    void add(const Jet& jet) { visit(jet, *this); }
    template <class T>
    void add(const std::vector<T>& values) {
        add(values.size());
        for (const T& value : values) {
            add(value);
        }
    }

    [[nodiscard]] std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
};

class Reader {
public:
    Reader(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {
        if (!rest_.starts_with(kMagic)) {
            fail();
        }
        rest_.remove_prefix(kMagic.size());
    }

    template <Plain T>
    void add(T& value) {
        take(&value, sizeof value);
    }
    void add(std::string& text) {
        text.resize(count(1));
        take(text.data(), text.size());
    }
    template <int R, int C>
    void add(Eigen::Matrix<double, R, C>& matrix) {
        for (double& value : matrix.reshaped()) {
            add(value);
        }
    }
    template <class T, std::size_t N>
    void add(std::array<T, N>& values) {
        for (T& value : values) {
            add(value);
        }
    }
    void add(CadFace& face) { visit(face, *this); }
    void add(Jet& jet) { visit(jet, *this); }
    template <class T>
    void add(std::vector<T>& values) {
        values.resize(count(sizeof(std::int32_t)));
        for (T& value : values) {
            add(value);
        }
    }

    void end() const {
        if (!rest_.empty()) {
            fail();
        }
    }

private:
    // How many follow. \param least_bytes of each
    std::size_t count(std::size_t least_bytes) {
        std::size_t value = 0;
        add(value);
        if (value > rest_.size() / least_bytes) {
            fail();
        }
        return value;
    }

    void take(void* to, std::size_t size) {
        if (size > rest_.size()) {
            fail();
        }
        if (size > 0) {
            std::memcpy(to, rest_.data(), size);
        }
        rest_.remove_prefix(size);
    }

    [[noreturn]] void fail() const {
        throw InputError("mesh.cad_failed", name_,
                         "what the CAD reader made of it ends too early; run it again, and build "
                         "meshwind anew where that does not help");
    }

    std::string_view rest_;
    const std::string& name_;
};

}  // namespace

std::string bytes_of(const CadMesh& mesh) {
    Writer writer;
    visit(mesh, writer);
    return writer.take();
}

CadMesh cad_mesh_of(std::string_view bytes, const std::string& name) {
    Reader reader(bytes, name);
    CadMesh mesh;
    visit(mesh, reader);
    reader.end();
    return mesh;
}

}  // namespace meshwind
