/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writes .4dgs of the model keyframe-delta: all splats in the first frame of each group, then their changes. */
#include "config.h"

#include "media/dynamic/fourdgs_pack.h"

#ifdef HAVE_SPZ

#include "system/atomic.h"

#include <math.h>
#include <stdlib.h>
#include <zlib.h>

/* Origin, unless a line states one: definition (the specification of .4dgs). */
/* Opcodes of records. */
enum { HEADER = 1, FOOTER, QUANTIZATION, WINDOWS, CHUNK, INDEX = 8, DELTA = 0x10 };
#define MAGIC \
    "\x89"    \
    "4DGS1\r\n"         /* both ends of a file */
#define MAGIC_BYTES 8   /* of it */
#define FRAME 9         /* bytes of a record before its content */
#define CUTOFF 0.05     /* weight below which splats are invisible; those that never fade do not use it */
#define BY_DIFFERENCE 1 /* mode of changes: to the frame before */
#define GROUP 10u       /* frames of a group by default; chosen by hand, not measured */
#define INDEX_BYTES 68  /* of an entry of the index */

typedef adcgs_fourdgs_writer writer;

/** A chunk, for the index. */
typedef struct entry {
    uint64_t offset, length, reference, keyframe;
    uint32_t n, depth;
} entry;

/* ---- Bytes ---- */

/** Contents are made in memory, since their lengths precede them. */
typedef struct content {
    FILE *file; /**< NULL after an allocation failure */
    char *bytes;
    size_t n;
} content;

static int begin(content *c)
{
    *c = (content){.bytes = NULL};
    c->file = open_memstream(&c->bytes, &c->n);
    return c->file != NULL;
}

/** Finish the content; its bytes are valid until end(). */
static int finish(writer *w, content *c)
{
    const int bad = ferror(c->file);
    if (fclose(c->file) || bad || !c->bytes)
        w->failed = 1;
    return !w->failed;
}

/** Write the content as a record, and free it. */
static void end_record(writer *w, content *c, int opcode)
{
    if (finish(w, c)) {
        adcgs_put_u(w->file, (uint64_t)opcode, 1);
        adcgs_put_u(w->file, c->n, 8);
        fwrite(c->bytes, c->n, 1, w->file);
        w->at += FRAME + c->n;
    }
    free(c->bytes);
}

/* ---- Chunks ---- */

/** The streams as an unpacked block behind its sizes; changes: three groups, of which births and deaths are empty. */
static void put_block(FILE *to, writer *w, uint32_t n, int is_delta)
{
    content block;
    if (!begin(&block)) {
        w->failed = 1;
        return;
    }
    if (n)
        adcgs_fourdgs_put_splats(block.file, w, n, is_delta);
    if (finish(w, &block)) {
        const uint64_t bytes = block.n + (is_delta ? 24 : 0);
        adcgs_put_string(to, "");
        adcgs_put_u(to, bytes, 8);
        adcgs_put_u(to, bytes, 8);
        if (is_delta)
            adcgs_put_u(to, block.n, 8);
        fwrite(block.bytes, block.n, 1, to);
        if (is_delta)
            adcgs_put_u(to, 0, 8), adcgs_put_u(to, 0, 8);
    }
    free(block.bytes);
}

/** before: the chunk of the frame before. */
static void put_chunk(writer *w, entry *e, const entry *before, uint32_t frame)
{
    content c;
    const int is_delta = e->depth > 0;
    *e = (entry){.offset = w->at,
                 .keyframe = is_delta ? before->keyframe : w->at,
                 .reference = is_delta ? before->offset : 0,
                 .depth = e->depth,
                 .n = adcgs_fourdgs_next_rows(w, frame, is_delta)};
    if (!begin(&c)) {
        w->failed = 1;
        return;
    }
    adcgs_put_f64(c.file, frame / w->clip->fps);
    adcgs_put_f64(c.file, (frame + 1) / w->clip->fps);
    adcgs_put_u(c.file, 0, 4); /* level of detail */
    if (is_delta) {
        adcgs_put_u(c.file, BY_DIFFERENCE, 1);
        adcgs_put_u(c.file, e->reference, 8);
        adcgs_put_u(c.file, e->keyframe, 8);
        adcgs_put_u(c.file, e->depth, 2);
    }
    adcgs_put_u(c.file, e->n, 4);
    if (is_delta)
        adcgs_put_u(c.file, 0, 4), adcgs_put_u(c.file, 0, 4); /* births, deaths */
    put_block(c.file, w, e->n, is_delta);
    end_record(w, &c, is_delta ? DELTA : CHUNK);
    e->length = w->at - e->offset;
}

static void put_entry(FILE *to, const writer *w, const entry *e, uint32_t frame)
{
    adcgs_put_u(to, INDEX, 1);
    adcgs_put_u(to, INDEX_BYTES, 8);
    adcgs_put_f64(to, frame / w->clip->fps);
    adcgs_put_f64(to, (frame + 1) / w->clip->fps);
    adcgs_put_u(to, e->offset, 8);
    adcgs_put_u(to, e->length, 8);
    adcgs_put_u(to, e->n, 4);
    adcgs_put_u(to, 0, 4); /* bands of harmonics */
    adcgs_put_u(to, e->depth > 0, 1);
    adcgs_put_u(to, e->depth ? BY_DIFFERENCE : 0, 1);
    adcgs_put_u(to, e->reference, 8);
    adcgs_put_u(to, e->keyframe, 8);
    adcgs_put_u(to, e->depth, 2);
    adcgs_put_u(to, w->n, 8); /* splats of its state */
}

