/* So that a component may include rtapi_string.h. */
#include <string.h>
