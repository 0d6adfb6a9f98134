#include <cstdio>

#include "core/text_number.h"
#include "mesh/triangle_soup.h"

int main() {
    meshwind::TriangleSoup soup;
    soup.points_mm = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
    soup.faces = {{0, 1, 2}};
    const std::string area = meshwind::fixed(meshwind::area_mm2(soup), 3);
    std::puts(area.c_str());
    return area == "6.000" ? 0 : 1;
}
