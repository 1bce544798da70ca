/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Prediction over groups of 64 anchors: the values that do not depend on time, computed once. These are the canonical
 * primitives and, for groups with a moving anchor, the anchors' part of the deformation networks' first layer. A group without
 * motion is written once and never changes again.
 */
#include "config.h"

#include "base/cpu_detect.h"
#include "base/fmath.h"
#include "splat/splat_priv.h"

#include <stdalign.h>

/* Rows of scratch, in addition to three buffers as wide as the widest network: Sigma_v, f_p and f_v, f_g. */
#define INPUT_ROWS (ADCGS_SIGMA_MAX + 6 * ADCGS_OCTAVES_MAX + ADCGS_NV_MAX + ADCGS_NG_MAX)

/* ---- Inputs of a group ---- */

/*
 * Convert latents of 64 anchors to rows of 64 lanes; lanes past the last anchor are 0. stride: values from anchor to anchor.
 * factor: the factor of each anchor's steps, or NULL.
 */
static void load_rows(float *rows, const int16_t *yq, size_t stride, const float *d, int channels, uint32_t first, uint32_t n,
                      const float *factor)
{
    memset(rows, 0, (size_t)channels * ADCGS_LANES * sizeof *rows);
    for (uint32_t l = 0; l < ADCGS_LANES && first + l < n; l++)
        for (int c = 0; c < channels; c++)
            rows[(size_t)c * ADCGS_LANES + l] = (float)yq[(first + l) * stride + (size_t)c] * (factor ? d[c] * factor[l] : d[c]);
}

static void load_positions(adcgs_anchor_lanes *a, const adcgs_model *m, uint32_t first)
{
    const float half = 0.5f * m->voxel, cell = adcgs_bits_float((uint32_t)(127 - (m->depth + 1)) << 23);
    for (int c = 0; c < 3; c++)
        for (uint32_t l = 0; l < ADCGS_LANES; l++) {
            const uint32_t i = first + l < m->n ? m->pos[3 * (size_t)(first + l) + (size_t)c] : 0;
            const float odd = (float)(2 * i + 1);
            a->position[c][l] = fmaf(odd, half, m->origin[c]);
            a->code[c][l] = odd * cell;
        }
}

static void load_present(int32_t present[ADCGS_LANES], const adcgs_model *m, uint32_t first, int k)
{
    for (uint32_t l = 0; l < ADCGS_LANES; l++)
        present[l] = first + l < m->n && (m->mask[first + l] >> k & 1);
}

/* Factors of a group's steps, indexed by adcgs_group_steps(). */
typedef struct adcgs_group_factors {
    float of[ADCGS_STEPS_MAX][ADCGS_LANES];
} adcgs_group_factors;

static const float *factor_of(const adcgs_model *m, const adcgs_group_factors *factors, int group)
{
    return m->params.adaptive_steps ? factors->of[adcgs_group_steps(group)] : NULL;
}

/* ---- Values that do not depend on time ---- */

typedef struct canonical_job {
    adcgs_splat *splat;
    const uint32_t *moving_index; /* [groups] index among the moving groups, or UINT32_MAX */
} canonical_job;

/* Load f_g of primitive k of a group, chunk by chunk: each chunk has its own factors. */
static void load_fg(float *fg, const adcgs_model *m, uint32_t first, int k, const adcgs_group_factors *factors)
{
    const int n_fg = m->params.n_fg, count = n_fg / m->params.chunks;
    for (int c = 0; c < n_fg; c += count) {
        const int chunk = c / count;
        load_rows(fg + (size_t)c * ADCGS_LANES, m->fg + (size_t)(k * n_fg + c), (size_t)(m->params.k * n_fg), m->d_fg + c, count,
                  first, m->n, factor_of(m, factors, ADCGS_GROUP_FG + chunk));
    }
}

