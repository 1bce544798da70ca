/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Lenses: the model and its inverse, pinhole cameras for them, undistorted images, a real calibration. */
#include "outside_files.h"

#include "data/lens_model.h"
#include "data/scene.h"
#include "layouts/open.h"

#include <jansson.h>
#include <math.h>

/* clang-format off */
#define BARREL {.width = 320, .height = 240, .fx = 200, .fy = 210, .cx = 150, .cy = 130, .k = {-0.25, 0.07, -0.005}}
#define CUSHION {.width = 320, .height = 240, .fx = 300, .fy = 300, .cx = 160, .cy = 120, .k = {0.15, 0.05}}
#define CROOKED {.width = 200, .height = 260, .fx = 250, .fy = 230, .cx = 120, .cy = 100, .skew = 4, \
                 .k = {-0.1, 0.05, 0.02}, .p = {0.004, -0.006}}
#define RATIONAL {.width = 320, .height = 200, .fx = 180, .fy = 180, .cx = 170, .cy = 90, \
                  .k = {0.4, 0.1, 0.01, 0.6, 0.2, 0.02}, .p = {-0.001, 0.002}}
#define EIGHTH {.width = 240, .height = 240, .fx = 200, .fy = 200, .cx = 120, .cy = 120, .k = {-0.2, 0.1, -0.06}, .k8 = 0.03}
#define FISHEYE {.width = 320, .height = 240, .fx = 260, .fy = 265, .cx = 165, .cy = 118, .k = {0.03, -0.02, 0.01, -0.003}, \
                 .is_fisheye = 1}
#define SHEARED {.width = 100, .height = 80, .fx = 90, .fy = 80, .cx = 40, .cy = 45, .skew = -12}
/* The camera's axis is outside of the image, which is a crop of a larger one. */
#define ASIDE {.width = 100, .height = 80, .fx = 300, .fy = 300, .cx = -60, .cy = 140, .k = {-0.2, 0.05}, .p = {0.001, 0}}
/* clang-format on */

static const adcgs_lens lenses[] = {BARREL, CUSHION, CROOKED, RATIONAL, EIGHTH, SHEARED, ASIDE, FISHEYE};

static void expect_good(adcgs_status status)
{
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
}

/* ---- The model ---- */

/** The formula of lens.h, term by term. */
static void reference(const adcgs_lens *l, double x, double y, double uv[2])
{
    const double r = hypot(x, y), a = atan(r);
    double above = 1.0 + l->k8 * pow(r, 8), below = 1.0;
    for (int i = 0; i < 3; i++) {
        above += l->k[i] * pow(r, 2 * (i + 1));
        below += l->k[3 + i] * pow(r, 2 * (i + 1));
    }
    double bx = x * above / below + 2 * l->p[0] * x * y + l->p[1] * (r * r + 2 * x * x);
    double by = y * above / below + l->p[0] * (r * r + 2 * y * y) + 2 * l->p[1] * x * y;
    if (l->is_fisheye) {
        const double bent = a + l->k[0] * pow(a, 3) + l->k[1] * pow(a, 5) + l->k[2] * pow(a, 7) + l->k[3] * pow(a, 9);
        bx = r > 0.0 ? bent * x / r : 0.0;
        by = r > 0.0 ? bent * y / r : 0.0;
    }
    uv[0] = l->fx * bx + l->skew * by + l->cx;
    uv[1] = l->fy * by + l->cy;
}

static void test_projection(void **state)
{
    /* By hand: r^2 = 0.25 + 0.0625 = 0.3125; factor 1 + 0.1 r^2 = 1.03125; x' = 0.515625 + 2 p1 xy + p2 (r^2 + 2 x^2). */
    const adcgs_lens plain =
        {.width = 10, .height = 10, .fx = 100, .fy = 200, .cx = 5, .cy = 7, .skew = 10, .k = {0.1}, .p = {0.01, 0.02}};
    double uv[2], expected[2];
    adcgs_lens_project(&plain, 0.5, 0.25, uv);
    assert_true(fabs(uv[0] - (100 * (0.515625 + 0.0025 + 0.01625) + 10 * (0.2578125 + 0.004375 + 0.005) + 5)) < 1e-12);
    assert_true(fabs(uv[1] - (200 * (0.2578125 + 0.004375 + 0.005) + 7)) < 1e-12);
    for (size_t n = 0; n < ADCGS_COUNTOF(lenses); n++)
        for (int i = -10; i <= 10; i++)
            for (int j = -10; j <= 10; j++) {
                adcgs_lens_project(&lenses[n], 0.1 * i, 0.1 * j, uv);
                reference(&lenses[n], 0.1 * i, 0.1 * j, expected);
                assert_true(fabs(uv[0] - expected[0]) < 1e-9 && fabs(uv[1] - expected[1]) < 1e-9);
            }
}

