/* So that a component may include rtapi_limits.h. */
#include <limits.h>
