/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The walk of the position coder: the cube is halved 3 * depth times, x, y and z
 * in turn, and at each step the count of every non-empty cell is split. Cells
 * are kept in Morton order; a hash table finds the neighbours of the step, or,
 * where keys were made to collide, bisection. Encoder and decoder run the same
 * walk.
 */
#include "geom/geom.h"

#include "geom/geom_models.h"

#define NO_KEY UINT64_MAX
/* A key lies at most this far behind its slot; with more, somebody chose the keys to be slow. */
#define PROBES_MAX 64
#define X_MASK UINT64_C(0x4924924924924924)

typedef struct cell {
    uint64_t key;  /* Morton code of its lowest voxel */
    uint32_t n;    /* points */
    uint32_t left; /* of these in the left half, once split */
    uint32_t alone; /* one point, and nothing in the 26 cells around: so it will be for all its descendants */
    uint32_t split; /* left is known */
} cell;

typedef struct slot {
    uint64_t key;
    uint64_t index;
} slot;

typedef struct walk {
    adcgs_geom_coder coder;
    adcgs_geom_models models;
    adcgs_memory *memory; /* of everything here; may be NULL */
    int depth;
    uint32_t n;
    const uint64_t *codes; /* encoder: [n], ascending */
    cell *cells, *children;
    slot *slots;
    int slot_bits; /* 0: bisect instead */
    size_t n_cells;
    size_t finger[27];     /* where bisection for each neighbour ended last, in this step */
    uint64_t mask[3], unit[3]; /* bits of each axis; one cell in its direction */
} walk;

static size_t hash(const walk *w, uint64_t key)
{
    return (size_t)(key * UINT64_C(0x9e3779b97f4a7c15) >> (64 - w->slot_bits));
}

/* Bisection between bounds that are found by doubling steps away from where the same neighbour of the cell before was. */
static const cell *bisect(walk *w, uint64_t key, int neighbour)
{
    size_t low = w->finger[neighbour], high = low;
    for (size_t step = 1; high < w->n_cells && w->cells[high].key < key; step *= 2) {
        low = high + 1;
        high += step;
    }
    for (size_t step = 1; low > 0 && w->cells[low - 1].key >= key; step *= 2) {
        high = low - 1;
        low -= ADCGS_MIN(step, low);
    }
    high = ADCGS_MIN(high, w->n_cells);
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (w->cells[middle].key < key)
            low = middle + 1;
        else
            high = middle;
    }
    w->finger[neighbour] = low;
    return low < w->n_cells && w->cells[low].key == key ? &w->cells[low] : NULL;
}

/* The cell with a key, which is that of a neighbour 0..26 of the cell at hand, or NULL. */
static const cell *find(walk *w, uint64_t key, int neighbour)
{
    if (key == NO_KEY)
        return NULL;
    if (w->slot_bits == 0)
        return bisect(w, key, neighbour);
    const size_t wrap = ((size_t)1 << w->slot_bits) - 1;
    size_t i = hash(w, key);
    for (int probe = 0; probe < PROBES_MAX && w->slots[i].key != NO_KEY; probe++, i = (i + 1) & wrap)
        if (w->slots[i].key == key)
            return &w->cells[w->slots[i].index];
    return NULL;
}

static uint32_t count_at(walk *w, uint64_t key, int neighbour)
{
    const cell *found = find(w, key, neighbour);
    return found ? found->n : 0;
}

/* Cells without neighbours are nobody's neighbours, so they stay out of the table. */
static void fill_slots(walk *w)
{
    memset(w->finger, 0, sizeof w->finger);
    w->slot_bits = 3;
    while ((size_t)1 << w->slot_bits < 2 * w->n_cells)
        w->slot_bits++;
    const size_t size = (size_t)1 << w->slot_bits;
    for (size_t i = 0; i < size; i++)
        w->slots[i].key = NO_KEY;
    for (size_t c = 0; c < w->n_cells; c++) {
        if (w->cells[c].alone)
            continue;
        size_t i = hash(w, w->cells[c].key);
        int probe = 0;
        for (; probe < PROBES_MAX && w->slots[i].key != NO_KEY; probe++)
            i = (i + 1) & (size - 1);
        if (probe == PROBES_MAX) {
            w->slot_bits = 0;
            return;
        }
        w->slots[i] = (slot){ w->cells[c].key, c };
    }
}