/** The index, then the footer, which states the place and the checksum of it. */
static void put_end(writer *w, const entry *entries)
{
    content index;
    const uint64_t place = w->at;
    uint32_t crc = 0;
    if (!begin(&index)) {
        w->failed = 1;
        return;
    }
    for (uint32_t f = 0; f < w->clip->n_frames; f++)
        put_entry(index.file, w, &entries[f], f);
    if (finish(w, &index)) {
        fwrite(index.bytes, index.n, 1, w->file);
        crc = (uint32_t)crc32_z(0, (const Bytef *)index.bytes, index.n);
    }
    free(index.bytes);
    adcgs_put_u(w->file, FOOTER, 1);
    adcgs_put_u(w->file, 20, 8);
    adcgs_put_u(w->file, place, 8);
    adcgs_put_u(w->file, 0, 8); /* no table of kinds of records */
    adcgs_put_u(w->file, crc, 4);
    fwrite(MAGIC, MAGIC_BYTES, 1, w->file);
}

/* ---- The file ---- */

static void put_header(writer *w)
{
    const double *const offset = w->clip->frames->offset;
    content c;
    fwrite(MAGIC, MAGIC_BYTES, 1, w->file);
    w->at = MAGIC_BYTES;
    if (!begin(&c)) {
        w->failed = 1;
        return;
    }
    adcgs_put_string(c.file, "default");
    adcgs_put_string(c.file, "adcgs " PACKAGE_VERSION);
    adcgs_put_f64(c.file, w->clip->n_frames / w->clip->fps);
    adcgs_put_u(c.file, w->n, 8);
    adcgs_put_f64(c.file, CUTOFF);
    adcgs_put_string(c.file, "keyframe-delta");
    for (int k = 0; k < 6; k++)
        adcgs_put_f64(c.file, offset[k % 3] + (k < 3 ? w->low[k] : w->high[k - 3]));
    adcgs_put_u(c.file, 0, 1); /* degree of harmonics */
    adcgs_put_u(c.file, 0, 1); /* flags */
    adcgs_put_u(c.file, 0, 4); /* no metadata */
    end_record(w, &c, HEADER);
}

/** Steps in the order of the record; those of motion, time and sigma have only bins of 0. */
static void put_steps(writer *w)
{
    const double steps[] = {w->step,
                            ADCGS_FOURDGS_STEP_SCALE,
                            ADCGS_FOURDGS_STEP_ROTATION,
                            ADCGS_FOURDGS_STEP_LEVEL,
                            ADCGS_FOURDGS_STEP_LEVEL,
                            w->step,
                            1.0 / w->clip->fps,
                            1.0};
    content c;
    if (!begin(&c)) {
        w->failed = 1;
        return;
    }
    adcgs_put_string(c.file, "uniform-v1");
    for (int a = 0; a < 3; a++)
        adcgs_put_f64(c.file, w->clip->frames->offset[a]);
    for (size_t i = 0; i < ADCGS_COUNTOF(steps); i++)
        adcgs_put_f64(c.file, steps[i]);
    adcgs_put_u(c.file, 1, 1); /* step of harmonics */
    adcgs_put_u(c.file, 0, 4); /* no bounds */
    end_record(w, &c, QUANTIZATION);
    if (!begin(&c)) {
        w->failed = 1;
        return;
    }
    adcgs_put_u(c.file, 1, 4); /* one window, the whole clip */
    adcgs_put_f64(c.file, 0.0);
    adcgs_put_f64(c.file, w->clip->n_frames / w->clip->fps);
    end_record(w, &c, WINDOWS);
}

static adcgs_status put_file(writer *w)
{
    const uint32_t group = w->clip->group ? w->clip->group : GROUP, frames = w->clip->n_frames;
    entry *const entries = calloc(frames, sizeof *entries);
    w->failed = !entries;
    if (entries) {
        put_header(w);
        put_steps(w);
        for (uint32_t f = 0; f < frames && !w->failed; f++) {
            entries[f].depth = f % group;
            put_chunk(w, &entries[f], f ? &entries[f - 1] : NULL, f);
        }
        put_end(w, entries);
    }
    free(entries);
    return w->failed ? adcgs_fail(w->error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", w->path, w->n) : ADCGS_OK;
}

static int make_tables(writer *w)
{
    const size_t rows = (size_t)w->n * ADCGS_FOURDGS_PLACES * sizeof(int32_t), stream = (size_t)12 * w->n + 12;
    w->room = compressBound((uLong)stream);
    w->rows[0] = calloc(1, rows);
    w->rows[1] = calloc(1, rows);
    w->moved = malloc(w->n * sizeof *w->moved);
    w->symbols = malloc(stream);
    w->planes = malloc(stream);
    w->packed = malloc(w->room);
    return w->rows[0] && w->rows[1] && w->moved && w->symbols && w->planes && w->packed;
}

adcgs_status adcgs_fourdgs_write(const adcgs_splat_clip *clip, const char *path, adcgs_error *error)
{
    adcgs_atomic atomic;
    writer w = {.clip = clip, .path = path, .error = error};
    ADCGS_TRY(adcgs_splat_clip_check(clip, &w.step, w.low, w.high, path, error));
    w.n = clip->frames->n;
    adcgs_status status = make_tables(&w) ? adcgs_atomic_open(&atomic, path, error)
                                          : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", path, w.n);
    if (status == ADCGS_OK) {
        w.file = atomic.file;
        status = put_file(&w);
        if (status == ADCGS_OK)
            status = adcgs_atomic_commit(&atomic, error);
        else
            adcgs_atomic_abort(&atomic);
    }
    free(w.rows[0]);
    free(w.rows[1]);
    free(w.moved);
    free(w.symbols);
    free(w.planes);
    free(w.packed);
    return status;
}

#else

adcgs_status adcgs_fourdgs_write(const adcgs_splat_clip *clip, const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build has no .4dgs: it needs zlib and zstd", path);
}

#endif
