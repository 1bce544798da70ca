/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Settings of adcgs-dec. */
#ifndef ADCGS_APPS_DEC_DEC_SETTINGS_H
#define ADCGS_APPS_DEC_DEC_SETTINGS_H

#include "apps/dec/dec_budget.h"
#include "apps/dec/dec_splats.h"
#include "camera/path.h"
#include "cli/cli.h"
#include "media/operand.h"
#include "media/video/video.h"

typedef struct adcgs_dec_settings {
    const adcgs_cli *cli;
    const char *input, *output, *format, *times, *verify, *answer, *beside, *cameras, *script, *budget_text;
    const char *offset_text;
    adcgs_budget budget;
    adcgs_dec_splats_config splats;
    int axes, has_axes; /**< of splats; index into the option's words */
    adcgs_video_style video;
    adcgs_camera_path_request request;
    adcgs_config config;
    int quiet, order, tiers, cpu, fit, half, use_float, linear, bits, alpha, depth, md5, frametimes, play;
    int has_sound_offset;
    char *sound;                         /**< file of the sound, found by adcgs_dec_find_sound(); the caller free()s it */
    double sound_offset;                 /**< time of the stream at which the sound begins, in seconds */
    double part;                         /**< part of the stream at which the frame lies (--time N%); negative: not given */
    double opened;                       /**< time before opening the input, in seconds */
    adcgs_operand source, beside_source; /**< of the bytes that the decoders still read */
} adcgs_dec_settings;

/** Fills the table of options, in the order of the help, with targets in the settings. */
void adcgs_dec_options(adcgs_dec_settings *s, adcgs_option_table *options);
#define ADCGS_DEC_RULES 16 /**< rows of the table; definition */
/** Options that go together. */
extern const adcgs_option_rule adcgs_dec_rules[ADCGS_DEC_RULES];
/** Checks the rules that the tables cannot express, and sets the derived settings. */
adcgs_status adcgs_dec_check(adcgs_dec_settings *s, adcgs_error *error);
/** Replaces a scene that --sound names by its sound, if it has one, and takes over the sound's time. */
adcgs_status adcgs_dec_find_sound(adcgs_dec_settings *s, adcgs_error *error);
/** True if the coding of a video was specified. */
int adcgs_dec_has_style(const adcgs_dec_settings *s);

#endif
