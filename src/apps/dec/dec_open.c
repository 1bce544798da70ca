/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Opens a stream from any source. */
#include "apps/dec/dec_open.h"

#include "stream/input.h"
#include "stream/salvage.h"
#include "system/interrupt.h"

#include <stdlib.h>

/** Opens a stream that is read in order, within the budget. */
static adcgs_status open_in_order(adcgs_decoder **decoder, adcgs_read_fn read, void *user, const adcgs_dec_open_config *how,
                                  adcgs_error *error)
{
    return how->budget->of == ADCGS_BUDGET_BYTES ? adcgs_budget_open(decoder, how->budget, read, user, how->config, error)
                                                 : adcgs_open_stream(decoder, read, user, how->config, error);
}

/** Opens the bytes of a file or page that the budget allows. */
static adcgs_status open_part(adcgs_decoder **decoder, const char *input, const adcgs_dec_open_config *how, adcgs_error *error)
{
    adcgs_operand source;
    ADCGS_TRY(adcgs_operand_open(&source, input, NULL, error));
    const adcgs_status status = open_in_order(decoder, adcgs_operand_read, &source, how, error);
    adcgs_operand_close(&source);
    if (status != ADCGS_OK)
        adcgs_error_locate(error, input);
    return status;
}

/** Loads the whole stream first: a damaged stream is read several times. */
static adcgs_status open_whole(adcgs_decoder **decoder, const char *input, const adcgs_dec_open_config *how, adcgs_error *error)
{
    uint8_t *data;
    size_t bytes;
    ADCGS_TRY(adcgs_http_load(&data, &bytes, input, adcgs_salvage_bytes, adcgs_interrupted, error));
    const adcgs_status status = adcgs_open_memory(decoder, data, bytes, how->config, error);
    free(data);
    if (status != ADCGS_OK)
        adcgs_error_locate(error, input);
    return status;
}

/** Reads by ranges if that saves bytes and the server supports them, else in order, with one request. */
static adcgs_status open_url(adcgs_decoder **decoder, adcgs_http **http, const char *input, const adcgs_dec_open_config *how,
                             adcgs_error *error)
{
    const int part = how->budget->of == ADCGS_BUDGET_BYTES;
    const adcgs_http_config config = {.limit = part ? (uint64_t)how->budget->most : 0,
                                      .any_order = how->config->on_demand && !part,
                                      .interrupted = adcgs_interrupted};
    ADCGS_TRY(adcgs_http_open(http, input, &config, error));
    const uint64_t size = adcgs_http_size(*http);
    if (config.any_order && !size)
        adcgs_cli_note(how->cli, "%s: the server supports no ranges: reading the whole stream", input);
    adcgs_status status = size ? adcgs_open_at(decoder, adcgs_http_read_at, *http, size, how->config, error)
                               : open_in_order(decoder, adcgs_http_read, *http, how, error);
    if (status == ADCGS_OK && size)
        return ADCGS_OK; /* the connection stays open for the decoder */
    if (status != ADCGS_OK)
        adcgs_error_locate(error, input);
    status = adcgs_http_explain(*http, status, error);
    adcgs_http_close(http);
    return status;
}

adcgs_status adcgs_dec_report_tune_in(const adcgs_cli *cli, const adcgs_decoder *decoder, const char *name, adcgs_error *error)
{
    adcgs_info info;
    ADCGS_TRY(adcgs_get_info(decoder, &info, sizeof info, error));
    if (info.first_segment > 0)
        adcgs_cli_note(cli, "%s: tuned in at segment %d, at %g s", name, info.first_segment, info.time_start);
    return ADCGS_OK;
}

/** Opens standard input, whose beginning may be missing. A budget of bytes counts from the first byte. */
static adcgs_status open_pipe(adcgs_decoder **decoder, const adcgs_dec_open_config *how, adcgs_error *error)
{
    adcgs_config config = *how->config;
    config.tune_in = how->budget->of != ADCGS_BUDGET_BYTES;
    const adcgs_dec_open_config joining = {.cli = how->cli, .budget = how->budget, .config = &config};
    const adcgs_status status = open_in_order(decoder, adcgs_file_read, stdin, &joining, error);
    if (status != ADCGS_OK)
        adcgs_error_locate(error, "standard input");
    return status == ADCGS_OK ? adcgs_dec_report_tune_in(how->cli, *decoder, "standard input", error) : status;
}

adcgs_status adcgs_dec_open(adcgs_decoder **decoder, adcgs_operand *source, const char *input, const adcgs_dec_open_config *how,
                            adcgs_error *error)
{
    *source = (adcgs_operand){.name = input};
    if (adcgs_is_url(input))
        return how->config->conceal ? open_whole(decoder, input, how, error)
                                    : open_url(decoder, &source->http, input, how, error);
    if (strcmp(input, "-"))
        return how->budget->of == ADCGS_BUDGET_BYTES ? open_part(decoder, input, how, error)
                                                     : adcgs_operand_decode(decoder, source, input, how->config, error);
    return open_pipe(decoder, how, error);
}
