/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Tries one conformance vector on the library, at one CPU level, thread count and way of input. */
#include "apps/conform/conform.h"

#include "base/digest.h"
#include "base/thread_pool.h"
#include "stream/chunk.h"
#include "stream/input.h"
#include "stream/stream.h"

#include <adcgs/decoder.h>
#include <adcgs/frame.h>

#include <stdarg.h>
#include <stdlib.h>

/* Memory bound of a decoder: MEMORY_FACTOR models of the level and MEMORY_CONSTANT bytes. A decoder holds the models and,
   while reading, a chunk and the values decoded from it; more memory is a defect. Chosen by hand, not measured. */
#define MEMORY_FACTOR 2
#define MEMORY_CONSTANT (UINT64_C(1) << 20)

typedef struct attempt {
    const adcgs_vector *vector;
    const uint8_t *data;
    size_t bytes;
    const adcgs_trial *trial;
    char *what;
} attempt;

/* Describes the difference; always returns 0. */
static int wrong(const attempt *a, const char *format, ...) ADCGS_PRINTF(2, 3);

static int wrong(const attempt *a, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(a->what, ADCGS_WHAT, format, list);
    va_end(list);
    return 0;
}

const char *adcgs_outcome_name(adcgs_outcome outcome)
{
    static const char *const names[] = {"ok", "WRONG", "CRASHED", "TIMEOUT"};
    return names[outcome];
}

static adcgs_span input_of(const attempt *a)
{
    return (adcgs_span){.next = a->data, .left = a->bytes, .step = a->trial->step};
}

static int status_fits(const attempt *a, adcgs_status status, adcgs_status expected, const adcgs_error *error)
{
    if (status == expected)
        return 1;
    return wrong(a, "status \"%s\", expected \"%s\"%s%.200s", adcgs_status_name(status), adcgs_status_name(expected),
                 status == ADCGS_OK ? "" : ": ", status == ADCGS_OK ? "" : error->text);
}

/* ---- P: the trace, and the memory that parsing takes ---- */

static int trace_fits(const attempt *a, adcgs_trace_sum *trace, const adcgs_memory *memory)
{
    const adcgs_vector *const v = a->vector;
    const uint64_t most = MEMORY_FACTOR * adcgs_level_get(v->level)->model_bytes + MEMORY_CONSTANT;
    char hex[ADCGS_HEX];
    if (memory->peak > most)
        return wrong(a, "takes %llu bytes, more than %llu", (unsigned long long)memory->peak, (unsigned long long)most);
    if (v->status != ADCGS_OK)
        return 1;
    adcgs_trace_sum_final(trace, hex);
    if (trace->lines != v->elements || strcmp(hex, v->trace))
        return wrong(a, "P: trace of %u lines is %s, expected %u, %s", trace->lines, hex, v->elements, v->trace);
    return 1;
}

static int parse_fits(const attempt *a, adcgs_pool *pool)
{
    adcgs_memory memory = {.limit = 0};
    const adcgs_read_options options = {.cpu = a->trial->cpu, .pool = pool, .memory = &memory};
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_stream stream;
    adcgs_span input = input_of(a);
    adcgs_trace_sum trace;
    adcgs_trace_sum_init(&trace);
    const adcgs_status status =
        adcgs_stream_read(&stream, adcgs_span_read, &input, &options, adcgs_trace_sum_add, &trace, &error);
    int good = status_fits(a, status, a->vector->status, &error) && trace_fits(a, &trace, &memory);
    if (status == ADCGS_OK && stream.truncated != a->vector->truncated)
        good = wrong(a, "truncated is %d", stream.truncated);
    if (status == ADCGS_OK)
        adcgs_stream_clear(&stream, &memory);
    if (memory.used > 0)
        good = wrong(a, "%llu bytes of memory are left behind", (unsigned long long)memory.used);
    return good;
}

/* ---- M, S, R ---- */