/** Projection inverts unprojection over the whole image, edges included. Directions increase along rows: one branch only. */
static void test_inverse(void **state)
{
    for (size_t n = 0; n < ADCGS_COUNTOF(lenses); n++)
        for (int j = 0; j <= 40; j++) {
            double before = -HUGE_VAL;
            for (int i = 0; i <= 40; i++) {
                const double u = lenses[n].width * i / 40.0, v = lenses[n].height * j / 40.0;
                double xy[2], uv[2];
                assert_true(adcgs_lens_unproject(&lenses[n], u, v, xy));
                adcgs_lens_project(&lenses[n], xy[0], xy[1], uv);
                assert_true(fabs(uv[0] - u) < 1e-8 && fabs(uv[1] - v) < 1e-8);
                assert_true(xy[0] > before);
                before = xy[0];
            }
        }
}

/** r - r^3 grows until r = 1/sqrt(3), where it is 2/(3 sqrt(3)). Nothing is seen further out; the inverse is the near branch. */
static void test_fold(void **state)
{
    adcgs_lens fold = {.width = 74, .height = 10, .fx = 100, .fy = 100, .cx = 37, .cy = 5, .k = {-1.0}};
    const double most = 100.0 * 2.0 / (3.0 * sqrt(3.0));
    adcgs_camera camera = {0};
    double xy[2];
    for (int turn = 0; turn < 8; turn++) {
        const double c = cos(turn), s = sin(turn);
        assert_true(adcgs_lens_unproject(&fold, 37 + c * (most - 1e-3), 5 + s * (most - 1e-3), xy));
        assert_true(hypot(xy[0], xy[1]) < 1.0 / sqrt(3.0) && hypot(xy[0], xy[1]) > 0.57);
        assert_false(adcgs_lens_unproject(&fold, 37 + c * (most + 1e-3), 5 + s * (most + 1e-3), xy));
    }
    expect_good(adcgs_lens_pinhole(&fold, &camera, "x", &error)); /* corners at 37.3 pixels */
    assert_true(camera.width > 74);
    fold.width = 80;
    fold.cx = 40;
    expect_error(adcgs_lens_pinhole(&fold, &camera, "some.json", &error), ADCGS_ERR_DATA, "some.json: ", "folds inside");
    /* The model would grow again further out. The first fold counts. */
    fold.k[1] = 10.0;
    fold.k[0] = -5.0;
    assert_true(adcgs_lens_unproject(&fold, 41, 5, xy) && xy[0] < 0.05);
    assert_false(adcgs_lens_unproject(&fold, 40 + 40, 5, xy));
    /* A pole: 1/(1 - r^2) reaches every place in the image before r is 1. */
    const adcgs_lens pole = {.width = 80, .height = 10, .fx = 10, .fy = 10, .cx = 40, .cy = 5, .k = {0, 0, 0, -1.0}};
    assert_true(adcgs_lens_unproject(&pole, 80, 5, xy) && xy[0] < 1.0);
    /* Tangential terms fold too. */
    adcgs_lens bent = {.width = 80, .height = 80, .fx = 40, .fy = 40, .cx = 40, .cy = 40, .p = {0.3, 0}};
    expect_error(adcgs_lens_pinhole(&bent, &camera, "x", &error), ADCGS_ERR_DATA, "x: ", "folds inside");
}

/**
 * A circular image that also shows the scene behind the lens. The pinhole of the same focal lengths sees 60 degrees to each side
 * of the axis.
 */
/* clang-format off */
#define CIRCLE {.width = 400, .height = 300, .fx = 100, .fy = 101, .cx = 190, .cy = 210, .k = {0.04, -0.01, 0.002, -0.0003}, \
                .is_fisheye = 1}
/* clang-format on */

