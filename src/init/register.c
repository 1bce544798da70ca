/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Points of a body, and their matches in a frame. */
#include "init/register.h"

#include "geometry/vector.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define TINT 14.0       /* pixels per unit of colour difference: 0.07 corresponds to one pixel */
#define MATCH_REACH 2.0 /* pixels: maximum distance of a match in space */
#define MATCH_OFF 3.0   /* pixels: the same including the colour term */
#define FACING 0.15     /* cosine: minimum between normal and viewing ray; below it, a surface is seen at a grazing angle */
/* Sum of the matches' weights, below which a pose is undetermined: three points fix one, geometry. */
#define WEIGHT_LEAST 3
#define GAIN_LEAST 0.4 /* minimum lighting gain */
#define GAIN_MOST 2.5  /* maximum lighting gain */
#define GAIN_KNOWN 0.2 /* prior of the gains: sum of squares of a channel at which a side's own data has half the weight */

int adcgs_body_side(const float normal[3])
{
    int most = 0;
    for (int a = 1; a < 3; a++)
        if (fabsf(normal[a]) > fabsf(normal[most]))
            most = a;
    if (!(fabsf(normal[most]) > 0))
        return ADCGS_BODY_SIDES - 1;
    return 8 * most + 4 * (normal[most] < 0) + 2 * (normal[(most + 1) % 3] < 0) + (normal[(most + 2) % 3] < 0);
}

adcgs_status adcgs_body_add(adcgs_body_model *m, const adcgs_stereo_point *point, const float normal[3], adcgs_error *error)
{
    if (m->n == m->capacity) {
        const uint32_t capacity = m->capacity ? 2 * m->capacity : 512;
        adcgs_stereo_point *p = adcgs_alloc(NULL, capacity, sizeof *p, error);
        adcgs_body_more *more = p ? adcgs_alloc(NULL, capacity, sizeof *more, error) : NULL;
        if (!more) {
            adcgs_free(NULL, p);
            return adcgs_alloc_status(error);
        }
        if (m->n) {
            memcpy(p, m->p, m->n * sizeof *p);
            memcpy(more, m->more, m->n * sizeof *more);
        }
        adcgs_free(NULL, m->p);
        adcgs_free(NULL, m->more);
        m->p = p;
        m->more = more;
        m->capacity = capacity;
    }
    m->p[m->n] = *point;
    m->p[m->n].body = 0;
    m->more[m->n] = (adcgs_body_more){.normal = {normal[0], normal[1], normal[2]}, .side = (uint8_t)adcgs_body_side(normal)};
    m->n++;
    return ADCGS_OK;
}

void adcgs_body_clear(adcgs_body_model *m)
{
    adcgs_free(NULL, m->p);
    adcgs_free(NULL, m->more);
    *m = (adcgs_body_model){.n = 0};
}

void adcgs_frame_views_init(adcgs_frame_views *views, const adcgs_stereo_rig *rig, int frame)
{
    *views = (adcgs_frame_views){.frame = frame};
    for (int c = 0; c < rig->n_cameras; c++)
        if (rig->camera[c].background && rig->camera[c].frame[frame])
            views->camera[views->n++] = &rig->camera[c];
}

int adcgs_faces(const adcgs_stereo_view *view, const double x[3], const double normal[3])
{
    const double to[3] = {view->centre[0] - x[0], view->centre[1] - x[1], view->centre[2] - x[2]};
    const double along = adcgs_v3_dot(to, normal);
    return along > 0 ? along * along > FACING * FACING * adcgs_v3_dot(to, to) : adcgs_v3_dot(normal, normal) < 0.5;
}

int adcgs_body_point_at(const adcgs_body_model *m, uint32_t i, const adcgs_rigid *at, const adcgs_frame_views *views, double x[3],
                        double normal[3])
{
    const float *n = m->more[i].normal;
    int faces = 0;
    adcgs_rigid_apply(at, m->p[i].x, x);
    adcgs_rigid_turn(at, (const double[]){(double)n[0], (double)n[1], (double)n[2]}, normal);
    for (int k = 0; k < views->n; k++)
        faces += adcgs_faces(&views->camera[k]->view, x, normal);
    return faces;
}

