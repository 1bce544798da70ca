/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The renderer's stages and its workspace: project the slots, sort the visible
 * splats by depth, bin them into tiles in that order, blend the tiles. Every
 * stage runs in parallel over disjoint pieces whose results are combined by
 * index, so the image does not depend on the number of threads.
 */
#include "config.h"

#include "render/raster_isa.h"
#include "render/sort.h"

/* Slots in one piece of projection work. */
#define PROJECT_PIECE 1024u
/* Maximum number of slots, and of (splat, tile) pairs of a frame, counted by the splats' tile rectangles. */
#define SPLATS_MAX ((uint64_t)1 << 28)
#define ENTRIES_MAX ((uint64_t)1 << 28)
/* Maximum number of counters of all binning pieces together, unless one piece needs more. */
#define COUNTERS_MAX ((size_t)1 << 22)

/* An array that can grow; growing discards its contents. */
typedef struct room {
    void *data;
    size_t bytes;
} room;

/* Sorted splats [begin, end), whose pairs go to emitted[at...]. */
typedef struct bin_piece {
    uint32_t begin, end;
    uint64_t at;
    uint32_t emitted;
} bin_piece;

struct adcgs_raster {
    adcgs_raster_dsp dsp;
    adcgs_pool *pool;
    adcgs_memory *memory;
    room projected, outlines, areas, keys, other, piece_counts; /* by slot */
    room splats, first, where;                                  /* sorted; first pair of each; slot to sorted */
    room pieces, counts, emitted, tile_start, entries, place;   /* binning */
    room transmittance;                                         /* blending */
    adcgs_project_job project;
    adcgs_bin_job bin;
    adcgs_blend_job blend;
    uint32_t n_slots, n;
    int n_pieces, tiles, keep;
    adcgs_kept kept;
};

static adcgs_status grow_room(adcgs_raster *r, room *x, uint64_t count, size_t size, adcgs_error *error)
{
    if (count > SIZE_MAX / 2 / size)
        return adcgs_fail(error, ADCGS_ERR_LIMIT, "rendering: %llu elements of workspace", (unsigned long long)count);
    const size_t need = (size_t)count * size;
    if (need <= x->bytes && x->data)
        return ADCGS_OK;
    adcgs_free(r->memory, x->data);
    *x = (room){NULL, 0};
    const size_t bytes = need + need / 4 + 64;
    x->data = adcgs_alloc(r->memory, bytes, 1, error);
    if (!x->data)
        return adcgs_alloc_status(error);
    x->bytes = bytes;
    return ADCGS_OK;
}

adcgs_status adcgs_raster_create(adcgs_raster **out, adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_memory *memory,
                                 adcgs_error *error)
{
    adcgs_cpu_level level;
    *out = NULL;
    ADCGS_TRY(adcgs_cpu_resolve(cpu, &level, error));
    adcgs_raster *r = adcgs_alloc(memory, 1, sizeof *r, error);
    if (!r)
        return adcgs_alloc_status(error);
    r->pool = pool;
    r->memory = memory;
    r->dsp = adcgs_raster_scalar;
#ifdef HAVE_AVX2
    if (level >= ADCGS_CPU_AVX2)
        r->dsp = adcgs_raster_avx2;
#endif
#ifdef HAVE_AVX512
    if (level >= ADCGS_CPU_AVX512)
        r->dsp = adcgs_raster_avx512;
#endif
    *out = r;
    return ADCGS_OK;
}

void adcgs_raster_free(adcgs_raster **raster)
{
    adcgs_raster *r = *raster;
    if (!r)
        return;
    room *const rooms[] = {&r->projected,  &r->outlines, &r->areas, &r->keys,         &r->other,  &r->piece_counts,
                           &r->splats,     &r->first,    &r->where, &r->pieces,       &r->counts, &r->emitted,
                           &r->tile_start, &r->entries,  &r->place, &r->transmittance};
    for (size_t i = 0; i < ADCGS_COUNTOF(rooms); i++)
        adcgs_free(r->memory, rooms[i]->data);
    adcgs_free(r->memory, r);
    *raster = NULL;
}