static int models_fit(const attempt *a, adcgs_decoder *decoder, const char models[][ADCGS_HEX], int n)
{
    adcgs_info info;
    if (adcgs_get_info(decoder, &info, sizeof info, NULL) != ADCGS_OK || info.segments != n)
        return wrong(a, "M: %d segments, expected %d", info.segments, n);
    for (int i = 0; i < n; i++) {
        uint8_t digest[16];
        char hex[ADCGS_HEX] = "";
        if (adcgs_get_model_digest(decoder, i, digest, NULL) == ADCGS_OK)
            adcgs_md5_hex(digest, hex);
        if (strcmp(hex, models[i]))
            return wrong(a, "M: model %d is %s, expected %s", i, hex, models[i]);
    }
    return 1;
}

static int splats_fit(const attempt *a, adcgs_decoder *decoder, int i, double time, const char md5[ADCGS_HEX])
{
    uint8_t digest[16];
    char hex[ADCGS_HEX] = "";
    if (adcgs_get_splat_digest(decoder, time, digest, NULL) == ADCGS_OK)
        adcgs_md5_hex(digest, hex);
    return strcmp(hex, md5) ? wrong(a, "S: splats %d are %s, expected %s", i, hex, md5) : 1;
}

static int frame_fits(const attempt *a, int i, adcgs_decoder *decoder)
{
    const adcgs_vector *const v = a->vector;
    const adcgs_camera *const camera = &v->cameras[v->frames[i].camera];
    adcgs_frame frame = {.width = camera->width, .height = camera->height};
    adcgs_error error = {ADCGS_OK, ""};
    char hex[ADCGS_HEX] = "";
    uint8_t digest[16];
    adcgs_status status = ADCGS_ERR_MEMORY;
    if (camera->width < 1 || camera->height < 1 || camera->width > 16384 || camera->height > 16384)
        return wrong(a, "camera of %dx%d", (int)camera->width, (int)camera->height);
    frame.rgb = malloc(3 * sizeof *frame.rgb * (size_t)camera->width * (size_t)camera->height);
    if (frame.rgb)
        status = adcgs_render(decoder, camera, v->frames[i].time, &frame, &error);
    if (status == ADCGS_OK) {
        adcgs_frame_digest(&frame, digest);
        adcgs_md5_hex(digest, hex);
    } else if (status == ADCGS_ERR_USAGE) {
        snprintf(hex, sizeof hex, ADCGS_REFUSED);
    }
    free(frame.rgb);
    if (strcmp(hex, v->frames[i].md5))
        return wrong(a, "R: frame %d is %s, expected %s %.160s", i, hex, v->frames[i].md5, error.text);
    return 1;
}

static int results_fit(const attempt *a, adcgs_decoder *decoder)
{
    const adcgs_vector *const v = a->vector;
    int good = models_fit(a, decoder, v->models, v->n_models);
    for (int i = 0; good && i < v->n_splats; i++)
        good = splats_fit(a, decoder, i, v->splats[i].time, v->splats[i].md5);
    for (int i = 0; good && i < v->n_frames; i++)
        good = frame_fits(a, i, decoder);
    return good;
}

static int fewer_fit(const attempt *a, adcgs_decoder *decoder, const adcgs_fewer *fewer)
{
    int good = models_fit(a, decoder, fewer->models, fewer->n_models);
    for (int i = 0; good && i < fewer->n_splats; i++)
        good = splats_fit(a, decoder, i, fewer->splats[i].time, fewer->splats[i].md5);
    return good;
}

/* Decodes through the public interface. With complete, a truncated stream has to be refused. fewer: NULL for all layers. */
static int decode_fits(const attempt *a, int complete, const adcgs_fewer *fewer)
{
    adcgs_config config;
    adcgs_decoder *decoder = NULL;
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_span input = input_of(a);
    adcgs_config_init(&config, sizeof config);
    config.cpu = a->trial->cpu;
    config.threads = a->trial->threads;
    config.strict_end = complete;
    config.layers = fewer ? fewer->layers : 0;
    const adcgs_status status = adcgs_open_stream(&decoder, adcgs_span_read, &input, &config, &error);
    const int refused = complete && a->vector->truncated;
    int good = status_fits(a, status, refused ? ADCGS_ERR_TRUNCATED : a->vector->status, &error);
    if (good && status == ADCGS_OK)
        good = fewer ? fewer_fit(a, decoder, fewer) : results_fit(a, decoder);
    adcgs_close(&decoder);
    if (!good && fewer) {
        char why[ADCGS_WHAT];
        snprintf(why, sizeof why, "%s", a->what);
        wrong(a, "with %d layers: %.300s", fewer->layers, why);
    }
    return good;
}

