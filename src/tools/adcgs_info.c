/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-info: what a stream holds and where its bytes are. */
#include "config.h"

#include "base/cpu.h"
#include "base/digest.h"
#include "base/pool.h"
#include "cli/cli.h"
#include "model/model_priv.h"
#include "stream/input.h"
#include "stream/stream.h"
#include "tools/info_points.h"

#include <errno.h>
#include <stdlib.h>

typedef struct settings {
    const char *input, *points;
    int json, bits, trace, digest;
} settings;

/** A chunk as the elements of its header tell. */
typedef struct chunk {
    char type[5];
    uint64_t offset;
    unsigned segment, bytes;
} chunk;

typedef struct report {
    adcgs_stream stream;
    adcgs_info info;
    chunk *chunks;
    size_t n_chunks, capacity;
    int trace;  /**< print elements as they come */
    int failed; /**< no memory for a chunk */
} report;

/** One line of the table of components. */
typedef struct component {
    const char *name;
    uint64_t bytes;
} component;

#define COMPONENTS 10

static void list_components(const adcgs_bytes *b, component out[COMPONENTS])
{
    const component list[COMPONENTS] = {
        { "header", b->header },     { "networks", b->networks }, { "geometry", b->geometry }, { "layer0", b->layer[0] },
        { "layer1", b->layer[1] },   { "layer2", b->layer[2] },   { "layer3", b->layer[3] },   { "layer4", b->layer[4] },
        { "cameras", b->cameras },   { "metadata", b->metadata },
    };
    memcpy(out, list, sizeof list);
}

/** Text from the stream, with bytes that a terminal might obey replaced. */
static void print_safe(const char *text)
{
    for (; *text; text++)
        putchar((unsigned char)*text < 32 || *text == 127 ? '?' : *text);
}

static void add_chunk(report *r, uint64_t bit, const char *type)
{
    chunk c = { .offset = bit / 8 };
    snprintf(c.type, sizeof c.type, "%s", type);
    if (r->n_chunks == r->capacity) {
        const size_t capacity = r->capacity ? 2 * r->capacity : 64;
        chunk *chunks = realloc(r->chunks, capacity * sizeof *chunks);
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
    report *r = user;
    if (r->trace)
        printf("%llu %s %s\n", (unsigned long long)bit, element, value);
    if (strcmp(element, "chunk.type") == 0)
        add_chunk(r, bit, value);
    if (r->failed || r->n_chunks == 0)
        return;
    chunk *last = &r->chunks[r->n_chunks - 1];
    if (strcmp(element, "chunk.length") == 0)
        last->bytes = (unsigned)strtoul(value, NULL, 10);
    else if (strcmp(element, "chunk.segment") == 0)
        last->segment = (unsigned)strtoul(value, NULL, 10);
}

static adcgs_status read_report(report *r, const settings *s, adcgs_error *error)
{
    const int standard_input = strcmp(s->input, "-") == 0;
    FILE *file = standard_input ? stdin : fopen(s->input, "rb");
    adcgs_read_options options = { .layers = 0 };
    if (!file)
        return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: %s", s->input, strerror(errno));
    adcgs_status status = adcgs_cpu_resolve(ADCGS_CPU_AUTO, &options.cpu, error);
    if (status == ADCGS_OK)
        status = adcgs_pool_create(&options.pool, 0, error);
    if (status == ADCGS_OK)
        status = adcgs_stream_read(&r->stream, adcgs_file_read, file, &options, on_element, r, error);
    if (status == ADCGS_OK && r->failed)
        status = adcgs_fail(error, ADCGS_ERR_MEMORY, "no memory for the list of chunks");
    if (status == ADCGS_OK)
        adcgs_stream_info(&r->stream, &r->info);
    adcgs_pool_free(&options.pool);
    if (!standard_input)
        fclose(file);
    if (status != ADCGS_OK)
        adcgs_error_locate(error, standard_input ? "standard input" : s->input);
    return status;
}

static void print_header(const report *r, const char *name)
{
    const adcgs_info *i = &r->info;
    printf("%s: adcgs stream %d.%d, profile %d, level %d%s\n", name, i->version_major, i->version_minor, i->profile, i->level,
           i->truncated ? ", TRUNCATED" : "");
    printf("time        %g .. %g s, %d segment%s, %g frames/s\n", i->time_start, i->time_end, i->segments,
           i->segments == 1 ? "" : "s", i->frame_rate);
    printf("scene       origin %g %g %g, scale %g, axes %s, unit %s\n", i->scene_origin[0], i->scene_origin[1],
           i->scene_origin[2], i->scene_scale, i->axes, i->units);
    printf("picture     colour %s, background %g %g %g, filter %g px^2\n", i->colour, (double)i->background[0],
           (double)i->background[1], (double)i->background[2], (double)r->stream.screen_filter);
    printf("model       %u anchors (%u static), %u Gaussians of at most %d each, %u weights, %d of %d layers\n", i->anchors,
           i->static_anchors, i->gaussians, i->k, i->weights, i->layers, adcgs_params_layers(&r->stream.params));
}

static void print_components(const report *r)
{
    component list[COMPONENTS];
    list_components(&r->info.bytes, list);
    printf("\n%-12s %12s %8s %12s\n", "component", "bytes", "percent", "bits/anchor");
    for (int i = 0; i < COMPONENTS; i++)
        printf("%-12s %12llu %8.2f %12.3f\n", list[i].name, (unsigned long long)list[i].bytes,
               100.0 * (double)list[i].bytes / (double)r->info.bytes.total, 8.0 * (double)list[i].bytes / r->info.anchors);
    printf("%-12s %12llu %8.2f %12.3f\n", "total", (unsigned long long)r->info.bytes.total, 100.0,
           8.0 * (double)r->info.bytes.total / r->info.anchors);
}

static uint32_t count_gaussians(const adcgs_model *m)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < m->n; i++)
        for (unsigned bits = m->mask[i]; bits; bits &= bits - 1)
            n++;
    return n;
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