/* ---- Projection and depth order ---- */

static void project_piece(void *arg, int index, int thread)
{
    adcgs_raster *r = arg;
    const uint32_t begin = (uint32_t)index * PROJECT_PIECE, end = ADCGS_MIN(begin + PROJECT_PIECE, r->n_slots);
    uint32_t *where = r->where.data, n = begin;
    for (uint32_t slot = begin; slot < end; slot += 64)
        n += r->dsp.project(&r->project, slot, n);
    if (r->keep)
        memset(where + begin, 0xff, (size_t)(end - begin) * sizeof *where);
    ((uint32_t *)r->piece_counts.data)[index] = n - begin;
}

static adcgs_status project(adcgs_raster *r, const adcgs_primitives *primitives, const adcgs_view *view, float filter,
                            adcgs_error *error)
{
    const uint32_t pieces = (primitives->n + PROJECT_PIECE - 1) / PROJECT_PIECE;
    if (primitives->n % 64 || primitives->n > SPLATS_MAX)
        return adcgs_fail(error, primitives->n % 64 ? ADCGS_ERR_USAGE : ADCGS_ERR_LIMIT,
                          "rendering: %u slots of primitives, expected a multiple of 64 up to 2^28", primitives->n);
    r->n_slots = primitives->n;
    ADCGS_TRY(grow_room(r, &r->projected, r->n_slots, sizeof(adcgs_splat2d), error));
    ADCGS_TRY(grow_room(r, &r->outlines, r->n_slots, sizeof(adcgs_outline), error));
    ADCGS_TRY(grow_room(r, &r->areas, r->n_slots, sizeof(uint32_t), error));
    ADCGS_TRY(grow_room(r, &r->keys, r->n_slots, sizeof(uint64_t), error));
    ADCGS_TRY(grow_room(r, &r->other, r->n_slots, sizeof(uint64_t), error));
    ADCGS_TRY(grow_room(r, &r->where, r->n_slots, sizeof(uint32_t), error));
    ADCGS_TRY(grow_room(r, &r->piece_counts, pieces, sizeof(uint32_t), error));
    r->project = (adcgs_project_job){.primitives = primitives,
                                     .view = view,
                                     .filter = filter,
                                     .tiles_x = (view->width + ADCGS_TILE - 1) / ADCGS_TILE,
                                     .tiles_y = (view->height + ADCGS_TILE - 1) / ADCGS_TILE,
                                     .splats = r->projected.data,
                                     .outlines = r->outlines.data,
                                     .keys = r->keys.data,
                                     .areas = r->areas.data};
    adcgs_pool_run(r->pool, project_piece, r, (int)pieces);
    uint64_t *keys = r->keys.data;
    const uint32_t *counts = r->piece_counts.data;
    r->n = 0;
    for (uint32_t i = 0; i < pieces; i++) {
        memmove(keys + r->n, keys + (size_t)i * PROJECT_PIECE, counts[i] * sizeof *keys);
        r->n += counts[i];
    }
    r->bin.order = adcgs_sort_keys(keys, r->other.data, r->n);
    return ADCGS_OK;
}

/* ---- Binning ---- */

/* Cut the sorted splats into pieces of about equal area, and reserve memory for all pairs of each piece. */
static adcgs_status cut_pieces(adcgs_raster *r, adcgs_error *error)
{
    const uint32_t *areas = r->areas.data;
    uint64_t total = 0;
    for (uint32_t i = 0; i < r->n; i++)
        total += areas[(uint32_t)r->bin.order[i]];
    if (total > ENTRIES_MAX)
        return adcgs_fail(error, ADCGS_ERR_LIMIT, "rendering: the splats cover %llu tiles, more than 2^28",
                          (unsigned long long)total);
    const int threads = adcgs_pool_threads(r->pool);
    size_t pieces = threads > 1 ? 4 * (size_t)threads : 1;
    pieces = ADCGS_MIN(pieces, COUNTERS_MAX / (size_t)r->tiles);
    pieces = ADCGS_MAX(pieces, 1);
    ADCGS_TRY(grow_room(r, &r->pieces, pieces, sizeof(bin_piece), error));
    ADCGS_TRY(grow_room(r, &r->counts, pieces * (size_t)r->tiles, sizeof(uint32_t), error));
    ADCGS_TRY(grow_room(r, &r->emitted, total + pieces * ADCGS_BIN_SLACK, sizeof(uint64_t), error));
    bin_piece *p = r->pieces.data;
    uint64_t sum = 0;
    uint32_t i = 0;
    for (size_t k = 0; k < pieces; k++) {
        p[k] = (bin_piece){.begin = i, .at = sum + k * ADCGS_BIN_SLACK};
        while (i < r->n && (k + 1 == pieces || sum < total * (k + 1) / pieces))
            sum += areas[(uint32_t)r->bin.order[i++]];
        p[k].end = i;
    }
    r->n_pieces = (int)pieces;
    return ADCGS_OK;
}

