/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Requests to a web server and checks of its responses: the front of the module
 * with libcurl.
 */
#include "config.h"

#include "net/http.h"

#include "net/http_curl.h"

#include <stdio.h>
#include <stdlib.h>
#include <strings.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define RANGE_FIRST (UINT64_C(64) << 10) /* bytes of a first range */
#define RANGE_MAX (UINT64_C(1) << 20)    /* bytes of the longest range */
#define BYTES_MAX (UINT64_C(1) << 36)    /* of a stream of the highest level; definition (the specification) */

/** A cached range. */
typedef struct window {
    uint8_t *bytes; /**< [room], the first `held` of them valid */
    size_t held, room;
    uint64_t at;    /**< offset of the first byte */
    uint64_t asked; /**< maximum length of the request */
} window;

struct adcgs_http {
    const adcgs_curl *curl;
    adcgs_transfer *transfer;
    char *url;
    uint64_t size;      /**< 0: it can only be read in order */
    adcgs_http_head is; /**< head of the first response; later ones must agree */
    uint64_t left;      /**< bytes that may still be read */
    window windows[2];  /**< two, so that a jump, to the index for example, keeps the range before it */
    int used;           /**< index of the window used last */
    adcgs_error why;    /**< reason of a read failure */
};

#ifdef HAVE_CURL

static ADCGS_MODULE_GET(get_curl, adcgs_curl, adcgs_curl_table, "adcgs_http.so", "http needs libcurl")

#else

static adcgs_status get_curl(const adcgs_curl **curl, const char *path, adcgs_error *error)
{
    *curl = NULL;
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%.160s: http needs libcurl, which this build lacks", path);
}

#endif

    int adcgs_is_url(const char *name)
{
    return !strncasecmp(name, "http://", 7) || !strncasecmp(name, "https://", 8);
}

/* ---- Requests ---- */

static adcgs_status fail_status(const adcgs_http *h, int status, adcgs_error *error)
{
    const char *const what = status == 401   ? " (a password is required)"
                             : status == 206 ? " (a range that was not requested)"
                             : status == 403 ? " (forbidden)"
                             : status == 404 ? " (not found)"
                                             : "";
    return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: the server answers with status %d%s", h->url, status, what);
}

static adcgs_status check_size(const adcgs_http *h, uint64_t size, adcgs_error *error)
{
    return size <= BYTES_MAX ? ADCGS_OK
                             : adcgs_fail(error, ADCGS_ERR_LIMIT, "%.160s: %llu bytes, expected at most %llu", h->url,
                                          (unsigned long long)size, (unsigned long long)BYTES_MAX);
}

/** Validator that makes the server send a range only of the unchanged resource. A weak tag does not guarantee that. */
static const char *same(const adcgs_http *h)
{
    return *h->is.tag == '"' ? h->is.tag : *h->is.modified ? h->is.modified : NULL;
}

static int has_changed(const adcgs_http *h, const adcgs_http_head *head)
{
    return head->size != h->is.size || (*h->is.tag ? strcmp(head->tag, h->is.tag) : strcmp(head->modified, h->is.modified));
}

/** Check that the response is the range from `first` on, at most as long as requested. */
static adcgs_status check_range(const adcgs_http *h, const adcgs_http_head *head, uint64_t first, uint64_t last,
                                adcgs_error *error)
{
    if (head->first == first && head->last <= last)
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: the server sent a range other than bytes %llu to %llu", h->url,
                      (unsigned long long)first, (unsigned long long)last);
}

/** Read the whole body, of expected length n, into a window. */
static adcgs_status fill(adcgs_http *h, window *w, size_t n, adcgs_error *error)
{
    size_t got = 1;
    if (n > h->left)
        return adcgs_fail(error, ADCGS_ERR_LIMIT, "%.160s: more than %llu bytes read in total", h->url,
                          (unsigned long long)BYTES_MAX);
    if (n > w->room) {
        uint8_t *const bytes = realloc(w->bytes, n);
        if (!bytes)
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "%.160s: out of memory for %zu bytes", h->url, n);
        w->bytes = bytes;
        w->room = n;
    }
    for (w->held = 0; w->held < n && got > 0; w->held += got)
        ADCGS_TRY(h->curl->read(h->transfer, w->bytes + w->held, n - w->held, &got, error));
    h->left -= w->held;
    uint8_t more;
    if (w->held == n)
        ADCGS_TRY(h->curl->read(h->transfer, &more, 1, &got, error)); /* reading to the end keeps the connection usable */
    if (w->held == n && got == 0)
        return ADCGS_OK;
    w->held = 0;
    return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: the server sent %s bytes than announced", h->url, got ? "more" : "fewer");
}

