/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Undistortion of images. Catmull-Rom needs 16 pixels where Lanczos needs 36, and keeps a ramp a ramp. Values are clamped to
 * the range of all 16 pixels. Clamping to the four nearest pixels would flatten every peak between them.
 */
#include "config.h"

#include "scene/lens.h"

#include <math.h>

/** The four pixels around a position along one axis, and their weights. */
typedef struct taps {
    int at[4];
    float weight[4];
} taps;

/** n pixels, with the outermost repeated outside; x from 0 to n. */
static taps find_taps(double x, int n)
{
    const int whole = (int)(x + 0.5) - 1; /* rounds down, as x is not negative */
    const float f = (float)(x - 0.5 - whole);
    taps t = {.weight = {((1.0f - 0.5f * f) * f - 0.5f) * f, (1.5f * f - 2.5f) * f * f + 1.0f, ((2.0f - 1.5f * f) * f + 0.5f) * f,
                         (0.5f * f - 0.5f) * f * f}};
    for (int i = 0; i < 4; i++)
        t.at[i] = ADCGS_MIN(ADCGS_MAX(whole - 1 + i, 0), n - 1);
    return t;
}

static void sample(const adcgs_image *image, const taps *across, const taps *down, float *out)
{
    const int channels = image->channels;
    const float *row[4];
    for (int j = 0; j < 4; j++)
        row[j] = image->data + (size_t)down->at[j] * (size_t)image->width * (size_t)channels;
    for (int c = 0; c < channels; c++) {
        float sum = 0.0f, low = HUGE_VALF, high = -HUGE_VALF;
        for (int j = 0; j < 4; j++) {
            float line = 0.0f;
            for (int i = 0; i < 4; i++) {
                const float value = row[j][across->at[i] * channels + c];
                line += across->weight[i] * value;
                low = value < low ? value : low;
                high = value > high ? value : high;
            }
            sum += down->weight[j] * line;
        }
        out[c] = sum < low ? low : sum > high ? high : sum;
    }
}

/** Clamps to [0, n]; NaN becomes 0. */
static double limit(double x, int n)
{
    return x > 0.0 ? x < n ? x : n : 0.0;
}

static void straighten_rows(const adcgs_lens *lens, const adcgs_camera *camera, const adcgs_image *from, adcgs_image *to)
{
    float *out = to->data;
    for (int j = 0; j < to->height; j++)
        for (int i = 0; i < to->width; i++, out += to->channels) {
            double at[2];
            adcgs_lens_project(lens, (i + 0.5 - camera->cx) / camera->fx, (j + 0.5 - camera->cy) / camera->fy, at);
            const taps across = find_taps(limit(at[0], from->width), from->width);
            const taps down = find_taps(limit(at[1], from->height), from->height);
            sample(from, &across, &down, out);
        }
}

adcgs_status adcgs_lens_straighten(const adcgs_lens *lens, const adcgs_camera *camera, adcgs_image *image, const char *path,
                                   adcgs_error *error)
{
    adcgs_image out;
    ADCGS_TRY(adcgs_image_alloc(&out, camera->width, camera->height, image->channels, path, error));
    adcgs_image_premultiply(image); /* colours of transparent pixels must not bleed into their neighbours */
    straighten_rows(lens, camera, image, &out);
    adcgs_image_unpremultiply(&out);
    adcgs_image_free(image);
    *image = out;
    return ADCGS_OK;
}
