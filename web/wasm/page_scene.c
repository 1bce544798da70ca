/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The page's scene: takes bytes, gives a summary and exact frames. One scene per instance. */
#include "config.h"

#include "camera/follow.h"
#include "camera/pivot.h"
#include "geometry/rotation.h"
#include "wasm/export.h"
#include "wasm/page_scene.h"
#include "wasm/wasm_threads.h"

#include <adcgs/adcgs.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/** Maximum size of a stream that is kept: opening it again needs twice as much, in a memory of 4 GiB. */
#define BYTES_MOST (UINT64_C(1) << 30)
/** Maximum size of a stream of level 2, definition (spec clause "Levels"): the bound before HEAD gives the level. */
#define BYTES_UNKNOWN (UINT64_C(256) << 20)

static struct {
    adcgs_decoder *decoder;
    adcgs_info info;
    adcgs_filmed_camera *cameras;
    adcgs_camera home;
    double pivot[3];
    adcgs_error error;
    char fault[sizeof((adcgs_error *)0)->text]; /* the first concealed fault */
    float *values;
    uint8_t *rgba;
    size_t pixels; /* room in both */
    char digest[33];
} scene;

adcgs_decoder *adcgs_page_decoder(void)
{
    return scene.decoder;
}

adcgs_error *adcgs_page_error(void)
{
    return &scene.error;
}

adcgs_status adcgs_page_fail(adcgs_status status, const char *text)
{
    scene.error.status = status;
    snprintf(scene.error.text, sizeof scene.error.text, "%s", text);
    return status;
}

void *PAGE_EXPORT(page_alloc)(size_t bytes)
{
    return malloc(bytes);
}

void PAGE_EXPORT(page_free)(void *pointer)
{
    free(pointer);
}

const char *PAGE_EXPORT(page_error)(void)
{
    return scene.error.text;
}

const char *PAGE_EXPORT(page_fault)(void)
{
    return scene.fault;
}

static void note_fault(void *user, adcgs_log_level level, const char *text)
{
    if (level == ADCGS_LOG_WARNING && !*scene.fault)
        snprintf(scene.fault, sizeof scene.fault, "%s", text);
}

static adcgs_config make_config(int layers)
{
    adcgs_config config;
    adcgs_config_init(&config, sizeof config);
    config.threads = 1;
    config.pool = adcgs_page_pool();
    config.layers = layers;
    config.log = note_fault;
    *scene.fault = 0;
    return config;
}

/** Start again, with a stream whose bytes arrive over time. */
int PAGE_EXPORT(page_open)(void)
{
    const adcgs_config config = make_config(0);
    adcgs_close(&scene.decoder);
    return adcgs_open_push(&scene.decoder, &config, &scene.error);
}

/** Open a whole stream with fewer layers, or the intact parts of a damaged one. On failure the previous stream stays open. */
int PAGE_EXPORT(page_reopen)(const void *data, size_t bytes, int layers, int conceal)
{
    adcgs_config config = make_config(layers);
    adcgs_decoder *decoder;
    config.conceal = conceal;
    const adcgs_status status = adcgs_open_memory(&decoder, data, bytes, &config, &scene.error);
    if (status != ADCGS_OK)
        return status;
    adcgs_close(&scene.decoder);
    scene.decoder = decoder;
    return status;
}

/** Push bytes. \return the highest arrival (adcgs_arrival), or a status. */
int PAGE_EXPORT(page_push)(const uint8_t *data, size_t bytes)
{
    int most = ADCGS_ARRIVED_NOTHING;
    for (size_t used = 0; bytes && most != ADCGS_ARRIVED_END; data += used, bytes -= used) {
        adcgs_arrival arrived;
        const adcgs_status status = adcgs_push(scene.decoder, data, bytes, &used, &arrived, &scene.error);
        if (status != ADCGS_OK)
            return status;
        most = (int)arrived > most ? (int)arrived : most;
    }
    return most;
}

/** The maximum size of the stream, by its level or, before HEAD, by level 2. */
double PAGE_EXPORT(page_useful)(void)
{
    adcgs_info info;
    const int known = adcgs_get_info(scene.decoder, &info, sizeof info, NULL) == ADCGS_OK;
    const uint64_t bytes = known ? info.bytes_max : BYTES_UNKNOWN;
    return (double)(bytes < BYTES_MOST ? bytes : BYTES_MOST);
}

int PAGE_EXPORT(page_end)(void)
{
    return adcgs_push_end(scene.decoder, &scene.error);
}

const adcgs_info *PAGE_EXPORT(page_info)(void)
{
    return adcgs_get_info(scene.decoder, &scene.info, sizeof scene.info, &scene.error) == ADCGS_OK ? &scene.info : NULL;
}

