/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A sweep for readers: tables and checks as text, and with the charts as one HTML page. */
#include "config.h"

#include "apps/sweep/sweep.h"

#include "apps/sweep/charts.h"
#include "system/atomic.h"
#include "system/base64.h"
#include "system/file.h"
#include "system/text.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#define PICTURE_BYTES_MAX ((uint64_t)1 << 30) /* bytes of an image for the page; chosen by hand, not measured */

/** Output of a report: plain text, or HTML if html is set. */
typedef struct sheet {
    FILE *file;
    int html;
    int first; /* width of the first column in text */
} sheet;

/* Columns of a table: arithmetic, the widths in put_row(). Bytes of a cell: a choice and 16, chosen by hand, not measured. */
enum { COLUMNS = 10, CELL = ADCGS_SWEEP_CHOICE + 16 };

typedef char table_row[COLUMNS][CELL];

/* ---- Elements ---- */

static void put_escaped(const sheet *s, const char *text)
{
    for (; *text; text++)
        if (s->html && (*text == '<' || *text == '>' || *text == '&' || *text == '"'))
            fprintf(s->file, "&#%d;", *text);
        else
            fputc(*text, s->file);
}

static void heading(const sheet *s, const char *text)
{
    fprintf(s->file, s->html ? "<h2>" : "\n");
    put_escaped(s, text);
    fprintf(s->file, s->html ? "</h2>\n" : "\n");
}

/** Prints a paragraph. */
static void say(const sheet *s, const char *format, ...) ADCGS_PRINTF(2, 3);
static void say(const sheet *s, const char *format, ...)
{
    char text[600];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    fprintf(s->file, s->html ? "<p>" : "");
    put_escaped(s, text);
    fprintf(s->file, s->html ? "</p>\n" : "\n");
}

static void put_row(const sheet *s, table_row row, const char *tag)
{
    const int widths[COLUMNS] = {-s->first, 9, 26, 22, 12, 8, 10, 12, 10, 11};
    if (s->html)
        fprintf(s->file, "<tr>");
    for (int i = 0; i < COLUMNS; i++)
        if (s->html) {
            fprintf(s->file, "<%s>", tag);
            put_escaped(s, row[i]);
            fprintf(s->file, "</%s>", tag);
        } else
            fprintf(s->file, "%*s", widths[i], row[i]);
    fprintf(s->file, s->html ? "</tr>\n" : "\n");
}

static void open_table(const sheet *s, const char *first)
{
    table_row head = {"", "lambda", "bytes", "PSNR, dB", "moving, dB", "SSIM", "networks", "training s", "frames/s", "objective"};
    snprintf(head[0], CELL, "%s", first);
    if (s->html)
        fprintf(s->file, "<div class=\"wide\"><table>\n");
    put_row(s, head, "th");
}

static void close_table(const sheet *s)
{
    if (s->html)
        fprintf(s->file, "</table></div>\n");
}

/* ---- Rows ---- */

static void fill_number(char cell[CELL], double value, int digits)
{
    if (isfinite(value))
        snprintf(cell, CELL, "%.*f", digits, value);
    else
        snprintf(cell, CELL, "-");
}

static void fill_spread(char cell[CELL], const adcgs_spread *x, int digits)
{
    if (x->n > 1)
        snprintf(cell, CELL, "%.*f (%.*f..%.*f)", digits, x->mean, digits, x->min, digits, x->max);
    else
        fill_number(cell, x->mean, digits);
}

static void print_row(const sheet *s, const adcgs_sweep_row *r)
{
    table_row cells;
    snprintf(cells[0], CELL, "%s", r->name);
    snprintf(cells[1], CELL, "%.6g", r->lambda);
    if (r->lambda < 0)
        snprintf(cells[1], CELL, "-");
    fill_spread(cells[2], &r->bytes, 0);
    fill_spread(cells[3], &r->psnr, 2);
    fill_number(cells[4], r->moving.mean, 2);
    fill_number(cells[5], r->ssim.mean, 4);
    fill_number(cells[6], 100 * r->networks, 1);
    if (isfinite(r->networks))
        strcat(cells[6], " %");
    fill_number(cells[7], r->seconds.mean, 0);
    fill_number(cells[8], r->speed.mean, 0);
    fill_number(cells[9], r->objective.mean, 5);
    put_row(s, cells, "td");
}

