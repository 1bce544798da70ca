/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Makes the conformance vectors and their manifest: random models from seeds,
 * written by the codec's writer, some then edited chunk by chunk. What the
 * manifest expects of a good vector is what the portable kernels say on one
 * thread; what it expects of a bad one stands in the table here and is checked.
 */
#include "chunks.h"
#include "random_model.h"

#include "base/digest.h"
#include "model/model_priv.h"
#include "model/stream.h"

#include <adcgs/adcgs.h>

#include <stdio.h>
#include <stdlib.h>

/* ---- What is made ---- */

typedef struct recipe {
    const char *file, *title;
    uint64_t seed;
    adcgs_params params;
    uint32_t segments, anchors;
    int depth, level, slice_log2;
} recipe;

static const recipe recipes[] = {
    { "good-one-anchor.adcgs", "the smallest scene: one anchor with one primitive, nothing moves", 101,
      { .k = 1, .n_fv = 1, .n_fg = 0, .chunks = 1 }, 1, 1, 0, 1, 10 },
    { "good-still.adcgs", "a still scene with hyper-latents and all four chunks of f_g", 102,
      { .k = 5, .n_fv = 16, .n_fg = 8, .chunks = 4, .n_eta = 4 }, 1, 250, 6, 1, 10 },
    { "good-moving.adcgs", "a moving scene: both deformation networks, rotations, the fine one also reads f_v", 103,
      { .k = 4, .n_fv = 12, .n_fg = 4, .chunks = 2, .n_eta = 2, .octaves = 4, .fine_uses_fv = 1, .coarse_rotation = 1,
        .time_rows = 6, .time_width = 5 }, 1, 200, 7, 1, 10 },
    { "good-segments.adcgs", "three time segments, the second with the networks of the first, and an index", 104,
      { .k = 3, .n_fv = 8, .n_fg = 2, .chunks = 1, .n_eta = 1, .octaves = 2, .time_rows = 3, .time_width = 4 }, 3, 60, 6, 1, 10 },
    { "good-slices.adcgs", "several slices per layer", 105,
      { .k = 2, .n_fv = 6, .n_fg = 2, .chunks = 2, .n_eta = 8 }, 1, 400, 8, 1, 6 },
    { "good-k16.adcgs", "sixteen primitives per anchor, one row of time embeddings", 106,
      { .k = 16, .n_fv = 10, .n_fg = 2, .chunks = 1, .octaves = 10, .coarse_rotation = 1, .time_rows = 1, .time_width = 1 },
      1, 40, 5, 1, 10 },
    { "good-wide.adcgs", "the widest features: 64 channels of f_v, 32 of f_g", 107,
      { .k = 2, .n_fv = 64, .n_fg = 32, .chunks = 4, .n_eta = 3 }, 1, 50, 10, 1, 10 },
    { "good-deep.adcgs", "the finest grid, level 3", 108,
      { .k = 3, .n_fv = 8, .n_fg = 4, .chunks = 2, .octaves = 1, .time_rows = 12, .time_width = 2 }, 1, 80, 21, 3, 10 },
};

typedef enum edit {
    EDIT_BYTE,    /* change one byte of the file, nothing else */
    EDIT_CUT,     /* leave so many per mille of the file */
    EDIT_PAYLOAD, /* set a byte of a chunk's payload and make all checksums right */
    EDIT_INSERT,  /* insert a chunk before the chunk */
    EDIT_SWAP     /* exchange the chunk with the one after it */
} edit;

typedef struct variant {
    const char *file, *title;
    const char *of;     /* the vector it is made from */
    edit what;
    const char *chunk;  /* type of the chunk that is edited */
    int at, value;      /* place and new value of a byte; EDIT_BYTE: value is XORed */
    const char *type;   /* of the chunk to insert */
    const char *status; /* "" for a good one */
} variant;

