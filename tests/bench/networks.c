/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file The complete computation of training between the anchors' parameters and the primitives, at several widths of the
 * networks.
 */
#include "bench_parts.h"

#include "fmodel/pass.h"
#include "train/settings.h"

enum { GROUPS = 32, ANCHORS = 64 * GROUPS };

typedef struct networks {
    adcgs_fmodel *f;
    adcgs_pass *pass;
} networks;

static void both_ways(networks *n, int bf16)
{
    adcgs_pass_forward(n->pass, n->f, 0.4f, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL, .bf16 = bf16});
    adcgs_pass_backward(n->pass, n->f, ADCGS_DEFORM_ALL, 0, 1, 0, NULL);
}

static void in_binary32(void *arg)
{
    both_ways(arg, 0);
}

static void in_bf16(void *arg)
{
    both_ways(arg, 1);
}

static void open_networks(networks *n, const bench *b, int width)
{
    static uint32_t pos[ANCHORS][3];
    const float origin[3] = {-1, -1, -1};
    adcgs_train_config c;
    adcgs_error error;
    bench_check(adcgs_train_preset(&c, "paper", &error), &error);
    c.shape.theta_width = c.shape.omega_width = c.shape.varpi_width = width;
    for (uint32_t i = 0; i < ANCHORS; i++)
        pos[i][0] = i;
    bench_check(adcgs_fmodel_create(&n->f, &c.params, &c.shape, origin, 1.0f / 1024, (const uint32_t(*)[3])pos, ANCHORS, 3,
                                    &error),
                &error);
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++)
        if (n->f->mlp[i].n)
            adcgs_mlp_prepare(&n->f->mlp[i], n->f->param[i].p, 0);
    bench_check(adcgs_pass_create(&n->pass, n->f, b->level, NULL, &error), &error);
    for (size_t i = 0; i < (size_t)n->pass->primitives.n * ADCGS_ROWS; i++) /* plausible gradients of an image */
        n->pass->grad[i] = 1e-3f * (float)(i % 17) - 8e-3f;
}

/**
 * Operations of a network on 64 lanes: two for each multiply-add, for the forward pass, the gradients of inputs and those of
 * weights.
 */
static double operations(const adcgs_mlp *m, double tiles)
{
    double n = 0;
    for (int i = 0; i <= m->hidden; i++)
        n += (double)m->in[i] * m->n_out[i];
    return 3 * 2 * 64 * n * tiles;
}

void bench_networks(const bench *b)
{
    static const int widths[] = {32, 64, 128, 256};
    if (!bench_wants(b, "networks"))
        return;
    for (size_t i = 0; i < ADCGS_COUNTOF(widths); i++) {
        char group[32];
        networks n;
        open_networks(&n, b, widths[i]);
        snprintf(group, sizeof group, "networks of %d", widths[i]);
        const adcgs_mlp *m = n.f->mlp;
        const double work = operations(&m[ADCGS_P_THETA], GROUPS * n.f->params.k) + operations(&m[ADCGS_P_OMEGA], GROUPS) +
                            operations(&m[ADCGS_P_VARPI], GROUPS);
        const bench_item items[] = {{"forward and backward", in_binary32, &n, work, "operation", 1},
                                    {"the same in bf16", in_bf16, &n, work, "operation", 1}};
        bench_group(b, &(bench_place){.group = group, .anchors = ANCHORS, .threads = 1}, items,
                    adcgs_bf16_check(b->level, NULL) == ADCGS_OK ? 2 : 1, 1);
        adcgs_pass_free(&n.pass);
        adcgs_fmodel_free(&n.f);
    }
}