/** The inverse exists up to 89.4 degrees from the axis and not beyond. */
static void test_angles(void **state)
{
    const adcgs_lens circle = CIRCLE;
    double uv[2], xy[2];
    for (int turn = 0; turn < 12; turn++)
        for (int tenth = 0; tenth < 894; tenth++) {
            const double angle = tenth * 0.1 * M_PI / 180.0, x = tan(angle) * cos(turn), y = tan(angle) * sin(turn);
            reference(&circle, x, y, uv);
            assert_true(adcgs_lens_unproject(&circle, uv[0], uv[1], xy));
            assert_true(fabs(atan(hypot(xy[0], xy[1])) - angle) < 1e-10);
            assert_true(hypot(xy[0] - x, xy[1] - y) < 1e-9 * (1.0 + x * x + y * y));
        }
    reference(&circle, 1e9, 0, uv);
    assert_false(adcgs_lens_unproject(&circle, uv[0], uv[1], xy)); /* 90 degrees */
    assert_false(adcgs_lens_unproject(&circle, uv[0] + 20, uv[1], xy));
    adcgs_lens_project(&circle, 0.0, 0.0, uv);
    assert_true(uv[0] == circle.cx && uv[1] == circle.cy);
}

/** A fold of the model is an error only inside the image, or inside the part that the pinhole keeps. */
static void test_fisheye_folds(void **state)
{
    /* a - a^3 / 3 k grows up to a = sqrt(k). */
    adcgs_lens lens = {.width = 400, .height = 400, .fx = 100, .fy = 100, .cx = 200, .cy = 200, .is_fisheye = 1};
    adcgs_camera c = {0};
    const double corner = atan(sqrt(6.0)); /* of the part that the pinhole keeps */
    lens.k[0] = -1.0 / (3.0 * pow(corner + 0.01, 2));
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    lens.k[0] = -1.0 / (3.0 * pow(corner - 0.01, 2));
    expect_error(adcgs_lens_pinhole(&lens, &c, "cams.json", &error), ADCGS_ERR_DATA, "cams.json: ", "folds inside");
    lens.width = lens.height = 60; /* half the fold's radius reaches this corner, 42 pixels from the axis at focal length 100 */
    lens.cx = lens.cy = 30;
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    lens.k[0] = -3.0;
    expect_error(adcgs_lens_pinhole(&lens, &c, "x", &error), ADCGS_ERR_DATA, "x: ", "folds inside");
}

static void test_nonsense(void **state)
{
    static const double values[] = {NAN, INFINITY, -INFINITY, 1e308, -1e308, 1e300, 1e17, -1e17, 1e6, 0.0};
    double xy[2];
    for (size_t i = 0; i < ADCGS_COUNTOF(values); i++)
        for (size_t field = 2; field < 2 * sizeof(adcgs_lens) / sizeof(double); field++) {
            adcgs_lens lens = field % 2 ? (adcgs_lens)CROOKED : (adcgs_lens)FISHEYE;
            adcgs_camera camera = {0};
            memcpy((char *)&lens + field / 2 * sizeof(double), &values[i], sizeof(double));
            error = (adcgs_error){0};
            (void)adcgs_lens_unproject(&lens, 3, 4, xy);
            if (adcgs_lens_pinhole(&lens, &camera, "x", &error) == ADCGS_OK)
                assert_true(camera.width >= 1 && camera.width <= ADCGS_IMAGE_MAX && camera.height >= 1 &&
                            camera.height <= ADCGS_IMAGE_MAX);
            else
                assert_true(error.status == ADCGS_ERR_DATA && error.text[0]);
        }
}

/* ---- Pinholes ---- */

/** True if the lens's image shows the pinhole camera's pixel. */
static int is_shown(const adcgs_lens *lens, const adcgs_camera *c, double u, double v)
{
    double uv[2], back[2];
    const double x = (u - c->cx) / c->fx, y = (v - c->cy) / c->fy;
    reference(lens, x, y, uv);
    if (!(uv[0] >= -1e-5 && uv[1] >= -1e-5 && uv[0] <= lens->width + 1e-5 && uv[1] <= lens->height + 1e-5))
        return 0;
    return adcgs_lens_unproject(lens, uv[0], uv[1], back) && hypot(back[0] - x, back[1] - y) < 1e-7; /* not beyond a fold */
}