static void print_segments(const report *r)
{
    for (uint32_t i = 0; i < r->stream.n_segments; i++) {
        const adcgs_model *m = &r->stream.segments[i];
        printf("\nsegment %u: %g .. %g s, %u anchors, depth %u, voxel %g, %u Gaussians, %d layers\n", i, m->time_start,
               m->time_end, m->n, m->depth, (double)m->voxel, count_gaussians(m), m->layers);
        print_networks(m);
    }
}

static void print_extras(const report *r)
{
    if (r->stream.n_cameras > 0)
        printf("\ncameras\n");
    for (uint32_t i = 0; i < r->stream.n_cameras; i++) {
        const adcgs_camera *c = &r->stream.cameras[i];
        printf("  %u ", i);
        print_safe(c->name);
        printf(" %dx%d, focal %g %g, centre %g %g, at %g %g %g\n", (int)c->width, (int)c->height, c->fx, c->fy, c->cx, c->cy,
               c->cam_to_world[3], c->cam_to_world[7], c->cam_to_world[11]);
    }
    if (r->stream.n_meta > 0)
        printf("\nmetadata\n");
    for (uint32_t i = 0; i < r->stream.n_meta; i++) {
        printf("  ");
        print_safe(r->stream.meta[i].key);
        printf(" = ");
        print_safe(r->stream.meta[i].value);
        putchar('\n');
    }
}

static void print_chunks(const report *r)
{
    printf("\n%-6s %8s %12s %12s %12s\n", "chunk", "segment", "offset", "bits", "bits/anchor");
    for (size_t i = 0; i < r->n_chunks; i++) {
        const chunk *c = &r->chunks[i];
        printf("%-6s %8u %12llu %12llu %12.3f\n", c->type, c->segment, (unsigned long long)c->offset, 8ULL * c->bytes,
               8.0 * c->bytes / r->info.anchors);
    }
}

