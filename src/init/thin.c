/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Thinning by grid cells. Bisection finds the cell width that leaves the wanted number of points. */
#include "init/thin.h"

#include "grad/random.h"

#include <math.h>
#include <stdlib.h>

/* Chosen by hand, not measured. */
enum { ROUNDS = 16 };      /* bisection steps of the cells' width */
#define DETAIL_LEAST 0.02f /* contrast up to which cells have the chosen width */
#define FINER_MOST 16      /* maximum ratio of contrasts by which cells become smaller */
#define WIDTH_FINEST 0.5   /* pixels: bounds of the cells' width */
#define WIDTH_COARSEST 4096

/** A point, its cell, and its squared distance from the cell's centre. */
typedef struct entry {
    uint64_t cell;
    double off;
    uint32_t point;
} entry;

static int by_cell(const void *a, const void *b)
{
    const entry *p = a, *q = b;
    if (p->cell != q->cell)
        return p->cell < q->cell ? -1 : 1;
    if (p->off < q->off || p->off > q->off)
        return p->off < q->off ? -1 : 1;
    return p->point < q->point ? -1 : p->point > q->point;
}

/** Cell edges are powers of sqrt 2, so that points of several views share cells. */
static void set_entry(entry *e, const adcgs_stereo_point *p, double width)
{
    const double finer = sqrt((double)fminf(fmaxf(p->detail / DETAIL_LEAST, 1), FINER_MOST));
    const int level = (int)floor(2 * log2(width * (double)p->size / finer));
    const double edge = exp2(0.5 * level);
    uint64_t cell = adcgs_mix64((uint64_t)level);
    e->off = 0;
    for (int a = 0; a < 3; a++) {
        const double at = p->x[a] / edge, whole = floor(at);
        cell = adcgs_mix64(cell ^ (uint64_t)(int64_t)whole);
        e->off += pow(at - whole - 0.5, 2);
    }
    e->cell = cell;
}

static uint32_t count(entry *e, const adcgs_stereo_list *list, double width)
{
    uint32_t cells = 0;
    for (uint32_t i = 0; i < list->n; i++) {
        e[i].point = i;
        set_entry(&e[i], &list->point[i], width);
    }
    qsort(e, list->n, sizeof *e, by_cell);
    for (uint32_t i = 0; i < list->n; i++)
        cells += !i || e[i].cell != e[i - 1].cell;
    return cells;
}

adcgs_status adcgs_stereo_thin(adcgs_stereo_list *list, uint32_t most, adcgs_error *error)
{
    double fine = WIDTH_FINEST, coarse = WIDTH_COARSEST;
    if (list->n < 2)
        return ADCGS_OK;
    entry *e = adcgs_alloc(NULL, list->n, sizeof *e, error);
    adcgs_stereo_point *kept = adcgs_alloc(NULL, (size_t)most + 1, sizeof *kept, error);
    for (int i = 0; i < ROUNDS && e && kept; i++) {
        const double width = sqrt(fine * coarse);
        *(count(e, list, width) > most ? &fine : &coarse) = width;
    }
    const adcgs_status status = e && kept ? ADCGS_OK : adcgs_alloc_status(error);
    if (status == ADCGS_OK) {
        uint32_t n = 0;
        count(e, list, coarse);
        for (uint32_t i = 0; i < list->n && n < most; i++)
            if (!i || e[i].cell != e[i - 1].cell)
                kept[n++] = list->point[e[i].point];
        adcgs_free(NULL, list->point);
        list->point = kept;
        list->n = n;
        list->capacity = (size_t)most + 1;
        kept = NULL;
    }
    adcgs_free(NULL, kept);
    adcgs_free(NULL, e);
    return status;
}
