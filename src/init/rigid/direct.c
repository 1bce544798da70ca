/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Gauss-Newton steps over three rotations and three translations. */
#include "init/rigid/direct.h"

#include "geometry/vector.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    ROUNDS = 10, /* maximum number of steps */
    LEAST = 30   /* minimum number of samples */
};
#define OFF_FIRST 0.20  /* colour difference at which the agreement is one half, in the first round */
#define OFF_LAST 0.08   /* the same in the last round */
#define OFF_MIDDLE 0.12 /* the same from which iteration may stop early */
#define DAMPING 1e-3    /* relative increase of the system's diagonal */
#define STIFF 0.05      /* prior of slope 1, as a sum of squared colours */
#define SLOPE_MOST 3.0  /* maximum slope of colours: ratio */
#define STEP_LEAST 0.01 /* pixels: step length at which iteration stops */
#define STEP_MOST 1.5   /* pixels: maximum step of the body's points, approximately */
#define LIGHT_ROUNDS 4  /* rounds of fitting any lighting */

int adcgs_sample_image(const adcgs_stereo_camera *c, int frame, const double at[2], adcgs_sample *s)
{
    const double u = at[0] - 0.5, v = at[1] - 0.5;
    const int x = (int)floor(u), y = (int)floor(v), w = c->view.w;
    if (x < 0 || y < 0 || x + 1 >= w || y + 1 >= c->view.h)
        return 0;
    const uint8_t *p = c->frame[frame] + 4 * ((size_t)y * (size_t)w + (size_t)x), *q = p + 4 * (size_t)w;
    const double a = u - x, b = v - y;
    if (!p[3] || !p[7] || !q[3] || !q[7])
        return 0;
    for (int k = 0; k < 3; k++) {
        const double above = p[k] + a * (p[4 + k] - p[k]), below = q[k] + a * (q[4 + k] - q[k]);
        s->rgb[k] = (above + b * (below - above)) / 255;
        s->along[k] = ((1 - b) * (p[4 + k] - p[k]) + b * (q[4 + k] - q[k])) / 255;
        s->down[k] = (below - above) / 255;
    }
    return 1;
}

/** Sums of one pass over points and views. */
typedef struct pass {
    double off; /* colour difference at which the agreement is one half */
    int moves;  /* 1: a step is wanted, so a and b are accumulated */
    double centre[3];
    double a[36], b[6];
    adcgs_gain_sums gains;
    double light, n;
} pass;

/** Jacobian of a pixel position with respect to rotation about the centre and translation: rows u and v. */
static void derive(const adcgs_stereo_view *v, const double x[3], const double centre[3], double depth, const double at[2],
                   double row[2][6])
{
    const double arm[3] = {x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]};
    const double f[2] = {v->fx / depth, v->fy / depth};
    const double ray[2] = {(at[0] - v->cx) / v->fx, (at[1] - v->cy) / v->fy};
    for (int k = 0; k < 2; k++) {
        double to[3];
        for (int a = 0; a < 3; a++)
            row[k][3 + a] = to[a] = f[k] * (v->rotation[3 * k + a] - ray[k] * v->rotation[6 + a]);
        adcgs_v3_cross(arm, to, row[k]);
    }
}

/** \return the weight of a sample. off: residual, colour of the body minus colour of the image. */
static double add_sample(pass *p, const adcgs_sample *s, const float rgb[3], const float gain[3], int side, double trust,
                         double off[3])
{
    double off2 = 0;
    for (int k = 0; k < 3; k++) {
        off[k] = (double)(gain[k] * rgb[k]) - s->rgb[k];
        off2 += off[k] * off[k];
    }
    const double fits = 1 / (1 + off2 / (p->off * p->off)), weight = trust * fits * fits;
    p->light += trust * fits;
    p->n += trust;
    for (int k = 0; k < 3; k++) {
        p->gains.with[side][k] += weight * (double)rgb[k] * s->rgb[k];
        p->gains.own[side][k] += weight * (double)(rgb[k] * rgb[k]);
    }
    return weight;
}

