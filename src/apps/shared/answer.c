/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The conformance protocol on a decoder's side: reading requests, printing answers. */
#include "config.h"

#include "apps/shared/answer.h"

#include "base/cpu_detect.h"
#include "base/digest.h"
#include "cli/cli.h"
#include "stream/input.h"
#include "stream/stream.h"
#include "system/file.h"
#include "system/interrupt.h"
#include "system/numbers.h"

#include <adcgs/adcgs.h>

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define BLANKS " \t\r\n"
#define DIGITS "0123456789"
/*
 * Numbers after the word "camera" and its two integers: fx, fy, cx, cy, near plane and twelve of the matrix; definition.
 */
#define CAMERA_NUMBERS 17

const char *adcgs_fault_class(adcgs_status status)
{
    switch (status) {
    case ADCGS_ERR_DATA:
        return "data";
    case ADCGS_ERR_TRUNCATED:
        return "truncated";
    case ADCGS_ERR_UNSUPPORTED:
        return "unsupported";
    case ADCGS_ERR_LIMIT:
        return "limit";
    default:
        return NULL;
    }
}

/* ---- Reading ---- */

/* Makes room for one more element after count, which is a power of two whenever the room is used up. */
static void *one_more(void *array, int count, size_t size)
{
    if (count & (count - 1))
        return array;
    return realloc(array, (count ? 2 * (size_t)count : 1) * size);
}

static const char *word(char **rest)
{
    return strtok_r(NULL, BLANKS, rest);
}

/* Returns the end of a number's integer part in the grammar of requests, NULL if there is none: no sign except -, no leading
   zeros. */
static const char *whole_end(const char *text)
{
    text += *text == '-';
    const size_t digits = strspn(text, DIGITS);
    return digits == 0 || (digits > 1 && *text == '0') ? NULL : text + digits;
}

/* Integers have a single form, so that the answer repeats the request exactly. */
static int read_integer(const char *text, int min, int max, int *out)
{
    const char *end = text ? whole_end(text) : NULL;
    return !end || *end || !strcmp(text, "-0") ? -1 : adcgs_parse_int(text, min, max, out);
}

/* Refuses numbers that strtod() accepts beyond the grammar (0x10, nan, .5, 1., a plus). */
static int read_number(const char *text, double *out)
{
    const char *end = text ? whole_end(text) : NULL;
    if (end && *end == '.') {
        const size_t digits = strspn(end + 1, DIGITS);
        end = digits ? end + 1 + digits : NULL;
    }
    if (end && (*end == 'e' || *end == 'E')) {
        end += end[1] == '-' || end[1] == '+' ? 2 : 1;
        const size_t digits = strspn(end, DIGITS);
        end = digits ? end + digits : NULL;
    }
    return !end || *end ? -1 : adcgs_parse_real(text, -HUGE_VAL, HUGE_VAL, out);
}

static int read_camera(adcgs_requests *r, char **rest)
{
    double v[CAMERA_NUMBERS];
    int size[2];
    for (int i = 0; i < 2; i++)
        if (read_integer(word(rest), INT32_MIN, INT32_MAX, &size[i]))
            return -1;
    for (int i = 0; i < CAMERA_NUMBERS; i++)
        if (read_number(word(rest), &v[i]))
            return -1;
    adcgs_camera *grown = one_more(r->camera, r->n_cameras, sizeof *grown);
    if (!grown)
        return -1;
    r->camera = grown;
    adcgs_camera *c = &grown[r->n_cameras++];
    *c = (adcgs_camera){.width = size[0], .height = size[1], .fx = v[0], .fy = v[1], .cx = v[2], .cy = v[3], .near_plane = v[4]};
    memcpy(c->cam_to_world, v + 5, sizeof c->cam_to_world);
    return 0;
}

static int read_time(adcgs_request *to, const char *text)
{
    if (!text || strlen(text) >= sizeof to->text || read_number(text, &to->time))
        return -1;
    memcpy(to->text, text, strlen(text) + 1);
    return 0;
}

static int read_request(adcgs_requests *r, const char *name, char **rest)
{
    adcgs_request q = {ADCGS_REQUEST_MODEL, 0, 0.0, ""};
    if (!strcmp(name, "splats")) {
        q.kind = ADCGS_REQUEST_SPLATS;
        if (read_time(&q, word(rest)))
            return -1;
    } else if (!strcmp(name, "frame")) {
        q.kind = ADCGS_REQUEST_FRAME;
        if (read_integer(word(rest), 0, r->n_cameras - 1, &q.camera) || read_time(&q, word(rest)))
            return -1;
    } else if (!strcmp(name, "trace"))
        q.kind = ADCGS_REQUEST_TRACE;
    else if (strcmp(name, "model"))
        return -1;
    adcgs_request *grown = one_more(r->request, r->n, sizeof *grown);
    if (!grown)
        return -1;
    r->request = grown;
    grown[r->n++] = q;
    return 0;
}

static int read_line(adcgs_requests *r, char *line)
{
    char *rest = NULL;
    const char *name = strtok_r(line, BLANKS, &rest);
    int bad = 0;
    if (!name || *name == '#')
        return 0;
    if (!strcmp(name, "camera"))
        bad = read_camera(r, &rest);
    else if (!strcmp(name, "complete"))
        r->complete = 1;
    else if (!strcmp(name, "layers"))
        bad = r->layers || read_integer(word(&rest), 1, 5, &r->layers);
    else
        bad = read_request(r, name, &rest);
    return bad || word(&rest) ? -1 : 0;
}