static void print_curves(const sheet *s, const adcgs_sweep_plan *plan)
{
    heading(s, "Curves and yardsticks");
    open_table(s, "curve");
    for (int i = 0; i < plan->n_curves; i++)
        for (int j = 0; j < plan->curve[i].n; j++) {
            adcgs_sweep_row row;
            if (adcgs_sweep_point(&row, plan, &plan->curve[i], j))
                print_row(s, &row);
        }
    close_table(s);
}

static void print_stages(const sheet *s, const adcgs_sweep_plan *plan)
{
    heading(s, "Ablation");
    open_table(s, "stage");
    for (int i = 0; i < plan->n_stages; i++) {
        adcgs_sweep_row row;
        if (adcgs_sweep_row_make(&row, plan, plan->stage[i].name, plan->stage[i].cell, plan->stage[i].size))
            print_row(s, &row);
    }
    close_table(s);
    say(s, "Stages add up from base to densification; those before rate-distortion are stored uncompressed, 4 bytes a number, "
           "the others as streams. Without densification a run begins with all anchors of its budget. The last rows are the "
           "whole method with another number of primitives per anchor, or with the weights of its networks in 32 bits.");
}

/* ---- Checks ---- */

static void print_comparison(const sheet *s, const adcgs_sweep_plan *plan, const adcgs_sweep_curve *curve)
{
    const adcgs_comparison c = adcgs_sweep_compare(plan, curve);
    char rate[80] = "", moving[80] = "", place[160], rest[80] = "", smaller[80] = "";
    if (isfinite(c.bd_rate))
        snprintf(rate, sizeof rate, "BD-rate %+.1f %%, ", c.bd_rate);
    if (isfinite(c.bd_rate_moving))
        snprintf(moving, sizeof moving, "BD-rate of moving regions %+.1f %%, ", c.bd_rate_moving);
    if (!c.compared)
        snprintf(place, sizeof place, "none of its points is larger than the smallest stream");
    else if (c.above)
        snprintf(place, sizeof place, "above it (points compared: %d; margin at fewer bytes: %.2f dB or more)", c.compared,
                 c.margin);
    else
        snprintf(place, sizeof place, "NOT above it (points compared: %d; at worst %.2f dB below)", c.compared, -c.margin);
    if (c.compared && c.beyond)
        snprintf(rest, sizeof rest, "; points of it smaller than the smallest stream: %d", c.beyond);
    if (isfinite(c.smaller))
        snprintf(smaller, sizeof smaller, "; %.2f times smaller at most 0.1 dB below its best", c.smaller);
    say(s, "Against %s: %s%s%s%s%s.", curve->name, rate, moving, place, rest, smaller);
}

/** The reason for a curve without points: a compressor that had a file but made no output is missing. */
static const char *reason(const adcgs_sweep_plan *plan, const adcgs_sweep_curve *curve)
{
    adcgs_sweep_row row;
    const int packed = curve->size == ADCGS_FIGURE_ZSTD || curve->size == ADCGS_FIGURE_XZ;
    return packed && adcgs_sweep_row_make(&row, plan, "", curve->cell[0], ADCGS_FIGURE_RAW) ? " (is the program installed?)" : "";
}

static void print_checks(const sheet *s, const adcgs_sweep_plan *plan)
{
    const adcgs_curve_facts facts = adcgs_sweep_facts(plan);
    heading(s, "Checks");
    if (facts.n < 2)
        say(s, "Fewer than two points: there is no curve to check.");
    else
        say(s, "%s has %d points, spans a factor of %.2f in bytes and is %s in bytes and PSNR.", plan->curve[0].name, facts.n,
            facts.span, facts.monotone ? "monotone" : "NOT monotone");
    for (int i = 1; facts.n && i < plan->n_curves; i++) {
        const adcgs_sweep_curve *const curve = &plan->curve[i];
        adcgs_sweep_row row;
        int points = 0;
        for (int j = 0; j < curve->n; j++)
            points += adcgs_sweep_point(&row, plan, curve, j);
        if (points)
            print_comparison(s, plan, curve);
        else
            say(s, "Against %s: no result%s.", curve->name, reason(plan, curve));
    }
}

