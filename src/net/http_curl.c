/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The module with libcurl: one transfer at a time over a kept connection, read on demand. */
#include "config.h"

#include "net/http_curl.h"

#include <curl/curl.h>

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>
#include <time.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define CONNECT_MS 15000L /* milliseconds: time limit for a connection */
#define WAIT_SECONDS 30.0 /* time limit for WAIT_BYTES, after which the transfer fails */
#define WAIT_BYTES 1024   /* bytes that a live connection brings in WAIT_SECONDS */
#define POLL_MS 200       /* milliseconds: longest delay until an interrupt is noticed */
#define REDIRECTS 5L      /* followed at most */
#define HEAD_BYTES 65536  /* bytes: upper bound of all headers of a response */

#define TOO_LARGE 100 /* CURLE_TOO_LARGE, which older headers do not define; definition (curl.h) */

struct adcgs_transfer {
    CURLM *multi;
    CURL *easy;
    struct curl_slist *headers;
    const char *url;
    int (*interrupted)(void);
    int started, done; /**< a request has been sent; its response has ended */
    CURLcode result;   /**< valid once done */
    char reason[CURL_ERROR_SIZE];
    const char *refused; /**< reason to refuse the response; NULL: none */
    adcgs_http_head head;
    size_t head_bytes; /**< of all heads since the request, those of redirects too */
    int paused;        /**< more data waits behind the bytes held */
    double waited;     /**< seconds since WAIT_BYTES came */
    size_t came;
    size_t next, held; /**< bytes[next .. held) have not been read yet */
    uint8_t bytes[CURL_MAX_WRITE_SIZE];
};

static size_t take_header(char *data, size_t size, size_t n, void *user)
{
    adcgs_transfer *const t = user;
    t->head_bytes += n;
    if (t->head_bytes > HEAD_BYTES) {
        t->refused = "the headers of its response are too long";
        return 0;
    }
    adcgs_http_head_line(&t->head, data, n);
    return n;
}

/** The body: held until it is read; until then libcurl is paused. */
static size_t take_body(char *data, size_t size, size_t n, void *user)
{
    adcgs_transfer *const t = user;
    t->paused = t->next < t->held;
    if (t->paused)
        return CURL_WRITEFUNC_PAUSE;
    if (n > sizeof t->bytes)
        return 0;
    memcpy(t->bytes, data, n);
    t->next = 0;
    t->held = n;
    t->came += n;
    return n;
}

/* ---- Waiting ---- */

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/** True if libcurl refused a head line above its length limit. It reports CURLE_OUT_OF_MEMORY, or CURLE_TOO_LARGE since 8.6. */
static int is_long_line(const adcgs_transfer *t)
{
    curl_off_t connected = 0, came = 0;
    const int is_so = t->result == CURLE_OUT_OF_MEMORY || (int)t->result == TOO_LARGE;
    return is_so && !curl_easy_getinfo(t->easy, CURLINFO_CONNECT_TIME_T, &connected) && connected > 0 &&
           !curl_easy_getinfo(t->easy, CURLINFO_SIZE_DOWNLOAD_T, &came) && came == 0;
}

static adcgs_status fail(const adcgs_transfer *t, adcgs_error *error)
{
    if (is_long_line(t))
        return adcgs_fail(error, ADCGS_ERR_IO,
                          "%.160s: a header line of its response exceeds the %d bytes that libcurl "
                          "accepts, or memory is exhausted",
                          t->url, CURL_MAX_HTTP_HEADER);
    const char *const why = t->refused ? t->refused : *t->reason ? t->reason : curl_easy_strerror(t->result);
    return adcgs_fail(error, t->result == CURLE_OUT_OF_MEMORY ? ADCGS_ERR_MEMORY : ADCGS_ERR_IO, "%.160s: %s", t->url, why);
}