/* While finer tiers are absent, larger primitives cover the gaps between the anchors of the first tiers. */
static void enlarge_primitives(adcgs_anchor_lanes *anchor, const adcgs_model *m)
{
    const float factor = adcgs_step_factor(m->absent ? m->growth[m->finest - m->absent] : 0);
    for (int c = 0; c < 3; c++)
        for (int l = 0; l < ADCGS_LANES; l++)
            anchor->scale[c][l] *= factor;
}

static void predict_group(adcgs_splat *s, uint32_t group, uint32_t index, const adcgs_anchor_lanes *anchor, const float *fv,
                          const adcgs_group_factors *factors, float *fg, float *buffers)
{
    const adcgs_model *m = s->model;
    const adcgs_params *p = &m->params;
    const adcgs_float_layer *first = &s->prediction.layer[0];
    const size_t rows = (size_t)s->width * ADCGS_LANES, ldw = (size_t)first->n_in;
    float *shared = buffers, *z = buffers + rows, *other = buffers + 2 * rows;
    const int slots = adcgs_slot_inputs(p);
    alignas(64) float one[ADCGS_LANES];
    adcgs_dense_ones(one);
    s->dense.dense(shared, NULL, first->b, first->w, ldw, fv, first->n_out, p->n_fv);
    for (int k = 0; k < p->k; k++) {
        adcgs_slot_lanes local, *slot = index == UINT32_MAX ? &local : s->slots + (size_t)index * p->k + k;
        int32_t none[ADCGS_LANES];
        int32_t *present = index == UINT32_MAX ? none : s->present + ((size_t)index * p->k + (size_t)k) * ADCGS_LANES;
        const adcgs_slot_out to = adcgs_slot_out_of(s, group, k);
        load_fg(fg, m, group * ADCGS_LANES, k, factors);
        s->dense.dense(z, shared, NULL, first->w + p->n_fv + k, ldw, one, first->n_out, slots > 0);
        s->dense.dense(z, z, NULL, first->w + p->n_fv + slots, ldw, fg, first->n_out, p->n_fg);
        s->dsp.predict(slot, anchor, adcgs_floatnet_finish(&s->prediction, &s->dense, z, other));
        load_present(present, m, group * ADCGS_LANES, k);
        s->dsp.place(&to, slot, anchor, present);
    }
}

/* Compute the static inputs' part of a deformation network's layer 0. */
static void static_part(const adcgs_splat *s, float *to, const adcgs_floatnet *net, const float *x, int n_in)
{
    if (net->n_layers)
        s->dense.dense(to, NULL, NULL, net->layer[0].w, (size_t)net->layer[0].n_in, x, net->layer[0].n_out, n_in);
}

static void canonical_group(void *arg, int index, int thread)
{
    const canonical_job *job = arg;
    adcgs_splat *s = job->splat;
    const adcgs_model *m = s->model;
    const adcgs_params *p = &m->params;
    const uint32_t group = (uint32_t)index, moving = job->moving_index[group], first = group * ADCGS_LANES;
    adcgs_anchor_lanes local, *anchor = moving == UINT32_MAX ? &local : s->anchors + moving;
    float *sigma = s->scratch + (size_t)thread * s->scratch_rows * ADCGS_LANES, *code = sigma + ADCGS_SIGMA_MAX * ADCGS_LANES;
    float *fv = code + (size_t)p->octaves * 6 * ADCGS_LANES, *fg = fv + (size_t)p->n_fv * ADCGS_LANES;
    float *buffers = fg + (size_t)p->n_fg * ADCGS_LANES;
    adcgs_group_factors factors;
    adcgs_steps_factors(&s->steps, m, first, factors.of, buffers);
    load_positions(anchor, m, first);
    const int n_sigma = adcgs_sigma_rows(p);
    load_rows(sigma, m->sigma, (size_t)n_sigma, m->d_sigma, n_sigma, first, m->n, factor_of(m, &factors, ADCGS_GROUP_SIGMA));
    load_rows(anchor->colour[0], m->colour, ADCGS_COLOUR_N, m->d_colour, ADCGS_COLOUR_N, first, m->n,
              factor_of(m, &factors, ADCGS_GROUP_COLOUR));
    load_rows(fv, m->fv, p->n_fv, m->d_fv, p->n_fv, first, m->n, NULL);
    s->dsp.anchor(anchor, sigma, p->spans);
    enlarge_primitives(anchor, m);
    predict_group(s, group, moving, anchor, fv, &factors, fg, buffers);
    if (moving == UINT32_MAX)
        return;
    for (uint32_t l = 0; l < ADCGS_LANES; l++)
        s->moves[(size_t)moving * ADCGS_LANES + l] = first + l < m->n && !m->is_static[first + l];
    s->dsp.position_code(code, anchor->code[0], p->octaves);
    static_part(s, s->coarse_part + (size_t)moving * (size_t)s->coarse.layer[0].n_out * ADCGS_LANES, &s->coarse, fv, p->n_fv);
    static_part(s, s->fine_part + (size_t)moving * (size_t)s->fine.layer[0].n_out * ADCGS_LANES, &s->fine, code,
                6 * p->octaves + (p->fine_uses_fv ? p->n_fv : 0));
}