static void add_slope(pass *p, const adcgs_sample *s, const double row[2][6], const double off[3], double weight)
{
    for (int k = 0; k < 3; k++) {
        double j[6];
        for (int a = 0; a < 6; a++)
            j[a] = s->along[k] * row[0][a] + s->down[k] * row[1][a];
        for (int a = 0; a < 6; a++) {
            p->b[a] += weight * j[a] * off[k];
            for (int b = 0; b <= a; b++)
                p->a[6 * a + b] += weight * j[a] * j[b];
        }
    }
}

/** Samples the view at a point. at[2]: its pixel position. Returns 0 if the view gives no sample. */
static int sample_view(const adcgs_frame_views *views, int k, const double x[3], const double normal[3], double at[2],
                       double *depth, adcgs_sample *s)
{
    const adcgs_stereo_view *v = &views->camera[k]->view;
    return adcgs_faces(v, x, normal) && adcgs_stereo_rig_project(v, x, at, depth) &&
           adcgs_sample_image(views->camera[k], views->frame, at, s);
}

static void run(pass *p, const adcgs_body_model *m, const adcgs_frame_views *views, uint32_t stride, const adcgs_placement *place)
{
    for (uint32_t i = 0; i < m->n; i += stride) {
        double x[3], normal[3], at[2], depth, row[2][6], off[3];
        adcgs_sample s;
        const double trust = (m->more[i].agreed + 1.0) / (m->more[i].seen + 2.0);
        const int side = m->more[i].side;
        if (!adcgs_body_point_at(m, i, &place->at, views, x, normal))
            continue;
        for (int k = 0; k < views->n; k++) {
            if (!sample_view(views, k, x, normal, at, &depth, &s))
                continue;
            const double weight = add_sample(p, &s, m->p[i].rgb, place->gain[side], side, trust, off);
            if (!p->moves)
                continue;
            derive(&views->camera[k]->view, x, p->centre, depth, at, row);
            add_slope(p, &s, (const double(*)[6])row, off, weight);
        }
    }
}

/** Centroid of the body, which decouples rotation from translation, and the RMS distance of the points from it. */
static double find_centre(const adcgs_body_model *m, const adcgs_rigid *at, double centre[3])
{
    double mean[3] = {0, 0, 0}, far = 0;
    for (uint32_t i = 0; i < m->n; i++)
        for (int a = 0; a < 3; a++)
            mean[a] += m->p[i].x[a] / m->n;
    for (uint32_t i = 0; i < m->n; i++)
        for (int a = 0; a < 3; a++)
            far += pow(m->p[i].x[a] - mean[a], 2) / m->n;
    adcgs_rigid_apply(at, mean, centre);
    return sqrt(far);
}

/** One step. Returns 0 if there are too few samples or the step is negligible. */
static int step(pass *p, const adcgs_body_model *m, double radius, adcgs_placement *place)
{
    if (p->n < LEAST)
        return 0;
    for (int a = 0; a < 6; a++) { /* rotations are scaled by the radius, so that both are damped equally */
        p->a[7 * a] *= 1 + DAMPING;
        p->a[7 * a] += 1e-9;
    }
    if (!adcgs_solve_six(p->a, p->b))
        return 0;
    double moves = 0;
    for (int a = 0; a < 3; a++)
        moves += pow(radius * p->b[a], 2) + pow(p->b[3 + a], 2);
    const double most = STEP_MOST * m->pixel, shrink = moves > most * most ? most / sqrt(moves) : 1;
    adcgs_rigid d;
    for (int a = 0; a < 6; a++)
        p->b[a] *= shrink;
    adcgs_rigid_about(p->b, p->centre, p->b + 3, &d);
    adcgs_rigid_then(&place->at, &d, &place->at);
    return moves > STEP_LEAST * STEP_LEAST * m->pixel * m->pixel;
}

void adcgs_direct_judge(const adcgs_body_model *m, const adcgs_frame_views *views, uint32_t stride, adcgs_placement *place)
{
    for (int round = 0; round < 3; round++) { /* fits the gains, then measures the residual */
        pass p = {.off = OFF_LAST};
        run(&p, m, views, stride, place);
        place->light = p.n > 0 ? p.light / p.n : 0;
        if (round < 2)
            adcgs_gains_set(place->gain, &p.gains);
    }
}

