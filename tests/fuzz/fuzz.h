/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The interface of fuzz targets. Under libFuzzer (`make fuzz`) the engine calls the target; otherwise fuzz_main.c calls it, with
 * seeds, regressions and mutations that are the same every time.
 */
#ifndef ADCGS_TESTS_FUZZ_H
#define ADCGS_TESTS_FUZZ_H

#include "base/base.h"

#include <stdio.h>
#include <stdlib.h>

/** Tests one input; returns 0. A fault is a sanitizer's report, a signal, or FUZZ_REQUIRE. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
/**
 * Changes size bytes of data in a buffer of max bytes; returns the new size. Targets that read streams have a mutator for chunks.
 */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max, unsigned int seed);
/** The engine's own mutations. */
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max);

/** Files and folders that fuzz_main.c replays by default, relative to the source tree; ends with NULL. */
extern const char *const adcgs_fuzz_seeds[];

/* The engine is not instrumented: MemorySanitizer does not see its writes, arguments and results. */
#if defined(__has_feature)
#if __has_feature(memory_sanitizer)
#include <sanitizer/msan_interface.h>
#define FUZZ_WRITTEN(data, size) __msan_unpoison(data, size)
#endif
#endif
#ifndef FUZZ_WRITTEN
#define FUZZ_WRITTEN(data, size) ((void)0)
#endif

/** A condition that holds for every input. */
#define FUZZ_REQUIRE(condition)                                                           \
    do {                                                                                  \
        if (!(condition)) {                                                               \
            fprintf(stderr, "%s:%d: fault: false: %s\n", __FILE__, __LINE__, #condition); \
            abort();                                                                      \
        }                                                                                 \
    } while (0)

/** A copy from malloc(), with a zero byte after it, as in loaded files. */
static inline uint8_t *fuzz_file(const uint8_t *data, size_t size)
{
    uint8_t *copy = malloc(size + 1);
    FUZZ_REQUIRE(copy != NULL);
    if (size > 0)
        memcpy(copy, data, size);
    copy[size] = 0;
    return copy;
}

#endif
