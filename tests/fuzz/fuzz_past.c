/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Untrusted stream of an earlier live run, to be resumed. Each segment that the reader gives can be written and read again. After
 * the last segment it gives no more, however often it is called.
 */
#define _GNU_SOURCE

#include "outside_file.h"

#include "session/live_stream.h"
#include "session/resume_reader.h"

const char *const adcgs_fuzz_seeds[] = {"conformance/vectors", "tests/fuzz/regressions/past", NULL};

enum { ANCHORS = 4096 };

static void check(adcgs_status status, const adcgs_error *error)
{
    FUZZ_REQUIRE(status == ADCGS_OK || (error->status == status && error->text[0] && !strchr(error->text, '\n')));
}

/** Resumes as adcgs-enc does: the last segment is held back. */
static void go_on(adcgs_resume_reader *past)
{
    adcgs_encode_live live = {.max_anchors = 0};
    adcgs_model model, last = {.n = 0};
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_status status = ADCGS_OK;
    uint32_t n = 0;
    while (status == ADCGS_OK) {
        adcgs_buffer bytes;
        adcgs_buffer_init(&bytes);
        status = adcgs_resume_reader_next(past, &model, &error);
        check(status, &error);
        if (status != ADCGS_OK || !model.n)
            break;
        status = n++ ? adcgs_encode_live_add(&live, &last, &bytes, &error)
                     : adcgs_encode_live_continue(&live, &past->stream, ANCHORS, ADCGS_CPU_SCALAR, NULL, &error);
        check(status, &error);
        FUZZ_REQUIRE(status != ADCGS_ERR_INTERNAL); /* else it differs from the segment that was read */
        adcgs_model_clear(&last, NULL);
        adcgs_buffer_clear(&bytes);
        last = model;
    }
    if (status == ADCGS_OK)
        FUZZ_REQUIRE(adcgs_resume_reader_next(past, &model, &error) == ADCGS_OK && !model.n);
    adcgs_model_clear(&last, NULL);
    adcgs_encode_live_clear(&live);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[] = "/tmp/adcgs-fuzz-XXXXXX";
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_resume_reader past;
    const int file = mkstemp(path);
    FUZZ_REQUIRE(file >= 0 && write(file, data, size) == (ssize_t)size && close(file) == 0);
    FUZZ_REQUIRE(adcgs_resume_reader_open(&past, path, ADCGS_CPU_SCALAR, NULL, &error) == ADCGS_OK);
    go_on(&past);
    adcgs_resume_reader_close(&past);
    unlink(path);
    return 0;
}