void adcgs_direct_refine(const adcgs_body_model *m, const adcgs_frame_views *views, uint32_t stride, adcgs_placement *place)
{
    for (int round = 0; round < ROUNDS; round++) {
        const double along = round / (ROUNDS - 1.0);
        pass p = {.off = OFF_FIRST + along * (OFF_LAST - OFF_FIRST), .moves = 1};
        const double radius = find_centre(m, &place->at, p.centre);
        run(&p, m, views, stride, place);
        const int on = step(&p, m, radius, place);
        if (p.n > 0)
            adcgs_gains_set(place->gain, &p.gains);
        if (!on && p.off <= OFF_MIDDLE)
            return;
    }
}

double adcgs_direct_point(const adcgs_body_model *m, uint32_t i, const adcgs_frame_views *views, const adcgs_placement *place)
{
    double x[3], normal[3], best[ADCGS_STEREO_CAMERAS], sum = 0;
    int n = 0;
    adcgs_body_point_at(m, i, &place->at, views, x, normal);
    for (int k = 0; k < views->n; k++) {
        double at[2], depth, off = 0;
        adcgs_sample s;
        if (!sample_view(views, k, x, normal, at, &depth, &s))
            continue;
        for (int a = 0; a < 3; a++)
            off += pow((double)(place->gain[m->more[i].side][a] * m->p[i].rgb[a]) - s.rgb[a], 2);
        const double fits = 1 / (1 + off / (OFF_LAST * OFF_LAST));
        int j = n++;
        for (; j > 0 && best[j - 1] < fits; j--)
            best[j] = best[j - 1];
        best[j] = fits;
    }
    const int half = (n + 1) / 2;
    for (int k = 0; k < half; k++)
        sum += best[k] / half;
    return sum;
}

/* ---- Lighting-independent agreement ---- */

/** Linear fit from the body's colours to the image's, per side and channel. */
typedef struct line {
    double n, x, y, xx, xy;
    double slope, offset;
} line;

static void fit_line(line *l)
{
    const double spread = l->xx - l->x * l->x / ADCGS_MAX(l->n, 1e-9);
    const double both = l->xy - l->x * l->y / ADCGS_MAX(l->n, 1e-9);
    l->slope = fmin(fmax((both + STIFF) / (spread + STIFF), 0), SLOPE_MOST);
    l->offset = l->n > 0 ? (l->y - l->slope * l->x) / l->n : 0;
    l->n = l->x = l->y = l->xx = l->xy = 0;
}

/** Adds a sample to the fit. Returns 1 / (1 + squared residual) under the current fit. */
static double add_line(line side[3], const float rgb[3], const adcgs_sample *s)
{
    double off = 0;
    for (int a = 0; a < 3; a++)
        off += pow(side[a].slope * (double)rgb[a] + side[a].offset - s->rgb[a], 2);
    const double fits = 1 / (1 + off / (OFF_LAST * OFF_LAST));
    for (int a = 0; a < 3; a++) {
        const double x = (double)rgb[a], w = fits * fits;
        side[a].n += w;
        side[a].x += w * x;
        side[a].y += w * s->rgb[a];
        side[a].xx += w * x * x;
        side[a].xy += w * x * s->rgb[a];
    }
    return fits;
}

double adcgs_direct_any_light(const adcgs_body_model *m, const adcgs_frame_views *views, uint32_t stride, const adcgs_rigid *at)
{
    line lines[ADCGS_BODY_SIDES][3];
    double light = 0;
    memset(lines, 0, sizeof lines);
    for (int i = 0; i < 3 * ADCGS_BODY_SIDES; i++)
        lines[i / 3][i % 3].slope = 1;
    for (int round = 0; round < LIGHT_ROUNDS; round++) {
        double n = 0;
        light = 0;
        for (uint32_t i = 0; i < m->n; i += stride) {
            double x[3], normal[3], where[2], depth;
            adcgs_sample s;
            if (!adcgs_body_point_at(m, i, at, views, x, normal))
                continue;
            for (int k = 0; k < views->n; k++) {
                if (!sample_view(views, k, x, normal, where, &depth, &s))
                    continue;
                light += add_line(lines[m->more[i].side], m->p[i].rgb, &s);
                n++;
            }
        }
        light = n > 0 ? light / n : 0;
        for (int i = 0; i < 3 * ADCGS_BODY_SIDES; i++)
            fit_line(&lines[i / 3][i % 3]);
    }
    return light;
}
