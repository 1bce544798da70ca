/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-info: prints the contents of a stream and the bytes of its parts. */
#include "config.h"

#include "apps/info/info_check.h"
#include "apps/info/info_cut.h"
#include "apps/info/info_points.h"
#include "apps/info/info_report.h"
#include "apps/info/info_why.h"
#include "base/cpu_detect.h"
#include "base/digest.h"
#include "base/thread_pool.h"
#include "cli/cli.h"
#include "media/operand.h"
#include "media/splats/offset.h"
#include "model/model_priv.h"
#include "system/text.h"

#include <stdlib.h>

typedef struct settings {
    const char *input, *points, *repair, *output;
    int json, bits, trace, digest, why, check, has_bytes;
    uint64_t bytes;
} settings;

static void add_chunk(adcgs_info_report *r, uint64_t bit, const char *type)
{
    adcgs_info_chunk c = {.offset = bit / 8};
    snprintf(c.type, sizeof c.type, "%s", type);
    if (r->n_chunks == r->capacity) {
        const size_t capacity = r->capacity ? 2 * r->capacity : 64;
        adcgs_info_chunk *chunks = realloc(r->chunks, capacity * sizeof *chunks);
        r->failed |= !chunks;
        if (!chunks)
            return;
        r->chunks = chunks;
        r->capacity = capacity;
    }
    r->chunks[r->n_chunks++] = c;
}

static void on_element(void *user, uint64_t bit, const char *element, const char *value)
{
    adcgs_info_report *r = user;
    if (r->trace)
        printf("%llu %s %s\n", (unsigned long long)bit, element, value);
    if (strcmp(element, "chunk.type") == 0)
        add_chunk(r, bit, value);
    if (r->failed || r->n_chunks == 0)
        return;
    adcgs_info_chunk *last = &r->chunks[r->n_chunks - 1];
    if (strcmp(element, "chunk.length") == 0)
        last->bytes = (unsigned)strtoul(value, NULL, 10);
    else if (strcmp(element, "chunk.segment") == 0)
        last->segment = (unsigned)strtoul(value, NULL, 10);
}

static adcgs_status read_report(adcgs_info_report *r, const settings *s, adcgs_error *error)
{
    adcgs_read_options options = {.layers = 0};
    adcgs_operand from;
    ADCGS_TRY(adcgs_operand_open(&from, s->input, &(adcgs_http_config){.limit = 0}, error));
    adcgs_status status = adcgs_cpu_resolve(ADCGS_CPU_AUTO, &options.cpu, error);
    if (status == ADCGS_OK)
        status = adcgs_pool_create(&options.pool, 0, error);
    if (status == ADCGS_OK)
        status = adcgs_stream_read(&r->stream, adcgs_operand_read, &from, &options, on_element, r, error);
    if (status == ADCGS_OK && r->failed)
        status = adcgs_fail(error, ADCGS_ERR_MEMORY, "no memory for the list of chunks");
    if (status == ADCGS_OK)
        adcgs_stream_info(&r->stream, &r->info);
    adcgs_pool_free(&options.pool);
    if (status != ADCGS_OK)
        adcgs_error_locate(error, from.name);
    status = adcgs_operand_explain(&from, status, error);
    adcgs_operand_close(&from);
    return status;
}

static void print_header(const adcgs_info_report *r, const char *name)
{
    const adcgs_info *i = &r->info;
    char bodies[24] = "";
    adcgs_text_show(stdout, name);
    printf(": adcgs stream %d.%d, profile %d, level %d%s\n", i->version_major, i->version_minor, i->profile, i->level,
           i->truncated ? ", TRUNCATED" : "");
    printf("time        %g .. %g s, %d segment%s, %g frames/s\n", i->time_start, i->time_end, i->segments,
           i->segments == 1 ? "" : "s", i->frame_rate);
    printf("scene       origin %g %g %g, scale %g, axes %s, unit %s\n", i->scene_origin[0], i->scene_origin[1],
           i->scene_origin[2], i->scene_scale, i->axes, i->units);
    printf("image       colour %s, background %g %g %g, filter %g px^2\n", i->colour, (double)i->background[0],
           (double)i->background[1], (double)i->background[2], (double)r->stream.screen_filter);
    if (r->stream.params.bodies)
        snprintf(bodies, sizeof bodies, r->stream.params.bodies == 1 ? ", %d body" : ", %d bodies", r->stream.params.bodies);
    printf("model       %u anchors (%u static%s%s), %u Gaussians of at most %d each, %u weights, %d of %d layer%s, ", i->anchors,
           i->static_anchors, r->stream.params.spans ? ", others with lifetimes" : "", bodies, i->gaussians, i->k, i->weights,
           i->layers, adcgs_params_layers(&r->stream.params), adcgs_s((uint64_t)adcgs_params_layers(&r->stream.params)));
    printf("%d of %d tier%s\n", i->tiers_present, i->tiers, i->tiers == 1 ? "" : "s");
}