/** Make progress without blocking; wait briefly if there is none. */
static adcgs_status step(adcgs_transfer *t, adcgs_error *error)
{
    const CURLMsg *message;
    int running, left;
    if (curl_multi_perform(t->multi, &running) != CURLM_OK)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%.160s: libcurl cannot continue", t->url);
    while ((message = curl_multi_info_read(t->multi, &left)))
        if (message->msg == CURLMSG_DONE) {
            t->done = 1;
            t->result = message->data.result;
        }
    if (t->done || t->next < t->held)
        return ADCGS_OK;
    if (t->interrupted && t->interrupted())
        return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: interrupted", t->url);
    curl_multi_poll(t->multi, NULL, 0, POLL_MS, NULL);
    return ADCGS_OK;
}

/**
 * Wait until bytes of the body are available, it has ended, or `steps` steps brought nothing. Only waiting counts as time, not
 * the use of received bytes.
 */
static adcgs_status wait_for_body(adcgs_transfer *t, int steps, adcgs_error *error)
{
    for (; steps > 0 && !t->done && t->next == t->held; steps--) {
        const double begin = seconds();
        ADCGS_TRY(step(t, error));
        t->waited += seconds() - begin;
        if (t->came >= WAIT_BYTES)
            t->waited = 0.0;
        if (t->waited == 0.0)
            t->came = 0;
        if (t->waited > WAIT_SECONDS)
            return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: the server sent less than %d bytes in %.0f seconds", t->url,
                              WAIT_BYTES, WAIT_SECONDS);
    }
    return t->done && t->result != CURLE_OK && t->next == t->held ? fail(t, error) : ADCGS_OK;
}

/* ---- The table ---- */

static void stop(adcgs_transfer *t)
{
    if (t->started)
        curl_multi_remove_handle(t->multi, t->easy);
    curl_slist_free_all(t->headers);
    t->headers = NULL;
    t->started = t->done = t->paused = 0;
    t->next = t->held = t->came = t->head_bytes = 0;
    t->waited = 0.0;
    t->refused = NULL;
    *t->reason = 0;
}

static void transfer_close(adcgs_transfer **transfer)
{
    adcgs_transfer *const t = *transfer;
    if (!t)
        return;
    stop(t);
    curl_easy_cleanup(t->easy);
    curl_multi_cleanup(t->multi);
    curl_global_cleanup();
    free(t);
    *transfer = NULL;
}

/** Allowed protocols: by name since libcurl 7.85, as bits before. An https URL is never redirected to http. */
static CURLcode set_protocols(CURL *easy, int is_secure)
{
#if LIBCURL_VERSION_NUM >= 0x075500
    const CURLcode result = curl_easy_setopt(easy, CURLOPT_PROTOCOLS_STR, "http,https");
    return result ? result : curl_easy_setopt(easy, CURLOPT_REDIR_PROTOCOLS_STR, is_secure ? "https" : "http,https");
#else
    const long both = CURLPROTO_HTTP | CURLPROTO_HTTPS;
    const CURLcode result = curl_easy_setopt(easy, CURLOPT_PROTOCOLS, both);
    return result ? result : curl_easy_setopt(easy, CURLOPT_REDIR_PROTOCOLS, is_secure ? (long)CURLPROTO_HTTPS : both);
#endif
}

static CURLcode set_up(adcgs_transfer *t)
{
    CURL *const e = t->easy;
    CURLcode result = set_protocols(e, !strncasecmp(t->url, "https:", 6));
    result = result ? result : curl_easy_setopt(e, CURLOPT_URL, t->url);
    result = result ? result : curl_easy_setopt(e, CURLOPT_USERAGENT, "adcgs/" PACKAGE_VERSION);
    result = result ? result : curl_easy_setopt(e, CURLOPT_NOSIGNAL, 1L); /* the program has other threads */
    result = result ? result : curl_easy_setopt(e, CURLOPT_CONNECTTIMEOUT_MS, CONNECT_MS);
    result = result ? result : curl_easy_setopt(e, CURLOPT_FOLLOWLOCATION, 1L);
    result = result ? result : curl_easy_setopt(e, CURLOPT_MAXREDIRS, REDIRECTS);
    result = result ? result : curl_easy_setopt(e, CURLOPT_ERRORBUFFER, t->reason);
    result = result ? result : curl_easy_setopt(e, CURLOPT_HEADERFUNCTION, take_header);
    result = result ? result : curl_easy_setopt(e, CURLOPT_HEADERDATA, t);
    result = result ? result : curl_easy_setopt(e, CURLOPT_WRITEFUNCTION, take_body);
    return result ? result : curl_easy_setopt(e, CURLOPT_WRITEDATA, t);
}

