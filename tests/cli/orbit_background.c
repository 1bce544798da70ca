/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Measures how much an orbit looks at nothing: for each stream the largest share of an image's pixels that show background during
 * an orbit of 20 degrees to each side, up and down, from each stored camera about its pivot, less the largest share in the images
 * of the stored cameras. Prints one line for each stream.
 */
#include "config.h"

#include "camera/follow.h"
#include "camera/orbit_control.h"
#include "camera/pivot.h"
#include "geometry/rotation.h"

#include <adcgs/decoder.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 96, HEIGHT = 72 };
#define DEGREE 0.017453292519943295
#define STEP 5.0
#define ORBIT 20.0

static double background(adcgs_decoder *decoder, const adcgs_camera *camera, double time)
{
    static float depth[WIDTH * HEIGHT], alpha[WIDTH * HEIGHT];
    adcgs_camera small = *camera;
    adcgs_error error;
    int n = 0;
    adcgs_camera_stretch(&small, WIDTH, HEIGHT);
    if (adcgs_render_depth(decoder, &small, time, depth, alpha, &error) != ADCGS_OK) {
        fprintf(stderr, "%s\n", error.text);
        exit(1);
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        n += alpha[i] < 0.5f;
    return (double)n / (WIDTH * HEIGHT);
}

/** The largest share of background in the orbits of one camera. */
static double orbit(adcgs_decoder *decoder, const adcgs_info *info, const adcgs_camera *camera, double time)
{
    static const int ways[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    double pivot[3], most = 0;
    if (adcgs_pivot_find(pivot, decoder, camera, time, 0.5, 0.5, NULL) != ADCGS_OK)
        return 0;
    for (int way = 0; way < 4; way++)
        for (double angle = STEP; angle <= ORBIT; angle += STEP) {
            adcgs_orbit_control control;
            adcgs_orbit_control_init(&control, info, camera);
            adcgs_orbit_control_pivot(&control, pivot);
            adcgs_orbit_control_orbit(&control, ways[way][0] * angle * DEGREE, ways[way][1] * angle * DEGREE);
            most = fmax(most, background(decoder, &control.camera, time));
        }
    return most;
}

static int measure(const char *path)
{
    adcgs_decoder *decoder;
    adcgs_error error;
    adcgs_info info;
    double filmed = 0, most = 0;
    if (adcgs_open_file(&decoder, path, NULL, &error) != ADCGS_OK ||
        adcgs_get_info(decoder, &info, sizeof info, &error) != ADCGS_OK) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    adcgs_filmed_camera *cameras;
    if (adcgs_filmed_cameras_get(&cameras, decoder, &info, &error) != ADCGS_OK)
        return 1;
    for (int i = 0; i < info.cameras; i++) {
        const double time = isnan(cameras[i].time) ? info.time_start : cameras[i].time;
        filmed = fmax(filmed, background(decoder, &cameras[i].camera, time));
        most = fmax(most, orbit(decoder, &info, &cameras[i].camera, time));
    }
    printf("%.3f %s\n", most - filmed, path);
    free(cameras);
    adcgs_close(&decoder);
    return 0;
}

int main(int argc, char **argv)
{
    int failed = 0;
    for (int i = 1; i < argc; i++)
        failed |= measure(argv[i]);
    return failed;
}
