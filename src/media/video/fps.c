/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Frame rates as exact ratios. */
#include "config.h"

#include "media/video/fps.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define WHOLE_WITHIN 1e-6  /* absolute, frames per second */
#define NTSC_WITHIN 2e-6   /* relative; 29.97 differs from 30000/1001 by half of this */
#define EQUAL_WITHIN 1e-12 /* relative rounding error of a double that was a ratio */

double adcgs_fps_value(adcgs_fps rate)
{
    return rate.den ? (double)rate.num / (double)rate.den : 0.0;
}

static uint64_t common_divisor(uint64_t a, uint64_t b)
{
    while (b) {
        const uint64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/** Ratio in lowest terms, rounded if they do not fit their fields. */
static adcgs_fps make(uint64_t num, uint64_t den)
{
    const uint64_t divisor = common_divisor(num, den);
    num /= divisor;
    den /= divisor;
    while (num > UINT32_MAX || den > UINT32_MAX) {
        num = (num + 1) / 2;
        den = (den + 1) / 2;
    }
    return (adcgs_fps){(uint32_t)num, (uint32_t)den};
}

/** Convergents of the continued fraction, until one equals the value or the next does not fit. */
static adcgs_fps approach(double value)
{
    uint64_t num[2] = {1, (uint64_t)value}, den[2] = {0, 1};
    for (double rest = value; fabs((double)num[1] / (double)den[1] - value) > EQUAL_WITHIN * value;) {
        rest = 1.0 / (rest - floor(rest));
        if (!(rest < UINT32_MAX))
            break;
        const uint64_t term = (uint64_t)rest, next[2] = {term * num[1] + num[0], term * den[1] + den[0]};
        if (next[0] > INT32_MAX || next[1] > INT32_MAX) /* FFmpeg's rationals are int */
            break;
        num[0] = num[1];
        den[0] = den[1];
        num[1] = next[0];
        den[1] = next[1];
    }
    return make(ADCGS_MAX(num[1], 1), den[1]);
}

adcgs_fps adcgs_fps_of(double value)
{
    const double whole = floor(value + 0.5), ntsc = floor(value * 1.001 + 0.5);
    if (!(value > 0.0 && value <= UINT32_MAX / 1024.0))
        return (adcgs_fps){0, 0};
    if (whole >= 1.0 && fabs(value - whole) < WHOLE_WITHIN)
        return (adcgs_fps){(uint32_t)whole, 1};
    if (ntsc >= 1.0 && fabs(value - ntsc / 1.001) < NTSC_WITHIN * value)
        return make((uint64_t)ntsc * 1000, 1001);
    return approach(value);
}

adcgs_fps adcgs_fps_divide(adcgs_fps rate, int64_t by)
{
    return rate.den ? make(rate.num, (uint64_t)rate.den * (uint64_t)by) : rate;
}

/** A number of digits alone, from 1 to 2^32 - 1; 0 for any other text. */
static uint64_t whole_number(const char *text, char end)
{
    uint64_t value = 0;
    for (; *text >= '0' && *text <= '9' && value <= UINT32_MAX; text++)
        value = 10 * value + (uint64_t)(*text - '0');
    return *text == end && value <= UINT32_MAX ? value : 0;
}

int adcgs_fps_parse(const char *text, adcgs_fps *rate)
{
    const char *slash = strchr(text, '/');
    adcgs_fps found = {0, 0};
    if (slash) {
        const uint64_t num = whole_number(text, '/'), den = whole_number(slash + 1, 0);
        if (num && den)
            found = make(num, den);
    } else if ((*text >= '0' && *text <= '9') || *text == '.') {
        char *end;
        const double value = strtod(text, &end);
        if (!*end && isfinite(value))
            found = adcgs_fps_of(value);
    }
    const double value = adcgs_fps_value(found);
    if (!(value >= ADCGS_FPS_MIN && value <= ADCGS_FPS_MAX))
        return -1;
    *rate = found;
    return 0;
}

adcgs_status adcgs_fps_read_option(adcgs_fps *rate, const char *text, adcgs_error *error)
{
    if (!adcgs_fps_parse(text, rate))
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_USAGE, "--fps %.64s: expected frames per second from %g to %g, as 30, 29.97 or 30000/1001",
                      text, ADCGS_FPS_MIN, ADCGS_FPS_MAX);
}
