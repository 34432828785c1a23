/* The functions of rtapi.h for components: messages, time, memory, module parameters. See docs/hal.md. */
#ifndef PYEMC_RTAPI_H
#define PYEMC_RTAPI_H

#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "hal_host.h"

#ifdef __cplusplus
#define RTAPI_BEGIN_DECLS extern "C" {
#define RTAPI_END_DECLS }
#else
#define RTAPI_BEGIN_DECLS
#define RTAPI_END_DECLS
#endif

#ifndef TRUE
#define TRUE 1
#define FALSE 0
#endif

typedef int8_t rtapi_s8;
typedef uint8_t rtapi_u8;
typedef int16_t rtapi_s16;
typedef uint16_t rtapi_u16;
typedef int32_t rtapi_s32;
typedef uint32_t rtapi_u32;
typedef int64_t rtapi_s64;
typedef uint64_t rtapi_u64;
typedef intptr_t rtapi_intptr_t;
typedef uintptr_t rtapi_uintptr_t;
typedef bool rtapi_bool;
typedef double real_t __attribute__((aligned(8)));
typedef double rtapi_real;
typedef int64_t rtapi_sint;
typedef uint64_t rtapi_uint;
typedef int32_t s32;
typedef uint32_t u32;
typedef int64_t s64;
typedef uint64_t u64;

RTAPI_BEGIN_DECLS

__attribute__((weak)) const hal_host *hal_host_table = NULL;

typedef enum {
    RTAPI_MSG_NONE, RTAPI_MSG_ERR, RTAPI_MSG_WARN, RTAPI_MSG_INFO, RTAPI_MSG_DBG, RTAPI_MSG_ALL
} msg_level_t;

#define HAL_SAY_ \
    char text[512]; \
    va_list list; \
    va_start(list, format); \
    vsnprintf(text, sizeof(text), format, list); \
    va_end(list); \
    hal_host_table->say(text)

static inline __attribute__((format(printf, 1, 2))) void rtapi_print(const char *format, ...)
{
    HAL_SAY_;
}

static inline __attribute__((format(printf, 2, 3))) void rtapi_print_msg(msg_level_t level, const char *format, ...)
{
    if ((int)level > hal_host_table->msg_level)
        return;
    HAL_SAY_;
}

static inline int rtapi_get_msg_level(void) { return hal_host_table->msg_level; }

static inline int rtapi_set_msg_level(int level)
{
    if (level < RTAPI_MSG_NONE || level > RTAPI_MSG_ALL)
        return -EINVAL;
    ((hal_host *)hal_host_table)->msg_level = level;
    return 0;
}

#define rtapi_snprintf snprintf
#define rtapi_vsnprintf vsnprintf

static inline long long rtapi_get_time(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * 1000000000LL + now.tv_nsec;
}

/* Clocks are nanoseconds here, as everywhere in this HAL. */
static inline long long rtapi_get_clocks(void) { return rtapi_get_time(); }

static inline long rtapi_delay_max(void) { return 10000; }

/* Pass a few microseconds; more than rtapi_delay_max() ns are cut off. */
static inline void rtapi_delay(long ns)
{
    long long until = rtapi_get_time() + (ns > rtapi_delay_max() ? rtapi_delay_max() : ns);
    while (rtapi_get_time() < until) {}
}

typedef unsigned long rtapi_mutex_t;
static inline int rtapi_mutex_try(rtapi_mutex_t *mutex) { return __atomic_exchange_n(mutex, 1, __ATOMIC_ACQUIRE) != 0; }
static inline void rtapi_mutex_give(rtapi_mutex_t *mutex) { __atomic_store_n(mutex, 0, __ATOMIC_RELEASE); }
static inline void rtapi_mutex_get(rtapi_mutex_t *mutex) { while (rtapi_mutex_try(mutex)) {} }

#define HAL_PARAMETER(parameter_name, type_letter, where, count, text) \
    static const hal_parameter hal_parameter_##parameter_name \
        __attribute__((used, section("hal_parameters"), aligned(8))) = {#parameter_name, type_letter, where, count, text}

/* Where the descriptors are; weak, for a component without any has no such section. */
extern const hal_parameter __start_hal_parameters[] __attribute__((weak, visibility("hidden")));
extern const hal_parameter __stop_hal_parameters[] __attribute__((weak, visibility("hidden")));
__attribute__((weak)) const void *const hal_parameters_begin = __start_hal_parameters;
__attribute__((weak)) const void *const hal_parameters_end = __stop_hal_parameters;

#define RTAPI_MP_INT(variable, text) HAL_PARAMETER(variable, 'i', &variable, 1, text)
#define RTAPI_MP_UINT(variable, text) HAL_PARAMETER(variable, 'u', &variable, 1, text)
#define RTAPI_MP_LONG(variable, text) HAL_PARAMETER(variable, 'l', &variable, 1, text)
#define RTAPI_MP_STRING(variable, text) HAL_PARAMETER(variable, 's', &variable, 1, text)
#define RTAPI_MP_ARRAY_INT(variable, count, text) HAL_PARAMETER(variable, 'i', variable, count, text)
#define RTAPI_MP_ARRAY_UINT(variable, count, text) HAL_PARAMETER(variable, 'u', variable, count, text)
#define RTAPI_MP_ARRAY_LONG(variable, count, text) HAL_PARAMETER(variable, 'l', variable, count, text)
#define RTAPI_MP_ARRAY_STRING(variable, count, text) HAL_PARAMETER(variable, 's', variable, count, text)

#define MODULE_INFO(tag, info)
#define MODULE_AUTHOR(text)
#define MODULE_DESCRIPTION(text)
#define MODULE_LICENSE(text)
#define EXPORT_SYMBOL(symbol)
#define EXPORT_SYMBOL_GPL(symbol)

RTAPI_END_DECLS

#endif
