/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Videos of high dynamic range, whose frames are converted, and panoramas, which are reported. */
#include "video_clips.h"
#include "video_files.h"

#include "media/video/video.h"

/** Light of a screen by the formulae of BT.2100, 1 for 203 cd/m2. */
static void screen_light(int is_pq, const double signal[3], double light[3])
{
    const double a = 0.17883277, b = 1 - 4 * a, c = 0.5 - a * log(4 * a);
    for (int i = 0; i < 3; i++) {
        const double p = pow(signal[i], 4096 / (2523.0 * 128));
        const double pq = 1e4 * pow(fmax(p - 3424 / 4096.0, 0) / (2413 / 128.0 - 2392 / 128.0 * p), 16384 / 2610.0);
        const double hlg = signal[i] <= 0.5 ? signal[i] * signal[i] / 3 : (exp((signal[i] - c) / a) + b) / 12;
        light[i] = is_pq ? pq / 203 : hlg;
    }
    const double y = 0.2627 * light[0] + 0.678 * light[1] + 0.0593 * light[2];
    for (int i = 0; i < 3 && !is_pq; i++)
        light[i] *= 1000 / 203.0 * pow(y, 0.2);
}

/** sRGB of a light in BT.2020: light above 0.7 approaches 1. */
static void true_srgb(const double light[3], double rgb[3])
{
    static const double narrow[3][3] = {{1.6605, -0.5876, -0.0728}, {-0.1246, 1.1329, -0.0083}, {-0.0182, -0.1006, 1.1187}};
    double most = 0;
    for (int i = 0; i < 3; i++) {
        rgb[i] = fmax(narrow[i][0] * light[0] + narrow[i][1] * light[1] + narrow[i][2] * light[2], 0);
        most = fmax(most, rgb[i]);
    }
    for (int i = 0; i < 3; i++) {
        rgb[i] *= most > 0.7 ? (0.7 + 0.3 * (1 - exp((0.7 - most) / 0.3))) / most : 1;
        rgb[i] = rgb[i] <= 0.0031308 ? 12.92 * rgb[i] : 1.055 * pow(rgb[i], 1 / 2.4) - 0.055;
    }
}

/* HLG and PQ become sRGB; a clip with the curve of BT.709 keeps its values. */
static void test_dynamic_range(void **state)
{
    static const recipe clips[] = {
        {"hlg.mkv", "ffv1", "", AV_PIX_FMT_YUV420P10LE, 60, 38, 2, AVCOL_SPC_BT2020_NCL, AVCOL_RANGE_MPEG, {0, 1}, 0},
        {"pq.mp4", "libx264", "qp=0", AV_PIX_FMT_YUV420P10LE, 60, 38, 2, AVCOL_SPC_BT2020_NCL, AVCOL_RANGE_MPEG, {0, 1}, 0},
        {"sdr.mkv", "ffv1", "", AV_PIX_FMT_YUV420P10LE, 60, 38, 2, AVCOL_SPC_BT2020_NCL, AVCOL_RANGE_MPEG, {0, 1}, 0},
    };
    static const clip_kind curves[] = {{AVCOL_TRC_ARIB_STD_B67, 1, 0}, {AVCOL_TRC_SMPTE2084, 1, 0}, {AVCOL_TRC_BT2020_10, 1, 0}};
    static const char *const names[] = {"HLG", "PQ", NULL};
    for (size_t i = 0; i < ADCGS_COUNTOF(clips); i++) {
        const geometry g = {60, 38, 2, 2, 10, 0, 0.2627, 0.0593};
        const painted p = {10, 1};
        adcgs_video *video;
        adcgs_image image;
        if (!make_clip_of(&clips[i], &curves[i])) {
            print_message("skipped: no encoder %s\n", clips[i].encoder);
            continue;
        }
        expect_good(adcgs_video_open(&video, in(clips[i].name), &error));
        const char *const name = adcgs_video_get_info(video)->hdr;
        assert_true(name == names[i] || (name && names[i] && !strcmp(name, names[i])));
        expect_good(adcgs_video_read(video, 1, &image, &error));
        for (int at = 0; at < 60 * 38; at++) {
            double signal[3], light[3], rgb[3];
            true_pixel(&g, painted_sample, &p, at % 60, at / 60, signal);
            screen_light(i == 1, signal, light);
            true_srgb(light, rgb);
            for (int k = 0; k < 3; k++)
                if (!(fabs(image.data[3 * at + k] - (names[i] ? rgb[k] : signal[k])) < 1e-4))
                    fail_msg("%s: pixel %d, component %d: %g, expected %g", clips[i].name, at, k, (double)image.data[3 * at + k],
                             names[i] ? rgb[k] : signal[k]);
        }
        adcgs_image_free(&image);
        adcgs_video_close(&video);
    }
    /* White of paper is 203 cd/m2 by both curves (BT.2408): 0.75 and 0.58. */
    double light[3];
    screen_light(0, (const double[3]){0.75, 0.75, 0.75}, light);
    assert_true(fabs(light[1] - 1) < 0.01);
    screen_light(1, (const double[3]){0.5807, 0.5807, 0.5807}, light);
    assert_true(fabs(light[1] - 1) < 0.01);
}

/* A panorama is known by the container's metadata, not by its shape. */
static void test_panorama(void **state)
{
    static const char *const names[] = {"round.mp4", "round.mkv"};
    for (size_t i = 0; i < 2 * ADCGS_COUNTOF(names); i++) {
        const recipe clip = {.name = names[i / 2],
                             .encoder = "mpeg4",
                             .options = "",
                             .format = AV_PIX_FMT_YUV420P,
                             .width = 64,
                             .height = 32,
                             .frames = 2,
                             .aspect = {0, 1}};
        const clip_kind kind = {.is_round = i % 2 == 0};
        adcgs_video *video;
        assert_true(make_clip_of(&clip, &kind));
        expect_good(adcgs_video_open(&video, in(clip.name), &error));
        const char *const round = adcgs_video_get_info(video)->round;
        assert_true(kind.is_round ? round && !strcmp(round, "equirectangular") : !round);
        adcgs_video_close(&video);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_dynamic_range),
        cmocka_unit_test(test_panorama),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
