/* SPDX-License-Identifier: BSD-2-Clause */
/** \file PLY files of splats. */
#ifndef ADCGS_TESTS_PLY_SPLATS_H
#define ADCGS_TESTS_PLY_SPLATS_H

#include "random_splats.h"

#include "media/splats/splats.h"

#include <adcgs/adcgs.h>

#include <math.h>

#define NAMES 14
static const char *const names[NAMES] = {"x",       "y",       "z",       "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
                                         "scale_0", "scale_1", "scale_2", "rot_0",  "rot_1",  "rot_2",  "rot_3"};

/* ---- Files made here ---- */

/** Writes a PLY as text: all properties except `left_out`, `odd` with another type, n_rest of f_rest_*, then lines. */
static inline void put_splats(const char *name, const char *left_out, const char *odd, const char *odd_type, int n_rest,
                              const char *count, const char *lines)
{
    char text[8192];
    int n = snprintf(text, sizeof text, "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex %s\n", count);
    for (int i = 0; i < NAMES; i++)
        if (!left_out || strcmp(left_out, names[i]))
            n += snprintf(text + n, sizeof text - (size_t)n, "property %s %s\n",
                          odd && !strcmp(odd, names[i]) ? odd_type : "float", names[i]);
    for (int i = 0; i < n_rest; i++)
        n += snprintf(text + n, sizeof text - (size_t)n, "property float f_rest_%d\n", i);
    n += snprintf(text + n, sizeof text - (size_t)n, "end_header\n%s", lines);
    put_bytes(name, text, (size_t)n);
}

/* Relative errors of the numbers in a file. A scale is stored as a logarithm: one of up to 32 has an error of 2^-20. */
#define OPACITY_ERROR 1e-6
#define SCALE_ERROR 3e-6

#define GOOD "1 -2 0.5 0 1 -1 0 0 -1 1 2 0 0 0\n"

#endif