static const variant variants[] = {
    { "good-ancillary.adcgs", "an unknown ancillary chunk, to be skipped",
      "good-still.adcgs", EDIT_INSERT, "SEGM", 0, 0, "note", "" },
    { "bad-signature.adcgs", "text-mode transfer has damaged the signature",
      "good-one-anchor.adcgs", EDIT_BYTE, NULL, 4, 0x07, NULL, "data" },
    { "bad-chunk-header.adcgs", "a flipped bit in a chunk's header",
      "good-one-anchor.adcgs", EDIT_BYTE, NULL, 12, 0x01, NULL, "data" },
    { "bad-chunk-payload.adcgs", "a flipped bit in a chunk's payload",
      "good-one-anchor.adcgs", EDIT_BYTE, NULL, 30, 0x10, NULL, "data" },
    { "bad-empty.adcgs", "no byte at all",
      "good-one-anchor.adcgs", EDIT_CUT, NULL, 0, 0, NULL, "truncated" },
    { "bad-cut.adcgs", "the last third is missing",
      "good-moving.adcgs", EDIT_CUT, NULL, 667, 0, NULL, "truncated" },
    { "bad-version.adcgs", "a later major version",
      "good-one-anchor.adcgs", EDIT_PAYLOAD, "HEAD", 0, 99, NULL, "unsupported" },
    { "bad-profile.adcgs", "an unknown profile",
      "good-one-anchor.adcgs", EDIT_PAYLOAD, "HEAD", 4, 7, NULL, "unsupported" },
    { "bad-arith.adcgs", "the reserved arithmetic of the entropy networks",
      "good-one-anchor.adcgs", EDIT_PAYLOAD, "HEAD", 6, 1, NULL, "unsupported" },
    { "bad-critical.adcgs", "an unknown critical chunk",
      "good-one-anchor.adcgs", EDIT_INSERT, "SEGM", 0, 0, "XTRA", "unsupported" },
    { "bad-level.adcgs", "a grid finer than its level allows",
      "good-deep.adcgs", EDIT_PAYLOAD, "HEAD", 5, 1, NULL, "limit" },
    { "bad-order.adcgs", "features before positions",
      "good-one-anchor.adcgs", EDIT_SWAP, "GEOM", 0, 0, NULL, "data" },
    { "bad-digest.adcgs", "a model digest that is not the model's",
      "good-still.adcgs", EDIT_PAYLOAD, "hash", 3, 0x5a, NULL, "data" },
};

/* ---- Expectations ---- */

static const adcgs_camera cameras[] = {
    { .width = 48, .height = 32, .fx = 40, .fy = 40, .cx = 24, .cy = 16, .near_plane = 0.01,
      .cam_to_world = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -3 }, .name = "front" },
    { .width = 35, .height = 27, .fx = 30.5, .fy = 29.25, .cx = 15.25, .cy = 14.75, .near_plane = 0.25,
      .cam_to_world = { 0, 0, -1, 2, 0, 1, 0, 0.125, 1, 0, 0, -0.25 }, .name = "side" },
};
static const double times[] = { 0.0, 0.0137, 0.05, 1e9 };

static void hex_of(const void *data, size_t bytes, char hex[33])
{
    adcgs_md5 md5;
    uint8_t digest[16];
    adcgs_md5_init(&md5);
    adcgs_md5_update(&md5, data, bytes);
    adcgs_md5_final(&md5, digest);
    adcgs_md5_hex(digest, hex);
}

static adcgs_status open_vector(adcgs_decoder **decoder, const adcgs_buffer *file, adcgs_error *error)
{
    adcgs_config config;
    adcgs_config_init(&config);
    config.threads = 1;
    config.cpu = ADCGS_CPU_SCALAR;
    config.strict_end = 1;
    return adcgs_open_memory(decoder, file->data, file->size, &config, error);
}

