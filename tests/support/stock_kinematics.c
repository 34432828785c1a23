/* What a kinematics module of LinuxCNC needs of HAL, for tests: cells for its pins and parameters, found by name. */
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#define CELLS 256

static struct { char name[64]; int type; void *cell; } cells[CELLS];
static int count;
enum { BIT, FLOAT, S32, U32 };

int shim_count(void) { return count; }
const char *shim_name(int n) { return cells[n].name; }
int shim_type(int n) { return cells[n].type; }
void *shim_cell(int n) { return cells[n].cell; }

static int add(int type, void *cell, const char *format, va_list values) {
    if (count == CELLS) return -1;
    vsnprintf(cells[count].name, sizeof cells[count].name, format, values);
    cells[count].type = type;
    cells[count].cell = cell;
    count++;
    return 0;
}

#define PIN(kind, type)                                                                       \
    int hal_pin_##kind##_newf(int direction, void **at, int comp, const char *format, ...) {  \
        va_list values;                                                                       \
        *at = calloc(1, 8);                                                                   \
        va_start(values, format);                                                             \
        int result = add(type, *at, format, values);                                          \
        va_end(values);                                                                       \
        return result;                                                                        \
    }                                                                                         \
    static int named_##kind(void *cell, const char *format, ...) {                            \
        va_list values;                                                                       \
        va_start(values, format);                                                             \
        int result = add(type, cell, format, values);                                         \
        va_end(values);                                                                       \
        return result;                                                                        \
    }                                                                                         \
    int hal_pin_##kind##_new(const char *name, int direction, void **at, int comp) {          \
        *at = calloc(1, 8);                                                                   \
        return named_##kind(*at, "%s", name);                                                 \
    }

PIN(bit, BIT)
PIN(float, FLOAT)
PIN(s32, S32)
PIN(u32, U32)

int hal_param_float_newf(int direction, void *at, int comp, const char *format, ...) {
    va_list values;
    va_start(values, format);
    int result = add(FLOAT, at, format, values);
    va_end(values);
    return result;
}

int hal_init(const char *name) { return 1; }
int hal_ready(int comp) { return 0; }
int hal_set_unready(int comp) { return 0; }
int hal_exit(int comp) { return 0; }
void *hal_malloc(long size) { return calloc(1, size); }
int hal_export_funct(const char *name, void *function, void *arg, int fp, int reentrant, int comp) { return 0; }
void rtapi_print(const char *format, ...) {}
void rtapi_print_msg(int level, const char *format, ...) {}
int rtapi_snprintf(char *text, unsigned long size, const char *format, ...) {
    va_list values;
    va_start(values, format);
    int result = vsnprintf(text, size, format, values);
    va_end(values);
    return result;
}
