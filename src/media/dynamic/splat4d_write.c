/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writes .splat4d: finds the attributes that change and the order of the splats, and writes the header. */
#include "config.h"

#include "media/dynamic/splat4d_pack.h"

#ifdef HAVE_SPZ

#include "geom/geom.h"
#include "system/atomic.h"
#include "system/json.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: definition (.splat4d's code and FORMAT.md). */
#define FILE_HEADER 12     /* bytes before the JSON text */
#define GROUP 10           /* frames of a group by default, as the format's own encoder writes */
#define CURVE_BITS 16      /* of a coordinate on the Morton curve; chosen by hand, not measured */
#define JSON_BYTES 4096    /* of the header without its groups of frames, at most; arithmetic */
#define JSON_PER_GROUP 256 /* bytes of a group of frames in the header, at most; arithmetic: six numbers and their names */

typedef adcgs_splat4d_writer writer;

/* ---- Order ---- */

/** The first quaternion of a splat gets w >= 0, the others the sign that is nearer to the one before. */
static void find_signs(writer *w)
{
    for (uint32_t f = 0; f < w->clip->n_frames; f++)
        for (uint32_t i = 0; i < w->n; i++) {
            const adcgs_splats *const s = &w->clip->frames[f], *const before = s - (f > 0);
            double dot = f ? 0.0 : (double)s->rotation[0][i];
            for (int a = 0; a < 4 && f; a++)
                dot += (double)s->rotation[a][i] * (double)before->rotation[a][i];
            const int turned = dot < 0.0 ? -1 : 1, last = f ? w->sign[(size_t)(f - 1) * w->n + i] : 1;
            w->sign[(size_t)f * w->n + i] = (int8_t)(turned * last);
        }
}

/** Splats whose attribute leaves the first frame's value by more than half a step. */
static void find_masks(writer *w)
{
    for (uint32_t i = 0; i < w->n; i++) {
        for (int a = 0; a < ADCGS_SPLAT4D_ATTRIBUTES; a++) {
            int moves = 0;
            for (int c = 0; c < adcgs_splat4d_channels[a] && !moves; c++) {
                const double first = adcgs_splat4d_value(w, a, 0, i, c);
                for (uint32_t f = 1; f < w->clip->n_frames && !moves; f++)
                    moves = !(fabs(adcgs_splat4d_value(w, a, f, i, c) - first) <= 0.5 * w->step[a]);
            }
            w->mask[i] |= (uint8_t)(moves << a);
            w->moving[a] += (uint32_t)moves;
        }
        w->in_mask[w->mask[i]]++;
    }
}

typedef struct place {
    uint64_t key;
    uint32_t splat;
} place;

static int compare(const void *a, const void *b)
{
    const place *const x = a, *const y = b;
    return x->key != y->key ? (x->key < y->key ? -1 : 1) : (x->splat > y->splat) - (x->splat < y->splat);
}

/** Sort by masks, then along the curve. \return 0 on allocation failure */
static int find_order(writer *w)
{
    const adcgs_splats *const s = w->clip->frames;
    place *const places = malloc(w->n * sizeof *places);
    for (uint32_t i = 0; i < w->n && places; i++) {
        uint32_t voxel[3];
        for (int a = 0; a < 3; a++)
            voxel[a] =
                (uint32_t)(((1 << CURVE_BITS) - 1) * ((double)s->mean[a][i] - w->low[a]) / fmax(w->high[a] - w->low[a], 1e-300));
        places[i] = (place){(uint64_t)w->mask[i] << (3 * CURVE_BITS) | adcgs_morton(voxel), i};
    }
    if (places)
        qsort(places, w->n, sizeof *places, compare);
    for (uint32_t i = 0; i < w->n && places; i++)
        w->order[i] = places[i].splat;
    free(places);
    return places != NULL;
}

/* ---- The header ---- */