static void print_cameras(FILE *out)
{
    fprintf(out, ",\n      \"cameras\": [");
    for (size_t i = 0; i < ADCGS_COUNTOF(cameras); i++) {
        const adcgs_camera *const c = &cameras[i];
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

static adcgs_status print_frame(FILE *out, adcgs_decoder *decoder, int camera, double time, const char *separator,
                                adcgs_error *error)
{
    static float rgb[3 * 64 * 64];
    static uint8_t bytes[sizeof rgb];
    char hex[33];
    const adcgs_camera *const c = &cameras[camera];
    const size_t n = 3 * (size_t)c->width * (size_t)c->height;
    adcgs_frame frame = { .width = c->width, .height = c->height, .rgb = rgb };
    ADCGS_TRY(adcgs_render(decoder, c, time, &frame, error));
    for (size_t i = 0; i < n; i++)
        adcgs_store_le32(bytes + 4 * i, adcgs_float_bits(rgb[i]));
    hex_of(bytes, 4 * n, hex);
    fprintf(out, "%s\n        { \"camera\": %d, \"time\": %.17g, \"md5\": \"%s\" }", separator, camera, time, hex);
    return ADCGS_OK;
}

static adcgs_status print_good(FILE *out, adcgs_decoder *decoder, adcgs_error *error)
{
    adcgs_info info;
    ADCGS_TRY(adcgs_get_info(decoder, &info));
    fprintf(out, ",\n      \"models\": [");
    for (int i = 0; i < info.segments; i++) {
        uint8_t digest[16];
        char hex[33];
        ADCGS_TRY(adcgs_get_model_digest(decoder, i, digest));
        adcgs_md5_hex(digest, hex);
        fprintf(out, "%s\"%s\"", i ? ", " : "", hex);
    }
    fprintf(out, "]");
    print_cameras(out);
    fprintf(out, ",\n      \"frames\": [");
    int printed = 0;
    for (size_t t = 0; t < ADCGS_COUNTOF(times); t++)
        for (size_t c = 0; c < ADCGS_COUNTOF(cameras); c++)
            if (t == 0 || info.time_end > info.time_start)
                ADCGS_TRY(print_frame(out, decoder, (int)c, times[t], printed++ ? "," : "", error));
    fprintf(out, " ]");
    return ADCGS_OK;
}

static const char *class_of(adcgs_status status)
{
    return status == ADCGS_ERR_DATA ? "data" : status == ADCGS_ERR_TRUNCATED ? "truncated" :
           status == ADCGS_ERR_UNSUPPORTED ? "unsupported" : status == ADCGS_ERR_LIMIT ? "limit" : "";
}

/* ---- Files ---- */

typedef struct maker {
    const char *directory;
    FILE *manifest;
    int n;
} maker;

static adcgs_status write_file(const maker *m, const char *name, const adcgs_buffer *file, adcgs_error *error)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/vectors/%s", m->directory, name);
    FILE *const out = fopen(path, "wb");
    const int good = out && fwrite(file->data, 1, file->size, out) == file->size;
    if (!out || fclose(out) != 0 || !good)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write", path);
    return ADCGS_OK;
}

/* Write a vector and its entry; status: "" or how decoding has to end. */
static adcgs_status finish(maker *m, const char *name, const char *title, const char *status, const adcgs_buffer *file,
                           adcgs_error *error)
{
    char hex[33];
    adcgs_decoder *decoder = NULL;
    adcgs_error why = { ADCGS_OK, "" };
    const adcgs_status opened = open_vector(&decoder, file, &why);
    if (strcmp(class_of(opened), status) || (opened != ADCGS_OK && !*status)) {
        adcgs_close(&decoder);
        return adcgs_fail(error, ADCGS_ERR_INTERNAL, "%s: decoding ends with \"%s\" (%.120s), expected \"%s\"", name,
                          adcgs_status_name(opened), why.text, status);
    }
    hex_of(file->data, file->size, hex);
    fprintf(m->manifest, "%s\n    { \"file\": \"vectors/%s\", \"md5\": \"%s\",\n", m->n++ ? "," : "", name, hex);
    fprintf(m->manifest, "      \"title\": \"%s\",\n      \"verdict\": \"%s\"", title, *status ? "bad" : "good");
    adcgs_status result = ADCGS_OK;
    if (*status)
        fprintf(m->manifest, ", \"status\": \"%s\"", status);
    else
        result = print_good(m->manifest, decoder, error);
    fprintf(m->manifest, " }");
    adcgs_close(&decoder);
    return result == ADCGS_OK ? write_file(m, name, file, error) : result;
}

/* ---- Random models that show something ---- */

typedef struct painter {
    const adcgs_model *model;
    uint64_t state;
} painter;

/* Scales and colours near what a picture needs, as far as the coder lets them be; features and hyper-latents small and random. */
static void paint_site(void *user, const adcgs_latent_site *site)
{
    painter *const p = user;
    for (int c = 0; c < site->count; c++) {
        const int channel = site->first + c;
        int32_t n = site->si[c] > 0 ? (int32_t)adcgs_random_range(&p->state, -2, 2) : 0;
        if (site->group == ADCGS_GROUP_SIGMA || site->group == ADCGS_GROUP_COLOUR) {
            const int sigma = site->group == ADCGS_GROUP_SIGMA;
            const double step = 64.0 * (sigma ? p->model->d_sigma[channel] : p->model->d_colour[channel]);
            const double wanted = (double)adcgs_random_range(&p->state, 0, 1000) / 1000.0 - (sigma ? 3.5 : 0.0);
            n = site->si[c] > 0 ? (int32_t)(wanted / step - site->mu[c] / 64.0) : 0;
        }
        site->yq[c] = (int16_t)adcgs_clip(64 * n + site->mu[c], 32767);
    }
}

static adcgs_status paint(adcgs_model *m, uint64_t seed, adcgs_error *error)
{
    painter p = { .model = m, .state = seed };
    adcgs_latents *latents = NULL;
    for (int c = 0; c < m->params.n_fv; c++)
        m->d_fv[c] *= 0.0625f;
    for (int c = 0; c < m->params.n_fg; c++)
        m->d_fg[c] *= 0.0625f;
    for (int c = 0; c < ADCGS_SIGMA_N; c++)
        m->d_sigma[c] = 0x1p-10f + 0x1p-14f * (float)c;
    for (int c = 0; c < ADCGS_COLOUR_N; c++)
        m->d_colour[c] = 0x1p-11f;
    adcgs_status status = adcgs_latents_create(&latents, m, ADCGS_CPU_SCALAR, NULL, error);
    for (int layer = 0; layer < adcgs_params_layers(&m->params) && status == ADCGS_OK; layer++)
        status = adcgs_latents_walk(latents, m, layer, 0, m->n, paint_site, &p);
    adcgs_latents_free(&latents);
    return status;
}

static adcgs_status build(const recipe *r, adcgs_buffer *out, adcgs_error *error)
{
    adcgs_stream stream;
    uint64_t state = r->seed;
    adcgs_status status = adcgs_random_stream(&stream, &r->params, r->segments, r->anchors, r->depth, &state, error);
    stream.level = (uint8_t)r->level;
    stream.slice_log2 = (uint8_t)r->slice_log2;
    stream.background[0] = 0.25f;
    stream.background[2] = 0.5f;
    for (uint32_t i = 0; i < stream.n_segments && status == ADCGS_OK; i++)
        status = paint(&stream.segments[i], r->seed + 1000 * (i + 1), error);
    if (status == ADCGS_OK)
        status = adcgs_stream_write(&stream, out, error);
    adcgs_stream_clear(&stream, NULL);
    return status;
}

static adcgs_status edit_chunks(const variant *v, adcgs_buffer *file, adcgs_error *error)
{
    adcgs_chunk_list list = { .n = 0 };
    adcgs_status status = adcgs_chunk_list_read(&list, file->data, file->size, error);
    const int i = adcgs_chunk_list_find(&list, v->chunk);
    if (status == ADCGS_OK && (i < 0 || (size_t)v->at >= list.chunk[i].payload.size || i + 1 >= list.n))
        status = adcgs_fail(error, ADCGS_ERR_INTERNAL, "%s: nothing to edit in %s", v->file, v->chunk);
    if (status == ADCGS_OK && v->what == EDIT_INSERT)
        status = adcgs_chunk_list_insert(&list, i, v->type, "any bytes", error);
    else if (status == ADCGS_OK && v->what == EDIT_PAYLOAD)
        list.chunk[i].payload.data[v->at] = (uint8_t)v->value;
    else if (status == ADCGS_OK) {
        const adcgs_raw_chunk keep = list.chunk[i];
        list.chunk[i] = list.chunk[i + 1];
        list.chunk[i + 1] = keep;
    }
    file->size = 0;
    if (status == ADCGS_OK)
        adcgs_chunk_list_write(&list, file);
    adcgs_chunk_list_clear(&list);
    return status;
}

static adcgs_status apply(const variant *v, adcgs_buffer *file, adcgs_error *error)
{
    switch (v->what) {
    case EDIT_BYTE:
        file->data[v->at] = (uint8_t)(file->data[v->at] ^ v->value);
        return ADCGS_OK;
    case EDIT_CUT:
        file->size = file->size * (size_t)v->at / 1000;
        return ADCGS_OK;
    default:
        return edit_chunks(v, file, error);
    }
}

static const recipe *recipe_of(const char *name)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(recipes); i++)
        if (!strcmp(recipes[i].file, name))
            return &recipes[i];
    return NULL;
}