/** All corners of pixels are shown, and no side could be extended by a whole row or column. */
static void test_coverage(void **state)
{
    for (size_t n = 0; n < ADCGS_COUNTOF(lenses); n++) {
        adcgs_lens lens = lenses[n];
        adcgs_camera c = {0};
        int beyond[4] = {1, 1, 1, 1};
        expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
        assert_true(lens.width == lenses[n].width && c.fx == lens.fx && c.fy == lens.fy);
        assert_true(c.cx - lens.cx == floor(c.cx - lens.cx) && c.cy - lens.cy == floor(c.cy - lens.cy));
        for (int j = 0; j <= c.height; j++)
            for (int i = 0; i <= c.width; i++)
                assert_true(is_shown(&lens, &c, i, j));
        for (int j = 0; j <= c.height; j++) {
            beyond[0] &= is_shown(&lens, &c, -1, j);
            beyond[1] &= is_shown(&lens, &c, c.width + 1, j);
        }
        for (int i = 0; i <= c.width; i++) {
            beyond[2] &= is_shown(&lens, &c, i, -1);
            beyond[3] &= is_shown(&lens, &c, i, c.height + 1);
        }
        assert_false(beyond[0] || beyond[1] || beyond[2] || beyond[3]);
    }
}

/** The area of the largest rectangle, by exhaustive search: shown[j][i] counts the covered places in a row up to there. */
static int largest_by_trying(const adcgs_lens *lens)
{
    enum { LOW = -40, N = 160 };
    static int shown[N][N];
    const adcgs_camera plane = {.fx = lens->fx, .fy = lens->fy, .cx = lens->cx, .cy = lens->cy};
    int best = 0;
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
            shown[j][i] = is_shown(lens, &plane, i + LOW, j + LOW) ? (i ? shown[j][i - 1] : 0) + 1 : 0;
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++)
            for (int down = j, least = N; down < N; down++) {
                least = ADCGS_MIN(least, shown[down][i]);
                best = ADCGS_MAX(best, (least - 1) * (down - j));
            }
    return best;
}

static void test_largest(void **state)
{
    static const adcgs_lens small[] = {
        {.width = 60, .height = 40, .fx = 40, .fy = 40, .cx = 25, .cy = 23, .k = {-0.25, 0.07}},
        {.width = 60, .height = 40, .fx = 60, .fy = 50, .cx = 30, .cy = 20, .k = {0.2, 0.1}, .p = {0.01, -0.01}},
        {.width = 80, .height = 70, .fx = 60, .fy = 60, .cx = 40, .cy = 35, .skew = 30},
        {.width = 50, .height = 50, .fx = 190, .fy = 190, .cx = -20, .cy = 70, .k = {-0.3}},
    };
    for (size_t n = 0; n < ADCGS_COUNTOF(small); n++) {
        adcgs_lens lens = small[n];
        adcgs_camera c = {0};
        expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
        assert_int_equal(c.width * c.height, largest_by_trying(&small[n]));
    }
}

/** The part of a circular image that the pinhole keeps. */
static void test_circle(void **state)
{
    adcgs_lens lens = CIRCLE;
    adcgs_camera c = {0};
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    assert_true(c.fx == 100 && c.fy == 101 && lens.width == 400);
    assert_true(c.width == 2 * floor(100 * sqrt(3)) && c.cx == floor(100 * sqrt(3))); /* 60 degrees to each side */
    assert_true(c.height - c.cy > 90 && c.height - c.cy < floor(101 * sqrt(3)));      /* below the axis the image ends earlier */
    assert_true(c.cy == floor(101 * sqrt(3)));
    for (int j = 0; j <= c.height; j++)
        for (int i = 0; i <= c.width; i++)
            assert_true(is_shown(&lens, &c, i, j));
}

static void test_flat(void **state)
{
    adcgs_lens lens = {.width = 60, .height = 40, .fx = 50, .fy = 51, .cx = 29, .cy = 18};
    adcgs_camera c = {.near_plane = 3, .name = "kept"};
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    assert_true(lens.width == 0 && c.width == 60 && c.height == 40 && c.fx == 50 && c.fy == 51 && c.cx == 29 && c.cy == 18);
    assert_true(c.near_plane == 3 && !strcmp(c.name, "kept"));
    lens.width = 60;
    lens.k[0] = 1e-4; /* moves the corner by less than a hundredth of a pixel */
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    assert_int_equal(lens.width, 0);
    lens.width = 60;
    lens.k[0] = 1e-2;
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    assert_int_equal(lens.width, 60);
    /* A shear so steep that less than a tenth is left. */
    lens = (adcgs_lens){.width = 60, .height = 40, .fx = 50, .fy = 50, .cx = 30, .cy = 20, .skew = 1000};
    expect_error(adcgs_lens_pinhole(&lens, &c, "cam.json", &error), ADCGS_ERR_DATA, "cam.json: ", "a tenth");
}

