/* SPDX-License-Identifier: BSD-2-Clause */
/** \file One conformance vector against the library, at one CPU level and thread count. */
#include "tools/conform.h"

#include "base/digest.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct report {
    char *what;
    size_t size;
} report;

/* Say what is wrong; always 0, the verdict. */
static int wrong(const report *r, const char *format, ...) ADCGS_PRINTF(2, 3);

static int wrong(const report *r, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(r->what, r->size, format, list);
    va_end(list);
    return 0;
}

static void hex_of(const void *data, size_t bytes, char hex[ADCGS_HEX])
{
    adcgs_md5 md5;
    uint8_t digest[16];
    adcgs_md5_init(&md5);
    adcgs_md5_update(&md5, data, bytes);
    adcgs_md5_final(&md5, digest);
    adcgs_md5_hex(digest, hex);
}

static int models_match(const adcgs_vector *v, const adcgs_decoder *decoder, const report *r)
{
    adcgs_info info;
    if (adcgs_get_info(decoder, &info) != ADCGS_OK || info.segments != v->n_models)
        return wrong(r, "%d segments, expected %d", info.segments, v->n_models);
    for (int i = 0; i < v->n_models; i++) {
        uint8_t digest[16];
        char hex[ADCGS_HEX] = "";
        if (adcgs_get_model_digest(decoder, i, digest) == ADCGS_OK)
            adcgs_md5_hex(digest, hex);
        if (strcmp(hex, v->models[i]))
            return wrong(r, "model %d is %s, expected %s", i, hex, v->models[i]);
    }
    return 1;
}

/* MD5 of the frame's binary32 values as little-endian bytes. */
static void hex_of_frame(const adcgs_frame *frame, char hex[ADCGS_HEX])
{
    adcgs_md5 md5;
    uint8_t digest[16], word[4];
    const size_t n = 3 * (size_t)frame->width * (size_t)frame->height;
    adcgs_md5_init(&md5);
    for (size_t i = 0; i < n; i++) {
        adcgs_store_le32(word, adcgs_float_bits(frame->rgb[i]));
        adcgs_md5_update(&md5, word, sizeof word);
    }
    adcgs_md5_final(&md5, digest);
    adcgs_md5_hex(digest, hex);
}

static int frame_matches(const adcgs_vector *v, int i, adcgs_decoder *decoder, float *rgb, const report *r)
{
    const adcgs_camera *const camera = &v->cameras[v->frames[i].camera];
    adcgs_frame frame = {.width = camera->width, .height = camera->height, .rgb = rgb};
    adcgs_error error;
    char hex[ADCGS_HEX];
    if (adcgs_render(decoder, camera, v->frames[i].time, &frame, &error) != ADCGS_OK)
        return wrong(r, "frame %d: %s", i, error.text);
    hex_of_frame(&frame, hex);
    if (strcmp(hex, v->frames[i].md5))
        return wrong(r, "frame %d is %s, expected %s", i, hex, v->frames[i].md5);
    return 1;
}

static int frames_match(const adcgs_vector *v, adcgs_decoder *decoder, const report *r)
{
    size_t most = 1;
    for (int i = 0; i < v->n_cameras; i++) {
        const adcgs_camera *const c = &v->cameras[i];
        if (c->width < 1 || c->height < 1 || c->width > 16384 || c->height > 16384)
            return wrong(r, "camera %d: size %dx%d", i, (int)c->width, (int)c->height);
        most = ADCGS_MAX(most, (size_t)c->width * (size_t)c->height);
    }
    float *const rgb = malloc(most * 3 * sizeof *rgb);
    int good = rgb ? 1 : wrong(r, "out of memory");
    for (int i = 0; good && i < v->n_frames; i++)
        good = frame_matches(v, i, decoder, rgb, r);
    free(rgb);
    return good;
}

int adcgs_vector_try(const adcgs_vector *vector, const uint8_t *data, size_t bytes, adcgs_cpu_level cpu, int threads, char *what,
                     size_t size)
{
    const report r = {.what = what, .size = size};
    adcgs_config config;
    adcgs_decoder *decoder = NULL;
    adcgs_error error = {ADCGS_OK, ""};
    char hex[ADCGS_HEX];
    hex_of(data, bytes, hex);
    if (strcmp(hex, vector->md5))
        return wrong(&r, "file is %s, expected %s", hex, vector->md5);
    adcgs_config_init(&config);
    config.cpu = cpu;
    config.threads = threads;
    config.strict_end = 1;
    const adcgs_status status = adcgs_open_memory(&decoder, data, bytes, &config, &error);
    int good;
    if (status != vector->status)
        good = wrong(&r, "status \"%s\", expected \"%s\"%s%s", adcgs_status_name(status), adcgs_status_name(vector->status),
                     status == ADCGS_OK ? "" : ": ", status == ADCGS_OK ? "" : error.text);
    else
        good = status != ADCGS_OK || (models_match(vector, decoder, &r) && frames_match(vector, decoder, &r));
    adcgs_close(&decoder);
    return good;
}
