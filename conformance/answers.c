/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Entries of the manifest. */
#include "answers.h"

#include "base/digest.h"
#include "stream/input.h"

#include <adcgs/adcgs.h>

#include <stdlib.h>

static void hex_of(adcgs_md5 *md5, char hex[33])
{
    uint8_t digest[16];
    adcgs_md5_final(md5, digest);
    adcgs_md5_hex(digest, hex);
}

const char *adcgs_answers_verdict(const char *id)
{
    static const char *const verdicts[] = {"good", "bad", "limit", "unsup"};
    for (size_t i = 0; i < ADCGS_COUNTOF(verdicts); i++)
        if (strncmp(id, verdicts[i], strlen(verdicts[i])) == 0 && id[strlen(verdicts[i])] == '-')
            return verdicts[i];
    return "";
}

static const char *class_of(adcgs_status status)
{
    return status == ADCGS_ERR_DATA          ? "data"
           : status == ADCGS_ERR_TRUNCATED   ? "truncated"
           : status == ADCGS_ERR_UNSUPPORTED ? "unsupported"
           : status == ADCGS_ERR_LIMIT       ? "limit"
                                             : "";
}

/* ---- Parts of an entry ---- */

static const adcgs_command *own_command(const adcgs_plan *plan, const char *verb)
{
    for (int i = 0; i < plan->recipe->n; i++)
        if (adcgs_command_is(&plan->recipe->command[i], verb)) {
            plan->recipe->command[i].used = 1;
            return &plan->recipe->command[i];
        }
    return NULL;
}

/* Requirements, each in the form REQ-AREA-NUMBER. */
static adcgs_status print_requirements(FILE *out, const char *name, const adcgs_command *c, adcgs_error *error)
{
    fprintf(out, ",\n      \"%s\": [", name);
    for (int i = 1; i < c->n; i++) {
        if (strncmp(c->word[i], "REQ-", 4) || strlen(c->word[i]) != 12)
            return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": expected the number of a requirement", c->word[i]);
        fprintf(out, "%s\"%s\"", i == 1 ? "" : i % 6 ? ", " : ",\n        ", c->word[i]);
    }
    fprintf(out, "]");
    return ADCGS_OK;
}

static void print_cameras(FILE *out, const adcgs_plan *plan)
{
    fprintf(out, ",\n      \"cameras\": [");
    for (int i = 0; i < plan->n_cameras; i++) {
        const adcgs_camera *const c = &plan->cameras[i];
        fprintf(out, "%s\n        { \"name\": \"%s\", \"width\": %d, \"height\": %d, ", i ? "," : "", c->name, (int)c->width,
                (int)c->height);
        fprintf(out, "\"fx\": %.17g, \"fy\": %.17g, \"cx\": %.17g, \"cy\": %.17g,", c->fx, c->fy, c->cx, c->cy);
        fprintf(out, "\n          \"near\": %.17g, \"cam_to_world\": [", c->near_plane);
        for (int k = 0; k < 12; k++)
            fprintf(out, "%s%.17g", k ? ", " : "", c->cam_to_world[k]);
        fprintf(out, "] }");
    }
    fprintf(out, " ]");
}

static adcgs_status print_props(FILE *out, const adcgs_plan *plan, adcgs_decoder *decoder, size_t bytes, adcgs_error *error)
{
    adcgs_info info;
    ADCGS_TRY(adcgs_get_info(decoder, &info, sizeof info, error));
    if ((int)info.truncated != (strstr(plan->recipe->id, "truncated") != NULL))
        return adcgs_fail(error, ADCGS_ERR_INTERNAL, "%s: truncated is %d", plan->recipe->id, info.truncated);
    fprintf(out, ",\n      \"props\": { \"bytes\": %zu, \"anchors\": %u, \"segments\": %d, \"frames\": %d, \"truncated\": %s }",
            bytes, info.anchors, info.segments, plan->n_cameras * plan->n_times, info.truncated ? "true" : "false");
    return ADCGS_OK;
}

static adcgs_status print_models(FILE *out, adcgs_decoder *decoder, adcgs_error *error)
{
    adcgs_info info;
    ADCGS_TRY(adcgs_get_info(decoder, &info, sizeof info, error));
    fprintf(out, ",\n        \"M\": [");
    for (int i = 0; i < info.segments; i++) {
        uint8_t digest[16];
        char hex[33];
        ADCGS_TRY(adcgs_get_model_digest(decoder, i, digest, error));
        adcgs_md5_hex(digest, hex);
        fprintf(out, "%s\"%s\"", i == 0 ? "" : i % 3 ? ", " : ",\n          ", hex);
    }
    fprintf(out, "]");
    return ADCGS_OK;
}

