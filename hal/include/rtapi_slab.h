/* Memory for a component's own use, which no other process sees; not for realtime functions. */
#ifndef PYEMC_RTAPI_SLAB_H
#define PYEMC_RTAPI_SLAB_H

#include <stdlib.h>

#define RTAPI_GFP_KERNEL 0
#define rtapi_kmalloc(size, flags) malloc(size)
#define rtapi_kzalloc(size, flags) calloc(1, size)
#define rtapi_krealloc(at, size, flags) realloc(at, size)
#define rtapi_kfree(at) free((void *)(at))

#endif
