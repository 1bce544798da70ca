/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Bytes that arrive in order. */
#include "net/incoming.h"

adcgs_status adcgs_incoming_open(adcgs_incoming *in, const char *path, int (*interrupted)(void), adcgs_error *error)
{
    const adcgs_http_config config = {.interrupted = interrupted};
    *in = (adcgs_incoming){.name = path};
    if (adcgs_is_url(path))
        return adcgs_http_open(&in->http, path, &config, error);
    const adcgs_status status = adcgs_pipe_open(&in->pipe, path, error);
    in->name = in->pipe.name;
    return status;
}

void adcgs_incoming_close(adcgs_incoming *in)
{
    adcgs_http_close(&in->http);
    adcgs_pipe_close(&in->pipe);
}

adcgs_status adcgs_incoming_read(adcgs_incoming *in, void *buffer, size_t bytes, size_t *got, adcgs_error *error)
{
    if (in->http)
        return adcgs_http_take(in->http, buffer, bytes, got, &in->ended, error);
    const adcgs_status status = adcgs_pipe_read(&in->pipe, buffer, bytes, got, error);
    in->ended = in->pipe.ended;
    return status;
}
