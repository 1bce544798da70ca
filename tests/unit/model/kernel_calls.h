/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Calls of kernels in tests: guarded arrays of ordinary, wide or extreme numbers. */
#ifndef ADCGS_TESTS_KERNEL_CALLS_H
#define ADCGS_TESTS_KERNEL_CALLS_H

#include "config.h"

#include "unit/pixels_scene.h"

#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

enum { ROUNDS = 12, GUARD = 64, GUARD_BYTE = 0x5a, BUFFERS = 32, L = 64 };
typedef enum kind { ORDINARY, WIDE, EXTREME, KINDS } kind;

/** The arrays of a call: inputs, the same for every level, and outputs, which are compared. All have guards on both sides. */
typedef struct call {
    adcgs_cpu_level level;
    kind kind;
    uint64_t state;
    int n, round;
    struct {
        float *block;
        size_t size;
        int output;
    } buffer[BUFFERS];
} call;

static inline float extreme(uint64_t *state)
{
    static const float numbers[] = {0.0f,   0x1p-149f, 0x1p-130f, FLT_MIN, 0x1p-24f, 0.5f, 1.0f,
                                    127.0f, 0x1p24f,   1e30f,     FLT_MAX, INFINITY, NAN};
    const float x = numbers[(size_t)(scene_uniform(state) * ADCGS_COUNTOF(numbers))];
    return scene_uniform(state) < 0.5 ? -x : x;
}

static inline float number(kind k, uint64_t *state)
{
    const double x = scene_normal(state);
    return k == ORDINARY ? (float)x : k == WIDE ? (float)(x * exp(8 * scene_normal(state))) : extreme(state);
}

static inline float *take_buffer(call *c, size_t n, int output)
{
    const size_t size = (n + 15) / 16 * 16, whole = size + 2 * GUARD;
    float *const block = adcgs_alloc(NULL, whole, sizeof *block, NULL);
    assert_non_null(block);
    assert_in_range(c->n, 0, BUFFERS - 1);
    memset(block, GUARD_BYTE, whole * sizeof *block);
    c->buffer[c->n].block = block;
    c->buffer[c->n].size = n;
    c->buffer[c->n++].output = output;
    return block + GUARD;
}

/** n numbers of a kind. */
static inline float *given_of(call *c, size_t n, kind k)
{
    float *const p = take_buffer(c, n, 0);
    for (size_t i = 0; i < n; i++)
        p[i] = number(k, &c->state);
    return p;
}

static inline float *given(call *c, size_t n)
{
    return given_of(c, n, c->kind);
}

/** One number, n times. */
static inline float *constant(call *c, size_t n, float x)
{
    float *const p = take_buffer(c, n, 0);
    for (size_t i = 0; i < n; i++)
        p[i] = x;
    return p;
}

/** An output that the kernel writes completely, or adds to if it has a start. */
static inline float *output(call *c, size_t n)
{
    return take_buffer(c, n, 1);
}

static inline float *added(call *c, size_t n)
{
    float *const p = take_buffer(c, n, 1);
    for (size_t i = 0; i < n; i++)
        p[i] = number(c->kind, &c->state);
    return p;
}

static inline int size_of(call *c, int most)
{
    return 1 + (int)(scene_uniform(&c->state) * most);
}

static inline int32_t *flags(call *c)
{
    int32_t *const p = (void *)take_buffer(c, L, 0);
    for (int i = 0; i < L; i++)
        p[i] = scene_uniform(&c->state) < 0.7;
    return p;
}

#endif
