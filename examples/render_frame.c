/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Render one frame of a stream to an image file: render_frame FILE OUT.ppm [SECONDS]. Uses the stream's first camera; a stream
 * without cameras is seen from in front of the scene.
 *
 * cc render_frame.c $(pkg-config --cflags --libs adcgs)
 */
#include <adcgs/adcgs.h>

#include <stdio.h>
#include <stdlib.h>

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

static void say(void *user, adcgs_log_level level, const char *text)
{
    (void)user;
    if (level == ADCGS_LOG_WARNING)
        fprintf(stderr, "warning: %s\n", text);
}

static adcgs_status render(const char *input, const char *output, double seconds, adcgs_error *error)
{
    adcgs_decoder *decoder;
    adcgs_config config;
    adcgs_info info;
    adcgs_config_init(&config, sizeof config);
    config.log = say;
    adcgs_status status = adcgs_open_file(&decoder, input, &config, error);
    if (status != ADCGS_OK)
        return status;
    status = adcgs_get_info(decoder, &info, sizeof info, error);
    const adcgs_camera camera = choose_camera(decoder, &info);
    const ptrdiff_t stride = 4 * (ptrdiff_t)camera.width;
    uint8_t *pixels = malloc((size_t)stride * (size_t)camera.height);
    if (!pixels)
        status = ADCGS_ERR_MEMORY;
    if (status == ADCGS_OK)
        status = adcgs_render_rgba8(decoder, &camera, seconds, ADCGS_ALPHA_OPAQUE, pixels, stride, error);
    if (status == ADCGS_OK && write_ppm(output, pixels, camera.width, camera.height) != 0)
        status = ADCGS_ERR_IO;
    free(pixels);
    adcgs_close(&decoder);
    return status;
}

int main(int argc, char **argv)
{
    adcgs_error error = {ADCGS_OK, ""};
    if (argc < 3 || argc > 4) {
        fprintf(stderr, "usage: %s FILE OUT.ppm [SECONDS]\n", argv[0]);
        return 2;
    }
    const adcgs_status status = render(argv[1], argv[2], argc > 3 ? atof(argv[3]) : 0, &error);
    if (status != ADCGS_OK)
        fprintf(stderr, "%s: %s\n", argv[0], error.status == status ? error.text : adcgs_status_name(status));
    return status == ADCGS_OK ? 0 : 1;
}
