/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * What every fuzz target offers. Under libFuzzer (`make fuzz`) the engine
 * calls the target; otherwise fuzz_main.c does, with seeds, regressions and
 * mutations that are the same every time.
 */
#ifndef ADCGS_TESTS_FUZZ_H
#define ADCGS_TESTS_FUZZ_H

#include "base/base.h"

#include <stdio.h>
#include <stdlib.h>

/** One input; returns 0. A fault is a sanitizer's report, a signal, or FUZZ_REQUIRE. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
/** Change data of size bytes in a buffer of max; returns the new size. Targets that read streams have one that knows chunks. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max, unsigned int seed);
/** The engine's own mutations. */
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max);

/** What fuzz_main.c replays when it is given nothing: files and folders of them, relative to the source tree; NULL at the end. */
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

/** What must hold whatever the input is. */
#define FUZZ_REQUIRE(condition)                                                                   \
    do {                                                                                          \
        if (!(condition)) {                                                                       \
            fprintf(stderr, "%s:%d: fault: not true: %s\n", __FILE__, __LINE__, #condition);      \
            abort();                                                                              \
        }                                                                                         \
    } while (0)

/** A copy from malloc(), with the zero byte behind it that files are loaded with. */
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