static adcgs_status transfer_open(adcgs_transfer **out, const char *url, int (*interrupted)(void), adcgs_error *error)
{
    adcgs_transfer *t = calloc(1, sizeof *t);
    *out = NULL;
    if (!t)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%.160s: out of memory", url);
    t->url = url;
    t->interrupted = interrupted;
    curl_global_init(CURL_GLOBAL_DEFAULT); /* counts its calls; curl_global_cleanup() undoes one */
    t->multi = curl_multi_init();
    t->easy = t->multi ? curl_easy_init() : NULL;
    if (!t->easy || set_up(t) != CURLE_OK) {
        transfer_close(&t);
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%.160s: libcurl cannot start", url);
    }
    *out = t;
    return ADCGS_OK;
}

/** "If-Range: ...": the range if the resource is unchanged, else the whole resource. */
static CURLcode set_same(adcgs_transfer *t, const char *same)
{
    char line[160];
    if (!same)
        return curl_easy_setopt(t->easy, CURLOPT_HTTPHEADER, NULL);
    snprintf(line, sizeof line, "If-Range: %s", same);
    t->headers = curl_slist_append(NULL, line);
    return t->headers ? curl_easy_setopt(t->easy, CURLOPT_HTTPHEADER, t->headers) : CURLE_OUT_OF_MEMORY;
}

static adcgs_status transfer_ask(adcgs_transfer *t, const char *range, const char *same, adcgs_http_head *head,
                                 adcgs_error *error)
{
    long status = 0;
    curl_off_t length = -1;
    stop(t);
    if (set_same(t, same) || curl_easy_setopt(t->easy, CURLOPT_RANGE, range) || curl_multi_add_handle(t->multi, t->easy))
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%.160s: libcurl cannot send a request", t->url);
    t->started = 1;
    ADCGS_TRY(wait_for_body(t, INT_MAX, error));
    *head = t->head;
    curl_easy_getinfo(t->easy, CURLINFO_RESPONSE_CODE, &status);
    curl_easy_getinfo(t->easy, CURLINFO_CONTENT_LENGTH_DOWNLOAD_T, &length);
    head->status = (int)status;
    head->length = length < 0 ? ADCGS_HTTP_UNKNOWN : (uint64_t)length;
    return ADCGS_OK;
}

static adcgs_status receive_bytes(adcgs_transfer *t, int steps, void *buffer, size_t bytes, size_t *got, adcgs_error *error)
{
    *got = 0;
    if (t->paused && t->next == t->held) {
        t->paused = 0;
        curl_easy_pause(t->easy, CURLPAUSE_CONT); /* may deliver the next bytes at once */
    }
    ADCGS_TRY(wait_for_body(t, steps, error));
    *got = ADCGS_MIN(bytes, t->held - t->next);
    memcpy(buffer, t->bytes + t->next, *got);
    t->next += *got;
    return ADCGS_OK;
}

static adcgs_status transfer_read(adcgs_transfer *t, void *buffer, size_t bytes, size_t *got, adcgs_error *error)
{
    return receive_bytes(t, INT_MAX, buffer, bytes, got, error);
}

static adcgs_status transfer_take(adcgs_transfer *t, void *buffer, size_t bytes, size_t *got, int *ended, adcgs_error *error)
{
    const adcgs_status status = receive_bytes(t, 1, buffer, bytes, got, error);
    *ended = t->done && t->next == t->held;
    return status;
}

const adcgs_curl adcgs_curl_table = {
    .version = PACKAGE_VERSION,
    .open = transfer_open,
    .close = transfer_close,
    .ask = transfer_ask,
    .read = transfer_read,
    .take = transfer_take,
};
