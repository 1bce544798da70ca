/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Render while bytes arrive: push_frames OUT.ppm <FILE. Reads a stream from standard input, and writes an image of its beginning
 * each time that more of it can be rendered. Uses the stream's first camera, or sees the scene from in front:
 *
 * curl -sN https://example.org/my.adcgs | ./push_frames now.ppm
 *
 * cc push_frames.c $(pkg-config --cflags --libs adcgs)
 */
#include <adcgs/adcgs.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static adcgs_camera choose_camera(const adcgs_decoder *decoder, const adcgs_info *info)
{
    adcgs_camera camera = {.width = 640, .height = 480, .fx = 600, .fy = 600, .cx = 320, .cy = 240};
    if (info->cameras > 0 && adcgs_get_camera(decoder, 0, &camera, NULL) == ADCGS_OK)
        return camera;
    for (int axis = 0; axis < 3; axis++) { /* axes as the world's, 4 scene units back along z */
        camera.cam_to_world[4 * axis + axis] = 1;
        camera.cam_to_world[4 * axis + 3] = info->scene_origin[axis] - (axis == 2 ? 4 * info->scene_scale : 0);
    }
    camera.near_plane = 0.01 * info->scene_scale;
    return camera;
}

/* A PPM has three samples per pixel; the fourth is left out. */
static int write_ppm(const char *path, const uint8_t *rgba, int width, int height)
{
    FILE *file = fopen(path, "wb");
    if (!file)
        return -1;
    fprintf(file, "P6\n%d %d\n255\n", width, height);
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
        fwrite(rgba + 4 * i, 3, 1, file);
    const int failed = ferror(file);
    return fclose(file) || failed ? -1 : 0;
}

static adcgs_status show(adcgs_decoder *decoder, const char *output, adcgs_error *error)
{
    adcgs_info info;
    adcgs_status status = adcgs_get_info(decoder, &info, sizeof info, error);
    if (status != ADCGS_OK)
        return status;
    const adcgs_camera camera = choose_camera(decoder, &info);
    const ptrdiff_t stride = 4 * (ptrdiff_t)camera.width;
    uint8_t *pixels = malloc((size_t)stride * (size_t)camera.height);
    if (!pixels)
        return ADCGS_ERR_MEMORY;
    status = adcgs_render_rgba8(decoder, &camera, info.time_start, ADCGS_ALPHA_OPAQUE, pixels, stride, error);
    if (status == ADCGS_OK && write_ppm(output, pixels, camera.width, camera.height) != 0)
        status = ADCGS_ERR_IO;
    free(pixels);
    printf("%llu bytes: can be rendered up to %g s\n", (unsigned long long)info.bytes.total, info.time_available);
    return status;
}

/* A call takes bytes up to the end of a chunk at most, so that the program can act between two of them. */
static adcgs_status push(adcgs_decoder *decoder, const uint8_t *data, size_t bytes, const char *output, int *ended,
                         adcgs_error *error)
{
    adcgs_status status = ADCGS_OK;
    while (bytes && !*ended && status == ADCGS_OK) {
        size_t used = 0;
        adcgs_arrival arrived = ADCGS_ARRIVED_NOTHING;
        status = adcgs_push(decoder, data, bytes, &used, &arrived, error);
        if (status == ADCGS_OK && arrived == ADCGS_ARRIVED_SEGMENT)
            status = show(decoder, output, error);
        *ended = arrived == ADCGS_ARRIVED_END;
        data += used;
        bytes -= used;
    }
    return status;
}

/* A stream that ends early shows its complete part. */
static adcgs_status receive(const char *output, adcgs_error *error)
{
    adcgs_decoder *decoder;
    uint8_t data[4096];
    int ended = 0;
    ssize_t n = 0;
    adcgs_status status = adcgs_open_push(&decoder, NULL, error);
    while (status == ADCGS_OK && !ended && (n = read(STDIN_FILENO, data, sizeof data)) > 0) /* as many bytes as there are */
        status = push(decoder, data, (size_t)n, output, &ended, error);
    if (status == ADCGS_OK)
        status = n < 0 ? ADCGS_ERR_IO : adcgs_push_end(decoder, error);
    if (status == ADCGS_OK)
        status = show(decoder, output, error);
    adcgs_close(&decoder);
    return status;
}

int main(int argc, char **argv)
{
    adcgs_error error = {ADCGS_OK, ""};
    if (argc != 2) {
        fprintf(stderr, "usage: %s OUT.ppm <FILE\n", argv[0]);
        return 2;
    }
    const adcgs_status status = receive(argv[1], &error);
    if (status != ADCGS_OK)
        fprintf(stderr, "%s: %s\n", argv[0], error.status == status ? error.text : adcgs_status_name(status));
    return status == ADCGS_OK ? 0 : 1;
}
