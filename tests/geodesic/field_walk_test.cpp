#include "geodesic/field_walk.h"
