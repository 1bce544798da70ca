/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Results of conformance runs as JUnit XML, which continuous integration displays. */
#include "config.h"

#include "apps/conform/conform.h"

#include <stdlib.h>

static void put_escaped(FILE *out, const char *text)
{
    for (; *text; text++)
        switch (*text) {
        case '&':
            fputs("&amp;", out);
            break;
        case '<':
            fputs("&lt;", out);
            break;
        case '"':
            fputs("&quot;", out);
            break;
        default:
            fputc((unsigned char)*text < 32 || (unsigned char)*text > 126 ? '?' : *text, out);
        }
}

adcgs_status adcgs_junit_open(adcgs_junit *junit, const char *path, adcgs_error *error)
{
    *junit = (adcgs_junit){.n = 0};
    if (!path)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_atomic_open(&junit->atomic, path, error));
    junit->memory = open_memstream(&junit->cases, &junit->bytes);
    if (junit->memory)
        return ADCGS_OK;
    adcgs_atomic_abort(&junit->atomic);
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "%.160s: out of memory", path);
}

/* A wrong result is a failure; a decoder that crashes or hangs is an error. */
void adcgs_junit_add(adcgs_junit *junit, const adcgs_vector *vector, adcgs_outcome outcome, double seconds, const char *what)
{
    const char *const tag = outcome == ADCGS_OUTCOME_WRONG ? "failure" : "error";
    if (!junit->memory)
        return;
    junit->n++;
    junit->failures += outcome == ADCGS_OUTCOME_WRONG;
    junit->errors += outcome == ADCGS_OUTCOME_CRASHED || outcome == ADCGS_OUTCOME_TIMEOUT;
    junit->seconds += seconds;
    fprintf(junit->memory, "  <testcase classname=\"conformance\" name=\"");
    put_escaped(junit->memory, vector->id);
    fprintf(junit->memory, "\" time=\"%.3f\"", seconds);
    if (outcome == ADCGS_OUTCOME_OK) {
        fprintf(junit->memory, "/>\n");
        return;
    }
    fprintf(junit->memory, ">\n    <%s type=\"%s\" message=\"", tag, adcgs_outcome_name(outcome));
    put_escaped(junit->memory, what);
    fprintf(junit->memory, "\"/>\n  </testcase>\n");
}

adcgs_status adcgs_junit_close(adcgs_junit *junit, adcgs_error *error)
{
    if (!junit->memory)
        return ADCGS_OK;
    FILE *const file = junit->atomic.file;
    const int complete = fclose(junit->memory) == 0;
    junit->memory = NULL;
    fprintf(file, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    fprintf(file, "<testsuite name=\"adcgs-conform\" tests=\"%d\" failures=\"%d\"", junit->n, junit->failures);
    fprintf(file, " errors=\"%d\" time=\"%.3f\">\n%s</testsuite>\n", junit->errors, junit->seconds, complete ? junit->cases : "");
    free(junit->cases);
    if (complete)
        return adcgs_atomic_commit(&junit->atomic, error);
    adcgs_atomic_abort(&junit->atomic);
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "JUnit report: out of memory");
}
