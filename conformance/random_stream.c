/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file Random valid streams. The library decodes each in every way, with equal results, and the codec's writer writes it
 * again, after which the reader must find the same models.
 */
#include "random_recipe.h"
#include "recipe_plan.h"

#include "base/cpu_detect.h"
#include "base/digest.h"
#include "base/thread_pool.h"
#include "stream/input.h"

#include <adcgs/adcgs.h>

#include <stdlib.h>

/* ---- One digest over all results of a decoder for a stream ---- */

static adcgs_status add_trace(adcgs_md5 *md5, const adcgs_buffer *file, adcgs_cpu_level cpu, int threads, int step,
                              adcgs_error *error)
{
    adcgs_span s = {.next = file->data, .left = file->size, .step = step};
    adcgs_read_options options = {.cpu = cpu};
    adcgs_trace_sum trace;
    adcgs_stream stream;
    char hex[33];
    adcgs_trace_sum_init(&trace);
    ADCGS_TRY(adcgs_pool_create(&options.pool, threads, error));
    const adcgs_status status = adcgs_stream_read(&stream, adcgs_span_read, &s, &options, adcgs_trace_sum_add, &trace, error);
    if (status == ADCGS_OK)
        adcgs_stream_clear(&stream, NULL);
    adcgs_trace_sum_final(&trace, hex);
    adcgs_md5_update(md5, hex, sizeof hex);
    adcgs_pool_free(&options.pool);
    return status;
}

static adcgs_status add_frame(adcgs_md5 *md5, adcgs_decoder *decoder, const adcgs_camera *camera, double time, adcgs_error *error)
{
    adcgs_frame frame = {.width = camera->width, .height = camera->height};
    uint8_t digest[16];
    frame.rgb = malloc(3 * sizeof *frame.rgb * (size_t)frame.width * (size_t)frame.height);
    if (!frame.rgb)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "no memory for a frame");
    const adcgs_status status = adcgs_render(decoder, camera, time, &frame, error);
    if (status == ADCGS_OK) {
        adcgs_frame_digest(&frame, digest);
        adcgs_md5_update(md5, digest, sizeof digest);
    }
    free(frame.rgb);
    return status;
}

static adcgs_status add_results(adcgs_md5 *md5, adcgs_decoder *decoder, const adcgs_plan *plan, adcgs_error *error)
{
    adcgs_info info;
    uint8_t digest[16];
    ADCGS_TRY(adcgs_get_info(decoder, &info, sizeof info, error));
    for (int i = 0; i < info.segments; i++) {
        ADCGS_TRY(adcgs_get_model_digest(decoder, i, digest, error));
        adcgs_md5_update(md5, digest, sizeof digest);
    }
    for (int t = 0; t < plan->n_times; t++) {
        ADCGS_TRY(adcgs_get_splat_digest(decoder, plan->times[t], digest, error));
        adcgs_md5_update(md5, digest, sizeof digest);
        for (int c = 0; c < plan->n_cameras; c++)
            ADCGS_TRY(add_frame(md5, decoder, &plan->cameras[c], plan->times[t], error));
    }
    return ADCGS_OK;
}

static adcgs_status digest_of(const adcgs_plan *plan, const adcgs_buffer *file, adcgs_cpu_level cpu, int threads, int step,
                              uint8_t digest[16], adcgs_error *error)
{
    adcgs_decoder *decoder = NULL;
    adcgs_config config;
    adcgs_md5 md5;
    adcgs_span s = {.next = file->data, .left = file->size, .step = step};
    adcgs_md5_init(&md5);
    ADCGS_TRY(add_trace(&md5, file, cpu, threads, step, error));
    adcgs_config_init(&config, sizeof config);
    config.cpu = cpu;
    config.threads = threads;
    ADCGS_TRY(adcgs_open_stream(&decoder, adcgs_span_read, &s, &config, error));
    const adcgs_status status = add_results(&md5, decoder, plan, error);
    adcgs_close(&decoder);
    adcgs_md5_final(&md5, digest);
    return status;
}

static adcgs_status check_ways(const adcgs_plan *plan, const adcgs_buffer *file, adcgs_error *error)
{
    static const int ways[][2] = {{1, 0}, {4, 5}, {1, 1}, {7, 0}}; /* threads, step */
    uint8_t first[16], other[16];
    ADCGS_TRY(digest_of(plan, file, ADCGS_CPU_SCALAR, 1, 0, first, error));
    for (int level = ADCGS_CPU_SCALAR; level <= (int)adcgs_cpu_best(); level++)
        for (size_t i = 0; i < ADCGS_COUNTOF(ways); i++) {
            ADCGS_TRY(digest_of(plan, file, (adcgs_cpu_level)level, ways[i][0], ways[i][1], other, error));
            if (memcmp(first, other, sizeof first))
                return adcgs_fail(error, ADCGS_ERR_INTERNAL, "%s, %d threads, input in pieces of %d bytes: other results",
                                  adcgs_cpu_name((adcgs_cpu_level)level), ways[i][0], ways[i][1]);
        }
    return ADCGS_OK;
}

