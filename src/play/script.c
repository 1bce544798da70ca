/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reads scripts. */
#include "config.h"

#include "play/script.h"

#include "play/play_state.h"
#include "system/file.h"

#include <math.h>
#include <stdlib.h>
#include <stdio.h>

#define BLANKS " \t\r"
/* Origin: chosen by hand, not measured. */
#define SCRIPT_BYTES_MAX (1 << 20) /* of a script */
#define EXPECT_TOLERANCE 1e-6      /* default tolerance of an expected value, in its unit */

static int read_number(const char *text, double *out)
{
    char *end;
    if (!text)
        return -1;
    *out = strtod(text, &end);
    return end == text || *end || !(fabs(*out) <= 1e9) ? -1 : 0;
}

static int read_numbers(char **rest, double *out, int n)
{
    for (int i = 0; i < n; i++)
        if (read_number(strtok_r(NULL, BLANKS, rest), &out[i]))
            return -1;
    return 0;
}

static int read_text(adcgs_script_line *to, char **rest)
{
    const char *word = strtok_r(NULL, BLANKS, rest);
    to->text = word ? strdup(word) : NULL;
    return to->text ? 0 : -1;
}

/** Removes "shift-" from a name, and notes it. */
static const char *take_shift(const char *name, int *shift)
{
    *shift = name && !strncmp(name, "shift-", 6);
    return *shift ? name + 6 : name;
}

static int read_key(adcgs_script_line *to, char **rest)
{
    static const struct {
        const char *name;
        int key;
    } names[] = {
        {"space", ' '},           {"escape", ADCGS_KEY_ESCAPE}, {"left", ADCGS_KEY_LEFT},      {"right", ADCGS_KEY_RIGHT},
        {"home", ADCGS_KEY_HOME}, {"end", ADCGS_KEY_END},       {"pageup", ADCGS_KEY_PAGE_UP}, {"pagedown", ADCGS_KEY_PAGE_DOWN},
        {"f1", ADCGS_KEY_F1},     {"f11", ADCGS_KEY_F11},       {"shift", ADCGS_KEY_SHIFT},
    };
    const char *name = take_shift(strtok_r(NULL, BLANKS, rest), &to->shift);
    if (!name)
        return -1;
    for (size_t i = 0; i < ADCGS_COUNTOF(names); i++)
        if (!strcmp(names[i].name, name))
            to->key = names[i].key;
    if (!to->key && name[0] > ' ' && name[0] < 127 && !name[1])
        to->key = name[0];
    return to->key ? 0 : -1;
}

static int read_wait(adcgs_script_line *to, char **rest)
{
    static const struct {
        const char *name;
        adcgs_script_kind kind;
    } units[] = {
        {"frames", ADCGS_SCRIPT_WAIT_FRAMES}, {"seconds", ADCGS_SCRIPT_WAIT_SECONDS},   {"bytes", ADCGS_SCRIPT_WAIT_BYTES},
        {"tiers", ADCGS_SCRIPT_WAIT_TIERS},   {"segments", ADCGS_SCRIPT_WAIT_SEGMENTS},
    };
    const char *const amount = strtok_r(NULL, BLANKS, rest);
    to->kind = ADCGS_SCRIPT_WAIT_END;
    if (amount && !strcmp(amount, "end"))
        return 0;
    const char *const unit = strtok_r(NULL, BLANKS, rest);
    if (read_number(amount, to->number) || to->number[0] < 0.0)
        return -1;
    for (size_t i = 0; i < ADCGS_COUNTOF(units) && unit; i++)
        if (!strcmp(units[i].name, unit)) {
            to->kind = units[i].kind;
            return 0;
        }
    return -1;
}

static int read_drag(adcgs_script_line *to, char **rest)
{
    const char *button = take_shift(strtok_r(NULL, BLANKS, rest), &to->shift);
    to->key = !button ? 0 : !strcmp(button, "left") ? 1 : !strcmp(button, "middle") ? 2 : !strcmp(button, "right") ? 3 : 0;
    return to->key ? read_numbers(rest, to->number, 4) : -1;
}

/** The name of a control. */
static int read_control(adcgs_script_line *to, char **rest)
{
    static const struct {
        const char *name;
        adcgs_play_control control;
    } names[] = {
        {"slider", ADCGS_CONTROL_SLIDER}, {"play", ADCGS_CONTROL_PLAY}, {"previous", ADCGS_CONTROL_PREVIOUS},
        {"next", ADCGS_CONTROL_NEXT},     {"help", ADCGS_CONTROL_HELP}, {"full", ADCGS_CONTROL_FULL},
    };
    const char *const name = strtok_r(NULL, BLANKS, rest);
    for (size_t i = 0; i < ADCGS_COUNTOF(names) && name; i++)
        if (!strcmp(names[i].name, name))
            to->key = (int)names[i].control;
    return to->key ? 0 : -1;
}

/** Two fractions. */
static int read_slide(adcgs_script_line *to, char **rest)
{
    if (read_numbers(rest, to->number, 2))
        return -1;
    for (int i = 0; i < 2; i++)
        if (to->number[i] < 0.0 || to->number[i] > 1.0)
            return -1;
    return 0;
}

/** WIDTHxHEIGHT */
static int read_size(const char *text, double number[2])
{
    const char *x = text ? strchr(text, 'x') : NULL;
    char width[8] = "";
    if (!x || x == text || (size_t)(x - text) >= sizeof width)
        return -1;
    memcpy(width, text, (size_t)(x - text));
    if (read_number(width, &number[0]) || read_number(x + 1, &number[1]))
        return -1;
    for (int i = 0; i < 2; i++)
        if (number[i] < 64.0 || number[i] > 16384.0 || number[i] != floor(number[i]))
            return -1;
    return 0;
}

