#include <cstring>

#include <assimp/scene.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include "core/error.h"
#include "mesh/io/mesh_readers.h"

namespace meshwind {
namespace {

// Stands for the file system: there is no file but the bytes at hand.
class NoFiles : public Assimp::IOSystem {
public:
    bool Exists(const char*) const override { return false; }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
    void Close(Assimp::IOStream*) override {}
};

void append(const aiMesh& part, TriangleSoup& soup) {
    const auto offset = static_cast<std::int32_t>(soup.points_mm.size());
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
        const aiVector3D& p = part.mVertices[v];
        soup.points_mm.emplace_back(p.x, p.y, p.z);
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
        const aiFace& face = part.mFaces[f];
        if (face.mNumIndices == 3) {
            soup.faces.push_back({offset + static_cast<std::int32_t>(face.mIndices[0]),
                                  offset + static_cast<std::int32_t>(face.mIndices[1]),
                                  offset + static_cast<std::int32_t>(face.mIndices[2])});
        }
    }
}

// Exactly the header and its triangles: with bytes behind them assimp takes a file for text.
std::string_view checked(std::string_view bytes, const std::string& file) {
    const std::size_t count = bytes.size() < kStlHeaderBytes ? 0 : stl_count(bytes);
    const std::size_t held =
        bytes.size() < kStlHeaderBytes ? 0 : (bytes.size() - kStlHeaderBytes) / kStlTriangleBytes;
    if (bytes.size() < kStlHeaderBytes || held < count) {
        throw InputError("mesh.truncated", file,
                         "holds " + std::to_string(held) + " of the " + std::to_string(count) +
                             " triangles its header announces, export or copy the file again");
    }
    return bytes.substr(0, kStlHeaderBytes + kStlTriangleBytes * count);
}

}  // namespace

std::size_t stl_count(std::string_view bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + (kStlHeaderBytes - sizeof count), sizeof count);
    return count;
}

TriangleSoup read_binary_stl(std::string_view bytes, const std::string& file) {
    const std::string_view exact = checked(bytes, file);
    TriangleSoup soup;
    if (exact.size() == kStlHeaderBytes) {
        return soup;
    }
    Assimp::Importer importer;
    importer.SetIOHandler(new NoFiles);  // it takes it over
    const aiScene* scene = importer.ReadFileFromMemory(exact.data(), exact.size(), 0, "stl");
    if (scene == nullptr) {
        throw InputError("mesh.not_a_mesh", file,
                         std::string("cannot be read as STL (") + importer.GetErrorString() +
                             "), export it again");
    }
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        append(*scene->mMeshes[m], soup);
    }
    return soup;
}

}  // namespace meshwind