/* ---- Creation ---- */

static int group_moves(const adcgs_model *m, uint32_t group)
{
    for (uint32_t i = group * ADCGS_LANES; i < group * ADCGS_LANES + ADCGS_LANES && i < m->n; i++)
        if (!m->is_static[i])
            return 1;
    return 0;
}

static uint32_t count_moving(const adcgs_splat *s, uint32_t *moving_index)
{
    const int movers = s->coarse.n_layers || s->fine.n_layers || s->model->params.spans || s->model->params.bodies;
    uint32_t moving = 0;
    for (uint32_t g = 0; g < s->groups; g++)
        moving_index[g] = movers && group_moves(s->model, g) ? moving++ : UINT32_MAX;
    return moving;
}

static adcgs_status ready_networks(adcgs_splat *s, adcgs_cpu_level cpu, adcgs_error *error)
{
    const adcgs_net *nets = s->model->net;
    ADCGS_TRY(adcgs_steps_init(&s->steps, s->model, cpu, s->memory, error));
    ADCGS_TRY(adcgs_floatnet_init(&s->prediction, &nets[ADCGS_ROLE_PREDICTION], s->memory, error));
    if (s->model->params.time_rows) {
        ADCGS_TRY(adcgs_floatnet_init(&s->coarse, &nets[ADCGS_ROLE_COARSE], s->memory, error));
        ADCGS_TRY(adcgs_floatnet_init(&s->fine, &nets[ADCGS_ROLE_FINE], s->memory, error));
    }
    s->width = ADCGS_MAX(s->prediction.width, ADCGS_MAX(s->coarse.width, s->fine.width));
    return ADCGS_OK;
}

static void *get(adcgs_splat *s, size_t count, size_t size, int *missing, adcgs_error *error)
{
    void *p = *missing ? NULL : adcgs_alloc(s->memory, count, size, error);
    if (!p)
        *missing = 1;
    return p;
}

static adcgs_status alloc_arrays(adcgs_splat *s, adcgs_error *error)
{
    const size_t k = s->model->params.k, moving = s->moving, threads = (size_t)adcgs_pool_threads(s->pool);
    const size_t coarse = (size_t)s->coarse.layer[0].n_out, fine = (size_t)s->fine.layer[0].n_out;
    const size_t row = ADCGS_LANES * sizeof(float);
    int missing = 0;
    s->scratch_rows = INPUT_ROWS + ADCGS_MAX(3 * (size_t)s->width, (adcgs_steps_scratch(&s->steps) + row - 1) / row);
    s->out = get(s, ADCGS_ROWS * s->groups * k, row, &missing, error);
    s->moving_group = get(s, moving, sizeof(uint32_t), &missing, error);
    s->anchors = get(s, moving, sizeof(adcgs_anchor_lanes), &missing, error);
    s->slots = get(s, moving * k, sizeof(adcgs_slot_lanes), &missing, error);
    s->present = get(s, moving * k, row, &missing, error);
    s->moves = get(s, moving, row, &missing, error);
    s->coarse_part = get(s, moving * coarse, row, &missing, error);
    s->fine_part = get(s, moving * fine, row, &missing, error);
    s->scratch = get(s, threads * s->scratch_rows, row, &missing, error);
    s->time_code = get(s, adcgs_time_columns(s->model), sizeof(float), &missing, error);
    s->coarse_time = get(s, coarse, sizeof(float), &missing, error);
    s->fine_time = get(s, fine, sizeof(float), &missing, error);
    return !missing ? ADCGS_OK : adcgs_alloc_status(error);
}

