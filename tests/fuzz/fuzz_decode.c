/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The public decoder on whole streams. The last bytes choose limits, threads, CPU level, layers and the kind of input. A quarter
 * of the streams that decode are decoded again in another way, with the same result. Checksums are corrected first, except if the
 * choice excludes it.
 */
#include "fuzz.h"
#include "stream_edit.h"

#include "base/digest.h"

#include <adcgs/adcgs.h>

#define WIDTH 20
#define HEIGHT 12
#define MEMORY_MOST ((uint64_t)256 << 20)
#define HEAVY 1e9 /* products of the networks for an image; above this a model is rendered only at one time */

const char *const adcgs_fuzz_seeds[] = {"conformance/vectors", "tests/fuzz/regressions/decode", NULL};

/** A source that returns at most step bytes at a time. */
typedef struct dripping {
    const uint8_t *next;
    size_t left, step;
} dripping;

static int64_t drip(void *user, void *buffer, size_t bytes)
{
    dripping *d = user;
    const size_t n = ADCGS_MIN(ADCGS_MIN(bytes, d->left), d->step);
    if (n > 0)
        memcpy(buffer, d->next, n);
    d->next += n;
    d->left -= n;
    return (int64_t)n;
}

static adcgs_camera any_camera(const adcgs_decoder *d, int stored)
{
    adcgs_camera camera =
        {.fx = 20, .fy = 20, .cx = 10, .cy = 6, .near_plane = 0.01, .cam_to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -3}};
    if (stored)
        (void)adcgs_get_camera(d, 0, &camera, NULL);
    camera.width = WIDTH;
    camera.height = HEIGHT;
    return camera;
}

/** A time that may be in a crossfade. */
static double middle_of(const adcgs_info *info)
{
    return 0.5 * info->time_start + 0.5 * info->time_end;
}

/** Makes all queries of a decoder; returns a checksum of the results. */
static uint32_t ask(adcgs_decoder *d, int stored_camera)
{
    adcgs_info info;
    adcgs_primitives primitives;
    uint8_t digest[16], bytes[WIDTH * HEIGHT * 3], rgba[WIDTH * HEIGHT * 4];
    float rgb[WIDTH * HEIGHT * 3];
    uint32_t crc = 0;
    FUZZ_REQUIRE(adcgs_get_info(d, &info, sizeof info, NULL) == ADCGS_OK);
    FUZZ_REQUIRE(info.segments >= 1 && info.layers >= 1 && info.frame_rate > 0 && info.scene_scale > 0);
    for (int i = 0; i < info.metadata; i++)
        FUZZ_REQUIRE(adcgs_get_metadata(d, adcgs_get_metadata_key(d, i)) != NULL);
    for (int i = 0; i < info.segments; i++) {
        FUZZ_REQUIRE(adcgs_get_model_digest(d, i, digest, NULL) == ADCGS_OK);
        crc = adcgs_crc32c(crc, digest, sizeof digest);
    }
    const adcgs_camera camera = any_camera(d, stored_camera);
    const int moments = (double)info.weights * info.gaussians > HEAVY ? 1 : 3;
    for (int i = 0; i < moments; i++) {
        const double time = i == 2 ? middle_of(&info) : i ? info.time_end : info.time_start;
        FUZZ_REQUIRE(adcgs_set_tiers(d, i % 2, NULL) == ADCGS_OK);
        adcgs_frame frame = {WIDTH, HEIGHT, rgb};
        if (adcgs_get_primitives(d, time, &primitives, NULL) != ADCGS_OK ||
            adcgs_render(d, &camera, time, &frame, NULL) != ADCGS_OK)
            continue;
        for (size_t p = 0; p < ADCGS_COUNTOF(rgb); p++)
            FUZZ_REQUIRE(rgb[p] - rgb[p] == 0); /* finite */
        adcgs_frame_to_u8(&frame, bytes);
        FUZZ_REQUIRE(adcgs_render_rgba8(d, &camera, time, ADCGS_ALPHA_STRAIGHT, rgba, 4 * WIDTH, NULL) != ADCGS_ERR_USAGE);
        crc = adcgs_crc32c(adcgs_crc32c(crc, rgb, sizeof rgb), bytes, sizeof bytes);
    }
    return crc;
}

static adcgs_status decode(const uint8_t *data, size_t size, const adcgs_config *config, size_t step, int stored, uint32_t *crc)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_decoder *d = NULL;
    dripping source = {data, size, step};
    const adcgs_status status = adcgs_open_stream(&d, drip, &source, config, &error);
    FUZZ_REQUIRE((status == ADCGS_OK) == (d != NULL));
    FUZZ_REQUIRE(status == ADCGS_OK || (error.status == status && error.text[0] && !strchr(error.text, '\n')));
    FUZZ_REQUIRE(status != ADCGS_ERR_INTERNAL && status != ADCGS_ERR_IO && status != ADCGS_ERR_USAGE);
    if (d)
        *crc = ask(d, stored);
    adcgs_close(&d);
    return status;
}