static void write_steps(adcgs_json *json, const writer *w)
{
    adcgs_json_open(json, "bounds", '{');
    adcgs_json_real(json, "pos_m", 0.5 * w->step[ADCGS_SPLAT4D_MEAN]);
    adcgs_json_real(json, "scale_rel", exp(0.5 * w->step[ADCGS_SPLAT4D_SCALE]) - 1.0);
    adcgs_json_real(json, "rgb", 0.5 * w->step[ADCGS_SPLAT4D_COLOUR]);
    adcgs_json_real(json, "alpha", 0.5 * w->step[ADCGS_SPLAT4D_OPACITY]);
    adcgs_json_real(json, "rot", 0.5 * w->step[ADCGS_SPLAT4D_ROTATION]);
    adcgs_json_close(json);
    adcgs_json_open(json, "steps", '{');
    adcgs_json_real(json, "pos", w->step[ADCGS_SPLAT4D_MEAN]);
    adcgs_json_real(json, "scale_log", w->step[ADCGS_SPLAT4D_SCALE]);
    adcgs_json_real(json, "rgb", w->step[ADCGS_SPLAT4D_COLOUR]);
    adcgs_json_real(json, "alpha", w->step[ADCGS_SPLAT4D_OPACITY]);
    adcgs_json_real(json, "rot", w->step[ADCGS_SPLAT4D_ROTATION]);
    adcgs_json_real(json, "base_pos", w->step[ADCGS_SPLAT4D_MEAN]);
    adcgs_json_real(json, "base_scale_log", w->step[ADCGS_SPLAT4D_SCALE]);
    adcgs_json_close(json);
}

/** Numbers of splats whose attributes change, and bounds of all positions. */
static void write_splats(adcgs_json *json, const writer *w)
{
    static const char *const names[ADCGS_SPLAT4D_ATTRIBUTES] = {"pos", "rot", "rgb", "alpha", "scale"};
    adcgs_json_open(json, "dyn", '{');
    for (int a = 0; a < ADCGS_SPLAT4D_ATTRIBUTES; a++)
        adcgs_json_int(json, names[a], w->moving[a]);
    adcgs_json_close(json);
    adcgs_json_open(json, "groups", '[');
    for (int m = 0; m < ADCGS_SPLAT4D_MASKS; m++)
        if (w->in_mask[m]) {
            adcgs_json_open(json, NULL, '{');
            adcgs_json_int(json, "mask", m);
            adcgs_json_int(json, "count", w->in_mask[m]);
            adcgs_json_close(json);
        }
    adcgs_json_close(json);
    adcgs_json_open(json, "aabb", '[');
    for (int k = 0; k < 6; k++)
        adcgs_json_real(json, NULL, k < 3 ? w->low[k] : w->high[k - 3]);
    adcgs_json_close(json);
}

static void write_place(adcgs_json *json, const writer *w, size_t k, uint64_t begin)
{
    adcgs_json_int(json, "offset", (int64_t)(begin + w->place[k]));
    adcgs_json_int(json, "len", (int64_t)(w->place[k + 1] - w->place[k]));
}

/** begin: of the body in the file. */
static adcgs_status write_json(FILE *file, const writer *w, uint64_t begin)
{
    adcgs_json json;
    adcgs_json_init(&json);
    json.is_line = 1;
    json.digits = 17;
    adcgs_json_open(&json, NULL, '{');
    adcgs_json_int(&json, "n", w->n);
    adcgs_json_int(&json, "t", w->clip->n_frames);
    adcgs_json_real(&json, "fps", w->clip->fps);
    adcgs_json_int(&json, "gop", w->group);
    write_steps(&json, w);
    write_splats(&json, w);
    adcgs_json_bool(&json, "denoised", 0);
    adcgs_json_open(&json, "static_section", '{');
    write_place(&json, w, 0, begin);
    adcgs_json_close(&json);
    adcgs_json_open(&json, "gops", '[');
    for (uint32_t first = 0, k = 1; first < w->clip->n_frames; first += w->group, k++) {
        const uint32_t last = ADCGS_MIN(first + w->group, w->clip->n_frames) - 1;
        adcgs_json_open(&json, NULL, '{');
        write_place(&json, w, k, begin);
        adcgs_json_int(&json, "f0", first);
        adcgs_json_int(&json, "f1", last);
        adcgs_json_real(&json, "t0", first / w->clip->fps);
        adcgs_json_real(&json, "t1", last / w->clip->fps);
        adcgs_json_close(&json);
    }
    adcgs_json_close(&json);
    adcgs_json_close(&json);
    return adcgs_json_write(&json, file, w->path, w->error);
}