/** Fill a window with at most this many bytes from `first` on. */
static adcgs_status fetch(adcgs_http *h, window *w, uint64_t first, uint64_t bytes, adcgs_error *error)
{
    char range[48];
    adcgs_http_head head;
    const uint64_t last = first + ADCGS_MIN(bytes, h->size - first) - 1;
    snprintf(range, sizeof range, "%llu-%llu", (unsigned long long)first, (unsigned long long)last);
    w->held = 0;
    ADCGS_TRY(h->curl->ask(h->transfer, range, same(h), &head, error));
    if (head.status == 200 || head.status == 412 || head.status == 416 || (head.status == 206 && has_changed(h, &head)))
        return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: changed while it was read", h->url);
    if (head.status != 206)
        return fail_status(h, head.status, error);
    ADCGS_TRY(check_range(h, &head, first, last, error));
    w->at = first;
    w->asked = bytes;
    return fill(h, w, (size_t)(head.last - first + 1), error);
}

/* ---- Opening ---- */

/** Request the whole resource, or its first `limit` bytes, to be read in order. */
static adcgs_status ask_in_order(adcgs_http *h, uint64_t limit, adcgs_error *error)
{
    char range[48];
    snprintf(range, sizeof range, "0-%llu", (unsigned long long)limit - 1);
    ADCGS_TRY(h->curl->ask(h->transfer, limit ? range : NULL, NULL, &h->is, error));
    if (limit && h->is.status == 416) /* it is empty */
        ADCGS_TRY(h->curl->ask(h->transfer, NULL, NULL, &h->is, error));
    if (h->is.status == 206 && limit)
        return check_range(h, &h->is, 0, limit - 1, error);
    if (h->is.status != 200)
        return fail_status(h, h->is.status, error);
    return limit || h->is.length == ADCGS_HTTP_UNKNOWN ? ADCGS_OK : check_size(h, h->is.length, error);
}

/** Request the first range; falls back to reading in order if the server has no ranges. */
static adcgs_status ask_any_order(adcgs_http *h, adcgs_error *error)
{
    char range[48];
    snprintf(range, sizeof range, "0-%llu", (unsigned long long)RANGE_FIRST - 1);
    ADCGS_TRY(h->curl->ask(h->transfer, range, NULL, &h->is, error));
    if (h->is.status == 416 || (h->is.status == 206 && h->is.size == ADCGS_HTTP_UNKNOWN)) /* empty, or of unknown size */
        return ask_in_order(h, 0, error);
    if (h->is.status == 200)
        return h->is.length == ADCGS_HTTP_UNKNOWN ? ADCGS_OK : check_size(h, h->is.length, error);
    if (h->is.status != 206)
        return fail_status(h, h->is.status, error);
    ADCGS_TRY(check_size(h, h->is.size, error));
    ADCGS_TRY(check_range(h, &h->is, 0, RANGE_FIRST - 1, error));
    h->size = h->is.size;
    h->windows[0].asked = RANGE_FIRST;
    return fill(h, &h->windows[0], (size_t)h->is.last + 1, error);
}

static adcgs_status open_url(adcgs_http *h, const char *url, const adcgs_http_config *config, adcgs_error *error)
{
    h->url = strdup(url);
    if (!h->url)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%.160s: out of memory", url);
    h->left = config->limit ? ADCGS_MIN(config->limit, BYTES_MAX) : BYTES_MAX;
    ADCGS_TRY(h->curl->open(&h->transfer, h->url, config->interrupted, error));
    return config->any_order ? ask_any_order(h, error) : ask_in_order(h, config->limit, error);
}

adcgs_status adcgs_http_open(adcgs_http **out, const char *url, const adcgs_http_config *config, adcgs_error *error)
{
    const adcgs_curl *curl;
    *out = NULL;
    ADCGS_TRY(get_curl(&curl, url, error));
    adcgs_http *h = calloc(1, sizeof *h);
    if (!h)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%.160s: out of memory", url);
    h->curl = curl;
    const adcgs_status status = open_url(h, url, config, error);
    if (status != ADCGS_OK)
        adcgs_http_close(&h);
    *out = h;
    return status;
}