static void segment_digest(const report *r, uint32_t segment, char text[33])
{
    uint8_t digest[16];
    adcgs_model_digest(&r->stream.segments[segment], digest);
    adcgs_md5_hex(digest, text);
}

static void print_digests(const report *r)
{
    char text[33];
    for (uint32_t i = 0; i < r->stream.n_segments; i++) {
        segment_digest(r, i, text);
        printf("%s  segment %u\n", text, i);
    }
}

static void json_header(adcgs_json *j, const report *r)
{
    const adcgs_info *i = &r->info;
    adcgs_json_int(j, "version_major", i->version_major);
    adcgs_json_int(j, "version_minor", i->version_minor);
    adcgs_json_int(j, "profile", i->profile);
    adcgs_json_int(j, "level", i->level);
    adcgs_json_bool(j, "truncated", i->truncated);
    adcgs_json_real(j, "time_start", i->time_start);
    adcgs_json_real(j, "time_end", i->time_end);
    adcgs_json_real(j, "frame_rate", i->frame_rate);
    adcgs_json_int(j, "anchors", i->anchors);
    adcgs_json_int(j, "static_anchors", i->static_anchors);
    adcgs_json_int(j, "gaussians", i->gaussians);
    adcgs_json_int(j, "weights", i->weights);
    adcgs_json_int(j, "k", i->k);
    adcgs_json_int(j, "layers", i->layers);
    adcgs_json_real(j, "scene_scale", i->scene_scale);
    adcgs_json_open(j, "scene_origin", '[');
    for (int a = 0; a < 3; a++)
        adcgs_json_real(j, NULL, i->scene_origin[a]);
    adcgs_json_close(j, ']');
    adcgs_json_string(j, "colour", i->colour);
    adcgs_json_string(j, "axes", i->axes);
    adcgs_json_string(j, "units", i->units);
}

static void json_bytes(adcgs_json *j, const report *r)
{
    component list[COMPONENTS];
    list_components(&r->info.bytes, list);
    adcgs_json_open(j, "bytes", '{');
    for (int i = 0; i < COMPONENTS; i++)
        adcgs_json_int(j, list[i].name, (int64_t)list[i].bytes);
    adcgs_json_int(j, "total", (int64_t)r->info.bytes.total);
    adcgs_json_close(j, '}');
}

static void json_segments(adcgs_json *j, const report *r)
{
    char text[33];
    adcgs_json_open(j, "segments", '[');
    for (uint32_t i = 0; i < r->stream.n_segments; i++) {
        const adcgs_model *m = &r->stream.segments[i];
        segment_digest(r, i, text);
        adcgs_json_open(j, NULL, '{');
        adcgs_json_real(j, "time_start", m->time_start);
        adcgs_json_real(j, "time_end", m->time_end);
        adcgs_json_int(j, "anchors", m->n);
        adcgs_json_int(j, "gaussians", count_gaussians(m));
        adcgs_json_int(j, "depth", m->depth);
        adcgs_json_int(j, "layers", m->layers);
        adcgs_json_string(j, "digest", text);
        adcgs_json_open(j, "networks", '{');
        for (int role = 0; role < ADCGS_ROLES; role++)
            if (m->net[role].present)
                adcgs_json_int(j, adcgs_role_name(role), adcgs_net_weights(&m->net[role]));
        adcgs_json_close(j, '}');
        adcgs_json_close(j, '}');
    }
    adcgs_json_close(j, ']');
}

static void json_extras(adcgs_json *j, const report *r)
{
    adcgs_json_open(j, "cameras", '[');
    for (uint32_t i = 0; i < r->stream.n_cameras; i++) {
        const adcgs_camera *c = &r->stream.cameras[i];
        adcgs_json_open(j, NULL, '{');
        adcgs_json_string(j, "name", c->name);
        adcgs_json_int(j, "width", c->width);
        adcgs_json_int(j, "height", c->height);
        adcgs_json_close(j, '}');
    }
    adcgs_json_close(j, ']');
    adcgs_json_open(j, "metadata", '{');
    for (uint32_t i = 0; i < r->stream.n_meta; i++)
        adcgs_json_string(j, r->stream.meta[i].key, r->stream.meta[i].value);
    adcgs_json_close(j, '}');
}