static void bin_piece_splats(void *arg, int index, int thread)
{
    adcgs_raster *r = arg;
    bin_piece *piece = (bin_piece *)r->pieces.data + index;
    uint32_t *counts = (uint32_t *)r->counts.data + (size_t)index * (size_t)r->tiles;
    memset(counts, 0, (size_t)r->tiles * sizeof *counts);
    piece->emitted = r->dsp.bin(&r->bin, piece->begin, piece->end, counts, (uint64_t *)r->emitted.data + piece->at);
}

/* Turn the pieces' counts into their first positions: by tile, then by piece. Also set the first pair of each piece. */
static uint32_t place_counts(adcgs_raster *r)
{
    uint32_t *start = r->tile_start.data, *counts = r->counts.data, sum = 0;
    for (int t = 0; t < r->tiles; t++) {
        start[t] = sum;
        for (int p = 0; p < r->n_pieces; p++) {
            uint32_t *count = counts + (size_t)p * (size_t)r->tiles + (size_t)t;
            const uint32_t n = *count;
            *count = sum;
            sum += n;
        }
    }
    start[r->tiles] = sum;
    uint32_t pairs = 0;
    bin_piece *pieces = r->pieces.data;
    for (int p = 0; p < r->n_pieces; p++) {
        const uint32_t n = pieces[p].emitted;
        pieces[p].emitted = pairs;
        pairs += n;
    }
    return sum;
}

static void scatter_piece(void *arg, int index, int thread)
{
    adcgs_raster *r = arg;
    const bin_piece *piece = (bin_piece *)r->pieces.data + index;
    const uint64_t *from = (uint64_t *)r->emitted.data + piece->at;
    const uint32_t begin = piece->emitted;
    const uint32_t n = (index + 1 < r->n_pieces ? piece[1].emitted : r->kept.tile_start[r->tiles]) - begin;
    uint32_t *next = (uint32_t *)r->counts.data + (size_t)index * (size_t)r->tiles;
    uint32_t *place = r->place.data, *first = r->first.data;
    adcgs_tile_entry *entries = r->entries.data;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t at = next[from[i] >> 16 & 0xfffff]++;
        entries[at] = (adcgs_tile_entry){(uint32_t)(from[i] >> 36), (uint32_t)(from[i] & 0xffff)};
        if (r->keep)
            place[at] = begin + i;
    }
    if (r->keep)
        for (uint32_t i = piece->begin; i < piece->end; i++)
            first[i] += begin;
}

static adcgs_status bin(adcgs_raster *r, adcgs_error *error)
{
    r->tiles = r->project.tiles_x * r->project.tiles_y;
    ADCGS_TRY(grow_room(r, &r->splats, r->n, sizeof(adcgs_splat2d), error));
    ADCGS_TRY(grow_room(r, &r->first, (uint64_t)r->n + 1, sizeof(uint32_t), error));
    ADCGS_TRY(grow_room(r, &r->tile_start, (uint64_t)r->tiles + 1, sizeof(uint32_t), error));
    ADCGS_TRY(cut_pieces(r, error));
    r->bin = (adcgs_bin_job){.order = r->bin.order,
                             .from = r->projected.data,
                             .outlines = r->outlines.data,
                             .tiles_x = r->project.tiles_x,
                             .to = r->splats.data,
                             .first = r->first.data,
                             .where = r->keep ? r->where.data : NULL};
    adcgs_pool_run(r->pool, bin_piece_splats, r, r->n_pieces);
    const uint32_t entries = place_counts(r);
    ADCGS_TRY(grow_room(r, &r->entries, entries, sizeof(adcgs_tile_entry), error));
    if (r->keep)
        ADCGS_TRY(grow_room(r, &r->place, entries, sizeof(uint32_t), error));
    r->kept.tile_start = r->tile_start.data;
    adcgs_pool_run(r->pool, scatter_piece, r, r->n_pieces);
    ((uint32_t *)r->first.data)[r->n] = entries;
    return ADCGS_OK;
}

