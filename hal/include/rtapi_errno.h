/* So that a component may include rtapi_errno.h. */
#include <errno.h>