static void print_components(const adcgs_info_report *r)
{
    adcgs_info_component list[ADCGS_INFO_COMPONENTS];
    adcgs_info_list_components(&r->info.bytes, list);
    printf("\n%-12s %12s %8s %12s\n", "component", "bytes", "percent", "bits/anchor");
    for (int i = 0; i < ADCGS_INFO_COMPONENTS; i++)
        printf("%-12s %12llu %8.2f %12.3f\n", list[i].name, (unsigned long long)list[i].bytes,
               100.0 * (double)list[i].bytes / (double)r->info.bytes.total, 8.0 * (double)list[i].bytes / r->info.anchors);
    printf("%-12s %12llu %8.2f %12.3f\n", "total", (unsigned long long)r->info.bytes.total, 100.0,
           8.0 * (double)r->info.bytes.total / r->info.anchors);
}

static void print_networks(const adcgs_model *m)
{
    for (int role = 0; role < ADCGS_ROLES; role++) {
        const adcgs_net *net = &m->net[role];
        if (!net->present)
            continue;
        printf("  %-8s %7u weights, %u", adcgs_role_name(role), adcgs_net_weights(net), adcgs_net_inputs(net));
        for (int l = 0; l < net->n_layers; l++)
            printf(" > %u%s", net->layer[l].w.rows, net->layer[l].residual ? " residual" : "");
        putchar('\n');
    }
}

static adcgs_status print_segments(const adcgs_info_report *r, adcgs_error *error)
{
    size_t at = 0;
    for (uint32_t i = 0; i < r->stream.n_segments; i++) {
        const adcgs_model *m = &r->stream.segments[i];
        printf("\nsegment %u: %g .. %g s, %u anchors, depth %u, voxel %g, %u Gaussians, %d layer%s, %llu bytes\n", i,
               m->time_start, m->time_end, m->n, m->depth, (double)m->voxel, adcgs_info_count_gaussians(m), m->layers,
               adcgs_s((uint64_t)m->layers), (unsigned long long)adcgs_info_segment_bytes(r, i, &at));
        if (m->reach > 0)
            printf("  crossfade of %g s into the next\n", m->reach);
        uint32_t same, refined;
        ADCGS_TRY(adcgs_info_kept(r, i, &same, &refined, error));
        if (m->predicted)
            printf("  predicted from segment %u: %u anchors kept, %u refined, %u new\n", i - 1, same, refined,
                   m->n - same - refined);
        print_networks(m);
    }
    return ADCGS_OK;
}

static void print_time(const adcgs_stored_camera *c)
{
    if (!isnan(c->time))
        printf(", time %g s", c->time);
    if (c->path >= 0)
        printf(", path %d", c->path);
    putchar('\n');
}

static void print_extras(const adcgs_info_report *r)
{
    if (r->stream.n_cameras > 0)
        printf("\ncameras\n");
    for (uint32_t i = 0; i < r->stream.n_cameras; i++) {
        const adcgs_camera *c = &r->stream.cameras[i].camera;
        printf("  %u ", i);
        adcgs_text_show(stdout, c->name);
        printf(" %dx%d, focal %g %g, centre %g %g, at %g %g %g", (int)c->width, (int)c->height, c->fx, c->fy, c->cx, c->cy,
               c->cam_to_world[3], c->cam_to_world[7], c->cam_to_world[11]);
        print_time(&r->stream.cameras[i]);
    }
    if (r->stream.n_meta > 0)
        printf("\nmetadata\n");
    for (uint32_t i = 0; i < r->stream.n_meta; i++) {
        printf("  ");
        adcgs_text_show(stdout, r->stream.meta[i].key);
        printf(" = ");
        adcgs_text_show(stdout, r->stream.meta[i].value);
        putchar('\n');
    }
}

static void print_chunks(const adcgs_info_report *r)
{
    printf("\n%-6s %8s %12s %12s %12s\n", "chunk", "segment", "offset", "bits", "bits/anchor");
    for (size_t i = 0; i < r->n_chunks; i++) {
        const adcgs_info_chunk *c = &r->chunks[i];
        printf("%-6s %8u %12llu %12llu %12.3f\n", c->type, c->segment, (unsigned long long)c->offset, 8ULL * c->bytes,
               8.0 * c->bytes / r->info.anchors);
    }
}

static void print_digests(const adcgs_info_report *r)
{
    char text[33];
    for (uint32_t i = 0; i < r->stream.n_segments; i++) {
        adcgs_info_digest(r, i, text);
        printf("%s  segment %u\n", text, i);
    }
}

#ifndef HAVE_ENCODER
adcgs_status adcgs_info_print_json(const adcgs_info_report *r, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "--json: this build writes no JSON: it was made without the encoder");
}
#endif

static adcgs_status write_points(const adcgs_info_report *r, const char *path, adcgs_error *error)
{
    adcgs_points points;
    double offset[3];
    ADCGS_TRY(adcgs_info_points(&points, offset, &r->stream, path, error));
    const adcgs_status status = adcgs_points_write(&points, offset, path, error);
    if (status == ADCGS_OK && adcgs_offset_is(offset))
        fprintf(stderr,
                "adcgs-info: %s: the scene is too far from the origin for binary32: %.17g %.17g %.17g was subtracted from "
                "positions\n",
                path, offset[0], offset[1], offset[2]);
    adcgs_points_free(&points);
    return status;
}