static void print_all(const sheet *s, const adcgs_sweep_plan *plan)
{
    if (plan->n_curves) {
        print_curves(s, plan);
        print_checks(s, plan);
    }
    if (plan->n_stages)
        print_stages(s, plan);
}

void adcgs_sweep_print(FILE *file, const adcgs_sweep_plan *plan)
{
    size_t first = 24;
    for (int i = 0; i < plan->n_curves; i++)
        first = ADCGS_MAX(first, strlen(plan->curve[i].name));
    const sheet s = {file, 0, (int)first + 2};
    print_all(&s, plan);
}

/* ---- Page ---- */

/** Prints a chart from its first element on, enlarged by a click like images. A missing chart is left out. */
static void print_chart(const sheet *s, const adcgs_sweep *sweep, const adcgs_chart *chart)
{
    char path[ADCGS_SWEEP_PATH], line[4096];
    int begun = 0;
    snprintf(path, sizeof path, "%s/%s.svg", sweep->directory, chart->name);
    FILE *const svg = fopen(path, "r");
    if (!svg)
        return;
    fprintf(s->file, "<figure><label><input type=\"checkbox\">");
    while (fgets(line, sizeof line, svg)) {
        const char *const start = begun ? line : strstr(line, "<svg");
        begun |= start != NULL;
        if (start)
            fputs(start, s->file);
    }
    fprintf(s->file, "</label></figure>\n");
    fclose(svg);
}

/** Prints an image that a click enlarges to full size and reduces again, by a hidden checkbox, without scripts. */
static void print_picture(const sheet *s, const adcgs_sweep_picture *p)
{
    char text[200];
    uint8_t *data;
    size_t bytes;
    adcgs_error error;
    if (!p->is_there || adcgs_file_load(&data, &bytes, p->path, PICTURE_BYTES_MAX, &error) != ADCGS_OK)
        return;
    const int n = snprintf(text, sizeof text, "The %s of the test views of %s: %.2f dB", p->name, p->run, p->psnr);
    if (isfinite(p->time))
        snprintf(text + n, sizeof text - (size_t)n, ", at %.3g s", p->time);
    fprintf(s->file, "<figure><label><input type=\"checkbox\"><img alt=\"");
    put_escaped(s, text);
    fprintf(s->file, "\" src=\"data:image/png;base64,");
    adcgs_base64_write(s->file, data, bytes, 0);
    fprintf(s->file, "\"></label><figcaption>");
    put_escaped(s, text);
    fprintf(s->file, ". Truth, decoded, four times their difference; click it for full size.</figcaption></figure>\n");
    free(data);
}

/** Finds the processor's name, if the system provides it. */
static void find_processor(char *name, size_t size)
{
    char line[256];
    FILE *const file = fopen("/proc/cpuinfo", "r");
    snprintf(name, size, "unknown processor");
    while (file && fgets(line, sizeof line, file)) {
        const char *const colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !colon)
            continue;
        snprintf(name, size, "%s", colon + 1 + strspn(colon + 1, " "));
        name[strcspn(name, "\n")] = '\0';
        break;
    }
    if (file)
        fclose(file);
}

