/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Random numbers and empty tensors for the tests of networks. */
#ifndef ADCGS_TESTS_NET_NUMBERS_H
#define ADCGS_TESTS_NET_NUMBERS_H

#include "net/net.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

static inline uint32_t random32(uint64_t *state)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(*state >> 33) ^ (uint32_t)(*state >> 11);
}

/* Uniform in [-limit, limit]. */
static inline int32_t draw(uint64_t *state, int32_t limit)
{
    return (int32_t)(random32(state) % (2 * (uint32_t)limit + 1)) - limit;
}

static inline void make_tensor(adcgs_tensor *t, uint32_t rows, uint32_t cols)
{
    *t = (adcgs_tensor){.rows = rows, .cols = cols};
    t->m = adcgs_alloc(NULL, (size_t)rows * cols, sizeof *t->m, NULL);
    assert_non_null(t->m);
}

#endif
