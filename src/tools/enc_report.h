/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What adcgs-enc reports of a file it has written: measured from the file, on the disk. */
#ifndef ADCGS_TOOLS_ENC_REPORT_H
#define ADCGS_TOOLS_ENC_REPORT_H

#include "cli/cli.h"
#include "train/trainer.h"

typedef struct adcgs_enc_report {
    const char *file;
    const adcgs_train_config *config;
    adcgs_cpu_level cpu;
    const adcgs_scene *scene;     /**< the whole */
    adcgs_train_report last; /**< of the training run, that of the last segment */
    adcgs_time spent;        /**< in training, all segments together */
    size_t uncompressed;     /**< bytes of the file of plain numbers; 0: none was asked for */
    int threads, json; /**< as on the command line */
    int heard;         /**< interrupts that the run has answered; one more ends the measurement */
} adcgs_enc_report;

/**
 * Decode the file and measure it, on views that training never saw if the scene has any; print the result, as text on stderr or
 * as JSON on stdout. *met: whether the run's target was met, 1 without one; if not, a line on stderr says how far the result
 * is from it. An interrupt ends the measurement with a remark that the file is written; with JSON, which there is none of then,
 * it is ADCGS_ERR_IO.
 */
adcgs_status adcgs_enc_report_print(const adcgs_cli *cli, const adcgs_enc_report *report, int *met, adcgs_error *error);

#endif
