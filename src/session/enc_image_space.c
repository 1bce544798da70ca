/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Memory and disk space for a run's images. */
#include "session/enc_image_space.h"

#include "scene/image_cache.h"
#include "scene/image_store.h"
#include "scene/spool.h"
#include "system/text.h"

#include <stdlib.h>

/** Formats "46.9 GB". */
static const char *show_bytes(uint64_t bytes, char text[24])
{
    static const char *const units[] = {"bytes", "kB", "MB", "GB", "TB"};
    double value = (double)bytes;
    size_t unit = 0;
    while (value >= 1000 && unit + 1 < ADCGS_COUNTOF(units)) {
        value /= 1000;
        unit++;
    }
    snprintf(text, 24, "%.*f %s", unit > 0, value, units[unit]);
    return text;
}

static void tell(const adcgs_enc_context *w, const adcgs_image_store_need *need, const char *folder)
{
    char all[24], memory[24], file[24], room[24];
    const adcgs_cli *const cli = w->progress.cli;
    show_bytes(need->bytes, all);
    show_bytes(need->memory, memory);
    show_bytes(need->file, file);
    if (!need->again)
        adcgs_cli_note(cli, "images at full size take about %s: %s in memory, %s in a file in %s, which has room for %s", all,
                       memory, file, folder, show_bytes(need->room, room));
    else
        adcgs_cli_note(cli,
                       "images at full size take about %s: %s fit into memory, %s into a file in %s%s%s; %u of %u images "
                       "will be decoded again for each use, which is slow: give more --memory, or a TMPDIR with room",
                       all, memory, file, folder, need->problem ? ": " : "", need->problem ? strerror(need->problem) : "",
                       need->again, need->n);
}

adcgs_status adcgs_enc_report_space(adcgs_enc_context *w, adcgs_error *error)
{
    const adcgs_trainer *const t = w->t;
    const adcgs_image_store_config config = {.split = ADCGS_SPLIT_TRAIN, .divide = t->config.scale, .memory = t->views.memory};
    adcgs_image_store_need need;
    if (w->told_room)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_image_store_estimate(&need, t->scene, &config, error));
    char *const folder = adcgs_spool_folder();
    if (folder && need.memory < need.bytes) {
        adcgs_progress_clear(&w->progress);
        tell(w, &need, folder);
        w->told_room = need.again > 0 ? 2 : 1;
    }
    free(folder);
    return ADCGS_OK;
}

void adcgs_enc_keep_images(const adcgs_enc_job *job, const adcgs_scene *scene)
{
    const int ranks = job->ranks ? ADCGS_MAX(job->ranks->local_size, 1) : 1; /* of a host, which share its memory */
    const uint64_t room = adcgs_image_store_default_memory() / (uint64_t)ranks;
    const uint64_t need = adcgs_image_store_least(scene, ADCGS_SPLIT_TRAIN, job->config.scale);
    if (scene->images)
        adcgs_image_cache_limit(scene->images, job->o->memory ? job->o->memory : ADCGS_MIN(need, room));
}

void adcgs_enc_report_no_space(adcgs_enc_context *w)
{
    const char *why;
    const uint32_t n = w->t->views.store ? adcgs_image_store_decoded_again(w->t->views.store, &why) : 0;
    if (!n || w->told_room == 2)
        return;
    adcgs_progress_clear(&w->progress);
    adcgs_cli_note(w->progress.cli, "no room for %u of %u image%s (%s): decoded again for each use, which is slow", n,
                   w->t->views.n, adcgs_s(w->t->views.n), why);
    w->told_room = 2;
}
