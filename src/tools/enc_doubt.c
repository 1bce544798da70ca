/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Cameras that are not where they are said to be show in the training views: the others outvote them. */
#include "tools/enc_doubt.h"

#include "data/sort.h"
#include "grad/random.h"
#include "metric/evaluate.h"

#include <math.h>

#define VIEWS 96         /* that are measured at most */
#define CAMERAS_FEW 3    /* which stay: what is between them is a guess */
#define CAMERAS_MANY 5   /* enough for one to be odd */
#define DB_ODD 6.0       /* below the median camera, and SPREADS times as far below the quartile as that is below the median */
#define SPREADS 3.0      /* cameras of a rig that see more or less of what is hard may differ as much, but not one alone */
#define DB_UNSEEN 8.0    /* that views that training never saw are worse by, where each camera is given its pictures alone */
#define NAMED 3

typedef struct tally {
    double sum;
    uint32_t n;
    const char *name; /* of its first view that is measured */
} tally;

/** Of each camera, and the interrupts that came before. */
typedef struct tallies {
    tally of[VIEWS];
    int heard;
} tallies;

static adcgs_status count(void *user, const adcgs_view_score *score, adcgs_error *error)
{
    tallies *const all = user;
    tally *const t = &all->of[score->camera];
    if (adcgs_interrupts() > all->heard)
        return adcgs_fail(error, ADCGS_ERR_IO, "interrupted");
    t->sum += score->fitted_psnr;
    t->name = t->n++ ? t->name : score->view->camera.name;
    return ADCGS_OK;
}

static void say_odd(const adcgs_cli *cli, const tally *list, int cameras, const char *file)
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
            adcgs_cli_note(cli, "%s: the camera of view %s has %.1f dB, the median camera %.1f: is its pose right?", file,
                           list[i].name, mean[i], median);
}

void adcgs_enc_doubt(const adcgs_cli *cli, adcgs_decoder *decoder, const adcgs_scene *scene, double unseen, const char *file,
                     int heard)
{
    const uint32_t all = scene->n_views[ADCGS_SPLIT_TRAIN], n = ADCGS_MIN(all, VIEWS);
    adcgs_scene_view picked[VIEWS];
    tallies found = {.heard = heard};
    adcgs_scene some = *scene;
    adcgs_evaluation mean;
    adcgs_error error;
    if (*cli->quiet || !n)
        return;
    /* One of each stretch of views, anywhere in it: cameras may come in turns. */
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
        adcgs_cli_note(cli, "%s: filmed by %d camera%s: what is seen from elsewhere is a guess", file, cameras,
                       cameras > 1 ? "s" : "");
    if (unseen < mean.psnr - DB_UNSEEN)
        adcgs_cli_note(cli, "%s: training views have %.1f dB, others %.1f: are poses, axes and times right, and views enough?",
                       file, mean.psnr, unseen);
    say_odd(cli, found.of, cameras, file);
}
