/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Trials of adcgs-enc. */
#include "config.h"

#include "session/enc_trials.h"

#include "system/interrupt.h"
#include "train/resolve.h"
#include "train/trial/trial.h"

static int show(void *user, const char *without, uint32_t done, uint32_t most)
{
    adcgs_enc_context *w = user;
    if (!adcgs_enc_team_follows(&w->team))
        adcgs_progress_show(&w->progress, "trials    %u of at most %u: %s%s", done + 1, most,
                            without ? "without " : "all mechanisms", without ? without : "");
    return adcgs_interrupted();
}

static void tell(const adcgs_enc_job *job, const adcgs_trials *t)
{
    if (job->ranks && job->ranks->rank) /* the first rank reports for all */
        return;
    for (uint32_t i = 0; i < t->n; i++)
        if (t->of[i].dropped)
            adcgs_cli_note(job->cli,
                           "%s: without %s %u held-out images have %.2f dB instead of %.2f in trials of %u iterations: "
                           "it is turned off; --set trial_share=0 keeps it",
                           job->scene->directory, adcgs_mechanism_names[t->of[i].mechanism], t->views, t->of[i].without,
                           t->of[i].with, t->iterations);
}

adcgs_status adcgs_enc_try(adcgs_enc_job *job, adcgs_enc_context *w, adcgs_error *error)
{
    const adcgs_trials_options options = {.cpu = job->cpu,
                                          .pool = job->pool,
                                          .memory = job->o->memory,
                                          .progress = show,
                                          .user = w};
    adcgs_trials trials;
    uint8_t dropped[ADCGS_MECHANISMS];
    const char *const state = job->o->finish ? job->o->finish : job->o->resume;
    if (state && !job->o->has_segment) {
        ADCGS_TRY(adcgs_checkpoint_dropped(dropped, state, error));
        adcgs_resolve_trials(&job->config, dropped);
        return ADCGS_OK;
    }
    ADCGS_TRY(adcgs_trials_run(&trials, &job->config, job->scene, &options, error));
    adcgs_trials_dropped(&trials, dropped);
    adcgs_resolve_trials(&job->config, dropped);
    adcgs_progress_clear(&w->progress);
    adcgs_trials_format(&trials, w->trials);
    tell(job, &trials);
    return ADCGS_OK;
}
