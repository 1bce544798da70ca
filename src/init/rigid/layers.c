/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Grids of the moving points. */
#include "init/rigid/layers.h"

#include "init/rigid/direct.h"
#include "system/sort_values.h"

#include <math.h>

/* Origin of all: chosen by hand, not measured. */
enum {
    AROUND = 64,    /* maximum number of neighbours that are counted */
    FEW = 500,      /* points: size of the sparse sets, approximately */
    SAMPLES = 4096, /* points whose pixel size is compared, at most */
    TEN = 10,       /* mean number of points within reach */
    TRIED = 37      /* one in so many points is tried for the reach */
};
#define CELL 3.0         /* pixels: cell size of the full grid */
#define CELL_FEW 14.0    /* pixels: cell size of the sparse grid */
#define REACH_LEAST 2    /* pixels: minimum reach */
#define REACH_MOST 12    /* pixels: maximum reach */
#define REACH_STEP 1.25  /* ratio of tried reaches */
#define PIXEL_LEAST 0.4  /* pixel size / reach, minimum */
#define NORMAL_REACH 1.3 /* radius for normals / reach */

/** Median of the points' pixel sizes. */
static adcgs_status find_pixel(adcgs_layers *l, uint32_t n, adcgs_error *error)
{
    const uint32_t stride = n / SAMPLES + 1;
    uint32_t k = 0;
    double *size = adcgs_alloc(NULL, n / stride + 1, sizeof *size, error);
    if (!size)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < n; i += stride)
        size[k++] = (double)l->p[i].size;
    adcgs_sort(size, k);
    l->pixel = fmax(size[k / 2], 1e-6);
    adcgs_free(NULL, size);
    return ADCGS_OK;
}

/** Radius that contains ten points on average. A large radius also enlarges the pixel size. */
static void find_reach(adcgs_layers *l)
{
    uint32_t near[AROUND];
    const double pixel = l->pixel;
    for (l->reach = REACH_LEAST * pixel; l->reach < REACH_MOST * pixel; l->reach *= REACH_STEP) {
        uint64_t sum = 0, n = 0;
        for (int m = 0; m < l->n; m++)
            for (uint32_t i = 0; i < l->all[m].n; i += TRIED, n++)
                sum += adcgs_cloud_within(&l->all[m], l->all[m].p[i].x, l->reach, near, AROUND);
        if (sum >= TEN * n)
            break;
    }
    l->pixel = fmax(pixel, PIXEL_LEAST * l->reach);
}

/** Sets the colour from the softened image closest to the point's own colour: its source view, or a similar one. */
static void recolour(adcgs_stereo_point *p, const float normal[3], const adcgs_frame_views *views)
{
    const double n[3] = {(double)normal[0], (double)normal[1], (double)normal[2]};
    float best[3], least = 4;
    for (int k = 0; k < views->n; k++) {
        adcgs_sample s;
        double at[2], depth;
        float off = 0;
        if (!adcgs_faces(&views->camera[k]->view, p->x, n) ||
            !adcgs_stereo_rig_project(&views->camera[k]->view, p->x, at, &depth) ||
            !adcgs_sample_image(views->camera[k], views->frame, at, &s))
            continue;
        for (int a = 0; a < 3; a++)
            off += fabsf((float)s.rgb[a] - p->rgb[a]);
        if (off < least) {
            least = off;
            for (int a = 0; a < 3; a++)
                best[a] = (float)s.rgb[a];
        }
    }
    if (least < 4)
        memcpy(p->rgb, best, sizeof best);
}

adcgs_status adcgs_layers_init(adcgs_layers *l, const adcgs_stereo *stereo, const adcgs_stereo_rig *rig, adcgs_error *error)
{
    uint32_t end = 0;
    *l = (adcgs_layers){.rig = rig, .n = rig->n_frames, .p = adcgs_alloc(NULL, stereo->n_moving, sizeof *l->p, error)};
    if (!l->p)
        return adcgs_alloc_status(error);
    memcpy(l->p, stereo->moving, stereo->n_moving * sizeof *l->p);
    ADCGS_TRY(find_pixel(l, stereo->n_moving, error));
    l->normal = adcgs_alloc(NULL, stereo->n_moving, sizeof *l->normal, error);
    if (!l->normal)
        return adcgs_alloc_status(error);
    for (int m = 0; m < l->n; m++) {
        const uint32_t begin = end;
        while (end < stereo->n_moving && l->p[end].t <= rig->frame_time[m])
            end++;
        l->begin[m + 1] = end;
        adcgs_frame_views_init(&l->views[m], rig, m);
        ADCGS_TRY(adcgs_cloud_init(&l->all[m], l->p + begin, end - begin, 1, CELL * l->pixel, error));
        ADCGS_TRY(adcgs_cloud_init(&l->few[m], l->p + begin, end - begin, (end - begin) / FEW + 1, CELL_FEW * l->pixel, error));
    }
    find_reach(l);
    for (int m = 0; m < l->n; m++) {
        adcgs_cloud_normals(&l->all[m], NORMAL_REACH * l->reach, rig, l->normal + l->begin[m]);
        for (uint32_t i = l->begin[m]; i < l->begin[m + 1]; i++)
            recolour(&l->p[i], l->normal[i], &l->views[m]);
    }
    return ADCGS_OK;
}

void adcgs_layers_clear(adcgs_layers *l)
{
    for (int m = 0; m < l->n; m++) {
        adcgs_cloud_clear(&l->all[m]);
        adcgs_cloud_clear(&l->few[m]);
    }
    adcgs_free(NULL, l->normal);
    adcgs_free(NULL, l->p);
    *l = (adcgs_layers){.n = 0};
}