/* ---- Images ---- */

/** A smooth scene: no feature is smaller than a tenth of the focal length. */
static double pattern_at(double x, double y, int channel)
{
    return 0.5 + 0.3 * sin(20 * x + channel) * cos(17 * y - channel) + 0.1 * sin(11 * (x + y));
}

/** The image of that scene through a lens. */
static void draw(adcgs_image *image, const adcgs_lens *lens, int channels)
{
    const double fold = adcgs_lens_fold(lens);
    expect_good(adcgs_image_alloc(image, lens->width, lens->height, channels, "x", &error));
    for (int j = 0; j < image->height; j++)
        for (int i = 0; i < image->width; i++) {
            double xy[2];
            const int shown = adcgs_lens_invert(lens, fold, i + 0.5, j + 0.5, xy);
            assert_true(shown || lens->is_fisheye); /* a fisheye also sees behind itself */
            for (int c = 0; c < channels; c++)
                image->data[(j * image->width + i) * channels + c] = shown ? (float)pattern_at(xy[0], xy[1], c) : 0.0f;
        }
}

/** The undistorted image against the pinhole camera's view of the scene. */
typedef struct differences {
    double inside, mean, edge; /**< largest and root mean square inside; largest in the outermost two pixels */
} differences;

static differences compare(adcgs_lens lens, int channels)
{
    enum { EDGE = 2 };
    adcgs_camera c = {0};
    adcgs_image image;
    differences d = {0.0, 0.0, 0.0};
    double n = 0.0;
    draw(&image, &lens, channels);
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    expect_good(adcgs_lens_straighten(&lens, &c, &image, "x", &error));
    assert_true(image.width == c.width && image.height == c.height && image.channels == channels);
    for (int i = 0; i < c.height * c.width * channels; i++) {
        const int x = i / channels % c.width, y = i / channels / c.width;
        const double truth = pattern_at((x + 0.5 - c.cx) / c.fx, (y + 0.5 - c.cy) / c.fy, i % channels);
        const double off = fabs((double)image.data[i] - truth);
        if (x >= EDGE && y >= EDGE && x < c.width - EDGE && y < c.height - EDGE) {
            d.inside = fmax(d.inside, off);
            d.mean += off * off;
            n++;
        } else
            d.edge = fmax(d.edge, off);
    }
    d.mean = sqrt(d.mean / n);
    adcgs_image_free(&image);
    return d;
}

static adcgs_lens enlarge(adcgs_lens lens, int times)
{
    lens.width *= times;
    lens.height *= times;
    lens.fx *= times;
    lens.fy *= times;
    lens.cx *= times;
    lens.cy *= times;
    lens.skew *= times;
    return lens;
}

/**
 * Errors are below one grey level of 8 bits inside and below two at the edge, where pixels are repeated. They fall with the third
 * power of the pixel's size. At peaks, which are clamped to the range of their pixels, they fall with the second.
 */
static void test_straightened(void **state)
{
    for (size_t n = 0; n < ADCGS_COUNTOF(lenses); n++) {
        const adcgs_lens lens = enlarge(lenses[n], lenses[n].fx < 100 ? 2 : 1);
        const differences d = compare(lens, 3), fine = compare(enlarge(lens, 2), 1);
        print_message("lens %zu: %.1e inside, mean %.1e, edge %.1e; at twice the size %.1e, %.1e, %.1e\n", n, d.inside, d.mean,
                      d.edge, fine.inside, fine.mean, fine.edge);
        assert_true(d.inside < 0.0025 && d.edge < 0.008);
        assert_true(fine.mean < d.mean / 5.0 && fine.inside < d.inside / 2.5);
    }
}

/**
 * The same for a circular image, whose pixels far from the axis span a wider angle than the pinhole's. A larger image has smaller
 * errors.
 */