/** The offsets in the JSON text depend on its length, so it is padded with blanks to one that is known before. */
static adcgs_status write_header(FILE *file, const writer *w, uint32_t groups)
{
    const size_t length = JSON_BYTES + (size_t)JSON_PER_GROUP * groups;
    uint8_t fixed[FILE_HEADER] = {'S', 'P', '4', 'D', 1};
    char *text = NULL;
    size_t bytes = 0;
    FILE *const memory = open_memstream(&text, &bytes);
    if (!memory)
        return adcgs_fail(w->error, ADCGS_ERR_MEMORY, "%s: out of memory", w->path);
    adcgs_status status = write_json(memory, w, FILE_HEADER + length);
    if (fclose(memory) && status == ADCGS_OK)
        status = adcgs_fail(w->error, ADCGS_ERR_MEMORY, "%s: out of memory", w->path);
    if (status == ADCGS_OK && bytes > length)
        status = adcgs_fail(w->error, ADCGS_ERR_UNSUPPORTED, "%s: a header of %zu bytes, expected at most %zu", w->path, bytes,
                            length);
    adcgs_store_le32(fixed + 8, (uint32_t)length);
    if (status == ADCGS_OK) {
        fwrite(fixed, sizeof fixed, 1, file);
        fprintf(file, "%-*s", (int)length, text);
    }
    free(text);
    return status;
}

/* ---- The file ---- */

/** Memory for all tables; the caller finds missing ones. */
static int make_tables(writer *w, uint32_t groups)
{
    w->sign = malloc((size_t)w->clip->n_frames * w->n);
    w->mask = calloc(w->n, 1);
    w->order = malloc(w->n * sizeof *w->order);
    w->place = calloc((size_t)groups + 2, sizeof *w->place);
    return w->sign && w->mask && w->order && w->place;
}

/** Room for the symbols of the largest stream. */
static int make_room(writer *w)
{
    size_t most = (size_t)4 * w->n;
    for (int a = 0; a < ADCGS_SPLAT4D_ATTRIBUTES; a++)
        most = ADCGS_MAX(most, (size_t)w->moving[a] * (size_t)adcgs_splat4d_channels[a] * w->group);
    w->symbols = malloc(most * sizeof *w->symbols);
    w->planes = malloc(most * sizeof *w->symbols);
    return w->symbols && w->planes;
}

static adcgs_status make_file(writer *w, uint32_t groups)
{
    char *body = NULL;
    size_t bytes = 0;
    adcgs_atomic atomic;
    if (!make_tables(w, groups))
        return adcgs_fail(w->error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", w->path, w->n);
    find_signs(w);
    find_masks(w);
    w->body = find_order(w) && make_room(w) ? open_memstream(&body, &bytes) : NULL;
    if (!w->body)
        return adcgs_fail(w->error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", w->path, w->n);
    adcgs_status status = adcgs_splat4d_body(w);
    if (fclose(w->body) && status == ADCGS_OK)
        status = adcgs_fail(w->error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", w->path, w->n);
    if (status == ADCGS_OK)
        status = adcgs_atomic_open(&atomic, w->path, w->error);
    if (status == ADCGS_OK) {
        status = write_header(atomic.file, w, groups);
        fwrite(body, bytes, 1, atomic.file);
        if (status == ADCGS_OK)
            status = adcgs_atomic_commit(&atomic, w->error);
        else
            adcgs_atomic_abort(&atomic);
    }
    free(body);
    return status;
}

adcgs_status adcgs_splat4d_write(const adcgs_splat_clip *clip, const char *path, adcgs_error *error)
{
    writer w = {.clip = clip, .path = path, .error = error, .group = clip->group ? clip->group : GROUP};
    ADCGS_TRY(adcgs_splat_clip_check(clip, &w.step[ADCGS_SPLAT4D_MEAN], w.low, w.high, path, error));
    w.n = clip->frames->n;
    w.step[ADCGS_SPLAT4D_ROTATION] = ADCGS_SPLAT4D_STEP_ROTATION;
    w.step[ADCGS_SPLAT4D_COLOUR] = w.step[ADCGS_SPLAT4D_OPACITY] = ADCGS_SPLAT4D_STEP_LEVEL;
    w.step[ADCGS_SPLAT4D_SCALE] = ADCGS_SPLAT4D_STEP_SCALE;
    const adcgs_status status = make_file(&w, (clip->n_frames + w.group - 1) / w.group);
    free(w.sign);
    free(w.mask);
    free(w.order);
    free(w.place);
    free(w.symbols);
    free(w.planes);
    return status;
}

#else

adcgs_status adcgs_splat4d_write(const adcgs_splat_clip *clip, const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build has no .splat4d: it needs zlib and zstd", path);
}

#endif
