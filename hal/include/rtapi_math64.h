/* So that a component may include rtapi_math64.h. */
#include <math.h>
