/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A random stream and its bytes, for tests. Included after cmocka's needs. */
#ifndef ADCGS_TESTS_STREAM_FIXTURE_H
#define ADCGS_TESTS_STREAM_FIXTURE_H

#include "random_model.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

typedef struct fixture {
    adcgs_stream stream;
    adcgs_buffer bytes;
} fixture;

/** An empty fixture; teardown() frees it. */
static inline fixture *fixture_new(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    adcgs_buffer_init(&f->bytes);
    adcgs_stream_init(&f->stream);
    *state = f;
    return f;
}

/** Keys and predicted segments in turns of three, layers of several slices, by adcgs_random_turns(), and their bytes. */
static inline int fixture_turns(fixture *f, const adcgs_params *params, uint32_t segments, uint32_t n, int depth, uint32_t added,
                                uint64_t *seed)
{
    f->stream.params = *params;
    f->stream.slice_log2 = ADCGS_SLICE_LOG2_MIN;
    if (adcgs_random_turns(&f->stream, segments, n, depth, added, seed, NULL) != ADCGS_OK)
        return -1;
    return adcgs_stream_write(&f->stream, &f->bytes, NULL) == ADCGS_OK ? 0 : -1;
}

static int teardown(void **state)
{
    fixture *f = *state;
    adcgs_stream_clear(&f->stream, NULL);
    adcgs_buffer_clear(&f->bytes);
    free(f);
    return 0;
}

#endif