void adcgs_http_close(adcgs_http **http)
{
    adcgs_http *const h = *http;
    if (!h)
        return;
    h->curl->close(&h->transfer);
    for (int i = 0; i < 2; i++)
        free(h->windows[i].bytes);
    free(h->url);
    free(h);
    *http = NULL;
}

/* ---- Reading ---- */

uint64_t adcgs_http_size(const adcgs_http *http)
{
    return http->size;
}

int64_t adcgs_http_read(void *user, void *buffer, size_t bytes)
{
    adcgs_http *const h = user;
    size_t got = 0;
    if (h->left > 0 && h->curl->read(h->transfer, buffer, (size_t)ADCGS_MIN((uint64_t)bytes, h->left), &got, &h->why))
        return -1;
    h->left -= got;
    return (int64_t)got;
}

adcgs_status adcgs_http_take(adcgs_http *h, void *buffer, size_t bytes, size_t *got, int *ended, adcgs_error *error)
{
    *got = 0;
    *ended = h->left == 0;
    if (!*ended)
        ADCGS_TRY(h->curl->take(h->transfer, buffer, (size_t)ADCGS_MIN((uint64_t)bytes, h->left), got, ended, error));
    h->left -= *got;
    return ADCGS_OK;
}

static int has(const window *w, uint64_t offset)
{
    return offset >= w->at && offset - w->at < w->held;
}

int64_t adcgs_http_read_at(void *user, uint64_t offset, void *buffer, size_t bytes)
{
    adcgs_http *const h = user;
    const window *const last = &h->windows[h->used];
    const int goes_on = last->held > 0 && offset == last->at + last->held;
    const uint64_t range = goes_on ? ADCGS_MIN(2 * last->asked, RANGE_MAX) : RANGE_FIRST;
    h->used ^= !goes_on && !has(last, offset); /* the other one has it, or is the older one */
    window *const w = &h->windows[h->used];
    if (!has(w, offset) && fetch(h, w, offset, range, &h->why))
        return -1;
    const size_t skip = (size_t)(offset - w->at), n = ADCGS_MIN(bytes, w->held - skip);
    memcpy(buffer, w->bytes + skip, n);
    return (int64_t)n;
}

adcgs_status adcgs_http_explain(const adcgs_http *http, adcgs_status status, adcgs_error *error)
{
    if (!http || http->why.status == ADCGS_OK || status != ADCGS_ERR_IO)
        return status;
    *error = http->why;
    return http->why.status;
}

/** Memory grows with the bytes that arrive, not with the announced length. */
static adcgs_status load_resource(adcgs_http *h, uint8_t **data, size_t *bytes, adcgs_http_useful_fn useful, adcgs_error *error)
{
    size_t room = 0;
    for (int64_t got = 1; got > 0; *bytes += (size_t)got) {
        const uint64_t most = useful(*data, *bytes);
        if (*bytes >= most) {
            *bytes = (size_t)most;
            return ADCGS_OK;
        }
        if (*bytes > ADCGS_HTTP_LOAD_MAX)
            return adcgs_fail(error, ADCGS_ERR_LIMIT, "%.160s: expected at most %llu bytes", h->url,
                              (unsigned long long)ADCGS_HTTP_LOAD_MAX);
        if (*bytes == room) {
            room = ADCGS_MAX(2 * room, (size_t)RANGE_FIRST);
            uint8_t *const grown = realloc(*data, room);
            if (!grown)
                return adcgs_fail(error, ADCGS_ERR_MEMORY, "%.160s: out of memory for %zu bytes", h->url, room);
            *data = grown;
        }
        got = adcgs_http_read(h, *data + *bytes, room - *bytes);
        if (got < 0)
            return adcgs_http_explain(h, ADCGS_ERR_IO, error);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_http_load(uint8_t **data, size_t *bytes, const char *url, adcgs_http_useful_fn useful,
                             int (*interrupted)(void), adcgs_error *error)
{
    adcgs_http *h;
    const adcgs_http_config config = {.interrupted = interrupted};
    *data = NULL;
    *bytes = 0;
    ADCGS_TRY(adcgs_http_open(&h, url, &config, error));
    const adcgs_status status = load_resource(h, data, bytes, useful, error);
    adcgs_http_close(&h);
    if (status == ADCGS_OK)
        return ADCGS_OK;
    free(*data);
    *data = NULL;
    return status;
}
