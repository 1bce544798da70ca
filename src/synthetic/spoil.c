/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Faults of images and cameras, from basic arithmetic only, like all code of the scenes. */
#include "synthetic/spoil.h"

#include "geometry/rotation.h"
#include "synthetic/sine.h"
#include "synthetic/texture.h"

#include <stdlib.h>

#define SEED 131u                           /* of the random numbers; any number */
#define TURN (2.0 * 3.14159265358979323846) /* radians; geometry */
#define NAME_BYTES 16                       /* bytes of a fault's name; definition */

/* One row per kind. */
static const struct {
    const char *name;
    double most;
    int whole;
} kinds[ADCGS_SPOILS] = {
    {"exposure", 4.0, 0},    {"white", 4.0, 0},  {"step", 4.0, 0},   {"pose", 100.0, 0}, {"shake", 100.0, 0},
    {"wrongpose", 180.0, 0}, {"axes", 3.0, 1},   {"sync", 100.0, 0}, {"drop", 0.95, 0},  {"twice", 1.0, 0},
    {"before", 0.9, 0},      {"inside", 0.9, 0}, {"after", 0.9, 0},  {"tint", 4.0, 0},
};

/* Parses one fault. Returns the text after it, NULL if it is invalid. */
static const char *parse_one(adcgs_spoil *out, const char *text, adcgs_error *error)
{
    const size_t length = strcspn(text, "=,");
    int kind = 0;
    while (kind < ADCGS_SPOILS && (strlen(kinds[kind].name) != length || strncmp(kinds[kind].name, text, length) != 0))
        kind++;
    if (kind == ADCGS_SPOILS) {
        (void)adcgs_fail(error, ADCGS_ERR_USAGE,
                         "spoil: unknown fault '%.*s', expected exposure, white, step, pose, shake, wrongpose, axes, sync, drop, "
                         "twice, before, inside, after or tint",
                         (int)ADCGS_MIN(length, (size_t)NAME_BYTES), text);
        return NULL;
    }
    char *end = NULL;
    const char *const value = text + length + (text[length] == '=');
    const double strength = strtod(value, &end);
    if (text[length] != '=' || end == value || (*end && *end != ',') || !(strength >= 0.0 && strength <= kinds[kind].most) ||
        (kinds[kind].whole && strength != (double)(int)strength)) {
        (void)adcgs_fail(error, ADCGS_ERR_USAGE, "spoil: %s needs a strength: expected %s from 0 to %g", kinds[kind].name,
                         kinds[kind].whole ? "a whole number" : "a number", kinds[kind].most);
        return NULL;
    }
    out->strength[kind] = strength;
    return end;
}

adcgs_status adcgs_spoil_parse(adcgs_spoil *out, const char *text, adcgs_error *error)
{
    *out = (adcgs_spoil){{0.0}};
    while (text && *text) {
        text = parse_one(out, text, error);
        if (!text)
            return ADCGS_ERR_USAGE;
        if (*text == ',' && !*++text)
            return adcgs_fail(error, ADCGS_ERR_USAGE, "spoil: expected a fault after the comma");
    }
    return ADCGS_OK;
}

/* A random number in [0,1), of a camera or an image. */
static double draw(int which, int i, adcgs_spoil_kind kind)
{
    return adcgs_texture_random(which, i, (int)kind, SEED);
}

/* Approximately normal: the sum of twelve random numbers. */
static double draw_normal(int which, int i, adcgs_spoil_kind kind)
{
    double sum = -6.0;
    for (int k = 0; k < 12; k++)
        sum += draw(which, 12 * i + k, kind);
    return sum;
}

int adcgs_spoil_hides(const adcgs_spoil *spoil, const adcgs_spoil_picture *picture)
{
    const double *const s = spoil->strength, middle = picture->time - 0.5;
    return picture->time < s[ADCGS_SPOIL_BEFORE] || picture->time > 1.0 - s[ADCGS_SPOIL_AFTER] ||
           (middle < 0.0 ? -middle : middle) < 0.5 * s[ADCGS_SPOIL_INSIDE] ||
           draw(picture->number, 0, ADCGS_SPOIL_DROP) < s[ADCGS_SPOIL_DROP];
}

