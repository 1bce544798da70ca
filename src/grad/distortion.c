/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Depth distortion: its images, energy and gradient. */
#include "grad/distortion.h"

#include <math.h>

static const float black[3] = {0, 0, 0}; /* background; definition */
/** Minimum coverage of a pixel; below it, the variance of depth is meaningless; chosen by hand, not measured. */
static const float COVER_LEAST = 0.01f;

void adcgs_distortion_clear(adcgs_distortion *d)
{
    adcgs_free(NULL, d->rows);
    adcgs_free(NULL, d->depth);
    adcgs_free(NULL, d->image);
    *d = (adcgs_distortion){.slots = 0};
}

static adcgs_status make_room(adcgs_distortion *d, size_t slots, size_t pixels, adcgs_error *error)
{
    if (slots <= d->slots && pixels <= d->pixels)
        return ADCGS_OK;
    slots = ADCGS_MAX(slots, d->slots);
    pixels = ADCGS_MAX(pixels, d->pixels);
    adcgs_distortion_clear(d);
    d->rows = adcgs_alloc(NULL, slots * ADCGS_GRAD_ROWS, sizeof *d->rows, error);
    d->depth = adcgs_alloc(NULL, slots * 3, sizeof *d->depth, error);
    d->image = adcgs_alloc(NULL, pixels * 6, sizeof *d->image, error);
    if (!d->rows || !d->depth || !d->image)
        return adcgs_alloc_status(error);
    d->slots = slots;
    d->pixels = pixels;
    return ADCGS_OK;
}

/**
 * Sets inverse to 1 / z of all visible primitives, and to 0 for the others. Returns the mean over the visible ones, 0 without
 * any.
 */
static float inverse_depths(const adcgs_primitives *p, const adcgs_view *v, float *inverse)
{
    double sum = 0;
    size_t seen = 0;
    for (size_t i = 0; i < p->n; i++) {
        const float z =
            v->rotation[6] * p->mean[0][i] + v->rotation[7] * p->mean[1][i] + v->rotation[8] * p->mean[2][i] + v->translation[2];
        const int can = z > v->near_plane && p->opacity[i] > 0;
        inverse[i] = can ? 1 / z : 0;
        sum += (double)inverse[i];
        seen += (size_t)can;
    }
    return seen ? (float)(sum / (double)seen) : 0;
}

/** Energy of the rendered sums, image [3][pixels]: of u, of u^2, and of 1. grad: gradient with respect to these, times weight. */
static double energy_of(const float *image, float *grad, size_t pixels, float weight)
{
    const float soft = ADCGS_DISTORTION_SOFT * ADCGS_DISTORTION_SOFT, each = weight / (float)pixels;
    double energy = 0;
    for (size_t i = 0; i < pixels; i++) {
        const float first = image[i], second = image[pixels + i], cover = image[2 * pixels + i];
        const float cover2 = fmaxf(cover * cover, COVER_LEAST * COVER_LEAST);
        const float variance = fmaxf(cover * second - first * first, 0) / cover2, by = each / (soft + variance);
        energy += (double)(cover2 * logf(1 + variance / soft));
        grad[i] = -2 * first * by;
        grad[pixels + i] = cover * by;
        grad[2 * pixels + i] = second * by;
    }
    return energy / (double)pixels;
}

/** u = 1 - m / z, so du/dz = m / z^2. */
static void add_gradient(const adcgs_raster_grads *from, const adcgs_raster_grads *to, const float *u, float inverse_mean,
                         const adcgs_view *v, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const float inverse = (1 - u[i]) * inverse_mean;
        const float dz = (from->colour[0][i] + 2 * u[i] * from->colour[1][i]) * inverse * inverse / inverse_mean;
        for (int a = 0; a < 3; a++)
            to->mean[a][i] += from->mean[a][i] + dz * v->rotation[6 + a];
        for (int a = 0; a < 3; a++)
            to->scale[a][i] += from->scale[a][i];
        for (int a = 0; a < 4; a++)
            to->rotation[a][i] += from->rotation[a][i];
        to->opacity[i] += from->opacity[i];
    }
}

adcgs_status adcgs_distortion_add(adcgs_distortion *d, adcgs_raster *raster, adcgs_raster_back *back,
                                  const adcgs_primitives *primitives, const adcgs_view *view, float filter, float weight,
                                  const adcgs_raster_grads *grads, double *energy, adcgs_error *error)
{
    const size_t n = primitives->n, pixels = (size_t)view->width * (size_t)view->height;
    ADCGS_TRY(make_room(d, n, pixels, error));
    float *u = d->depth, *square = u + n, *one = square + n, *image = d->image, *grad = image + 3 * pixels;
    const float inverse_mean = inverse_depths(primitives, view, u);
    if (energy)
        *energy = 0;
    if (!(inverse_mean > 0))
        return ADCGS_OK;
    for (size_t i = 0; i < n; i++) {
        u[i] = 1 - u[i] / inverse_mean;
        square[i] = u[i] * u[i];
        one[i] = 1;
    }
    adcgs_primitives depths = *primitives;
    depths.colour[0] = u;
    depths.colour[1] = square;
    depths.colour[2] = one;
    ADCGS_TRY(adcgs_raster_forward(raster, &depths, view, black, filter, image, 1, error));
    const double mean = energy_of(image, grad, pixels, weight);
    adcgs_raster_grads own = adcgs_raster_grads_of(d->rows, n);
    own.screen = NULL;
    ADCGS_TRY(adcgs_raster_backward(back, raster, &depths, view, black, filter, image, grad, &own, error));
    add_gradient(&own, grads, u, inverse_mean, view, n);
    if (energy)
        *energy = mean;
    return ADCGS_OK;
}