static void print_machine(const sheet *s, const adcgs_sweep *sweep)
{
    char processor[128], threads[48] = "as many threads as processors", date[32] = "";
    const time_t now = time(NULL);
    struct tm day;
    find_processor(processor, sizeof processor);
    if (sweep->threads)
        snprintf(threads, sizeof threads, "%d thread%s", sweep->threads, sweep->threads > 1 ? "s" : "");
    if (gmtime_r(&now, &day))
        strftime(date, sizeof date, "%Y-%m-%d", &day);
    say(s,
        "%s, %ld processor%s online, %s unless a curve says otherwise; training seconds are CPU seconds of all threads; adcgs "
        "%s, %s. %s",
        processor, sysconf(_SC_NPROCESSORS_ONLN), adcgs_s((uint64_t)sysconf(_SC_NPROCESSORS_ONLN)), threads, PACKAGE_VERSION,
        date, sweep->command);
}

static void print_settings(const sheet *s, const adcgs_sweep *sweep, const adcgs_sweep_plan *plan)
{
    say(s, "Scene %s; preset %s%s%s%s; every figure is that of the file on disk, decoded, on views that training never saw.",
        sweep->scene, sweep->preset ? sweep->preset : "of the encoder", sweep->fixed ? ", sizes fixed" : "",
        sweep->set ? "; settings " : "", sweep->set ? sweep->set : "");
    if (sweep->n_seed > 1)
        say(s, "Each figure is the mean of %d seeds, with the smallest and the largest value.", sweep->n_seed);
    if (sweep->iterations)
        say(s, "%d iterations of training.", sweep->iterations);
    for (int i = 0; i < plan->n_curves; i++)
        say(s, "%s: %s.", plan->curve[i].name, plan->curve[i].note);
}

static const char style[] =
    "body { font: 15px/1.45 sans-serif; max-width: 100em; margin: 2em auto; padding: 0 1em; color: #222; }\n"
    ".wide { overflow-x: auto; }\ntable { border-collapse: collapse; }\n"
    ".charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(32em, 100%), 1fr)); gap: 0 1em; }\n"
    "figure { margin: 1em 0; min-width: 0; break-inside: avoid; }\nfigure svg, figure img { max-width: 100%; height: auto; }\n"
    "td, th { padding: 0.2em 0.8em; text-align: right; border-bottom: 1px solid #ddd; white-space: nowrap; }\n"
    "td:first-child, th:first-child { text-align: left; }\np { overflow-wrap: anywhere; }\n"
    "label { display: block; cursor: zoom-in; overflow-x: auto; }\nlabel input { display: none; }\n"
    "label input:checked + img, label input:checked + svg { max-width: none; cursor: zoom-out; }\n"
    "@media print { body { margin: 0; max-width: none; } td, th { padding: 0.1em 0.4em; font-size: 10px; } }\n";

adcgs_status adcgs_sweep_write_page(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, unsigned charts, adcgs_error *error)
{
    char path[ADCGS_SWEEP_PATH];
    adcgs_sweep_picture picture[ADCGS_SWEEP_PICTURES];
    adcgs_atomic file;
    ADCGS_TRY(adcgs_sweep_pictures(sweep, plan, picture, error));
    snprintf(path, sizeof path, "%s/index.html", sweep->directory);
    ADCGS_TRY(adcgs_atomic_open(&file, path, error));
    const sheet s = {file.file, 1, 0};
    fprintf(file.file, "<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
                       "<meta name=\"viewport\" content=\"width=device-width\">\n<title>Rate, distortion and time: ");
    put_escaped(&s, sweep->scene);
    fprintf(file.file, "</title>\n<style>\n%s</style>\n<h1>Rate, distortion and time</h1>\n", style);
    if (charts)
        say(&s, "Click a chart for its full size.");
    fprintf(file.file, "<div class=\"charts\">\n");
    for (int i = 0; adcgs_charts[i].name; i++)
        if (charts & 1U << i)
            print_chart(&s, sweep, &adcgs_charts[i]);
    fprintf(file.file, "</div>\n");
    for (int i = 0; i < ADCGS_SWEEP_PICTURES; i++)
        print_picture(&s, &picture[i]);
    print_all(&s, plan);
    heading(&s, "Settings");
    print_settings(&s, sweep, plan);
    print_machine(&s, sweep);
    fprintf(file.file, "</html>\n");
    return adcgs_atomic_commit(&file, error);
}
