/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Lenses for tests, and their projection in double. */
#ifndef ADCGS_TESTS_LENS_REFERENCE_H
#define ADCGS_TESTS_LENS_REFERENCE_H

#include "outside_files.h"

#include "scene/lens_model.h"

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

static inline int unproject(const adcgs_lens *lens, double u, double v, double xy[2])
{
    return adcgs_lens_invert(lens, adcgs_lens_fold(lens), u, v, xy);
}

static inline void expect_good(adcgs_status status)
{
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
}

/** The formula of lens.h, term by term. */
static inline void reference(const adcgs_lens *l, double x, double y, double uv[2])
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

/**
 * A circular image that also shows the scene behind the lens. The pinhole of the same focal lengths sees 60 degrees to each side
 * of the axis.
 */
/* clang-format off */
#define CIRCLE {.width = 400, .height = 300, .fx = 100, .fy = 101, .cx = 190, .cy = 210, .k = {0.04, -0.01, 0.002, -0.0003}, \
                .is_fisheye = 1}
/* clang-format on */

#endif
