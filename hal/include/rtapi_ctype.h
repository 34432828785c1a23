/* So that a component may include rtapi_ctype.h. */
#include <ctype.h>