typedef struct anywhere {
    const uint8_t *data;
    size_t size;
} anywhere;

static int64_t read_anywhere(void *user, uint64_t offset, void *buffer, size_t bytes)
{
    const anywhere *a = user;
    FUZZ_REQUIRE(bytes > 0 && offset < a->size && bytes <= a->size - offset);
    memcpy(buffer, a->data + offset, bytes);
    return (int64_t)bytes;
}

/** Read on demand or as a whole, a stream gives the same frames, also in a crossfade. */
static void compare_frames(adcgs_decoder *a, adcgs_decoder *b, double time)
{
    float rgb[2][WIDTH * HEIGHT * 3];
    const adcgs_camera camera = any_camera(a, 0);
    adcgs_frame one = {WIDTH, HEIGHT, rgb[0]}, other = {WIDTH, HEIGHT, rgb[1]};
    const adcgs_status status = adcgs_render(a, &camera, time, &one, NULL);
    FUZZ_REQUIRE(adcgs_render(b, &camera, time, &other, NULL) == status || status != ADCGS_OK);
    FUZZ_REQUIRE(status != ADCGS_OK || memcmp(rgb[0], rgb[1], sizeof rgb[0]) == 0);
}

/**
 * Reads on demand, from the last segment to the first: gives the models of the whole stream if that decodes, else any valid ones.
 */
static void seek(const uint8_t *data, size_t size, const adcgs_config *config)
{
    anywhere source = {data, size};
    adcgs_decoder *d = NULL, *whole = NULL;
    adcgs_info info, all = {.truncated = 1};
    if (adcgs_open_at(&d, read_anywhere, &source, size, config, NULL) != ADCGS_OK)
        return;
    FUZZ_REQUIRE(adcgs_get_info(d, &info, sizeof info, NULL) == ADCGS_OK && info.segments >= 1);
    if (adcgs_open_memory(&whole, data, size, config, NULL) == ADCGS_OK)
        FUZZ_REQUIRE(adcgs_get_info(whole, &all, sizeof all, NULL) == ADCGS_OK);
    FUZZ_REQUIRE(all.truncated || all.segments == info.segments);
    for (int i = info.segments - 1; i >= 0; i--) {
        uint8_t digest[16], expected[16];
        const adcgs_status status = adcgs_get_model_digest(d, i, digest, NULL);
        if (all.truncated)
            continue;
        FUZZ_REQUIRE(status == ADCGS_OK && adcgs_get_model_digest(whole, i, expected, NULL) == ADCGS_OK);
        FUZZ_REQUIRE(memcmp(digest, expected, sizeof digest) == 0);
    }
    if (!all.truncated)
        compare_frames(d, whole, middle_of(&info));
    adcgs_close(&whole);
    adcgs_close(&d);
}

/** Number of the first available segment: above 0 after a start in the middle. */
static int first_of(const adcgs_decoder *d)
{
    adcgs_info info;
    return d && adcgs_get_info(d, &info, sizeof info, NULL) == ADCGS_OK ? info.first_segment : 0;
}

/**
 * Pushes the stream in pieces, with queries in between. The final models or failure are those of reading in order, except
 * discarded segments.
 */
static void push(const uint8_t *data, size_t size, const adcgs_config *config, size_t step, int forgets)
{
    adcgs_decoder *d = NULL, *whole = NULL;
    adcgs_status status = ADCGS_OK;
    uint8_t digest[16], expected[16];
    FUZZ_REQUIRE(adcgs_open_push(&d, config, NULL) == ADCGS_OK);
    for (size_t at = 0, used = 1; at < size && used && status == ADCGS_OK; at += used) {
        adcgs_arrival arrived;
        status = adcgs_push(d, data + at, ADCGS_MIN(step, size - at), &used, &arrived, NULL);
        if (arrived == ADCGS_ARRIVED_SEGMENT && forgets)
            FUZZ_REQUIRE(adcgs_push_discard_before(d, 1e9, NULL) == ADCGS_OK &&
                         adcgs_get_splat_digest(d, 1e9, digest, NULL) == ADCGS_OK);
        else if (arrived == ADCGS_ARRIVED_SEGMENT)
            FUZZ_REQUIRE(adcgs_get_model_digest(d, first_of(d), digest, NULL) == ADCGS_OK);
        if (arrived == ADCGS_ARRIVED_END)
            break;
    }
    if (status == ADCGS_OK)
        status = adcgs_push_end(d, NULL);
    FUZZ_REQUIRE(adcgs_open_memory(&whole, data, size, config, NULL) == status);
    for (int i = first_of(whole); whole && adcgs_get_model_digest(whole, i, expected, NULL) == ADCGS_OK; i++) {
        const adcgs_status got = adcgs_get_model_digest(d, i, digest, NULL);
        FUZZ_REQUIRE(got == ADCGS_OK || (forgets && got == ADCGS_ERR_USAGE));
        FUZZ_REQUIRE(got != ADCGS_OK || memcmp(digest, expected, sizeof digest) == 0);
    }
    adcgs_close(&whole);
    adcgs_close(&d);
}

