#include "postproc/deviation.h"
