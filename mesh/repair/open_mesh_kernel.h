/// The kernel of OpenMesh without its own assertions, which compare names of types at every access:
/// they make building and refining a mesh take one and a half times as long. Assertions of this
/// project stay. Included by .cpp files of this folder only.
#pragma once

#pragma push_macro("NDEBUG")
#ifndef NDEBUG
#define NDEBUG
#endif
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#pragma pop_macro("NDEBUG")
#include <cassert>  // says anew whether assertions are on