/** Reads the name of an expected value, the value, and its tolerance. A size has two values. */
static int read_expect(adcgs_script_line *to, char **rest)
{
    if (read_text(to, rest))
        return -1;
    if (!strcmp(to->text, "size"))
        return read_size(strtok_r(NULL, BLANKS, rest), to->number);
    if (read_numbers(rest, to->number, 1))
        return -1;
    const char *tolerance = strtok_r(NULL, BLANKS, rest);
    to->number[1] = EXPECT_TOLERANCE;
    return tolerance ? read_number(tolerance, &to->number[1]) : 0;
}

static int read_arguments(adcgs_script_line *to, char **rest)
{
    switch (to->kind) {
    case ADCGS_SCRIPT_WAIT_FRAMES:
    case ADCGS_SCRIPT_WAIT_SECONDS:
    case ADCGS_SCRIPT_WAIT_BYTES:
    case ADCGS_SCRIPT_WAIT_TIERS:
    case ADCGS_SCRIPT_WAIT_SEGMENTS:
    case ADCGS_SCRIPT_WAIT_END:
        return read_wait(to, rest);
    case ADCGS_SCRIPT_DRAG:
        return read_drag(to, rest);
    case ADCGS_SCRIPT_POINT:
    case ADCGS_SCRIPT_CLICK:
        return read_control(to, rest);
    case ADCGS_SCRIPT_SLIDE:
        return read_slide(to, rest);
    case ADCGS_SCRIPT_MOVE:
        return read_numbers(rest, to->number, 2);
    case ADCGS_SCRIPT_WHEEL:
        return read_numbers(rest, to->number, 1);
    case ADCGS_SCRIPT_KEY:
    case ADCGS_SCRIPT_HOLD:
    case ADCGS_SCRIPT_RELEASE:
        return read_key(to, rest);
    case ADCGS_SCRIPT_SIZE:
        return read_size(strtok_r(NULL, BLANKS, rest), to->number);
    case ADCGS_SCRIPT_SCREENSHOT:
    case ADCGS_SCRIPT_GRAB:
    case ADCGS_SCRIPT_RECORD:
        return read_text(to, rest);
    case ADCGS_SCRIPT_EXPECT:
        return read_expect(to, rest);
    case ADCGS_SCRIPT_QUIT:
        return 0;
    }
    return -1;
}

/** \return nonzero if the line is a command of that form; otherwise the line may be filled in part */
static int read_command(adcgs_script_line *to, char *line)
{
    static const struct {
        const char *name;
        adcgs_script_kind kind;
    } names[] = {
        {"wait", ADCGS_SCRIPT_WAIT_FRAMES}, {"drag", ADCGS_SCRIPT_DRAG},     {"move", ADCGS_SCRIPT_MOVE},
        {"wheel", ADCGS_SCRIPT_WHEEL},      {"key", ADCGS_SCRIPT_KEY},       {"hold", ADCGS_SCRIPT_HOLD},
        {"release", ADCGS_SCRIPT_RELEASE},  {"size", ADCGS_SCRIPT_SIZE},     {"screenshot", ADCGS_SCRIPT_SCREENSHOT},
        {"grab", ADCGS_SCRIPT_GRAB},        {"record", ADCGS_SCRIPT_RECORD}, {"expect", ADCGS_SCRIPT_EXPECT},
        {"quit", ADCGS_SCRIPT_QUIT},        {"point", ADCGS_SCRIPT_POINT},   {"click", ADCGS_SCRIPT_CLICK},
        {"slide", ADCGS_SCRIPT_SLIDE},
    };
    char *rest = NULL;
    const char *const name = strtok_r(line, BLANKS, &rest);
    for (size_t i = 0; i < ADCGS_COUNTOF(names) && name; i++)
        if (!strcmp(names[i].name, name)) {
            to->kind = names[i].kind;
            return !read_arguments(to, &rest) && !strtok_r(NULL, BLANKS, &rest);
        }
    return 0;
}

static adcgs_status read_lines(adcgs_script *out, char *text, const char *path, adcgs_error *error)
{
    int lines = 1;
    for (const char *c = text; *c; c++)
        lines += *c == '\n';
    out->lines = calloc((size_t)lines, sizeof *out->lines);
    if (!out->lines)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%.160s: out of memory for %d lines", path, lines);
    for (int number = 1; number <= lines; number++) {
        char *const end = text + strcspn(text, "\n");
        *end = 0;
        const char first = text[strspn(text, BLANKS)];
        if (first && first != '#') {
            adcgs_script_line *const line = &out->lines[out->n++];
            line->line = number;
            if (!read_command(line, text))
                return adcgs_fail(error, ADCGS_ERR_USAGE, "%.160s: line %d is no command of a script", path, number);
        }
        text = end + 1;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_script_read(adcgs_script *out, const char *path, adcgs_error *error)
{
    uint8_t *data;
    size_t bytes;
    *out = (adcgs_script){0};
    ADCGS_TRY(adcgs_file_load_text(&data, &bytes, path, SCRIPT_BYTES_MAX, error));
    adcgs_status status = memchr(data, 0, bytes) ? adcgs_fail(error, ADCGS_ERR_USAGE, "%.160s: not a text", path)
                                                 : read_lines(out, (char *)data, path, error);
    free(data);
    if (status != ADCGS_OK)
        adcgs_script_clear(out);
    return status;
}

void adcgs_script_clear(adcgs_script *script)
{
    for (int i = 0; i < script->n; i++)
        free(script->lines[i].text);
    free(script->lines);
    *script = (adcgs_script){0};
}
