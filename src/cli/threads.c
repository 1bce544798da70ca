/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The threads of a program. */
#include "cli/cli.h"

adcgs_status adcgs_cli_pool(const adcgs_cli *cli, adcgs_pool **out, int threads, adcgs_error *error)
{
    ADCGS_TRY(adcgs_pool_create(out, threads, error));
    if (adcgs_pool_missing(*out))
        adcgs_cli_note(cli, "%d of %d threads could not be started; continuing with %d, which takes longer",
                       adcgs_pool_missing(*out), adcgs_pool_missing(*out) + adcgs_pool_threads(*out), adcgs_pool_threads(*out));
    return ADCGS_OK;
}
