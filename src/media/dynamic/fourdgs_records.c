/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The records of a .4dgs file from its first to its last byte: opcode, length, content. Unknown ones are skipped. */
#include "config.h"

#include "media/dynamic/fourdgs.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: definition (the specification of .4dgs). */
/* Opcodes of records. */
enum { HEADER = 1, FOOTER, QUANTIZATION, WINDOWS, CHUNK, BAND = 7, INDEX, DELTA = 0x10, TRACK = 0x25 };
#define FRAME 9          /* bytes of a record before its content */
#define MAGIC 8          /* bytes at both ends of a file */
#define STEP_MAX 1e9     /* largest step, in the attribute's unit; chosen by hand, not measured */
#define DURATION_MAX 1e9 /* seconds; chosen by hand, not measured */

/* Bytes of both ends; definition (.4dgs). */
static const uint8_t magic[MAGIC] = {0x89, '4', 'D', 'G', 'S', '1', '\r', '\n'};

static adcgs_status fail_short(const adcgs_fourdgs *f, uint64_t offset, const char *name, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: the %s at byte %llu ends early", f->path, name,
                      (unsigned long long)offset);
}

/** A string for comparison and messages, cut to the room of `to`. */
static void read_string(char *to, size_t room, adcgs_byte_cursor *c)
{
    const uint32_t n = adcgs_cursor_u32(c);
    const uint8_t *const text = adcgs_cursor_bytes(c, n);
    const size_t kept = text ? ADCGS_MIN(n, room - 1) : 0;
    if (kept)
        memcpy(to, text, kept);
    to[kept] = 0;
}

/* ---- Single records ---- */

static adcgs_status read_header(adcgs_fourdgs *f, uint64_t offset, adcgs_byte_cursor c, adcgs_error *error)
{
    char text[32];
    read_string(text, sizeof text, &c); /* the profile, which binds only writers */
    read_string(text, sizeof text, &c); /* the program that wrote the file */
    f->duration = adcgs_cursor_f64(&c);
    f->n = adcgs_cursor_u64(&c);
    f->cutoff = adcgs_cursor_f64(&c);
    read_string(text, sizeof text, &c);
    for (int i = 0; i < 6; i++)
        f->box[i] = adcgs_cursor_f64(&c);
    f->degree = adcgs_cursor_u8(&c);
    if (c.failed)
        return fail_short(f, offset, "header", error);
    f->has_keyframes = !strcmp(text, "keyframe-delta");
    if (!f->has_keyframes && strcmp(text, "gaussian-birth"))
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED,
                          "%s: .4dgs with the temporal model \"%s\", expected gaussian-birth or keyframe-delta", f->path, text);
    if (f->degree > ADCGS_SPLATS_DEGREE_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: harmonics of degree %d, expected 0 to 3", f->path, f->degree);
    if (f->n > ADCGS_SPLATS_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %llu splats, expected at most %u", f->path, (unsigned long long)f->n,
                          ADCGS_SPLATS_MAX);
    if (!(f->duration >= 0.0 && f->duration <= DURATION_MAX) || !(f->cutoff >= 0.0 && f->cutoff <= 1.0))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs of %g seconds with a cutoff of %g, expected 0 to %g, and 0 to 1",
                          f->path, f->duration, f->cutoff, DURATION_MAX);
    return ADCGS_OK;
}

static adcgs_status read_steps(adcgs_fourdgs *f, uint64_t offset, adcgs_byte_cursor c, adcgs_error *error)
{
    char scheme[32];
    double *const steps[] = {&f->step_position, &f->step_scale,  &f->step_rotation, &f->step_colour,
                             &f->step_opacity,  &f->step_motion, &f->step_time,     &f->step_sigma};
    read_string(scheme, sizeof scheme, &c);
    for (int a = 0; a < 3; a++)
        f->origin[a] = adcgs_cursor_f64(&c);
    for (size_t i = 0; i < ADCGS_COUNTOF(steps); i++)
        *steps[i] = adcgs_cursor_f64(&c);
    if (c.failed)
        return fail_short(f, offset, "quantization", error);
    if (strcmp(scheme, "uniform-v1"))
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: .4dgs with the quantization \"%s\", expected uniform-v1", f->path,
                          scheme);
    for (int a = 0; a < 3; a++)
        if (!isfinite(f->origin[a]))
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: an origin of positions that is not finite", f->path);
    for (size_t i = 0; i < ADCGS_COUNTOF(steps); i++)
        if (!(*steps[i] > 0.0 && *steps[i] <= STEP_MAX))
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: step %zu of the quantization is %g, expected 0 to %g", f->path,
                              i, *steps[i], STEP_MAX);
    f->has_steps = 1;
    return ADCGS_OK;
}

static adcgs_status read_windows(adcgs_fourdgs *f, uint64_t offset, adcgs_byte_cursor c, adcgs_error *error)
{
    const uint32_t n = adcgs_cursor_u32(&c);
    if (c.failed || (uint64_t)n * 16 > (uint64_t)(c.end - c.at))
        return fail_short(f, offset, "table of windows", error);
    free(f->windows);
    f->windows = malloc(n * sizeof *f->windows + !n);
    if (!f->windows)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", f->path);
    f->n_windows = n;
    for (uint32_t i = 0; i < n; i++) {
        f->windows[i].begin = adcgs_cursor_f64(&c);
        f->windows[i].end = adcgs_cursor_f64(&c);
        if (isnan(f->windows[i].begin) || isnan(f->windows[i].end))
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: window %u is not a number", f->path, i);
    }
    return ADCGS_OK;
}

