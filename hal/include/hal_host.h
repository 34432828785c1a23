/* What a component in C asks of the process that has loaded it: a table of functions, filled in by hal/_native.pyx.

   The loader stores its address in the component's `hal_host_table` before anything of the component runs. Components
   do not use it directly: hal.h and rtapi.h have the functions of LinuxCNC's names, made of these. */
#ifndef PYEMC_HAL_HOST_H
#define PYEMC_HAL_HOST_H

typedef void (*hal_host_code)(void *arg, long period_ns);

/* Numbers below 0 are errno values. Not for realtime functions, but for `say`. */
typedef struct hal_host {
    int (*init)(const char *name);
    int (*ready)(int comp_id);
    int (*leave)(int comp_id);
    void *(*memory)(long size);
    int (*pin)(int type, int dir, void **where, int comp_id, const char *name);
    int (*param)(int type, int dir, void *where, int comp_id, const char *name);
    int (*function)(const char *name, hal_host_code code, void *arg, int uses_fp, int reentrant, int comp_id);
    void (*say)(const char *text); /* also from a realtime function */
    int msg_level;
} hal_host;

/* A parameter that `loadrt` may set; the descriptors of a component lie side by side in the section hal_parameters. */
typedef struct hal_parameter {
    const char *name;
    char type; /* i: int, l: long, s: string, u: unsigned int */
    void *at;
    long most; /* items of an array; 1: a single value */
    const char *doc;
} hal_parameter;

#endif