static adcgs_status print_json(const report *r, adcgs_error *error)
{
    adcgs_json j;
    adcgs_json_init(&j, stdout);
    adcgs_json_open(&j, NULL, '{');
    json_header(&j, r);
    json_bytes(&j, r);
    json_segments(&j, r);
    json_extras(&j, r);
    adcgs_json_open(&j, "chunks", '[');
    for (size_t i = 0; i < r->n_chunks; i++) {
        adcgs_json_open(&j, NULL, '{');
        adcgs_json_string(&j, "type", r->chunks[i].type);
        adcgs_json_int(&j, "segment", r->chunks[i].segment);
        adcgs_json_int(&j, "offset", (int64_t)r->chunks[i].offset);
        adcgs_json_int(&j, "bytes", r->chunks[i].bytes);
        adcgs_json_close(&j, '}');
    }
    adcgs_json_close(&j, ']');
    adcgs_json_close(&j, '}');
    return adcgs_json_finish(&j, error);
}

static adcgs_status write_points(const report *r, const char *path, adcgs_error *error)
{
    adcgs_points points;
    ADCGS_TRY(adcgs_info_points(&points, &r->stream, path, error));
    const adcgs_status status = adcgs_points_write(&points, path, error);
    adcgs_points_free(&points);
    return status;
}

static adcgs_status print_report(const report *r, const settings *s, adcgs_error *error)
{
    if (s->points)
        return write_points(r, s->points, error);
    if (s->json)
        return print_json(r, error);
    if (s->digest)
        print_digests(r);
    if (!s->digest && !s->trace) {
        print_header(r, s->input);
        print_components(r);
        if (s->bits)
            print_chunks(r);
        print_segments(r);
        print_extras(r);
    }
    return ADCGS_OK;
}

int main(int argc, char **argv)
{
    settings s = { .input = NULL };
    const adcgs_option options[] = {
        { "json", 'j', ADCGS_OPTION_FLAG, &s.json, 0, 0, NULL, "print one JSON object", NULL, NULL },
        { "bits", 'b', ADCGS_OPTION_FLAG, &s.bits, 0, 0, NULL, "list every chunk with its bits", NULL, NULL },
        { "trace", 't', ADCGS_OPTION_FLAG, &s.trace, 0, 0, NULL,
          "print position in bits, name and value of every\nsyntax element", NULL, NULL },
        { "digest", 'd', ADCGS_OPTION_FLAG, &s.digest, 0, 0, NULL, "print the digest of each segment's model", NULL, NULL },
        { "points", 0, ADCGS_OPTION_STRING, &s.points, 0, 0, "FILE",
          "write the anchors' positions and colours, as .ply or\n.drc (Draco), instead of a report", NULL, NULL },
    };
    const adcgs_cli cli = { "adcgs-info", "FILE|-", "Says what an adcgs stream holds and where its bytes are.", NULL, options,
                            ADCGS_COUNTOF(options), 1, 1 };
    adcgs_error error = { ADCGS_OK, "" };
    int first, code = adcgs_cli_parse(&cli, argc, argv, &first);
    if (code >= 0)
        return code;
    report r = { .trace = 0 };
    s.input = argv[first];
    r.trace = s.trace && !s.json;
    if (s.points && (s.json || s.bits || s.trace || s.digest))
        return adcgs_cli_error(&cli, ADCGS_ERR_USAGE, "--points goes with no other option");
    adcgs_status status = read_report(&r, &s, &error);
    if (status == ADCGS_OK)
        status = print_report(&r, &s, &error);
    adcgs_stream_clear(&r.stream, NULL);
    free(r.chunks);
    if (status != ADCGS_OK)
        fflush(stdout);
    return adcgs_cli_leave(&cli, status == ADCGS_OK ? 0 : adcgs_cli_fail(&cli, &error));
}