static void test_circle_straightened(void **state)
{
    const adcgs_lens lens = enlarge((adcgs_lens)CIRCLE, 2);
    const differences d = compare(lens, 3), fine = compare(enlarge(lens, 2), 1);
    print_message("%.1e inside, mean %.1e, edge %.1e; at twice the size %.1e, %.1e, %.1e\n", d.inside, d.mean, d.edge,
                  fine.inside, fine.mean, fine.edge);
    assert_true(d.inside < 0.02 && d.edge < 0.02 && d.mean < 0.002);
    assert_true(fine.mean < d.mean / 5.0 && fine.inside < d.inside / 2.5);
}

/** Undistortion invents nothing: values stay in the range of their surroundings, and one colour stays that colour. */
static void test_range(void **state)
{
    adcgs_lens lens = BARREL;
    adcgs_camera c = {0};
    adcgs_image image;
    int between = 0;
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    expect_good(adcgs_image_alloc(&image, lens.width, lens.height, 1, "x", &error));
    for (int i = 0; i < lens.width * lens.height; i++)
        image.data[i] = i * 2654435761u >> 31 ? 1.0f : 0.0f;
    expect_good(adcgs_lens_straighten(&lens, &c, &image, "x", &error));
    for (int i = 0; i < c.width * c.height; i++) {
        assert_true(image.data[i] >= 0.0f && image.data[i] <= 1.0f);
        between += image.data[i] > 0.0f && image.data[i] < 1.0f;
    }
    assert_true(between > c.width * c.height / 2);
    adcgs_image_free(&image);
    expect_good(adcgs_image_alloc(&image, lens.width, lens.height, 3, "x", &error));
    for (int i = 0; i < lens.width * lens.height * 3; i++)
        image.data[i] = 0.3f;
    expect_good(adcgs_lens_straighten(&lens, &c, &image, "x", &error));
    for (int i = 0; i < c.width * c.height * 3; i++)
        assert_true(image.data[i] == 0.3f);
    adcgs_image_free(&image);
}

/** The colours of transparent pixels do not leak into their neighbours. */
static void test_alpha(void **state)
{
    adcgs_lens lens = CUSHION;
    adcgs_camera c = {0};
    adcgs_image image;
    int partly = 0;
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    expect_good(adcgs_image_alloc(&image, lens.width, lens.height, 4, "x", &error));
    for (int i = 0; i < lens.width * lens.height; i++) {
        const int opaque = i % lens.width > 100 && i / lens.width > 90;
        const float pixel[4] = {opaque ? 0.25f : 1.0f, 0.5f, opaque ? 0.75f : 0.0f, opaque ? 1.0f : 0.0f};
        memcpy(image.data + 4 * i, pixel, sizeof pixel);
    }
    expect_good(adcgs_lens_straighten(&lens, &c, &image, "x", &error));
    for (int i = 0; i < c.width * c.height; i++) {
        const float *pixel = image.data + 4 * i;
        assert_true(pixel[3] >= 0.0f && pixel[3] <= 1.0f);
        partly += pixel[3] > 0.01f && pixel[3] < 0.99f;
        if (pixel[3] > 1e-3f)
            assert_true(fabsf(pixel[0] - 0.25f) < 1e-4f && fabsf(pixel[1] - 0.5f) < 1e-4f && fabsf(pixel[2] - 0.75f) < 1e-4f);
    }
    assert_true(partly > 100);
    adcgs_image_free(&image);
}

/* ---- A real calibration ---- */

static double cell(json_t *rows, size_t i, size_t j)
{
    return json_number_value(json_array_get(json_array_get(rows, i), j));
}

/** One camera of the calibration. Its pixels have their centres at whole numbers; D is k1 k2 p1 p2 k3. */
static adcgs_lens read_lens(json_t *k, json_t *d)
{
    return (adcgs_lens){.width = 1024,
                        .height = 1024,
                        .fx = cell(k, 0, 0),
                        .fy = cell(k, 1, 1),
                        .cx = cell(k, 0, 2) + 0.5,
                        .cy = cell(k, 1, 2) + 0.5,
                        .skew = cell(k, 0, 1),
                        .k = {cell(d, 0, 0), cell(d, 1, 0), cell(d, 4, 0)},
                        .p = {cell(d, 2, 0), cell(d, 3, 0)}};
}