/* The parts of the keys of the cells before, at and behind a cell along one axis; NO_KEY outside the cube. */
static void parts_along(const walk *w, int axis, uint64_t key, uint64_t part[3])
{
    const uint64_t mask = w->mask[axis];
    part[1] = key & mask;
    part[0] = part[1] ? (part[1] - w->unit[axis]) & mask : NO_KEY;
    part[2] = ((part[1] | ~mask) + w->unit[axis]) & mask;
    part[2] = part[2] ? part[2] : NO_KEY;
}

static void look_around(walk *w, cell *at, int axis, adcgs_geom_around *around)
{
    uint64_t a[3], u[3], v[3];
    parts_along(w, axis, at->key, a);
    parts_along(w, (axis + 1) % 3, at->key, u);
    parts_along(w, (axis + 2) % 3, at->key, v);
    *around = (adcgs_geom_around){
        .before = count_at(w, a[0] | u[1] | v[1], 4),
        .behind = count_at(w, a[2] | u[1] | v[1], 22),
    };
    int lateral = 0;
    for (int i = 0; i < 9; i++) {
        const uint64_t uv = u[i / 3] | v[i % 3];
        if (i == 4 || uv == NO_KEY)
            continue;
        around->ring_before += count_at(w, a[0] | uv, i);
        around->ring_behind += count_at(w, a[2] | uv, 18 + i);
        if (i % 2 == 0)
            continue;
        const cell *side = find(w, a[1] | uv, 9 + i);
        lateral += side != NULL;
        around->lateral_left += side && side->split && side->left;
        around->lateral_right += side && side->split && side->left < side->n;
    }
    if (at->n == 1 && !lateral && !around->before && !around->behind && !around->ring_before && !around->ring_behind)
        at->alone = !find(w, a[1] | u[0] | v[0], 9) && !find(w, a[1] | u[0] | v[2], 11) && !find(w, a[1] | u[2] | v[0], 15) &&
                    !find(w, a[1] | u[2] | v[2], 17);
}

