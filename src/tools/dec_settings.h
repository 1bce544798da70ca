/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What adcgs-dec is told. */
#ifndef ADCGS_TOOLS_DEC_SETTINGS_H
#define ADCGS_TOOLS_DEC_SETTINGS_H

#include "camera/path.h"
#include "cli/cli.h"
#include "io/http.h"
#include "io/video.h"
#include "tools/dec_budget.h"

#define ADCGS_DEC_OPTIONS 35

typedef struct adcgs_dec_settings {
    const adcgs_cli *cli;
    const char *input, *output, *format, *times, *verify, *answer, *splats, *beside, *cameras, *script, *budget_text;
    adcgs_budget budget;
    adcgs_video_style video;
    adcgs_camera_path_request request;
    adcgs_config config;
    int quiet, order, tiers, cpu, fit, half, rest_degree, use_float, linear, bits, alpha, depth, md5, frametimes, play;
    double part;   /**< of the stream: the moment to show; negative: none was given so */
    double opened; /**< when opening the input began, in seconds */
    adcgs_http *http, *http_beside; /**< what is read where URLs are given */
} adcgs_dec_settings;

/** The table of options, whose targets are in the settings. */
void adcgs_dec_options(adcgs_dec_settings *s, adcgs_option options[ADCGS_DEC_OPTIONS]);
/** What the table cannot check, and what follows from what was said. */
adcgs_status adcgs_dec_check(adcgs_dec_settings *s, adcgs_error *error);
/** Whether it was said how a video is coded. */
int adcgs_dec_has_style(const adcgs_dec_settings *s);

#endif