/** Projects a point with the pinhole camera of the published, undistorted images. */
static void see(const adcgs_camera *c, const double point[3], double uv[2])
{
    const double *m = c->cam_to_world;
    double p[3];
    for (int a = 0; a < 3; a++)
        p[a] = m[a] * (point[0] - m[3]) + m[4 + a] * (point[1] - m[7]) + m[8 + a] * (point[2] - m[11]);
    uv[0] = c->fx * p[0] / p[2] + c->cx;
    uv[1] = c->fy * p[1] / p[2] + c->cy;
}

/**
 * Projects triangulated points through the calibration's poses (millimetres) and lens, and back from the original image. The
 * pinhole camera at half the size sees them where the published cameras do.
 */
static void check_camera(const adcgs_scene *scene, const adcgs_camera *pinhole, json_t *all, size_t i, double *bent,
                         uint32_t *inside)
{
    const adcgs_lens lens = read_lens(json_array_get(json_object_get(all, "K"), i), json_array_get(json_object_get(all, "D"), i));
    json_t *r = json_array_get(json_object_get(all, "R"), i), *t = json_array_get(json_object_get(all, "T"), i);
    for (uint32_t n = 0; n < scene->points.n; n++) {
        const double *point = scene->points.position[n];
        double p[3], seen[2], uv[2], xy[2];
        for (size_t a = 0; a < 3; a++)
            p[a] = cell(r, a, 0) * point[0] + cell(r, a, 1) * point[1] + cell(r, a, 2) * point[2] + cell(t, a, 0) / 1000.0;
        adcgs_lens_project(&lens, p[0] / p[2], p[1] / p[2], uv);
        see(pinhole, point, seen);
        if (!(p[2] > 0.0 && seen[0] >= 0.0 && seen[1] >= 0.0 && seen[0] <= pinhole->width && seen[1] <= pinhole->height))
            continue; /* some points are so far off the axis that the model folds before it reaches them */
        (*inside)++;
        *bent = fmax(*bent, hypot(0.5 * uv[0] - seen[0], 0.5 * uv[1] - seen[1]));
        assert_true(adcgs_lens_unproject(&lens, uv[0], uv[1], xy));
        assert_true(fabs(0.5 * (lens.fx * xy[0] + lens.cx) - seen[0]) < 1e-3);
        assert_true(fabs(0.5 * (lens.fy * xy[1] + lens.cy) - seen[1]) < 1e-3);
    }
    adcgs_lens usable = lens;
    adcgs_camera c = {0};
    expect_good(adcgs_lens_pinhole(&usable, &c, "x", &error));
    assert_true(c.width > 1000 && c.height > 1000);
}

static void test_ring(void **state)
{
    char file[1100];
    const char *path = real_data("zju313_15f");
    adcgs_scene *scene;
    double bent = 0.0;
    uint32_t inside = 0;
    int cameras = 0;
    expect_good(adcgs_scene_open(&scene, path, NULL, &error));
    snprintf(file, sizeof file, "%s/calibration_original.json", path);
    json_t *root = json_load_file(file, 0, NULL), *all = json_object_get(json_object_get(root, "cams"), "20190823");
    assert_int_equal(json_array_size(json_object_get(all, "D")), 21);
    for (int s = 0; s < ADCGS_SPLITS; s++)
        for (uint32_t v = 0; v < scene->n_views[s]; v++) {
            unsigned int camera, frame;
            assert_int_equal(sscanf(strstr(scene->views[s][v].path, "/cam"), "/cam%u/frame_%u", &camera, &frame), 2);
            if (frame == 1) {
                check_camera(scene, &scene->views[s][v].camera, all, camera - 1, &bent, &inside);
                cameras++;
            }
        }
    assert_true(cameras == 21 && inside > 21 * scene->points.n * 9 / 10 && bent > 1.0); /* the distortion is more than nothing */
    print_message("%u points visible; distortion moves them by up to %.2f pixels of 512\n", inside, bent);
    json_decref(root);
    adcgs_scene_free(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_projection), cmocka_unit_test(test_inverse),       cmocka_unit_test(test_fold),
        cmocka_unit_test(test_angles),     cmocka_unit_test(test_fisheye_folds), cmocka_unit_test(test_circle),
        cmocka_unit_test(test_nonsense),   cmocka_unit_test(test_coverage),      cmocka_unit_test(test_largest),
        cmocka_unit_test(test_flat),       cmocka_unit_test(test_straightened),  cmocka_unit_test(test_range),
        cmocka_unit_test(test_alpha),      cmocka_unit_test(test_ring),          cmocka_unit_test(test_circle_straightened),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