/* ---- Blending ---- */

static void blend_tile(void *arg, int index, int thread)
{
    adcgs_raster *r = arg;
    r->dsp.blend(&r->blend, index);
}

static adcgs_status blend(adcgs_raster *r, const adcgs_view *view, const float background[3], float *rgb, adcgs_error *error)
{
    if (r->keep)
        ADCGS_TRY(grow_room(r, &r->transmittance, (uint64_t)r->tiles * 256, sizeof(float), error));
    r->blend = (adcgs_blend_job){.splats = r->splats.data,
                                 .entries = r->entries.data,
                                 .tile_start = r->tile_start.data,
                                 .tiles_x = r->project.tiles_x,
                                 .width = view->width,
                                 .height = view->height,
                                 .rgb = rgb,
                                 .transmittance = r->keep ? r->transmittance.data : NULL};
    memcpy(r->blend.background, background, sizeof r->blend.background);
    adcgs_pool_run(r->pool, blend_tile, r, r->tiles);
    return ADCGS_OK;
}

static adcgs_status project_and_bin(adcgs_raster *r, const adcgs_primitives *primitives, const adcgs_view *view, float filter,
                                    int keep, adcgs_error *error)
{
    r->keep = keep;
    r->kept = (adcgs_kept){0};
    ADCGS_TRY(project(r, primitives, view, filter, error));
    return bin(r, error);
}

adcgs_status adcgs_raster_forward(adcgs_raster *r, const adcgs_primitives *primitives, const adcgs_view *view,
                                  const float background[3], float screen_filter, float *rgb, int keep, adcgs_error *error)
{
    ADCGS_TRY(project_and_bin(r, primitives, view, screen_filter, keep != 0, error));
    ADCGS_TRY(blend(r, view, background, rgb, error));
    r->kept = (adcgs_kept){.n_splats = r->n,
                           .splats = r->splats.data,
                           .tiles_x = r->project.tiles_x,
                           .tiles_y = r->project.tiles_y,
                           .tile_start = r->tile_start.data,
                           .entries = r->entries.data,
                           .transmittance = r->keep ? r->transmittance.data : NULL,
                           .n_slots = r->n_slots,
                           .where = r->keep ? r->where.data : NULL,
                           .first = r->first.data,
                           .place = r->place.data};
    return ADCGS_OK;
}

static void colour_by_depth(void *arg, int index, int thread)
{
    adcgs_raster *r = arg;
    const bin_piece *piece = (bin_piece *)r->pieces.data + index;
    adcgs_splat2d *splats = r->splats.data;
    for (uint32_t i = piece->begin; i < piece->end; i++) {
        splats[i].rgb[0] = splats[i].depth;
        splats[i].rgb[1] = 1.0f;
        splats[i].rgb[2] = 0.0f;
    }
}

adcgs_status adcgs_raster_depth(adcgs_raster *r, const adcgs_primitives *primitives, const adcgs_view *view, float screen_filter,
                                float *sums, adcgs_error *error)
{
    static const float black[3];
    ADCGS_TRY(project_and_bin(r, primitives, view, screen_filter, 0, error));
    adcgs_pool_run(r->pool, colour_by_depth, r, r->n_pieces);
    return blend(r, view, black, sums, error);
}

void adcgs_raster_kept(const adcgs_raster *raster, adcgs_kept *kept)
{
    *kept = raster->kept;
}
