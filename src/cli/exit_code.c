/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Exit codes of the programs. */
#include "config.h"

#include "cli/cli.h"

int adcgs_exit_code(adcgs_status status)
{
    switch (status) {
    case ADCGS_OK:
        return 0;
    case ADCGS_ERR_USAGE:
        return 2;
    case ADCGS_ERR_MEMORY:
    case ADCGS_ERR_IO:
        return 3;
    case ADCGS_ERR_DATA:
    case ADCGS_ERR_TRUNCATED:
    case ADCGS_ERR_LIMIT:
        return 4;
    case ADCGS_ERR_UNSUPPORTED:
    case ADCGS_ERR_FPENV:
        return 5;
    default:
        return 1;
    }
}