static adcgs_status print_splats(FILE *out, const adcgs_plan *plan, adcgs_decoder *decoder, adcgs_error *error)
{
    fprintf(out, ",\n        \"S\": [");
    for (int i = 0; i < plan->n_times; i++) {
        uint8_t digest[16];
        char hex[33];
        ADCGS_TRY(adcgs_get_splat_digest(decoder, plan->times[i], digest, error));
        adcgs_md5_hex(digest, hex);
        fprintf(out, "%s\n          { \"time\": %.17g, \"md5\": \"%s\" }", i ? "," : "", plan->times[i], hex);
    }
    fprintf(out, " ]");
    return ADCGS_OK;
}

static adcgs_status print_frame(FILE *out, adcgs_decoder *decoder, const adcgs_camera *c, int index, double time, int first,
                                adcgs_error *error)
{
    uint8_t digest[16];
    char hex[33];
    adcgs_frame frame = {.width = c->width, .height = c->height};
    frame.rgb = malloc(3 * sizeof *frame.rgb * (size_t)c->width * (size_t)c->height);
    if (!frame.rgb)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "no memory for a frame");
    const adcgs_status status = adcgs_render(decoder, c, time, &frame, error);
    snprintf(hex, sizeof hex, "refused");
    if (status == ADCGS_OK) {
        adcgs_frame_digest(&frame, digest);
        adcgs_md5_hex(digest, hex);
    }
    free(frame.rgb);
    if (status != ADCGS_ERR_USAGE)
        ADCGS_TRY(status);
    fprintf(out, "%s\n          { \"camera\": %d, \"time\": %.17g, \"md5\": \"%s\" }", first ? "" : ",", index, time, hex);
    return ADCGS_OK;
}

static adcgs_status print_expected(FILE *out, const adcgs_plan *plan, adcgs_decoder *decoder, adcgs_trace_sum *trace,
                                   adcgs_error *error)
{
    char hex[33];
    adcgs_trace_sum_final(trace, hex);
    fprintf(out, ",\n      \"expect\": {\n        \"P\": { \"elements\": %u, \"trace_md5\": \"%s\" }", trace->lines, hex);
    ADCGS_TRY(print_models(out, decoder, error));
    ADCGS_TRY(print_splats(out, plan, decoder, error));
    fprintf(out, ",\n        \"R\": [");
    for (int t = 0; t < plan->n_times; t++)
        for (int c = 0; c < plan->n_cameras; c++)
            ADCGS_TRY(print_frame(out, decoder, &plan->cameras[c], c, plan->times[t], t + c == 0, error));
    fprintf(out, " ]");
    return ADCGS_OK;
}

/* Results with at most plan->fewer[i] layers. Frames are not listed: they follow from the splats. */
static adcgs_status print_fewer(FILE *out, const adcgs_plan *plan, const adcgs_buffer *file, int i, adcgs_error *error)
{
    adcgs_config config;
    adcgs_decoder *decoder = NULL;
    adcgs_config_init(&config, sizeof config);
    config.threads = 1;
    config.cpu = ADCGS_CPU_SCALAR;
    config.layers = plan->fewer[i];
    ADCGS_TRY(adcgs_open_memory(&decoder, file->data, file->size, &config, error));
    fprintf(out, "%s\n          { \"layers\": %d", i ? "," : ",\n        \"L\": [", plan->fewer[i]);
    adcgs_status status = print_models(out, decoder, error);
    if (status == ADCGS_OK)
        status = print_splats(out, plan, decoder, error);
    adcgs_close(&decoder);
    fprintf(out, " }%s", i + 1 == plan->n_fewer ? " ]" : "");
    return status;
}

/* ---- The entry ---- */

