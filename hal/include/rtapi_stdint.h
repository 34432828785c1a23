/* So that a component may include rtapi_stdint.h. */
#include <stdint.h>