void adcgs_gains_set(float gain[ADCGS_BODY_SIDES][3], const adcgs_gain_sums *sums)
{
    for (int c = 0; c < 3; c++) {
        double with = GAIN_KNOWN, own = GAIN_KNOWN;
        for (int s = 0; s < ADCGS_BODY_SIDES; s++) {
            with += sums->with[s][c];
            own += sums->own[s][c];
        }
        for (int s = 0; s < ADCGS_BODY_SIDES; s++) {
            const double g = (sums->with[s][c] + GAIN_KNOWN * with / own) / (sums->own[s][c] + GAIN_KNOWN);
            gain[s][c] = (float)fmin(fmax(g, GAIN_LEAST), GAIN_MOST);
        }
    }
}

static void tinted(const adcgs_body_model *m, uint32_t i, const adcgs_placement *place, float rgb[3])
{
    for (int a = 0; a < 3; a++)
        rgb[a] = m->p[i].rgb[a] * place->gain[m->more[i].side][a];
}

void adcgs_body_register(const adcgs_body_model *m, const adcgs_cloud *cloud, const adcgs_frame_views *views,
                         const adcgs_registration_stage *how, adcgs_placement *place)
{
    const double reach = how->reach * m->pixel, sharp = how->sharp * m->pixel;
    for (int round = 0; round < how->rounds; round++) {
        adcgs_rigid_sums sums = {.weight = 0};
        adcgs_gain_sums gains = {.with = {{0}}};
        for (uint32_t i = 0; i < m->n; i += how->stride) {
            double x[3], normal[3];
            float rgb[3];
            uint32_t j = 0;
            if (!adcgs_body_point_at(m, i, &place->at, views, x, normal))
                continue;
            tinted(m, i, place, rgb);
            const double far = adcgs_cloud_nearest(cloud, x, rgb, reach, TINT * m->pixel, &j);
            if (far < 0)
                continue;
            const double fits = 1 / (1 + far / (sharp * sharp));
            const double weight = fits * fits * (m->more[i].agreed + 1) / (m->more[i].seen + 2);
            adcgs_rigid_add(&sums, m->p[i].x, cloud->p[j].x, weight);
            for (int a = 0; a < 3; a++) {
                gains.with[m->more[i].side][a] += weight * (double)(m->p[i].rgb[a] * cloud->p[j].rgb[a]);
                gains.own[m->more[i].side][a] += weight * (double)(m->p[i].rgb[a] * m->p[i].rgb[a]);
            }
        }
        if (!(sums.weight > WEIGHT_LEAST))
            return;
        adcgs_rigid_fit(&sums, &place->at);
        adcgs_gains_set(place->gain, &gains);
    }
}

int adcgs_body_near(const adcgs_body_model *m, const adcgs_cloud *own, const double x[3], const float rgb[3], uint32_t *found)
{
    const double far = adcgs_cloud_nearest(own, x, rgb, MATCH_REACH * m->pixel, TINT * m->pixel, found);
    return far >= 0 && far < MATCH_OFF * MATCH_OFF * m->pixel * m->pixel;
}

int adcgs_body_match(const adcgs_body_model *m, uint32_t i, const double x[3], const adcgs_cloud *cloud,
                     const adcgs_placement *place, uint32_t *found)
{
    float rgb[3];
    tinted(m, i, place, rgb);
    return adcgs_body_near(m, cloud, x, rgb, found);
}

void adcgs_body_judge(const adcgs_body_model *m, const adcgs_cloud *cloud, const adcgs_frame_views *views, uint32_t stride,
                      adcgs_placement *place)
{
    double seen = 0, agreed = 0;
    for (uint32_t i = 0; i < m->n; i += stride) {
        double x[3], normal[3];
        uint32_t j;
        if (!adcgs_body_point_at(m, i, &place->at, views, x, normal))
            continue;
        const double weight = (m->more[i].agreed + 1.0) / (m->more[i].seen + 2.0);
        seen += weight;
        if (adcgs_body_match(m, i, x, cloud, place, &j))
            agreed += weight;
    }
    place->share = seen > 0 ? agreed / seen : 0;
}