/* ---- On demand ---- */

/* Random access to the bytes. */
static int64_t read_at(void *user, uint64_t offset, void *buffer, size_t bytes)
{
    const attempt *const a = user;
    memcpy(buffer, a->data + offset, bytes);
    return (int64_t)bytes;
}

/* Decodes segment by segment; after a failure adcgs_get_info() has to stay the same. *refused: class of the last failure. */
static int segments_fit(const attempt *a, adcgs_decoder *decoder, adcgs_status *refused)
{
    adcgs_info before, after;
    adcgs_error error = {ADCGS_OK, ""};
    uint8_t digest[16];
    (void)adcgs_get_info(decoder, &before, sizeof before, NULL);
    for (int i = 0; i < before.segments; i++) {
        const adcgs_status status = adcgs_get_model_digest(decoder, i, digest, &error);
        (void)adcgs_get_info(decoder, &after, sizeof after, NULL);
        if (after.segments != before.segments)
            return wrong(a, "on demand: %d segments after segment %d, %d before", after.segments, i, before.segments);
        if (status == ADCGS_ERR_INTERNAL || status == ADCGS_ERR_IO || status == ADCGS_ERR_USAGE)
            return wrong(a, "on demand: segment %d: %.200s", i, error.text);
        *refused = status != ADCGS_OK ? status : *refused;
    }
    return 1;
}

/*
 * Segment by segment, the results are those of the whole stream, and a level's exceeded bounds are noticed, too. With any other
 * fault, only the segments without the fault may be decoded.
 */
static int demand_fits(attempt *a)
{
    const adcgs_vector *const v = a->vector;
    adcgs_config config;
    adcgs_decoder *decoder = NULL;
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_config_init(&config, sizeof config);
    config.cpu = a->trial->cpu;
    config.threads = a->trial->threads;
    adcgs_status status = adcgs_open_at(&decoder, read_at, a, a->bytes, &config, &error);
    int good = status == ADCGS_OK ? segments_fit(a, decoder, &status) : 1;
    if (good && v->status == ADCGS_OK && status == ADCGS_OK)
        good = results_fit(a, decoder);
    else if (good && (v->status == ADCGS_OK || v->status == ADCGS_ERR_LIMIT) && status != v->status)
        good = wrong(a, "on demand: status \"%s\", expected \"%s\": %.200s", adcgs_status_name(status),
                     adcgs_status_name(v->status), error.text);
    adcgs_close(&decoder);
    return good;
}

adcgs_outcome adcgs_vector_try(const adcgs_vector *vector, const uint8_t *data, size_t bytes, const adcgs_trial *trial,
                               char what[ADCGS_WHAT])
{
    attempt a = {.vector = vector, .data = data, .bytes = bytes, .trial = trial, .what = what};
    adcgs_pool *pool = NULL;
    char hex[ADCGS_HEX];
    int good = 0;
    adcgs_hex_of(data, bytes, hex);
    if (strcmp(hex, vector->md5))
        wrong(&a, "file is %s, expected %s", hex, vector->md5);
    else if (adcgs_pool_create(&pool, trial->threads, NULL) != ADCGS_OK)
        wrong(&a, "no threads");
    else
        good = parse_fits(&a, pool) && decode_fits(&a, 0, NULL) && (!vector->truncated || decode_fits(&a, 1, NULL));
    for (int i = 0; good && i < vector->n_fewer; i++)
        good = decode_fits(&a, 0, &vector->fewer[i]);
    if (good && trial->threads == 1 && trial->step == 0)
        good = demand_fits(&a);
    adcgs_pool_free(&pool);
    return good ? ADCGS_OUTCOME_OK : ADCGS_OUTCOME_WRONG;
}
