/* So that a component may include rtapi_app.h. */
#include "rtapi.h"
