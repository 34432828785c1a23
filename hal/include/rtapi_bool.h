/* So that a component may include rtapi_bool.h. */
#include <stdbool.h>
