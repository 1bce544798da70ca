/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Wrong camera poses show in the training views, since the other cameras outvote them. */
#include "session/enc_diagnose.h"

#include "grad/random.h"
#include "metric/evaluate.h"
#include "system/interrupt.h"
#include "system/sort_values.h"

#include <math.h>

/*
 * Origin: chosen by hand, and checked on scenes with one fault, on zju313_15f with its 17 unlike cameras, and on scenes in order.
 */
#define VIEWS 96       /* most views that are measured */
#define CAMERAS_FEW 3  /* static cameras: views between them are unreliable */
#define CAMERAS_MANY 5 /* enough cameras for one to be an outlier */
/* Below the median camera, dB, and SPREADS times as far below the quartile as that is below the median. */
#define DB_ODD 6.0
#define SPREADS 3.0   /* cameras of a rig with harder or easier views may differ as much, but not a single one */
#define DB_UNSEEN 8.0 /* dB: deficit of views that training never saw, if each camera fits only its own images */
#define NAMED 3       /* most cameras that a message names */

typedef struct tally {
    double sum;
    uint32_t n;
    const char *name; /* name of its first measured view */
} tally;

/** The tallies of all cameras, and the number of earlier interrupts. */
typedef struct tallies {
    tally of[VIEWS];
    int interrupts;
} tallies;

static adcgs_status count(void *user, const adcgs_view_score *score, adcgs_error *error)
{
    tallies *const all = user;
    tally *const t = &all->of[score->camera];
    if (adcgs_interrupts() > all->interrupts)
        return adcgs_fail(error, ADCGS_ERR_IO, "interrupted");
    t->sum += score->fitted_psnr;
    t->name = t->n++ ? t->name : score->view->camera.name;
    return ADCGS_OK;
}

static void report_outliers(const adcgs_cli *cli, const tally *list, int cameras, const char *file)
{
    double mean[VIEWS], sorted[VIEWS];
    int named = 0;
    for (int i = 0; i < cameras; i++)
        sorted[i] = mean[i] = list[i].sum / list[i].n;
    adcgs_sort(sorted, (size_t)cameras);
    const double median = sorted[cameras / 2], quartile = sorted[cameras / 4];
    const double odd = fmin(median - DB_ODD, quartile - SPREADS * (median - quartile));
    for (int i = 0; i < cameras && cameras >= CAMERAS_MANY && named < NAMED; i++)
        if (mean[i] < odd && ++named)
            adcgs_cli_note(cli, "%s: the camera of view %s has %.1f dB, the median camera %.1f: check its pose", file,
                           list[i].name, mean[i], median);
}

void adcgs_enc_diagnose(const adcgs_cli *cli, adcgs_decoder *decoder, const adcgs_scene *scene, double unseen, const char *file,
                        int interrupts)
{
    const uint32_t all = scene->n_views[ADCGS_SPLIT_TRAIN], n = ADCGS_MIN(all, VIEWS);
    adcgs_scene_view picked[VIEWS];
    tallies found = {.interrupts = interrupts};
    adcgs_scene some = *scene;
    adcgs_evaluation mean;
    adcgs_error error;
    if (*cli->quiet || !n || scene->splats) /* the encoder itself placed the cameras of splats */
        return;
    /* Picks one view of each stretch of views, at a random place: cameras may take turns. */
    for (uint32_t i = 0; i < n; i++) {
        const uint64_t from = (uint64_t)all * i / n, until = (uint64_t)all * (i + 1) / n;
        picked[i] = scene->views[ADCGS_SPLIT_TRAIN][from + adcgs_random64(0, 0, i) % (until - from)];
    }
    some.views[ADCGS_SPLIT_TRAIN] = picked;
    some.n_views[ADCGS_SPLIT_TRAIN] = n;
    if (adcgs_evaluate(&mean, decoder, &some, ADCGS_SPLIT_TRAIN, ADCGS_MEASURE_FITTED, count, &found, &error) != ADCGS_OK)
        return;
    int cameras = 0;
    while (cameras < (int)n && found.of[cameras].n)
        cameras++;
    if (cameras <= CAMERAS_FEW && cameras < (int)n)
        adcgs_cli_note(cli, "%s: filmed by %d camera%s: other viewpoints are unreliable", file, cameras, cameras > 1 ? "s" : "");
    if (unseen < mean.psnr - DB_UNSEEN)
        adcgs_cli_note(cli, "%s: training views have %.1f dB, others %.1f: check poses, axes and times, and the number of views",
                       file, mean.psnr, unseen);
    report_outliers(cli, found.of, cameras, file);
}
