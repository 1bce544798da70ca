/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writes FTGS PLY version 1 (media/dynamic/ftgs.c reads it): time runs from 0 to 1, positions are linear in it. */
#include "config.h"

#include "media/dynamic/splat_paths.h"
#include "media/splats/offset.h"
#include "system/atomic.h"

#include <math.h>

#define COLUMNS 22          /* floats of a row; definition (FTGS), with normals */
#define OPACITY_MIN 1e-6    /* lower bound of opacities, which have logits; chosen by hand, not measured */
#define DURATION_MIN 0.0001 /* comment min_duration, of the clip, below that of pieces; chosen by hand, not measured */

static void put_header(FILE *file, const adcgs_pieces *p, const char *comment)
{
    static const char *const names[COLUMNS] = {"x",          "y",         "z",       "nx",           "ny",
                                               "nz",         "f_dc_0",    "f_dc_1",  "f_dc_2",       "opacity",
                                               "scale_0",    "scale_1",   "scale_2", "rot_0",        "rot_1",
                                               "rot_2",      "rot_3",     "time",    "log_duration", "velocity_0",
                                               "velocity_1", "velocity_2"};
    fprintf(file,
            "ply\nformat binary_little_endian 1.0\ncomment %s\ncomment ftgs_version 1\ncomment time_units normalized\ncomment "
            "sh_degree 0\ncomment use_velocity 1\ncomment min_duration %g\ncomment opacity_floor 0\ncomment n_frames %u\n",
            comment, DURATION_MIN, p->clip);
    if (adcgs_offset_is(p->offset))
        fprintf(file, "comment offset %.17g %.17g %.17g\n", p->offset[0], p->offset[1], p->offset[2]);
    fprintf(file, "element vertex %u\n", p->n);
    for (int i = 0; i < COLUMNS; i++)
        fprintf(file, "property float %s\n", names[i]);
    fputs("end_header\n", file);
}

/** unit: frames of the whole clip. */
static void put_row(FILE *file, const adcgs_piece *p, double unit)
{
    uint8_t record[4 * COLUMNS];
    float v[COLUMNS] = {0};
    const double opacity = fmax((double)p->opacity, OPACITY_MIN);
    v[9] = (float)log(opacity / (1.0 - opacity));
    v[17] = (float)((double)p->centre / unit);
    v[18] = (float)log((double)p->sigma / (p->sigma < ADCGS_PIECE_FOREVER ? unit : 1.0));
    for (int a = 0; a < 3; a++) {
        v[a] = p->mean[a];
        v[6 + a] = (float)(((double)p->colour[a] - 0.5) / ADCGS_SPLATS_DC);
        v[10 + a] = (float)log((double)p->scale[a]);
        v[19 + a] = (float)((double)p->motion[0][a] * unit);
    }
    for (int a = 0; a < 4; a++)
        v[13 + a] = p->rotation[a];
    for (int i = 0; i < COLUMNS; i++)
        adcgs_store_le32(record + 4 * i, adcgs_float_bits(v[i]));
    fwrite(record, sizeof record, 1, file);
}

adcgs_status adcgs_ftgs_write(const adcgs_pieces *pieces, const char *comment, const char *path, adcgs_error *error)
{
    adcgs_atomic atomic;
    ADCGS_TRY(adcgs_atomic_open(&atomic, path, error));
    put_header(atomic.file, pieces, comment);
    for (uint32_t i = 0; i < pieces->n; i++)
        put_row(atomic.file, &pieces->piece[i], ADCGS_MAX(pieces->clip - 1.0, 1.0));
    return adcgs_atomic_commit(&atomic, error);
}
