/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Reads the PLY of SpacetimeGaussians (Li et al., 2024): positions are cubic in time, opacities fade without a half in the
 * exponent, f_dc_0..2 are RGB. Time runs from 0 to 1; frame i is at i / frames. The full model, with f_t_0, has a network for its
 * colours in another file.
 */
#include "config.h"

#include "media/dynamic/activate.h"
#include "media/dynamic/motion.h"
#include "media/dynamic/ply_columns.h"
#include "media/dynamic/dynamic_readers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static int is_stg(const uint8_t *data, size_t bytes)
{
    return adcgs_ply_is(data, bytes) && adcgs_ply_declares(data, bytes, "trbf_center");
}

/** Numbers before activation become those of a motion; seconds: of the unit of time. */
static adcgs_status activate(adcgs_motion *m, double seconds, const char *path, adcgs_error *error)
{
    adcgs_splats_activate(&m->base);
    for (uint32_t i = 0; i < m->base.n; i++)
        m->sigma[i] = (float)(exp((double)m->sigma[i]) * sqrt(0.5)); /* exp(-(dt/s)^2) = exp(-dt^2 / (2 (s/sqrt 2)^2)) */
    adcgs_motion_stretch(m, seconds);
    return adcgs_motion_check(m, path, error);
}

static adcgs_status with_columns(adcgs_motion *m, adcgs_ply *ply, adcgs_ply_columns_fn use)
{
    const adcgs_ply_column own[] = {
        {"trbf_center", m->centre, 1},    {"trbf_scale", m->sigma, 1},      {"motion_0", m->motion[0][0], 1},
        {"motion_1", m->motion[0][1], 1}, {"motion_2", m->motion[0][2], 1}, {"motion_3", m->motion[1][0], 1},
        {"motion_4", m->motion[1][1], 1}, {"motion_5", m->motion[1][2], 1}, {"motion_6", m->motion[2][0], 1},
        {"motion_7", m->motion[2][1], 1}, {"motion_8", m->motion[2][2], 1}, {"omega_0", m->turn[0], 1},
        {"omega_1", m->turn[1], 1},       {"omega_2", m->turn[2], 1},       {"omega_3", m->turn[3], 1},
    };
    adcgs_ply_column columns[ADCGS_PLY_SPLAT_COLUMNS + ADCGS_COUNTOF(own)];
    adcgs_ply_splat_columns(columns, &m->base);
    memcpy(columns + ADCGS_PLY_SPLAT_COLUMNS, own, sizeof own);
    return use(ply, columns, ADCGS_COUNTOF(columns));
}

static adcgs_status read(adcgs_dynamic *m, adcgs_ply *ply, adcgs_error *error)
{
    if (adcgs_ply_find(ply, "f_t_0")) {
        if (!m->options.partial)
            return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED,
                              "%s: SpacetimeGaussians' full model (it has f_t_0): its colours need a network that the file does "
                              "not contain; --partial takes the first three as colours",
                              m->path);
        snprintf(m->remark, sizeof m->remark, "SpacetimeGaussians' full model without its network: colours are approximate");
    }
    adcgs_motion *const motion = m->state = calloc(1, sizeof *motion);
    if (!motion)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", m->path);
    ADCGS_TRY(with_columns(motion, ply, adcgs_ply_find_columns)); /* before memory is allocated for them */
    ADCGS_TRY(adcgs_motion_alloc(motion, ply->vertex.count, ADCGS_MOTION_ORDERS, ADCGS_MOTION_TURNS, m->path, error));
    ADCGS_TRY(with_columns(motion, ply, adcgs_ply_columns));
    adcgs_dynamic_set_clock(m, (adcgs_fps){0, 0}, 0);
    m->n = motion->base.n;
    m->has_identity = m->is_continuous = 1;
    return activate(motion, m->frames / adcgs_fps_value(m->rate), m->path, error);
}

static adcgs_status open_stg(adcgs_dynamic *m, adcgs_error *error)
{
    adcgs_ply *ply;
    ADCGS_TRY(adcgs_ply_open(&ply, m->data, m->bytes, m->path, error));
    const adcgs_status status = read(m, ply, error);
    adcgs_ply_close(&ply);
    return status;
}

const adcgs_dynamic_reader adcgs_dynamic_stg = {"SpacetimeGaussians PLY",  is_stg, 0, open_stg, adcgs_dynamic_motion_at,
                                                adcgs_dynamic_motion_close};
