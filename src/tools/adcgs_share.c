/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-share: makes a page for browsers of a stream, in one file. */
#include "config.h"

#include "cli/cli.h"
#include "io/atomic.h"
#include "io/file.h"
#include "io/kind.h"
#include "tools/share_page.h"

#include <adcgs/adcgs.h>

#include <stdlib.h>

#define PAGE_BYTES_MAX ((uint64_t)64 << 20)
#define STREAM_BYTES_MAX ((uint64_t)1 << 30) /* more than browsers open as one page */

typedef struct settings {
    const adcgs_cli *cli;
    const char *output, *title, *page;
    int quiet;
} settings;

/** The contents of a page. */
typedef struct parts {
    uint8_t *page, *stream;
    size_t page_bytes, stream_bytes;
} parts;

/** Refuses a damaged stream, since viewers of the page cannot fix it. */
static adcgs_status check_stream(const settings *s, const char *path, const parts *p, adcgs_error *error)
{
    adcgs_decoder *decoder;
    adcgs_info info;
    adcgs_status status = adcgs_open_memory(&decoder, p->stream, p->stream_bytes, NULL, error);
    if (status != ADCGS_OK) {
        adcgs_error_locate(error, path);
        return status;
    }
    status = adcgs_get_info(decoder, &info, sizeof info, error);
    adcgs_close(&decoder);
    if (status == ADCGS_OK && info.truncated)
        adcgs_cli_note(s->cli, "%s: the stream ends early; the page will show its complete part", path);
    return status;
}

static adcgs_status load_page(parts *p, const char *path, adcgs_error *error)
{
    const adcgs_status status = adcgs_file_load(&p->page, &p->page_bytes, path, PAGE_BYTES_MAX, error);
    if (status != ADCGS_ERR_IO)
        return status;
    const adcgs_error why = *error;
    return adcgs_fail(error, ADCGS_ERR_IO, "%.150s (the page for browsers: this build may lack it, or it is not installed)",
                      why.text);
}

static adcgs_status write_page(const settings *s, const char *path, const parts *p, adcgs_error *error)
{
    const adcgs_share_scene scene = {.name = path, .title = s->title, .data = p->stream, .bytes = p->stream_bytes};
    adcgs_atomic out;
    ADCGS_TRY(adcgs_share_check_page(p->page, p->page_bytes, s->page, error));
    ADCGS_TRY(adcgs_atomic_open(&out, s->output, error));
    adcgs_share_write(out.file, (const char *)p->page, p->page_bytes, &scene);
    const long bytes = ftell(out.file);
    ADCGS_TRY(adcgs_atomic_commit(&out, error));
    if (path)
        adcgs_cli_note(s->cli, "%s: %ld bytes, with a scene of %zu bytes", s->output, bytes, p->stream_bytes);
    else
        adcgs_cli_note(s->cli, "%s: %ld bytes, without a scene: it shows dropped files, and the stream of ?src=URL", s->output,
                       bytes);
    return ADCGS_OK;
}

static adcgs_status share(const settings *s, const char *path, adcgs_error *error)
{
    parts p = {0};
    adcgs_status status = ADCGS_OK;
    if (!s->output)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "no output: give -o PAGE.html");
    if (path && adcgs_atomic_same(path, s->output))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%.160s: the page would replace the stream: give another output", path);
    if (path)
        status = adcgs_kind_check(path, ADCGS_WANT_STREAM, error);
    if (status == ADCGS_OK && path)
        status = adcgs_file_load(&p.stream, &p.stream_bytes, path, STREAM_BYTES_MAX, error);
    if (status == ADCGS_OK && path)
        status = check_stream(s, path, &p, error);
    if (status == ADCGS_OK)
        status = load_page(&p, s->page, error);
    if (status == ADCGS_OK)
        status = write_page(s, path, &p, error);
    free(p.page);
    free(p.stream);
    return status;
}

int main(int argc, char **argv)
{
    settings s = {.page = PAGE_FILE};
    const adcgs_option options[] = {
        {.name = "output",
         .letter = 'o',
         .kind = ADCGS_OPTION_STRING,
         .target = &s.output,
         .value = "PAGE.html",
         .help = "page to write"},
        {.name = "title",
         .kind = ADCGS_OPTION_STRING,
         .target = &s.title,
         .value = "TEXT",
         .help = "title of the page (default: the file's name)"},
        {.name = "page",
         .kind = ADCGS_OPTION_STRING,
         .target = &s.page,
         .value = "FILE",
         .help = "page that receives the scene, by default the installed one:\n" PAGE_FILE},
    };
    const adcgs_cli cli = {.program = "adcgs-share",
                           .operands = "[FILE]",
                           .summary = "Make a page for browsers of a stream: one file with the decoder and the scene.",
                           .details = "Without FILE the page has no scene: it shows files that are dropped on it,\n"
                                      "and, on a web server, the stream of ?src=URL.\n"
                                      "Exit status: 0 done, 2 usage, 3 input or output, 4 invalid stream or page, 5 unsupported.",
                           .options = options,
                           .n_options = ADCGS_COUNTOF(options),
                           .min_operands = 0,
                           .max_operands = 1,
                           .quiet = &s.quiet};
    int first;
    s.cli = &cli;
    const int leave = adcgs_cli_parse(&cli, argc, argv, &first);
    if (leave >= 0)
        return leave;
    adcgs_error error = {ADCGS_OK, ""};
    error.status = share(&s, first < argc ? argv[first] : NULL, &error);
    return error.status == ADCGS_OK ? 0 : adcgs_cli_fail(&cli, &error);
}