static adcgs_status build_splat(adcgs_splat *s, adcgs_cpu_level cpu, uint32_t *moving_index, adcgs_error *error)
{
    ADCGS_TRY(ready_networks(s, cpu, error));
    s->moving = count_moving(s, moving_index);
    ADCGS_TRY(alloc_arrays(s, error));
    for (uint32_t g = 0; g < s->groups; g++)
        if (moving_index[g] != UINT32_MAX)
            s->moving_group[moving_index[g]] = g;
    adcgs_bodies_init(s->pose, s->model);
    canonical_job job = {s, moving_index};
    adcgs_pool_run(s->pool, canonical_group, &job, (int)s->groups);
    return ADCGS_OK;
}

void adcgs_splat_dsp_init(adcgs_splat_dsp *dsp, adcgs_cpu_level level)
{
    (void)level; /* unused without SIMD */
    *dsp = adcgs_splat_scalar;
#ifdef HAVE_AVX2
    if (level >= ADCGS_CPU_AVX2)
        *dsp = adcgs_splat_avx2;
#endif
#ifdef HAVE_AVX512
    if (level >= ADCGS_CPU_AVX512)
        *dsp = adcgs_splat_avx512;
#endif
}

void adcgs_position_code(float *out, const float *x, int octaves)
{
    adcgs_splat_dsp dsp;
    adcgs_splat_dsp_init(&dsp, adcgs_cpu_best());
    dsp.position_code(out, x, octaves);
}

adcgs_status adcgs_splat_create(adcgs_splat **out, const adcgs_model *model, adcgs_cpu_level cpu, adcgs_pool *pool,
                                adcgs_memory *memory, adcgs_error *error)
{
    adcgs_cpu_level level;
    *out = NULL;
    ADCGS_TRY(adcgs_cpu_resolve(cpu, &level, error));
    adcgs_splat *s = adcgs_alloc(memory, 1, sizeof *s, error);
    if (!s)
        return adcgs_alloc_status(error);
    s->model = model;
    s->pool = pool;
    s->memory = memory;
    s->groups = adcgs_lane_groups(model->n);
    adcgs_dense_dsp_init(&s->dense, level);
    adcgs_splat_dsp_init(&s->dsp, level);
    uint32_t *moving_index = adcgs_alloc(memory, s->groups, sizeof *moving_index, error);
    const adcgs_status status = moving_index ? build_splat(s, level, moving_index, error) : adcgs_alloc_status(error);
    adcgs_free(memory, moving_index);
    if (status != ADCGS_OK)
        adcgs_splat_free(&s);
    *out = s;
    return status;
}

void adcgs_splat_free(adcgs_splat **splat)
{
    adcgs_splat *s = *splat;
    if (!s)
        return;
    void *const arrays[] = {s->out,         s->moving_group, s->anchors, s->slots,     s->present,     s->moves,
                            s->coarse_part, s->fine_part,    s->scratch, s->time_code, s->coarse_time, s->fine_time};
    for (size_t i = 0; i < ADCGS_COUNTOF(arrays); i++)
        adcgs_free(s->memory, arrays[i]);
    adcgs_steps_clear(&s->steps, s->memory);
    adcgs_floatnet_clear(&s->prediction, s->memory);
    adcgs_floatnet_clear(&s->coarse, s->memory);
    adcgs_floatnet_clear(&s->fine, s->memory);
    adcgs_free(s->memory, s);
    *splat = NULL;
}