adcgs_status adcgs_requests_read(adcgs_requests *out, const char *path, adcgs_error *error)
{
    adcgs_status status = ADCGS_OK;
    char *line = NULL;
    size_t room = 0;
    *out = (adcgs_requests){0};
    FILE *file = fopen(path, "r");
    if (!file)
        return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: %s", path, strerror(errno));
    ssize_t length;
    for (int number = 1; status == ADCGS_OK && (length = getline(&line, &room, file)) >= 0; number++)
        if (strlen(line) != (size_t)length || read_line(out, line + (number == 1 ? adcgs_file_mark(line, (size_t)length) : 0)))
            status = adcgs_fail(error, ADCGS_ERR_USAGE, "%.160s: line %d is no request", path, number);
    if (status == ADCGS_OK && ferror(file))
        status = adcgs_fail(error, ADCGS_ERR_IO, "%.160s: cannot read", path);
    for (int i = 0; out->layers && i < out->n && status == ADCGS_OK; i++)
        if (out->request[i].kind == ADCGS_REQUEST_TRACE)
            status = adcgs_fail(error, ADCGS_ERR_USAGE, "%.160s: layers and trace exclude each other", path);
    free(line);
    fclose(file);
    if (status != ADCGS_OK)
        adcgs_requests_clear(out);
    return status;
}

void adcgs_requests_clear(adcgs_requests *requests)
{
    free(requests->request);
    free(requests->camera);
    *requests = (adcgs_requests){0};
}

/* ---- Answering ---- */

static adcgs_status answer_trace(const adcgs_requests *requests, const char *path, adcgs_error *error)
{
    adcgs_read_options options = {.strict_end = requests->complete};
    adcgs_stream stream;
    adcgs_trace_sum sum;
    char hex[33];
    ADCGS_TRY(adcgs_cpu_resolve(ADCGS_CPU_AUTO, &options.cpu, error));
    FILE *file = fopen(path, "rb");
    if (!file)
        return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: %s", path, strerror(errno));
    adcgs_trace_sum_init(&sum);
    const adcgs_status status = adcgs_stream_read(&stream, adcgs_file_read, file, &options, adcgs_trace_sum_add, &sum, error);
    fclose(file);
    if (status != ADCGS_OK)
        return status;
    adcgs_stream_clear(&stream, NULL);
    adcgs_trace_sum_final(&sum, hex);
    printf("trace %u %s\n", (unsigned)sum.lines, hex);
    return ADCGS_OK;
}

static adcgs_status answer_model(adcgs_decoder *decoder, adcgs_error *error)
{
    adcgs_info info;
    ADCGS_TRY(adcgs_get_info(decoder, &info, sizeof info, error));
    for (int i = 0; i < info.segments; i++) {
        uint8_t digest[16];
        char hex[33];
        ADCGS_TRY(adcgs_get_model_digest(decoder, i, digest, error));
        adcgs_md5_hex(digest, hex);
        printf("model %d %s\n", i, hex);
    }
    return ADCGS_OK;
}

static adcgs_status answer_splats(const adcgs_request *q, adcgs_decoder *decoder, adcgs_error *error)
{
    uint8_t digest[16];
    char hex[33];
    ADCGS_TRY(adcgs_get_splat_digest(decoder, q->time, digest, error));
    adcgs_md5_hex(digest, hex);
    printf("splats %s %s\n", q->text, hex);
    return ADCGS_OK;
}

/* Instead of a digest, a camera that the specification refuses gets the word "refused", a frame beyond its limit "declined". */
static adcgs_status answer_frame(const adcgs_request *q, const adcgs_camera *camera, adcgs_decoder *decoder, adcgs_error *error)
{
    const int32_t w = camera->width, h = camera->height;
    const int sane = w >= 1 && w <= 16384 && h >= 1 && h <= 16384;
    adcgs_frame frame = {.width = w, .height = h, .rgb = malloc((sane ? 3 * (size_t)w * (size_t)h : 1) * sizeof(float))};
    char hex[33];
    if (!frame.rgb)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a frame");
    const adcgs_status status = adcgs_render(decoder, camera, q->time, &frame, error);
    if (status == ADCGS_OK) {
        uint8_t digest[16];
        adcgs_frame_digest(&frame, digest);
        adcgs_md5_hex(digest, hex);
    }
    free(frame.rgb);
    if (status != ADCGS_OK && status != ADCGS_ERR_USAGE && status != ADCGS_ERR_LIMIT)
        return status;
    if (status != ADCGS_OK)
        snprintf(hex, sizeof hex, "%s", status == ADCGS_ERR_USAGE ? "refused" : "declined");
    printf("frame %d %s %s\n", q->camera, q->text, hex);
    return ADCGS_OK;
}

adcgs_status adcgs_requests_answer(const adcgs_requests *requests, const char *path, adcgs_decoder *decoder, adcgs_error *error)
{
    adcgs_status status = ADCGS_OK;
    for (int i = 0; i < requests->n && status == ADCGS_OK && !adcgs_interrupted(); i++) {
        const adcgs_request *q = &requests->request[i];
        if (q->kind == ADCGS_REQUEST_TRACE)
            status = answer_trace(requests, path, error);
        else if (q->kind == ADCGS_REQUEST_MODEL)
            status = answer_model(decoder, error);
        else if (q->kind == ADCGS_REQUEST_SPLATS)
            status = answer_splats(q, decoder, error);
        else
            status = answer_frame(q, &requests->camera[q->camera], decoder, error);
    }
    return status;
}
