/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The report of adcgs-enc on a written file, measured from the file on the disk. */
#ifndef ADCGS_SESSION_ENC_REPORT_H
#define ADCGS_SESSION_ENC_REPORT_H

#include "cli/cli.h"
#include "train/trainer.h"

typedef struct adcgs_enc_report {
    const char *file;
    const adcgs_train_config *config;
    adcgs_cpu_level cpu;
    const adcgs_scene *scene; /**< the whole scene */
    adcgs_train_report last;  /**< of the training run, or of the last segment's */
    adcgs_time spent;         /**< on training, all segments together */
    size_t uncompressed;      /**< bytes of the file of plain numbers; 0: not requested */
    int threads, json;        /**< as on the command line */
    int interrupts;           /**< interrupts that the run has handled; one more ends the measurement */
} adcgs_enc_report;

/**
 * Decodes the file and measures it, on views that training never saw if the scene has any. Prints the result, as text to stderr
 * or as JSON to stdout. *met: 1 if the run's target was met or there is none; if not, a line on stderr shows the difference. An
 * interrupt ends the measurement with a remark that the file is written. With JSON, which then is not printed, it is
 * ADCGS_ERR_IO.
 */
adcgs_status adcgs_enc_report_print(const adcgs_cli *cli, const adcgs_enc_report *report, int *met, adcgs_error *error);

#endif
