/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Scripts that drive the player instead of a user: see PLAYER in adcgs-dec(1). */
#ifndef ADCGS_PLAY_SCRIPT_H
#define ADCGS_PLAY_SCRIPT_H

#include "base/base.h"

typedef enum adcgs_script_kind {
    ADCGS_SCRIPT_WAIT_FRAMES,   /**< number[0]: images shown */
    ADCGS_SCRIPT_WAIT_SECONDS,  /**< number[0] */
    ADCGS_SCRIPT_WAIT_BYTES,    /**< number[0]: of the stream, decoded */
    ADCGS_SCRIPT_WAIT_TIERS,    /**< number[0]: of the arriving segment */
    ADCGS_SCRIPT_WAIT_SEGMENTS, /**< number[0]: complete segments */
    ADCGS_SCRIPT_WAIT_END,      /**< of the stream */
    ADCGS_SCRIPT_DRAG,          /**< key: button; number: from x, y to x, y */
    ADCGS_SCRIPT_MOVE,          /**< number: by dx, dy */
    ADCGS_SCRIPT_POINT,         /**< key: a control, to its middle */
    ADCGS_SCRIPT_CLICK,         /**< the same, and press and release it */
    ADCGS_SCRIPT_SLIDE,         /**< number: drag the time slider from one fraction of the duration to another */
    ADCGS_SCRIPT_WHEEL,         /**< number[0]: steps */
    ADCGS_SCRIPT_KEY,           /**< key */
    ADCGS_SCRIPT_HOLD,          /**< key */
    ADCGS_SCRIPT_RELEASE,       /**< key */
    ADCGS_SCRIPT_SIZE,          /**< number: width, height */
    ADCGS_SCRIPT_SCREENSHOT,    /**< text: file */
    ADCGS_SCRIPT_GRAB,          /**< text: file */
    ADCGS_SCRIPT_RECORD,        /**< text: file */
    ADCGS_SCRIPT_EXPECT,        /**< text: name of the value; number: value, tolerance */
    ADCGS_SCRIPT_QUIT
} adcgs_script_kind;

typedef struct adcgs_script_line {
    int line; /**< in the file, from 1 */
    adcgs_script_kind kind;
    int shift; /**< held during the action */
    int key;   /**< a key as in event.h, a button, or an adcgs_play_control */
    double number[4];
    char *text; /**< owned by the script; NULL for lines without one */
} adcgs_script_line;

typedef struct adcgs_script {
    int n;
    adcgs_script_line *lines;
} adcgs_script;

/** ADCGS_ERR_USAGE, naming file and line, for an unknown command. */
adcgs_status adcgs_script_read(adcgs_script *out, const char *path, adcgs_error *error);
void adcgs_script_clear(adcgs_script *script);

#endif
