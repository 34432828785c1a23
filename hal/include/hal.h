/* The functions of hal.h with which a component in C makes its pins, parameters and functions. See docs/hal.md. */
#ifndef PYEMC_HAL_H
#define PYEMC_HAL_H

#include "rtapi.h"

#define HAL_NAME_LEN 47
#define HAL_SUCCESS 0

typedef enum {
    HAL_BIT = 1, HAL_FLOAT = 2, HAL_S32 = 3, HAL_U32 = 4, HAL_PORT = 5, HAL_S64 = 6, HAL_U64 = 7
} hal_type_t;
typedef enum { HAL_IN = 16, HAL_OUT = 32, HAL_IO = 48 } hal_pin_dir_t;
typedef enum { HAL_RO = 64, HAL_RW = 192 } hal_param_dir_t;

typedef volatile bool hal_bit_t;
typedef volatile real_t hal_float_t;
typedef volatile rtapi_s32 hal_s32_t;
typedef volatile rtapi_u32 hal_u32_t;
typedef volatile rtapi_s64 hal_s64_t;
typedef volatile rtapi_u64 hal_u64_t;

typedef union {
    hal_bit_t b;
    hal_s32_t s;
    hal_u32_t u;
    hal_s64_t ls;
    hal_u64_t lu;
    hal_float_t f;
} hal_data_u;

RTAPI_BEGIN_DECLS

int rtapi_app_main(void);
void rtapi_app_exit(void);

static inline int hal_init(const char *name) { return hal_host_table->init(name); }
static inline int hal_ready(int comp_id) { return hal_host_table->ready(comp_id); }
static inline int hal_exit(int comp_id) { return hal_host_table->leave(comp_id); }
static inline void *hal_malloc(long size) { return hal_host_table->memory(size); }

static inline int hal_pin_new(const char *name, hal_type_t type, hal_pin_dir_t dir, void **where, int comp_id)
{
    return hal_host_table->pin(type, dir, where, comp_id, name);
}

static inline int hal_param_new(const char *name, hal_type_t type, hal_param_dir_t dir, void *where, int comp_id)
{
    return hal_host_table->param(type, dir, where, comp_id, name);
}

static inline int hal_export_funct(
    const char *name, hal_host_code code, void *arg, int uses_fp, int reentrant, int comp_id)
{
    return hal_host_table->function(name, code, arg, uses_fp, reentrant, comp_id);
}

#define HAL_FORMATTED_NAME_ \
    char name[HAL_NAME_LEN + 2]; \
    va_list list; \
    va_start(list, format); \
    vsnprintf(name, sizeof(name), format, list); \
    va_end(list)

static inline __attribute__((format(printf, 6, 7))) int hal_export_functf(
    hal_host_code code, void *arg, int uses_fp, int reentrant, int comp_id, const char *format, ...)
{
    HAL_FORMATTED_NAME_;
    return hal_export_funct(name, code, arg, uses_fp, reentrant, comp_id);
}

static inline __attribute__((format(printf, 5, 6))) int hal_pin_newf(
    hal_type_t type, hal_pin_dir_t dir, void **where, int comp_id, const char *format, ...)
{
    HAL_FORMATTED_NAME_;
    return hal_pin_new(name, type, dir, where, comp_id);
}

static inline __attribute__((format(printf, 5, 6))) int hal_param_newf(
    hal_type_t type, hal_param_dir_t dir, void *where, int comp_id, const char *format, ...)
{
    HAL_FORMATTED_NAME_;
    return hal_param_new(name, type, dir, where, comp_id);
}

/* For each type: hal_pin_TYPE_new, hal_pin_TYPE_newf, hal_param_TYPE_new, hal_param_TYPE_newf. */
#define HAL_OF_TYPE_(word, type) \
    static inline int hal_pin_##word##_new(const char *name, hal_pin_dir_t dir, hal_##word##_t **where, int comp_id) \
    { \
        return hal_pin_new(name, type, dir, (void **)where, comp_id); \
    } \
    static inline int hal_param_##word##_new(const char *name, hal_param_dir_t dir, hal_##word##_t *where, int comp_id) \
    { \
        return hal_param_new(name, type, dir, (void *)where, comp_id); \
    } \
    static inline __attribute__((format(printf, 4, 5))) int hal_pin_##word##_newf( \
        hal_pin_dir_t dir, hal_##word##_t **where, int comp_id, const char *format, ...) \
    { \
        HAL_FORMATTED_NAME_; \
        return hal_pin_new(name, type, dir, (void **)where, comp_id); \
    } \
    static inline __attribute__((format(printf, 4, 5))) int hal_param_##word##_newf( \
        hal_param_dir_t dir, hal_##word##_t *where, int comp_id, const char *format, ...) \
    { \
        HAL_FORMATTED_NAME_; \
        return hal_param_new(name, type, dir, (void *)where, comp_id); \
    }

HAL_OF_TYPE_(bit, HAL_BIT)
HAL_OF_TYPE_(float, HAL_FLOAT)
HAL_OF_TYPE_(s32, HAL_S32)
HAL_OF_TYPE_(u32, HAL_U32)
HAL_OF_TYPE_(s64, HAL_S64)
HAL_OF_TYPE_(u64, HAL_U64)

RTAPI_END_DECLS

#endif
