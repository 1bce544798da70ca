/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The stream of an earlier live run. */
#include "config.h"

#include "session/enc_live_resume.h"

#include "session/resume_reader.h"
#include "system/text.h"

/** Adds the last segment unchanged. */
static adcgs_status add_last(adcgs_enc_live_resume *p, adcgs_encode_live *stream, adcgs_enc_live_file *file, adcgs_error *error)
{
    adcgs_buffer bytes;
    const double begin = p->last.time_start;
    adcgs_buffer_init(&bytes);
    adcgs_status status = adcgs_encode_live_add(stream, &p->last, &bytes, error);
    if (status == ADCGS_OK)
        status = adcgs_enc_live_file_append(file, bytes.data, bytes.size, error);
    p->bytes += bytes.size;
    p->n++;
    p->key = stream->model.predicted ? p->key : begin;
    adcgs_buffer_clear(&bytes);
    return status;
}

static adcgs_status take_segments(adcgs_enc_live_resume *p, adcgs_resume_reader *from, adcgs_encode_live *stream,
                                  adcgs_enc_live_file *file, uint32_t max_anchors, const adcgs_enc_job *job, adcgs_error *error)
{
    adcgs_model model;
    for (;;) {
        ADCGS_TRY(adcgs_resume_reader_next(from, &model, error));
        if (!model.n)
            return ADCGS_OK;
        const adcgs_status status =
            p->last.n ? add_last(p, stream, file, error)
                      : adcgs_encode_live_continue(stream, &from->stream, max_anchors, job->cpu, job->pool, error);
        adcgs_model_clear(&p->last, NULL);
        p->last = model;
        ADCGS_TRY(status);
    }
}

static void tell(const adcgs_enc_live_resume *p, const adcgs_resume_reader *from, const adcgs_cli *cli)
{
    const char *const fault = from->fault.status != ADCGS_OK ? from->fault.text : NULL;
    adcgs_cli_note(cli, "%s: %u segment%s %s complete, to %g s%s%s", from->path, p->n + 1, adcgs_s(p->n + 1), p->n ? "are" : "is",
                   p->last.time_end, fault ? "; after that: " : "", fault ? fault : "");
}

adcgs_status adcgs_enc_live_resume_read(adcgs_enc_live_resume *p, adcgs_encode_live *stream, adcgs_enc_live_file *file,
                                        uint32_t max_anchors, const adcgs_enc_job *job, adcgs_error *error)
{
    adcgs_resume_reader from;
    adcgs_status status = adcgs_resume_reader_open(&from, job->o->resume, job->cpu, job->pool, error);
    if (status == ADCGS_OK)
        status = take_segments(p, &from, stream, file, max_anchors, job, error);
    if (status == ADCGS_OK && !p->last.n)
        status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: no complete segment, so nothing can be continued%s%s", job->o->resume,
                            from.fault.status != ADCGS_OK ? "; " : "", from.fault.text);
    if (status == ADCGS_OK)
        tell(p, &from, job->cli);
    adcgs_resume_reader_close(&from);
    return status;
}

adcgs_status adcgs_enc_live_resume_end(adcgs_enc_live_resume *p, adcgs_encode_live *stream, adcgs_enc_live_file *file,
                                       double begin, adcgs_error *error)
{
    const double tick = (double)stream->front.timebase_num / stream->front.timebase_den;
    const int is_whole = begin > p->last.time_end - tick;
    const adcgs_status status = p->last.n && is_whole ? add_last(p, stream, file, error) : ADCGS_OK;
    adcgs_enc_live_resume_clear(p);
    return status;
}

void adcgs_enc_live_resume_clear(adcgs_enc_live_resume *p)
{
    adcgs_model_clear(&p->last, NULL);
    p->last = (adcgs_model){.n = 0};
}
