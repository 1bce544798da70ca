/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Heads of a web server's responses. */
#include "config.h"

#include "net/http_head.h"

#include <strings.h>

/** Parse decimal digits. \return true if there was at least one and the number fits. */
static int parse_number(const char **text, uint64_t *number)
{
    const char *const begin = *text;
    for (*number = 0; **text >= '0' && **text <= '9'; (*text)++) {
        if (*number > UINT64_MAX / 10 - 1)
            return 0;
        *number = 10 * *number + (uint64_t)(**text - '0');
    }
    return *text > begin;
}

/** "bytes 0-65535/100000"; with * for an unknown size, or for a range that cannot be had. */
static void parse_range(adcgs_http_head *head, const char *text)
{
    uint64_t first = ADCGS_HTTP_UNKNOWN, last = 0, size = ADCGS_HTTP_UNKNOWN;
    if (strncasecmp(text, "bytes ", 6))
        return;
    text += 6;
    if (*text == '*')
        text++;
    else if (!parse_number(&text, &first) || *text++ != '-' || !parse_number(&text, &last) || last < first)
        return;
    if (*text++ != '/' || (*text != '*' && (!parse_number(&text, &size) || *text)))
        return;
    if (first != ADCGS_HTTP_UNKNOWN && last >= size)
        return;
    head->first = first;
    head->last = last;
    head->size = size;
}

/** Keep a value that is sent back to the server unchanged; "" if it is too long or not plain ASCII. */
static void keep(char *to, size_t size, const char *value)
{
    const size_t n = strlen(value);
    *to = 0;
    for (const char *c = value; *c; c++)
        if (*c < ' ' || *c > '~')
            return;
    if (n < size)
        memcpy(to, value, n + 1);
}

static void parse_line(adcgs_http_head *head, char *line)
{
    char *value = strchr(line, ':');
    if (!strncmp(line, "HTTP/", 5)) /* another response: headers of a redirect no longer count */
        *head = (adcgs_http_head){.length = ADCGS_HTTP_UNKNOWN, .first = ADCGS_HTTP_UNKNOWN, .size = ADCGS_HTTP_UNKNOWN};
    if (!value)
        return;
    *value++ = 0;
    value += strspn(value, " \t");
    if (!strcasecmp(line, "Content-Range"))
        parse_range(head, value);
    else if (!strcasecmp(line, "ETag"))
        keep(head->tag, sizeof head->tag, value);
    else if (!strcasecmp(line, "Last-Modified"))
        keep(head->modified, sizeof head->modified, value);
}

void adcgs_http_head_line(adcgs_http_head *head, const char *data, size_t n)
{
    char line[256];
    while (n > 0 && strchr(" \t\r\n", data[n - 1]))
        n--;
    if (n >= sizeof line) /* headers of interest are shorter */
        return;
    memcpy(line, data, n);
    line[n] = 0;
    parse_line(head, line);
}