static adcgs_status make_all(maker *m, adcgs_error *error)
{
    adcgs_buffer file;
    adcgs_status status = ADCGS_OK;
    adcgs_buffer_init(&file);
    for (size_t i = 0; i < ADCGS_COUNTOF(recipes) && status == ADCGS_OK; i++) {
        file.size = 0;
        status = build(&recipes[i], &file, error);
        if (status == ADCGS_OK)
            status = finish(m, recipes[i].file, recipes[i].title, "", &file, error);
    }
    for (size_t i = 0; i < ADCGS_COUNTOF(variants) && status == ADCGS_OK; i++) {
        const variant *const v = &variants[i];
        file.size = 0;
        status = build(recipe_of(v->of), &file, error);
        if (status == ADCGS_OK)
            status = apply(v, &file, error);
        if (status == ADCGS_OK)
            status = finish(m, v->file, v->title, v->status, &file, error);
    }
    adcgs_buffer_clear(&file);
    return status;
}

int main(int argc, char **argv)
{
    char path[4096];
    adcgs_error error;
    if (argc != 2) {
        fprintf(stderr, "usage: make_vectors DIR (which holds a folder named vectors)\n");
        return 2;
    }
    maker m = { .directory = argv[1] };
    snprintf(path, sizeof path, "%s/manifest.json", m.directory);
    m.manifest = fopen(path, "w");
    if (!m.manifest) {
        fprintf(stderr, "make_vectors: %s: cannot write\n", path);
        return 3;
    }
    fprintf(m.manifest, "{ \"format\": 1,\n  \"vectors\": [");
    adcgs_status status = make_all(&m, &error);
    fprintf(m.manifest, " ] }\n");
    if (fclose(m.manifest) != 0 && status == ADCGS_OK)
        status = adcgs_fail(&error, ADCGS_ERR_IO, "%s: cannot write", path);
    if (status != ADCGS_OK)
        fprintf(stderr, "make_vectors: %s\n", error.text);
    return status == ADCGS_OK ? 0 : 1;
}