static adcgs_status print_report(const adcgs_info_report *r, const settings *s, adcgs_error *error)
{
    if (s->points)
        return write_points(r, s->points, error);
    if (s->json)
        return adcgs_info_print_json(r, error);
    if (s->why) {
        adcgs_info_why(r, s->input);
        return adcgs_cli_flush(error);
    }
    if (s->digest)
        print_digests(r);
    if (!s->digest && !s->trace) {
        print_header(r, s->input);
        print_components(r);
        if (s->bits)
            print_chunks(r);
        ADCGS_TRY(print_segments(r, error));
        print_extras(r);
    }
    return adcgs_cli_flush(error);
}

/** Exit status 1 if the stream has faults. */
static int check(const adcgs_cli *cli, const settings *s, adcgs_error *error)
{
    uint32_t faults = 0;
    adcgs_status status = adcgs_info_check(s->input, s->repair, &faults, error);
    if (status == ADCGS_OK)
        status = adcgs_cli_flush(error);
    fflush(stdout);
    return adcgs_cli_leave(cli, status != ADCGS_OK ? adcgs_cli_fail(cli, error) : faults > 0);
}

int main(int argc, char **argv)
{
    settings s = {.input = NULL};
    const adcgs_option options[] = {
        {"json", 'J', ADCGS_OPTION_FLAG, &s.json, 0, 0, NULL, "print one JSON object", NULL, NULL},
        {.letter = 'j', .kind = ADCGS_OPTION_FORMER, .value = "json"},
        {"bits", 'b', ADCGS_OPTION_FLAG, &s.bits, 0, 0, NULL, "list every chunk with its bits", NULL, NULL},
        {"trace", 0, ADCGS_OPTION_FLAG, &s.trace, 0, 0, NULL, "print bit position, name and value of every syntax\nelement", NULL,
         NULL},
        {.letter = 't', .kind = ADCGS_OPTION_FORMER, .value = "trace"},
        {"digest", 'd', ADCGS_OPTION_FLAG, &s.digest, 0, 0, NULL, "print the digest of each segment's model", NULL, NULL},
        {"why", 'w', ADCGS_OPTION_FLAG, &s.why, 0, 0, NULL, "explain the size of the stream", NULL, NULL},
        {"points", 0, ADCGS_OPTION_FILE, &s.points, 0, 0, "FILE",
         "file for the anchors' positions and colours, .ply or\n.drc (Draco), instead of a report", NULL, NULL},
        {"check", 0, ADCGS_OPTION_FLAG, &s.check, 0, 0, NULL, "list all faults of a file and its usable parts", NULL, NULL},
        {"repair", 0, ADCGS_OPTION_FILE, &s.repair, 0, 0, "FILE", "like --check, and write the usable parts to this file", NULL,
         NULL},
        {"bytes", 0, ADCGS_OPTION_SIZE, &s.bytes, 1, 1e12, "N",
         "maximum size of a stream written to --output (40k); as\nmany of the finest tiers as necessary are left out", NULL,
         &s.has_bytes},
        {"output", 'o', ADCGS_OPTION_FILE, &s.output, 0, 0, "FILE", "file that --bytes writes", NULL, NULL},
    };
    static const adcgs_option_rule rules[] = {
        {"why", ADCGS_OPTION_GOES_WITH, NULL},          {"points", ADCGS_OPTION_GOES_WITH, NULL},
        {"check,repair", ADCGS_OPTION_GOES_WITH, NULL}, {"bytes", ADCGS_OPTION_NEEDS, "output"},
        {"output", ADCGS_OPTION_NEEDS, "bytes"},        {"bytes,output", ADCGS_OPTION_GOES_WITH, NULL},
    };
    const adcgs_cli cli = {.program = "adcgs-info",
                           .operands = "FILE|URL|-",
                           .summary = "Print the contents of an adcgs stream and the bytes of its parts.",
                           .options = options,
                           .n_options = ADCGS_COUNTOF(options),
                           .rules = rules,
                           .n_rules = ADCGS_COUNTOF(rules),
                           .min_operands = 1,
                           .max_operands = 1};
    adcgs_error error = {ADCGS_OK, ""};
    int first, code = adcgs_cli_parse(&cli, argc, argv, &first);
    if (code >= 0)
        return code;
    adcgs_info_report r = {.trace = 0};
    s.input = argv[first];
    r.trace = s.trace && !s.json;
    if (s.check || s.repair)
        return check(&cli, &s, &error);
    adcgs_status status = read_report(&r, &s, &error);
    if (status == ADCGS_OK)
        status = s.has_bytes ? adcgs_info_cut(&r.stream, s.bytes, s.output, &error) : print_report(&r, &s, &error);
    adcgs_stream_clear(&r.stream, NULL);
    free(r.chunks);
    if (status != ADCGS_OK)
        fflush(stdout);
    return adcgs_cli_leave(&cli, status == ADCGS_OK ? 0 : adcgs_cli_fail(&cli, &error));
}
