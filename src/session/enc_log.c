/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The log of a run: JSON lines. */
#include "config.h"

#include "session/enc_log.h"

#include "system/json.h"
#include "train/resolve.h"

#include <math.h>

static void log_line(adcgs_enc_context *w, adcgs_json *line)
{
    if (adcgs_json_write(line, w->log, w->o->log, &w->log_error) != ADCGS_OK) {
        fclose(w->log); /* the run continues without its log, and reports this at its end */
        w->log = NULL;
    }
}

/** Begins a line with the members of all lines. */
static void open_line(adcgs_enc_context *w, adcgs_json *line, const char *stage)
{
    adcgs_json_init(line);
    line->is_line = 1;
    line->digits = 6;
    adcgs_json_open(line, NULL, '{');
    adcgs_json_string(line, "stage", stage);
    if (w->segments || w->is_live)
        adcgs_json_int(line, "segment", w->segment + 1);
    adcgs_json_int(line, "iteration", w->last.iteration);
}

void adcgs_enc_log_settings(adcgs_enc_context *w)
{
    adcgs_resolution r;
    adcgs_json line;
    if (!w->log || w->told_settings)
        return;
    w->told_settings = 1;
    open_line(w, &line, "settings");
    adcgs_json_open(&line, "changes", '[');
    for (size_t row = 0; adcgs_resolve_next(&w->t->config, &row, &r);) {
        adcgs_json_open(&line, NULL, '{');
        adcgs_json_string(&line, "setting", r.setting->name);
        adcgs_json_real(&line, "requested", r.requested);
        adcgs_json_real(&line, "used", r.used);
        adcgs_json_string(&line, "by", r.by);
        adcgs_json_string(&line, "reason", r.reason);
        adcgs_json_close(&line);
    }
    adcgs_json_close(&line);
    adcgs_json_close(&line);
    log_line(w, &line);
}

void adcgs_enc_log_decisions(adcgs_enc_context *w)
{
    adcgs_decision list[ADCGS_DECISIONS];
    adcgs_json line;
    if (!w->log)
        return;
    adcgs_decisions_list(&w->t->decisions, list);
    open_line(w, &line, "decisions");
    for (int i = 0; i < ADCGS_DECISIONS; i++)
        adcgs_json_real(&line, list[i].name, list[i].value);
    adcgs_json_close(&line);
    log_line(w, &line);
}

void adcgs_enc_log_last(adcgs_enc_context *w)
{
    const adcgs_train_report *r = &w->last;
    if (!w->log)
        return;
    w->next_log = r->iteration + 100;
    static const char *const streams[ADCGS_GROUPS] = {"eta", "f_v", "Sigma", "C", "f_g1", "f_g2", "f_g3", "f_g4"};
    adcgs_json line;
    open_line(w, &line, r->stage);
    adcgs_json_int(&line, "of", r->iterations);
    if (r->iteration) {
        adcgs_json_real(&line, "loss", r->loss);
        adcgs_json_real(&line, "psnr", r->psnr);
    }
    adcgs_json_int(&line, "anchors", r->anchors);
    adcgs_json_int(&line, "divide", r->divide);
    adcgs_json_real(&line, "bytes", round(r->bytes));
    adcgs_json_real(&line, "lambda", r->lambda);
    adcgs_json_real(&line, "rate", r->rate);
    adcgs_json_real(&line, "seconds", r->spent.clock);
    adcgs_json_real(&line, "cpu_seconds", r->spent.cpu);
    adcgs_json_int(&line, "rollbacks", r->rollbacks);
    if (r->attempt)
        adcgs_json_int(&line, "attempt", r->attempt);
    adcgs_json_open(&line, "streams", '{');
    for (int i = 0; i < ADCGS_GROUPS; i++)
        adcgs_json_real(&line, streams[i], round(r->stream[i]));
    adcgs_json_close(&line);
    adcgs_json_close(&line);
    log_line(w, &line);
}