double adcgs_spoil_time(const adcgs_spoil *spoil, const adcgs_spoil_picture *picture)
{
    const double *const s = spoil->strength;
    double time = picture->time;
    if (draw(picture->number, 0, ADCGS_SPOIL_TWICE) < s[ADCGS_SPOIL_TWICE])
        time -= picture->step;
    if (s[ADCGS_SPOIL_SYNC] > 0.0)
        time += s[ADCGS_SPOIL_SYNC] * (2.0 * draw(picture->camera, 0, ADCGS_SPOIL_SYNC) - 1.0) * picture->step;
    return time < 0.0 ? 0.0 : time > 1.0 ? 1.0 : time;
}

/* Turns the columns of a pose about an axis in the world. */
static void turn(double to_world[12], const double axis[3], double turns)
{
    for (int c = 0; c < 3; c++) {
        double column[3] = {to_world[c], to_world[4 + c], to_world[8 + c]};
        adcgs_v3_rotate(axis, adcgs_trace_sin(turns), adcgs_trace_cos(turns), column);
        for (int r = 0; r < 3; r++)
            to_world[4 * r + c] = column[r];
    }
}

/* Turns a pose about the camera's own axes. The error is in pixels: for x and y in the image's centre, for z at its edge. */
static void jolt(double to_world[12], int which, adcgs_spoil_kind kind, double pixels, double focal, int width)
{
    for (int c = 0; c < 3; c++) {
        const double axis[3] = {to_world[c], to_world[4 + c], to_world[8 + c]};
        turn(to_world, axis, draw_normal(which, c, kind) * pixels / (c < 2 ? focal : 0.5 * width) / TURN);
    }
}

void adcgs_spoil_pose(const adcgs_spoil *spoil, const adcgs_spoil_picture *picture, double focal, double to_world[12])
{
    static const double up[3] = {0.0, 0.0, 1.0};
    const double *const s = spoil->strength;
    const int axes = (int)s[ADCGS_SPOIL_AXES];
    if (s[ADCGS_SPOIL_POSE] > 0.0)
        jolt(to_world, picture->camera, ADCGS_SPOIL_POSE, s[ADCGS_SPOIL_POSE], focal, picture->width);
    if (s[ADCGS_SPOIL_SHAKE] > 0.0)
        jolt(to_world, picture->number, ADCGS_SPOIL_SHAKE, s[ADCGS_SPOIL_SHAKE], focal, picture->width);
    if (s[ADCGS_SPOIL_WRONGPOSE] > 0.0 && picture->camera == picture->cameras / 2)
        turn(to_world, up, s[ADCGS_SPOIL_WRONGPOSE] / 360.0);
    for (int r = 0; r < 3 && axes == 1; r++) {
        to_world[4 * r + 1] = -to_world[4 * r + 1];
        to_world[4 * r + 2] = -to_world[4 * r + 2];
    }
    if (axes == 2)
        adcgs_pose_invert(to_world);
    for (int r = 0; r < 3 && axes == 3; r++)
        to_world[4 * r] = -to_world[4 * r];
}

/* 2 to the power x, for x of a few units, by the series of the exponential. */
static double power_of_two(double x)
{
    double sum = 1.0, term = 1.0;
    for (int k = 1; k < 40; k++) {
        term *= x * 0.69314718055994530942 / k;
        sum += term;
    }
    return sum;
}

void adcgs_spoil_pixels(const adcgs_spoil *spoil, const adcgs_spoil_picture *picture, float *rgb, size_t pixels)
{
    const double *const s = spoil->strength;
    double gain[3];
    for (int c = 0; c < 3; c++)
        gain[c] =
            power_of_two(picture->stops + s[ADCGS_SPOIL_EXPOSURE] * (2.0 * draw(picture->camera, 0, ADCGS_SPOIL_EXPOSURE) - 1.0) +
                         s[ADCGS_SPOIL_WHITE] * (2.0 * draw(picture->camera, c, ADCGS_SPOIL_WHITE) - 1.0) +
                         (picture->time >= 0.5 ? 0.5 * (1 - c) * s[ADCGS_SPOIL_TINT] - s[ADCGS_SPOIL_STEP] : 0.0));
    for (size_t i = 0; i < pixels; i++)
        for (int c = 0; c < 3; c++) {
            const double value = gain[c] * (double)rgb[3 * i + (size_t)c];
            rgb[3 * i + (size_t)c] = (float)(value > 1.0 ? 1.0 : value);
        }
}