/* How many of the codes [first, first + n) have the bit clear. */
static uint32_t count_left(const uint64_t *codes, uint32_t n, uint64_t bit)
{
    uint32_t low = 0, high = n;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (codes[middle] & bit)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

static size_t split_cells(walk *w, int step)
{
    const int axis = step % 3, left_bits = 3 * w->depth - 1 - step;
    const uint64_t bit = UINT64_C(1) << left_bits;
    size_t n_children = 0;
    uint32_t first = 0;
    for (size_t i = 0; i < w->n_cells; i++) {
        cell *at = &w->cells[i];
        adcgs_geom_around around = { 0 };
        if (!at->alone)
            look_around(w, at, axis, &around);
        const uint32_t given = w->codes ? count_left(w->codes + first, at->n, bit) : 0;
        at->left = adcgs_geom_code_split(&w->coder, step, at->n, bit, &around, given);
        at->split = 1;
        first += at->n;
        if (at->left)
            w->children[n_children++] = (cell){ .key = at->key, .n = at->left, .alone = at->alone };
        if (at->left < at->n)
            w->children[n_children++] = (cell){ .key = at->key | bit, .n = at->n - at->left, .alone = at->alone };
    }
    return n_children;
}

static adcgs_status run(walk *w, adcgs_error *error)
{
    size_t slots = 8;
    while (slots < 2 * (size_t)w->n)
        slots *= 2;
    w->cells = adcgs_alloc(w->memory, w->n, sizeof *w->cells, error);
    w->children = adcgs_alloc(w->memory, w->n, sizeof *w->children, error);
    w->slots = adcgs_alloc(w->memory, slots, sizeof *w->slots, error);
    if (!w->cells || !w->children || !w->slots)
        return adcgs_alloc_status(error);
    adcgs_geom_models_init(&w->models);
    w->coder.models = &w->models;
    w->cells[0] = (cell){ .n = w->n };
    w->n_cells = 1;
    for (int step = 0; step < 3 * w->depth; step++) {
        for (int axis = 0; axis < 3; axis++) {
            const int bits = (step + 2 - axis) / 3; /* of this axis already split */
            w->mask[axis] = X_MASK >> axis & ((UINT64_C(1) << 3 * w->depth) - 1);
            /* an axis not yet split has no neighbours: its part is 0, and stays 0 */
            w->unit[axis] = bits ? UINT64_C(1) << (3 * (w->depth - bits) + 2 - axis) : 0;
        }
        fill_slots(w);
        w->n_cells = split_cells(w, step);
        cell *swap = w->cells;
        w->cells = w->children;
        w->children = swap;
    }
    return ADCGS_OK;
}

static void clear(walk *w)
{
    adcgs_free(w->memory, w->cells);
    adcgs_free(w->memory, w->children);
    adcgs_free(w->memory, w->slots);
}

static adcgs_status check_size(uint32_t n, int depth, adcgs_status status, adcgs_error *error)
{
    if (depth < 0 || depth > ADCGS_GEOM_DEPTH_MAX)
        return adcgs_fail(error, status, "positions of depth %d; it may be 0 to %d", depth, ADCGS_GEOM_DEPTH_MAX);
    if (n < 1 || n > UINT64_C(1) << 3 * depth)
        return adcgs_fail(error, status, "%u distinct positions cannot be of depth %d", n, depth);
    return ADCGS_OK;
}

/* Every third bit, closed up. */
static uint32_t gather(uint64_t code, int depth)
{
    uint32_t v = 0;
    for (int i = 0; i < depth; i++)
        v |= (uint32_t)(code >> 3 * i & 1) << i;
    return v;
}

adcgs_status adcgs_geom_decode_from(adcgs_range_dec *d, uint32_t n, int depth, uint32_t *voxels, adcgs_memory *memory,
                                    adcgs_error *error)
{
    ADCGS_TRY(check_size(n, depth, ADCGS_ERR_DATA, error));
    walk *w = adcgs_alloc(memory, 1, sizeof *w, error);
    if (!w)
        return adcgs_alloc_status(error);
    w->memory = memory;
    w->coder.dec = d;
    w->depth = depth;
    w->n = n;
    adcgs_status status = run(w, error);
    if (status == ADCGS_OK)
        status = adcgs_range_dec_finish(d, error);
    /* Every cell of the last step is one voxel with one point, because capacities were respected all the way. */
    for (uint32_t i = 0; status == ADCGS_OK && i < n; i++)
        for (int axis = 0; axis < 3; axis++)
            voxels[3 * i + (uint32_t)axis] = gather(w->cells[i].key >> (2 - axis), depth);
    clear(w);
    adcgs_free(memory, w);
    return status;
}

adcgs_status adcgs_geom_decode(const uint8_t *data, size_t bytes, uint32_t n, int depth, uint32_t *voxels, adcgs_error *error)
{
    adcgs_range_dec d;
    adcgs_range_dec_init(&d, data, bytes);
    return adcgs_geom_decode_from(&d, n, depth, voxels, NULL, error);
}

static adcgs_status list_codes(uint64_t *codes, const uint32_t *voxels, uint32_t n, int depth, adcgs_error *error)
{
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t *voxel = voxels + 3 * (size_t)i;
        if ((voxel[0] | voxel[1] | voxel[2]) >> depth)
            return adcgs_fail(error, ADCGS_ERR_USAGE, "position %u is outside the cube of depth %d", i, depth);
        codes[i] = adcgs_morton(voxel);
        if (i && codes[i] <= codes[i - 1])
            return adcgs_fail(error, ADCGS_ERR_USAGE, "position %u is not behind its predecessor in Morton order", i);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_geom_encode(adcgs_buffer *out, const uint32_t *voxels, uint32_t n, int depth, adcgs_error *error)
{
    ADCGS_TRY(check_size(n, depth, ADCGS_ERR_USAGE, error));
    walk *w = adcgs_alloc(NULL, 1, sizeof *w, error);
    uint64_t *codes = adcgs_alloc(NULL, n, sizeof *codes, error);
    adcgs_status status = w && codes ? list_codes(codes, voxels, n, depth, error) : adcgs_alloc_status(error);
    if (status == ADCGS_OK) {
        adcgs_range_enc encoder;
        adcgs_range_enc_init(&encoder, out);
        w->coder.enc = &encoder;
        w->codes = codes;
        w->depth = depth;
        w->n = n;
        status = run(w, error);
        adcgs_range_enc_finish(&encoder);
        clear(w);
    }
    adcgs_free(NULL, w);
    adcgs_free(NULL, codes);
    if (status == ADCGS_OK && out->failed)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for the coded positions");
    return status;
}
