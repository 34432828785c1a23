/* So that a component may include rtapi_gfp.h. */
#include "rtapi_slab.h"