/** Starts in the middle, as in tune-in. */
static void join(const uint8_t *data, size_t size, const adcgs_config *config, size_t step, uint8_t where)
{
    adcgs_config how = *config;
    const size_t at = size * where / 256;
    how.tune_in = 1;
    push(data + at, size - at, &how, step, 0);
}

/**
 * Decodes as a damaged stream. A valid stream has no faults, and its own models; the recovered parts of others can be rendered.
 */
static void conceal(const uint8_t *data, size_t size, const adcgs_config *config)
{
    adcgs_config how = *config;
    adcgs_decoder *d = NULL, *whole = NULL;
    adcgs_info info, all = {.truncated = 1};
    how.conceal = 1;
    if (adcgs_open_memory(&whole, data, size, config, NULL) == ADCGS_OK)
        FUZZ_REQUIRE(adcgs_get_info(whole, &all, sizeof all, NULL) == ADCGS_OK);
    const adcgs_status status = adcgs_open_memory(&d, data, size, &how, NULL);
    FUZZ_REQUIRE(all.truncated || status == ADCGS_OK);
    if (status == ADCGS_OK) {
        FUZZ_REQUIRE(adcgs_get_info(d, &info, sizeof info, NULL) == ADCGS_OK && info.segments >= 1);
        FUZZ_REQUIRE(all.truncated || (info.faults == 0 && info.segments == all.segments));
        (void)ask(d, 0);
    }
    for (int i = 0; i < all.segments && !all.truncated; i++) {
        uint8_t digest[16], expected[16];
        FUZZ_REQUIRE(adcgs_get_model_digest(d, i, digest, NULL) == ADCGS_OK);
        FUZZ_REQUIRE(adcgs_get_model_digest(whole, i, expected, NULL) == ADCGS_OK);
        FUZZ_REQUIRE(memcmp(digest, expected, sizeof digest) == 0);
    }
    adcgs_close(&whole);
    adcgs_close(&d);
}

/**
 * Limits the level to 1, or to 2 if the choice says so. The largest networks of level 1 take seconds each time, and about twenty
 * seconds with sanitizers and without SIMD; those of level 3 may take minutes.
 */
static void tame_level(uint8_t *stream, size_t size, int level)
{
    const size_t at = ADCGS_SIGNATURE_BYTES + ADCGS_CHUNK_HEADER_BYTES + 5;
    if (size > at && stream[at] > level)
        stream[at] = (uint8_t)level;
}

static void decode_both(uint8_t *stream, size_t size, const uint8_t choice[8])
{
    static const size_t steps[] = {SIZE_MAX, 1, 7, 4096};
    uint32_t crc = 0, again = 0;
    adcgs_config config;
    adcgs_config_init(&config, sizeof config);
    config.threads = 1 + (choice[1] % 8 == 0);
    config.cpu = (adcgs_cpu_level)(choice[2] % (adcgs_cpu_best() + 1));
    config.layers = choice[3] % 8 < 6 ? 0 : choice[3] % 6;
    config.strict_end = choice[4] & 1;
    config.memory_limit = choice[4] & 2 ? (uint64_t)choice[5] << 12 : MEMORY_MOST;
    const adcgs_status status = decode(stream, size, &config, steps[choice[6] % 4], choice[4] & 4, &crc);
    if (config.memory_limit == MEMORY_MOST) {
        seek(stream, size, &config);
        conceal(stream, size, &config);
        push(stream, size, &config, steps[choice[5] % 4], choice[4] & 8);
        join(stream, size, &config, steps[choice[5] % 4], choice[6]);
    }
    if (choice[7] % 4)
        return;
    config.threads = 3 - config.threads;
    config.cpu = ADCGS_CPU_SCALAR;
    const adcgs_status other = decode(stream, size, &config, steps[choice[7] / 4 % 4], choice[4] & 4, &again);
    FUZZ_REQUIRE((status == other && crc == again) || config.memory_limit < MEMORY_MOST);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t choice[8] = {0};
    const size_t n = ADCGS_MIN(size, sizeof choice);
    if (n > 0)
        memcpy(choice, data + size - n, n);
    uint8_t *stream = malloc(size + (size == 0));
    FUZZ_REQUIRE(stream != NULL);
    if (size > 0)
        memcpy(stream, data, size);
    tame_level(stream, size, 1 + (choice[0] % 4 == 0));
    if (choice[0] % 16)
        adcgs_repair_stream(stream, size, choice[0] & 32);
    decode_both(stream, size, choice);
    free(stream);
    return 0;
}
