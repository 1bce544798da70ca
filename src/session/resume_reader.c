/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reads back a stream that is to be continued. */
#include "config.h"

#include "session/resume_reader.h"

#include "model/model_priv.h"

#include <errno.h>
#include <stdlib.h>

#define READ_BYTES 65536 /* bytes read at a time; chosen by hand, not measured */

adcgs_status adcgs_resume_reader_open(adcgs_resume_reader *p, const char *path, adcgs_cpu_level cpu, adcgs_pool *pool,
                                      adcgs_error *error)
{
    const adcgs_read_options options = {.cpu = cpu, .pool = pool};
    *p = (adcgs_resume_reader){.path = path, .file = fopen(path, "rb")};
    adcgs_stream_init(&p->stream);
    if (!p->file)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: %s", path, strerror(errno));
    p->bytes = malloc(READ_BYTES);
    if (!p->bytes)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    return adcgs_push_create(&p->reader, &p->stream, &options, error);
}

void adcgs_resume_reader_close(adcgs_resume_reader *p)
{
    adcgs_push_free(&p->reader);
    adcgs_stream_clear(&p->stream, NULL);
    if (p->file)
        fclose(p->file);
    free(p->bytes);
    *p = (adcgs_resume_reader){.file = NULL};
}

/** Decodes to the end of a chunk at most. A fault of the stream ends reading, without a failure. */
static adcgs_status step(adcgs_resume_reader *p, adcgs_error *error)
{
    adcgs_arrival arrived = ADCGS_ARRIVED_NOTHING;
    size_t used = 0;
    if (p->n == 0) {
        p->at = 0;
        p->n = fread(p->bytes, 1, READ_BYTES, p->file);
        p->over = p->n == 0;
    }
    if (ferror(p->file))
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot read it back", p->path);
    if (p->over)
        return ADCGS_OK;
    const adcgs_status status = adcgs_push_take(p->reader, p->bytes + p->at, p->n, &used, &arrived, &p->fault);
    p->at += used;
    p->n -= used;
    p->over = status != ADCGS_OK || arrived == ADCGS_ARRIVED_END;
    if (status != ADCGS_ERR_MEMORY)
        return ADCGS_OK;
    *error = p->fault;
    return status;
}

/** Returns the last segment before the file ends or its damage begins, if the segment is complete. */
static adcgs_status take_last(adcgs_resume_reader *p, adcgs_model *model, adcgs_error *error)
{
    adcgs_push_progress progress;
    int drawable = 0;
    if (!adcgs_push_has_head(p->reader))
        return ADCGS_OK;
    adcgs_push_get_progress(p->reader, &progress);
    if (progress.tiers)
        ADCGS_TRY(adcgs_push_peek(p->reader, model, &drawable, error));
    if (drawable && !model->absent && model->layers == adcgs_params_layers(&model->params))
        return ADCGS_OK;
    adcgs_model_clear(model, NULL);
    *model = (adcgs_model){.n = 0};
    return ADCGS_OK;
}

adcgs_status adcgs_resume_reader_next(adcgs_resume_reader *p, adcgs_model *model, adcgs_error *error)
{
    *model = (adcgs_model){.n = 0};
    while (!p->over && p->stream.first_segment + p->stream.n_segments == p->given)
        ADCGS_TRY(step(p, error));
    const uint32_t held = p->stream.n_segments;
    if (p->stream.first_segment + held == p->given) {
        const int was_asked = p->is_done;
        p->is_done = 1;
        return was_asked ? ADCGS_OK : take_last(p, model, error);
    }
    p->given++;
    ADCGS_TRY(adcgs_model_copy(model, &p->stream.segments[held - 1], NULL, error));
    adcgs_stream_forget(&p->stream, held - 1, NULL); /* prediction needs only the last */
    return ADCGS_OK;
}
