#include "mesh/cad_face.h"

namespace meshwind {

bool is_named(const CadFace& face, std::size_t number, std::string_view word) {
    return word == std::to_string(number) || word == face.kind ||
           (!face.colour.empty() && word == face.colour);
}

}  // namespace meshwind