/* ---- Through the writer and back ---- */

static adcgs_status read_all(adcgs_stream *stream, const adcgs_buffer *file, adcgs_error *error)
{
    const adcgs_read_options options = {.cpu = ADCGS_CPU_SCALAR};
    adcgs_span s = {.next = file->data, .left = file->size};
    return adcgs_stream_read(stream, adcgs_span_read, &s, &options, NULL, NULL, error);
}

static adcgs_status same_models(const adcgs_stream *a, const adcgs_stream *b, adcgs_error *error)
{
    if (a->n_segments != b->n_segments)
        return adcgs_fail(error, ADCGS_ERR_INTERNAL, "%u segments became %u", a->n_segments, b->n_segments);
    for (uint32_t i = 0; i < a->n_segments; i++)
        if (!adcgs_model_equal(&a->segments[i], &b->segments[i], error))
            return ADCGS_ERR_INTERNAL;
    return ADCGS_OK;
}

/* Reads, writes, reads and writes again: the models must be the same, and both written streams must have the same bytes. */
static adcgs_status check_writer(const adcgs_buffer *file, adcgs_error *error)
{
    adcgs_stream a, b;
    adcgs_buffer first, second;
    adcgs_buffer_init(&first);
    adcgs_buffer_init(&second);
    ADCGS_TRY(read_all(&a, file, error));
    adcgs_status status = adcgs_stream_write(&a, &first, error);
    if (status == ADCGS_OK)
        status = read_all(&b, &first, error);
    if (status == ADCGS_OK) {
        status = same_models(&a, &b, error);
        if (status == ADCGS_OK)
            status = adcgs_stream_write(&b, &second, error);
        if (status == ADCGS_OK && (first.size != second.size || memcmp(first.data, second.data, first.size)))
            status = adcgs_fail(error, ADCGS_ERR_INTERNAL, "the stream has other bytes when it is written a second time");
        adcgs_stream_clear(&b, NULL);
    }
    adcgs_stream_clear(&a, NULL);
    adcgs_buffer_clear(&first);
    adcgs_buffer_clear(&second);
    return status;
}

/* ---- Seeds ---- */

static adcgs_status use_seed(uint64_t seed, const char *path, FILE *text, adcgs_error *error)
{
    static adcgs_plan plan;
    adcgs_recipe recipe;
    adcgs_buffer file;
    adcgs_buffer_init(&file);
    adcgs_status status = adcgs_random_recipe(&recipe, seed, text, error);
    if (status == ADCGS_OK && !text) {
        status = adcgs_plan_build(&plan, &recipe, &file, error);
        if (status == ADCGS_OK && !path)
            status = check_ways(&plan, &file, error);
        if (status == ADCGS_OK && !path)
            status = check_writer(&file, error);
        adcgs_plan_clear(&plan);
    }
    if (status == ADCGS_OK && path) {
        FILE *const out = fopen(path, "wb");
        const int good = out && fwrite(file.data, 1, file.size, out) == file.size;
        if (!out || fclose(out) != 0 || !good)
            status = adcgs_fail(error, ADCGS_ERR_IO, "%.160s: cannot write", path);
    }
    adcgs_buffer_clear(&file);
    adcgs_recipe_clear(&recipe);
    return status;
}

static int check_seeds(uint64_t first, int64_t count)
{
    int faults = 0;
    for (uint64_t seed = first; seed < first + (uint64_t)count; seed++) {
        adcgs_error error = {ADCGS_OK, ""};
        if (use_seed(seed, NULL, NULL, &error) == ADCGS_OK)
            continue;
        printf("seed %llu: %s\n", (unsigned long long)seed, error.text);
        faults++;
    }
    printf("%lld random streams, %d faults\n", (long long)count, faults);
    return faults ? 1 : 0;
}

int main(int argc, char **argv)
{
    const char *const verb = argc > 2 ? argv[1] : "";
    const uint64_t seed = argc > 2 ? strtoull(argv[2], NULL, 0) : 0;
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_status status;
    if (strcmp(verb, "check") == 0 && argc == 4)
        return check_seeds(seed, strtoll(argv[3], NULL, 0));
    if (strcmp(verb, "write") == 0 && argc == 4)
        status = use_seed(seed, argv[3], NULL, &error);
    else if (strcmp(verb, "recipe") == 0 && argc == 3)
        status = use_seed(seed, NULL, stdout, &error);
    else {
        fprintf(stderr, "usage: random_stream check SEED COUNT   decode in every way, write, read again\n"
                        "       random_stream write SEED FILE    write the stream to FILE\n"
                        "       random_stream recipe SEED        print its recipe\n");
        return 2;
    }
    if (status != ADCGS_OK)
        fprintf(stderr, "random_stream: %s\n", error.text);
    return status == ADCGS_OK ? 0 : 1;
}
