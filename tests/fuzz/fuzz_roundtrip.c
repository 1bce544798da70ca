/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Valid streams: the bytes choose parameters and sizes, and seed the rest. A written stream is read back unchanged with any
 * number of threads, and writing it again gives the same bytes.
 */
#include "fuzz.h"
#include "random_model.h"

#include "base/digest.h"
#include "base/thread_pool.h"
#include "stream/input.h"

const char *const adcgs_fuzz_seeds[] = {"conformance/vectors", "tests/fuzz/regressions/roundtrip", NULL};

static uint8_t in_range(uint8_t byte, int lo, int hi)
{
    return (uint8_t)(lo + byte % (hi - lo + 1));
}

static adcgs_params params_of(const uint8_t b[10])
{
    adcgs_params p;
    memset(&p, 0, sizeof p);
    p.k = in_range(b[0], 1, ADCGS_K_MAX);
    p.n_fv = in_range(b[1], 1, 40);
    p.chunks = in_range(b[2], 1, ADCGS_CHUNKS_MAX);
    p.n_fg = (uint8_t)(p.chunks * in_range(b[3], 0, ADCGS_NG_MAX / ADCGS_CHUNKS_MAX));
    p.n_eta = in_range(b[4], 0, ADCGS_ETA_MAX);
    p.octaves = in_range(b[5], 0, ADCGS_OCTAVES_MAX);
    p.fine_uses_fv = b[6] & 1;
    p.coarse_rotation = b[6] >> 1 & 1;
    p.adaptive_steps = b[6] >> 2 & 1;
    p.time_rows = b[7] & 1 ? in_range(b[7] >> 1, 1, 20) : 0;
    p.time_width = p.time_rows ? in_range(b[8], 1, 20) : 0;
    p.spans = p.time_rows ? b[6] >> 3 & 1 : 0;
    p.bodies = p.time_rows ? b[6] >> 4 : 0;
    p.smooth_time = p.time_rows ? b[8] >> 7 : 0;
    return p;
}

static void read_back(const adcgs_buffer *bytes, const adcgs_stream *stream, adcgs_pool *pool)
{
    const adcgs_read_options options = {.cpu = ADCGS_CPU_SCALAR, .pool = pool, .strict_end = 1};
    adcgs_stream back;
    adcgs_buffer again;
    adcgs_span s = {.next = bytes->data, .left = bytes->size};
    FUZZ_REQUIRE(adcgs_stream_read(&back, adcgs_span_read, &s, &options, NULL, NULL, NULL) == ADCGS_OK);
    FUZZ_REQUIRE(back.n_segments == stream->n_segments && back.n_cameras == stream->n_cameras && back.n_meta == stream->n_meta);
    for (uint32_t i = 0; i < back.n_segments; i++)
        FUZZ_REQUIRE(adcgs_model_equal(&back.segments[i], &stream->segments[i], NULL));
    adcgs_buffer_init(&again);
    FUZZ_REQUIRE(adcgs_stream_write(&back, &again, NULL) == ADCGS_OK);
    FUZZ_REQUIRE(again.size == bytes->size && memcmp(again.data, bytes->data, again.size) == 0);
    adcgs_buffer_clear(&again);
    adcgs_stream_clear(&back, NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t choice[16] = {0};
    uint64_t seed = (uint64_t)adcgs_crc32c(0, data, size) << 32 | size;
    adcgs_stream stream;
    adcgs_buffer bytes;
    adcgs_pool *pool = NULL;
    const size_t n = ADCGS_MIN(size, sizeof choice); /* the end, since it differs between the mutations of every stream */
    if (n > 0)
        memcpy(choice, data + size - n, n);
    const adcgs_params params = params_of(choice);
    const uint32_t segments = 1 + choice[10] % 3U, anchors = 1 + choice[11] % 150U;
    adcgs_buffer_init(&bytes);
    FUZZ_REQUIRE(adcgs_random_stream(&stream, &params, segments, anchors, 3 + choice[12] % 8, &seed, NULL) == ADCGS_OK);
    FUZZ_REQUIRE(adcgs_stream_write(&stream, &bytes, NULL) == ADCGS_OK);
    if (choice[13] % 8 == 0)
        FUZZ_REQUIRE(adcgs_pool_create(&pool, 2, NULL) == ADCGS_OK);
    read_back(&bytes, &stream, pool);
    adcgs_pool_free(&pool);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
    return 0;
}