/** Variance that the renderer adds to the splats' footprints, square pixels; 0 before the header. */
float PAGE_EXPORT(page_filter)(void)
{
    const adcgs_info *info = page_info();
    return info ? info->screen_filter : 0;
}

size_t PAGE_EXPORT(page_info_size)(void)
{
    return sizeof(adcgs_info);
}

size_t PAGE_EXPORT(page_camera_size)(void)
{
    return sizeof(adcgs_camera);
}

size_t PAGE_EXPORT(page_filmed_size)(void)
{
    return sizeof(adcgs_filmed_camera);
}

/** The stored cameras with their times, info.cameras of them. */
const adcgs_filmed_camera *PAGE_EXPORT(page_cameras)(void)
{
    const adcgs_info *info = page_info();
    free(scene.cameras);
    scene.cameras = NULL;
    if (!info || adcgs_filmed_cameras_get(&scene.cameras, scene.decoder, info, &scene.error) != ADCGS_OK)
        return NULL;
    return scene.cameras;
}

/** The point under a place of a camera's image, x and y from 0 to 1; NULL if it shows background. */
const double *PAGE_EXPORT(page_pivot)(const adcgs_camera *camera, double time, double x, double y)
{
    return adcgs_pivot_find(scene.pivot, scene.decoder, camera, time, x, y, &scene.error) == ADCGS_OK ? scene.pivot : NULL;
}

/** The first view, chosen as in the player. */
const adcgs_camera *PAGE_EXPORT(page_home)(void)
{
    const adcgs_info *info = page_info();
    adcgs_camera_path frames;
    if (!info)
        return NULL;
    const adcgs_camera_path_request request = {.has_times = 1, .begin = info->time_start, .end = info->time_start};
    if (adcgs_camera_path_make(&frames, scene.decoder, &request, &scene.error) != ADCGS_OK)
        return NULL;
    scene.home = frames.frame[0].camera;
    adcgs_camera_path_free(&frames);
    return &scene.home;
}

/** Fit a camera to an image of another size: the whole view stays visible, or with fill a part of it fills the image. */
void PAGE_EXPORT(page_fit)(adcgs_camera *camera, int width, int height, int fill)
{
    adcgs_camera_fit(camera, width, height, fill);
}

static adcgs_status reserve(size_t pixels)
{
    if (pixels <= scene.pixels)
        return ADCGS_OK;
    free(scene.values);
    free(scene.rgba);
    scene.values = malloc(3 * pixels * sizeof *scene.values);
    scene.rgba = malloc(4 * pixels);
    scene.pixels = scene.values && scene.rgba ? pixels : 0;
    return scene.pixels ? ADCGS_OK : adcgs_page_fail(ADCGS_ERR_MEMORY, "out of memory for an image");
}

/** From three samples a pixel to four, in place. */
static void widen(uint8_t *rgba, size_t pixels)
{
    for (size_t i = pixels; i-- > 0;) {
        const uint8_t rgb[3] = {rgba[3 * i], rgba[3 * i + 1], rgba[3 * i + 2]};
        memcpy(rgba + 4 * i, rgb, sizeof rgb);
        rgba[4 * i + 3] = 255;
    }
}

static void write_digest(const adcgs_frame *frame, char text[33])
{
    uint8_t bytes[16];
    adcgs_frame_digest(frame, bytes);
    for (size_t i = 0; i < sizeof bytes; i++)
        snprintf(text + 2 * i, 3, "%02x", bytes[i]);
}

/** Render an exact frame, of the first tiers only if tiers is not 0; with digest, also its MD5. */
int PAGE_EXPORT(page_draw)(const adcgs_camera *camera, double time, int tiers, int digest)
{
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    adcgs_status status = adcgs_set_tiers(scene.decoder, tiers, &scene.error);
    if (status == ADCGS_OK)
        status = reserve(pixels);
    adcgs_frame frame = {.width = camera->width, .height = camera->height, .rgb = scene.values};
    if (status == ADCGS_OK)
        status = adcgs_render(scene.decoder, camera, time, &frame, &scene.error);
    if (status != ADCGS_OK)
        return status;
    adcgs_frame_to_u8(&frame, scene.rgba);
    widen(scene.rgba, pixels);
    *scene.digest = 0;
    if (digest)
        write_digest(&frame, scene.digest);
    return ADCGS_OK;
}

const uint8_t *PAGE_EXPORT(page_pixels)(void)
{
    return scene.rgba;
}

const char *PAGE_EXPORT(page_digest)(void)
{
    return scene.digest;
}
