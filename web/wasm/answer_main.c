/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The decoder as a command of WASI for the conformance vectors. It answers requests like `adcgs-dec --answer`. */
#include "config.h"

#include "apps/shared/answer.h"

#include "cli/cli.h"
#include "system/interrupt.h"

#include <adcgs/adcgs.h>

#include <stdio.h>

/* WASI has no signals. */
int adcgs_interrupted(void)
{
    return 0;
}

static adcgs_status answer(adcgs_decoder **decoder, const adcgs_requests *requests, const char *path, adcgs_error *error)
{
    adcgs_config config;
    adcgs_config_init(&config, sizeof config);
    config.strict_end = requests->complete;
    config.layers = requests->layers;
    const adcgs_status status = adcgs_open_file(decoder, path, &config, error);
    const char *const fault = adcgs_fault_class(status);
    if (fault)
        printf("fault %s\n", fault);
    return status == ADCGS_OK ? adcgs_requests_answer(requests, path, *decoder, error) : status;
}

int main(int argc, char **argv)
{
    adcgs_decoder *decoder = NULL;
    adcgs_requests requests;
    adcgs_error error = {0};
    if (argc != 3) {
        fprintf(stderr, "usage: REQUESTS FILE\n");
        return 2;
    }
    adcgs_status status = adcgs_requests_read(&requests, argv[1], &error);
    if (status == ADCGS_OK) {
        status = answer(&decoder, &requests, argv[2], &error);
        adcgs_requests_clear(&requests);
    }
    adcgs_close(&decoder);
    if (status == ADCGS_OK && (fflush(stdout) || ferror(stdout))) {
        status = ADCGS_ERR_IO;
        snprintf(error.text, sizeof error.text, "standard output: cannot write");
    }
    if (status != ADCGS_OK)
        fprintf(stderr, "%s\n", error.text);
    return adcgs_exit_code(status);
}
