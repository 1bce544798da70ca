/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Small videos written by this program, and files for the tests of damage. */
#ifndef ADCGS_TESTS_VIDEO_FILES_H
#define ADCGS_TESTS_VIDEO_FILES_H

#include "outside_files.h"

#include "media/video/video.h"

#include <math.h>

#define TOP 96
static float pixels[TOP * TOP * 3];

#define expect_good(call)                              \
    do {                                               \
        if ((call) != ADCGS_OK)                        \
            fail_msg("%s: \"%s\"", #call, error.text); \
    } while (0)

/** A smooth moving image whose mean green encodes the frame: 0.2 + frame / 100. */
static inline adcgs_frame paint(int width, int height, int number)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            float *rgb = pixels + 3 * (y * width + x);
            rgb[0] = 0.5f + 0.4f * sinf(0.07f * (float)x + 0.2f * (float)number);
            rgb[1] = 0.2f + 0.01f * (float)number;
            rgb[2] = 0.5f + 0.4f * cosf(0.05f * (float)y);
        }
    return (adcgs_frame){width, height, pixels};
}

static inline void write_clip(const char *name, int width, int height, int frames, double rate)
{
    adcgs_video_writer *w;
    expect_good(adcgs_video_write_open(&w, in(name), width, height, rate, &(const adcgs_video_style){0}, &error));
    for (int i = 0; i < frames; i++) {
        const adcgs_frame frame = paint(width, height, i);
        expect_good(adcgs_video_write_frame(w, &frame, NULL, &error));
    }
    expect_good(adcgs_video_write_close(&w, &error));
    assert_null(w);
}

/** PSNR of an image's upper left part, the size of a frame, against that frame. */
static inline double psnr(const adcgs_image *image, int width, int height, int number)
{
    double sum = 0;
    paint(width, height, number);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++)
                sum += pow((double)image->data[3 * (y * image->width + x) + c] - (double)pixels[3 * (y * width + x) + c], 2);
    return -10 * log10(sum / (3.0 * width * height) + 1e-12);
}

static inline char *load_file(const char *name, size_t *bytes)
{
    char *data = malloc(1 << 20);
    FILE *file = fopen(in(name), "rb");
    assert_true(data && file);
    *bytes = fread(data, 1, 1 << 20, file);
    fclose(file);
    return data;
}

static inline void bad_file(const char *name, const void *data, size_t bytes)
{
    adcgs_video *video;
    put_bytes(name, data, bytes);
    expect_error(adcgs_video_open(&video, in(name), &error), ADCGS_ERR_DATA, name, name);
    assert_null(video);
}

/** Reads all frames of a damaged clip. \return number of frames refused; the others look as before. */
static inline int refused(const char *name, int frames)
{
    adcgs_video *video;
    const adcgs_status status = adcgs_video_open(&video, in(name), &error);
    if (status != ADCGS_OK) {
        expect_error(status, ADCGS_ERR_DATA, name, name);
        return frames;
    }
    const int n = (int)adcgs_video_get_info(video)->frames;
    int bad = ADCGS_MAX(frames - n, 0);
    for (int f = 0; f < n; f++) {
        adcgs_image image;
        char expected[40];
        snprintf(expected, sizeof expected, "frame %d:", f);
        const adcgs_status got = adcgs_video_read(video, f, &image, &error);
        if (got != ADCGS_OK) {
            expect_error(got, ADCGS_ERR_DATA, name, expected);
            bad++;
        } else if (psnr(&image, 64, 48, f) < 35)
            fail_msg("%s: frame %d is damaged, and no error is reported", name, f);
        adcgs_image_free(&image);
    }
    adcgs_video_close(&video);
    return bad;
}

#endif
