/* SPDX-License-Identifier: BSD-2-Clause */
/** \file States that a run leaves when it is stopped or fails. */
#include "config.h"

#include "session/enc_rescue.h"

#include "scene/spool.h"
#include "system/paths.h"

#include <stdlib.h>

int adcgs_enc_is_ready(const adcgs_enc_context *w)
{
    return w->o->output && !w->segments && w->t->run.iteration;
}

/** Returns the same base name in the folder of temporary files, from malloc(). */
static char *name_elsewhere(const char *name)
{
    char *const folder = adcgs_spool_folder(), *const slash = strrchr(name, '/');
    char *const path = folder ? adcgs_path("%s/%s", folder, slash ? slash + 1 : name) : NULL;
    free(folder);
    return path;
}

adcgs_status adcgs_enc_save(const adcgs_enc_context *w, const char *name, int reads_images, char **path, adcgs_error *error)
{
    adcgs_error ignored;
    adcgs_status status = reads_images ? adcgs_trainer_save(w->t, name, error) : adcgs_trainer_rescue(w->t, name, error);
    if (status != ADCGS_OK && !w->t->views.has_content && reads_images) /* unreadable images must not prevent saving the state */
        status = adcgs_trainer_rescue(w->t, name, error);
    *path = status == ADCGS_OK ? strdup(name) : name_elsewhere(name);
    if (status != ADCGS_OK && *path && adcgs_trainer_rescue(w->t, *path, &ignored) == ADCGS_OK)
        status = ADCGS_OK;
    if (status != ADCGS_OK || *path)
        return status;
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", name);
}

void adcgs_enc_report_continuation(const adcgs_cli *cli, const adcgs_enc_context *w, const char *what, const char *path)
{
    const int is_elsewhere = strcmp(path, w->state) != 0;
    const char *const resume = w->o->plan ? "" : " and --resume ", *const base = w->o->plan ? "" : w->segments ? w->base : path;
    char at[64] = "";
    if (w->segments)
        snprintf(at, sizeof at, " of segment %u of %u", w->segment + 1, w->segments);
    if (w->segments && is_elsewhere)
        adcgs_cli_error(cli, ADCGS_OK, "%s at iteration %u%s; move %s to %s, and continue with the same command%s%s", what,
                        adcgs_trainer_rescued(w->t), at, path, w->state, resume, base);
    else
        adcgs_cli_error(cli, ADCGS_OK, "%s at iteration %u%s; continue with the same command%s%s%s", what,
                        adcgs_trainer_rescued(w->t), at, resume, base,
                        adcgs_enc_is_ready(w) ? "; or make a file of this state with --finish" : "");
}

void adcgs_enc_rescue(const adcgs_cli *cli, adcgs_enc_context *w, adcgs_status status)
{
    adcgs_error why = {ADCGS_OK, ""};
    char *path;
    if (!w->t || w->is_live || w->o->finish || status == ADCGS_ERR_USAGE || !adcgs_trainer_rescued(w->t))
        return;
    adcgs_progress_clear(&w->progress);
    if (adcgs_enc_save(w, w->state, 0, &path, &why) != ADCGS_OK)
        adcgs_cli_error(cli, ADCGS_OK, "a failure ends the run at iteration %u, and its state is lost: %s", w->t->run.iteration,
                        why.text);
    else
        adcgs_enc_report_continuation(cli, w, "a failure ends the run: the state is saved", path);
    free(path);
}