/** Harmonics belong to the chunk before them. */
static adcgs_status read_band(adcgs_fourdgs *f, uint64_t offset, adcgs_byte_cursor c, adcgs_error *error)
{
    const int band = adcgs_cursor_u8(&c);
    if (c.failed || band < 1 || band > ADCGS_FOURDGS_BANDS || !f->n_chunks)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: band %d of harmonics at byte %llu behind %u chunks", f->path, band,
                          (unsigned long long)offset, f->n_chunks);
    adcgs_fourdgs_range *const to = &f->chunks[f->n_chunks - 1].bands[band - 1];
    if (to->data)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: two bands %d of harmonics for chunk %u", f->path, band,
                          f->n_chunks - 1);
    *to = (adcgs_fourdgs_range){c.at, (uint64_t)(c.end - c.at)};
    return ADCGS_OK;
}

static adcgs_status read_footer(adcgs_fourdgs *f, uint64_t offset, adcgs_byte_cursor c, adcgs_error *error)
{
    f->summary = adcgs_cursor_u64(&c);
    (void)adcgs_cursor_u64(&c); /* of the table of kinds of records */
    f->summary_crc = adcgs_cursor_u32(&c);
    f->footer = offset;
    if (c.failed)
        return fail_short(f, offset, "footer", error);
    if (f->summary > offset)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: an index at byte %llu, behind the footer at %llu", f->path,
                          (unsigned long long)f->summary, (unsigned long long)offset);
    if (!f->summary || !f->summary_crc)
        return ADCGS_OK;
    const uint32_t crc = adcgs_planes_crc32(f->data + f->summary, (size_t)(offset - f->summary));
    if (crc != f->summary_crc)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: the checksum of the index is %08x, expected %08x", f->path, crc,
                          f->summary_crc);
    return ADCGS_OK;
}

static adcgs_status read_record(adcgs_fourdgs *f, int opcode, uint64_t offset, adcgs_byte_cursor content, adcgs_error *error)
{
    switch (opcode) {
    case HEADER:
        return offset == MAGIC ? read_header(f, offset, content, error)
                               : adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: a second header at byte %llu", f->path,
                                            (unsigned long long)offset);
    case QUANTIZATION:
        return read_steps(f, offset, content, error);
    case WINDOWS:
        return read_windows(f, offset, content, error);
    case CHUNK:
    case DELTA:
        return adcgs_fourdgs_read_chunk(f, offset, content, opcode == DELTA, error);
    case BAND:
        return read_band(f, offset, content, error);
    case INDEX:
        return adcgs_fourdgs_check_index(f, offset, content, error);
    case TRACK:
        return adcgs_fourdgs_read_track(f, offset, content, error);
    case FOOTER:
        return read_footer(f, offset, content, error);
    default:
        return ADCGS_OK;
    }
}

/* ---- The file ---- */

static adcgs_status check_magic(const adcgs_fourdgs *f, adcgs_error *error)
{
    if (f->bytes < MAGIC || (memcmp(f->data, magic, 5) == 0 && f->data[5] != magic[5]))
        return adcgs_fail(error, f->bytes < MAGIC ? ADCGS_ERR_DATA : ADCGS_ERR_UNSUPPORTED, "%s: .4dgs of version %d, expected 1",
                          f->path, f->bytes < MAGIC ? 0 : f->data[5] - '0');
    for (int i = 0; i < MAGIC; i++)
        if (f->data[i] != magic[i])
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: byte %d of the magic is %02x, expected %02x", f->path, i,
                              f->data[i], magic[i]);
    if (f->bytes < 2 * MAGIC || memcmp(f->data + f->bytes - MAGIC, magic, MAGIC))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs of %zu bytes ends early: no magic at its end", f->path, f->bytes);
    return ADCGS_OK;
}

static adcgs_status check_whole(const adcgs_fourdgs *f, int last, adcgs_error *error)
{
    if (last != FOOTER)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: the last record has the opcode 0x%02x, expected a footer", f->path,
                          (unsigned)last);
    if (f->n_chunks && !f->has_steps)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: chunks, but no quantization", f->path);
    return ADCGS_OK;
}

adcgs_status adcgs_fourdgs_read(adcgs_fourdgs *f, adcgs_error *error)
{
    int opcode = 0;
    ADCGS_TRY(check_magic(f, error));
    const uint64_t end = f->bytes - MAGIC;
    for (uint64_t at = MAGIC; at < end;) {
        const uint64_t length = end - at >= FRAME ? adcgs_load_le64(f->data + at + 1) : 0;
        opcode = f->data[at];
        if (end - at < FRAME || length > end - at - FRAME)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: a record 0x%02x at byte %llu of %llu bytes, %llu follow",
                              f->path, (unsigned)opcode, (unsigned long long)at, (unsigned long long)length,
                              (unsigned long long)(end - at < FRAME ? 0 : end - at - FRAME));
        if (at == MAGIC && opcode != HEADER)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: the first record has the opcode 0x%02x, expected a header",
                              f->path, (unsigned)opcode);
        const uint8_t *const content = f->data + at + FRAME;
        ADCGS_TRY(read_record(f, opcode, at, (adcgs_byte_cursor){content, content + length, 0}, error));
        at += FRAME + length;
    }
    ADCGS_TRY(check_whole(f, opcode, error));
    return adcgs_fourdgs_sort_tracks(f, error);
}

void adcgs_fourdgs_free(adcgs_fourdgs *f)
{
    free(f->windows);
    free(f->chunks);
    free(f->tracks);
    *f = (adcgs_fourdgs){0};
}
