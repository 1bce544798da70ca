/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writing splats as PLY. */
#include "config.h"

#include "media/splats/splats_ply.h"

#include "media/splats/offset.h"

#include <math.h>

/* Origin: definition (properties of 3D Gaussian splatting's PLY files). */
#define WRITTEN 17  /* floats per splat without f_rest_* */
#define DC_END 9    /* index of the first of these after f_rest_* */
#define REST_MAX 45 /* of f_rest_*, 3 channels of degrees 1 to 3 */

/** Number of f_rest_* properties up to a degree. */
static int rest_count(int degree)
{
    return 3 * ((degree + 1) * (degree + 1) - 1);
}

static void put_header(FILE *file, const adcgs_splats *s, const adcgs_splats_style *style)
{
    static const char *const names[WRITTEN] = {"x",       "y",      "z",      "nx",      "ny",      "nz",
                                               "f_dc_0",  "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1",
                                               "scale_2", "rot_0",  "rot_1",  "rot_2",   "rot_3"};
    fprintf(file, "ply\nformat binary_little_endian 1.0\ncomment %s\n%s", style->comment,
            s->antialiased ? "comment SplatRenderMode: mip\n" : "");
    if (adcgs_offset_is(s->offset))
        fprintf(file, "comment offset %.17g %.17g %.17g\n", s->offset[0], s->offset[1], s->offset[2]);
    fprintf(file, "element vertex %u\n", s->n);
    for (int i = 0; i < WRITTEN; i++) {
        for (int j = 0; i == DC_END && j < rest_count(style->rest_degree); j++)
            fprintf(file, "property float f_rest_%d\n", j);
        fprintf(file, "property float %s\n", names[i]);
    }
    fputs("end_header\n", file);
}

/** Write a splat's numbers before their activations, each rounded once. */
static void put_splat(FILE *file, const adcgs_splats *s, uint32_t i, int rest_degree)
{
    float values[WRITTEN] = {0};
    uint8_t record[4 * (WRITTEN + REST_MAX)] = {0}, *to = record;
    const double opacity = (double)s->opacity[i];
    values[9] = (float)log(opacity / (1.0 - opacity));
    for (int a = 0; a < 3; a++) {
        values[a] = s->mean[a][i];
        values[6 + a] = (float)(((double)s->colour[a][i] - 0.5) / ADCGS_SPLATS_DC);
        values[10 + a] = (float)log((double)s->scale[a][i]);
    }
    for (int a = 0; a < 4; a++)
        values[13 + a] = s->rotation[a][i];
    for (int j = 0; j < WRITTEN; j++) {
        if (j == DC_END)
            to += 4 * rest_count(rest_degree);
        adcgs_store_le32(to, adcgs_float_bits(values[j]));
        to += 4;
    }
    fwrite(record, (size_t)(to - record), 1, file);
}

adcgs_status adcgs_splats_put_ply(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                                  adcgs_error *error)
{
    for (uint32_t i = 0; i < splats->n; i++)
        if (!(splats->opacity[i] > 0.0f && splats->opacity[i] < 1.0f))
            return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: splat %u: an opacity of %g has no logit", path, i,
                              (double)splats->opacity[i]);
    put_header(file, splats, style);
    for (uint32_t i = 0; i < splats->n; i++)
        put_splat(file, splats, i, style->rest_degree);
    return ADCGS_OK;
}
