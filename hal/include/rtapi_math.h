/* So that a component may include rtapi_math.h. */
#include <math.h>
