/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Progress, interruption and JSON for the programs. */
#include "config.h"

#include "cli/cli.h"

#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <unistd.h>

/* A signal handler can reach nothing but static storage. */
static volatile sig_atomic_t interrupted;

static void on_signal(int number)
{
    interrupted = number;
    signal(number, SIG_DFL);
}

void adcgs_interrupt_catch(void)
{
    const int numbers[] = {SIGINT, SIGTERM};
    for (size_t i = 0; i < ADCGS_COUNTOF(numbers); i++) {
        struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
        sigemptyset(&action.sa_mask);
        sigaction(numbers[i], &action, NULL);
    }
}

int adcgs_interrupted(void)
{
    return interrupted;
}

void adcgs_progress_init(adcgs_progress *progress)
{
    *progress = (adcgs_progress){.active = isatty(STDERR_FILENO)};
}

void adcgs_progress_show(adcgs_progress *progress, const char *format, ...)
{
    if (!progress->active)
        return;
    const double now = adcgs_seconds();
    if (progress->shown && now - progress->last < 0.1)
        return;
    va_list arguments;
    va_start(arguments, format);
    fputc('\r', stderr);
    vfprintf(stderr, format, arguments);
    fputs("\033[K", stderr);
    va_end(arguments);
    progress->last = now;
    progress->shown = 1;
}

void adcgs_progress_clear(adcgs_progress *progress)
{
    if (progress->shown)
        fputs("\r\033[K", stderr);
    progress->shown = 0;
}

void adcgs_json_init(adcgs_json *json, FILE *file)
{
    *json = (adcgs_json){.file = file};
}

static void put_string(FILE *file, const char *text)
{
    fputc('"', file);
    for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
        if (*c == '"' || *c == '\\')
            fprintf(file, "\\%c", *c);
        else if (*c < 0x20)
            fprintf(file, "\\u%04x", *c);
        else
            fputc(*c, file);
    }
    fputc('"', file);
}

/** Comma, newline, indentation and key before an item. */
static void begin_item(adcgs_json *json, const char *key)
{
    if (json->comma)
        fputc(',', json->file);
    if (json->depth)
        fprintf(json->file, "\n%*s", 2 * json->depth, "");
    if (key) {
        put_string(json->file, key);
        fputs(": ", json->file);
    }
    json->comma = 1;
}

void adcgs_json_open(adcgs_json *json, const char *key, char bracket)
{
    begin_item(json, key);
    fputc(bracket, json->file);
    json->depth++;
    json->comma = 0;
}

void adcgs_json_close(adcgs_json *json, char bracket)
{
    json->depth--;
    if (json->comma)
        fprintf(json->file, "\n%*s", 2 * json->depth, "");
    fputc(bracket, json->file);
    json->comma = 1;
}

void adcgs_json_string(adcgs_json *json, const char *key, const char *value)
{
    begin_item(json, key);
    put_string(json->file, value);
}

void adcgs_json_int(adcgs_json *json, const char *key, int64_t value)
{
    begin_item(json, key);
    fprintf(json->file, "%lld", (long long)value);
}

void adcgs_json_real(adcgs_json *json, const char *key, double value)
{
    begin_item(json, key);
    if (isfinite(value))
        fprintf(json->file, "%.10g", value);
    else
        fputs("null", json->file);
}

void adcgs_json_bool(adcgs_json *json, const char *key, int value)
{
    begin_item(json, key);
    fputs(value ? "true" : "false", json->file);
}

adcgs_status adcgs_json_finish(adcgs_json *json, adcgs_error *error)
{
    fputc('\n', json->file);
    return json->file == stdout ? adcgs_cli_flush(error) : ADCGS_OK; /* who opened another looks after it */
}