static adcgs_status print_good(FILE *out, const adcgs_plan *plan, const adcgs_buffer *file, adcgs_trace_sum *trace,
                               adcgs_error *error)
{
    const adcgs_command *const covers = own_command(plan, "covers");
    adcgs_decoder *decoder = NULL;
    adcgs_config config;
    if (!covers)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: the recipe has no command covers", plan->recipe->id);
    ADCGS_TRY(print_requirements(out, "covers", covers, error));
    adcgs_config_init(&config, sizeof config);
    config.threads = 1;
    config.cpu = ADCGS_CPU_SCALAR;
    ADCGS_TRY(adcgs_open_memory(&decoder, file->data, file->size, &config, error));
    adcgs_status status = print_props(out, plan, decoder, file->size, error);
    print_cameras(out, plan);
    if (status == ADCGS_OK)
        status = print_expected(out, plan, decoder, trace, error);
    for (int i = 0; i < plan->n_fewer && status == ADCGS_OK; i++)
        status = print_fewer(out, plan, file, i, error);
    fprintf(out, " }");
    adcgs_close(&decoder);
    return status;
}

/* expect CLASS "part of the message": ensures that the decoder refuses the vector for the intended reason. */
static adcgs_status print_bad(FILE *out, const adcgs_plan *plan, const char *verdict, adcgs_status status, const char *message,
                              size_t bytes, adcgs_error *error)
{
    const adcgs_command *const violates = own_command(plan, "violates"), *const expect = own_command(plan, "expect");
    if (!violates || !expect || expect->n != 3)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: the recipe lacks violates, or expect CLASS TEXT", plan->recipe->id);
    if (strcmp(class_of(status), expect->word[1]) || !strstr(message, expect->word[2]))
        return adcgs_fail(error, ADCGS_ERR_INTERNAL, "%s: ends with \"%s\" (%.100s), expected \"%s\" (%.60s)", plan->recipe->id,
                          class_of(status), message, expect->word[1], expect->word[2]);
    if ((strcmp(verdict, "limit") == 0 && status != ADCGS_ERR_LIMIT) ||
        (strcmp(verdict, "unsup") == 0 && status != ADCGS_ERR_UNSUPPORTED) ||
        (strcmp(verdict, "bad") == 0 && status != ADCGS_ERR_DATA && status != ADCGS_ERR_TRUNCATED))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: the verdict in its name does not fit its class", plan->recipe->id);
    fprintf(out, ",\n      \"status\": \"%s\"", class_of(status));
    ADCGS_TRY(print_requirements(out, "violates", violates, error));
    fprintf(out, ",\n      \"props\": { \"bytes\": %zu }", bytes);
    return ADCGS_OK;
}

static int is_plain(const char *text)
{
    for (; *text; text++)
        if (*text < 32 || *text > 126 || *text == '"' || *text == '\\')
            return 0;
    return 1;
}

adcgs_status adcgs_answers_print(FILE *out, const adcgs_plan *plan, const adcgs_buffer *file, adcgs_error *error)
{
    const char *const id = plan->recipe->id, *const verdict = adcgs_answers_verdict(id);
    const adcgs_command *const title = own_command(plan, "title");
    const adcgs_read_options options = {.cpu = ADCGS_CPU_SCALAR};
    adcgs_span source = {.next = file->data, .left = file->size};
    adcgs_trace_sum trace;
    adcgs_error why = {ADCGS_OK, ""};
    adcgs_stream stream;
    adcgs_md5 md5;
    char hex[33];
    if (!*verdict || !title || title->n != 2 || !is_plain(title->word[1]))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: needs a verdict in its name and a plain title in quotes", id);
    adcgs_trace_sum_init(&trace);
    const adcgs_status status = adcgs_stream_read(&stream, adcgs_span_read, &source, &options, adcgs_trace_sum_add, &trace, &why);
    if (status == ADCGS_OK)
        adcgs_stream_clear(&stream, NULL);
    adcgs_md5_init(&md5);
    adcgs_md5_update(&md5, file->data, file->size);
    hex_of(&md5, hex);
    fprintf(out, "    { \"id\": \"%s\",\n      \"file\": \"vectors/%s.adcgs\", \"recipe\": \"recipes/%s.txt\",\n", id, id, id);
    fprintf(out, "      \"title\": \"%s\",\n      \"md5\": \"%s\", \"level\": %u, \"verdict\": \"%s\"", title->word[1], hex,
            plan->stream.level, verdict);
    if (strcmp(verdict, "good"))
        ADCGS_TRY(print_bad(out, plan, verdict, status, why.text, file->size, error));
    else if (status != ADCGS_OK)
        return adcgs_fail(error, ADCGS_ERR_INTERNAL, "%s: ends with \"%s\": %.160s", id, adcgs_status_name(status), why.text);
    else
        ADCGS_TRY(print_good(out, plan, file, &trace, error));
    fprintf(out, " }");
    return ADCGS_OK;
}
