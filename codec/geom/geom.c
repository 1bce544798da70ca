/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The walk of the position coder. The cube is halved 3 * depth times, along x,
 * y and z in turn; each step splits the count of every non-empty cell. Cells
 * are stored in Morton order. A hash table finds the neighbours of the step;
 * if keys were made to collide, bisection does. Encoder and decoder run the
 * same walk.
 */
#include "geom/geom.h"

#include "geom/geom_models.h"

#define NO_CELL UINT32_MAX
/* Maximum distance of a key from its slot. A larger distance means that the keys were chosen to make the table slow. */
#define PROBES_MAX 64
#define X_MASK UINT64_C(0x4924924924924924)
/*
 * The cells around a cell are numbered 9 a + 3 u + v. Each of a, u and v is 0, 1 or 2 for a cell before, at or behind it: a along
 * the axis of the step, u along the next axis, v along the one after that. Bits of masks are numbered likewise.
 */
#define ITSELF 13
#define LAYER 0x1ffu

typedef struct cell {
    uint64_t key;         /* Morton code of its lowest voxel */
    uint32_t n;           /* points */
    uint32_t left;        /* of these in the left half, once split */
    uint32_t split : 1;   /* left is known */
    uint32_t alone : 1;   /* one point, and nothing in the 26 cells around: this also holds for all descendants */
    uint32_t around : 27; /* mask of the 27 cells around and at it: those that exist or, before the search, may exist */
} cell;

typedef struct walk {
    adcgs_geom_coder coder;
    adcgs_geom_models models;
    adcgs_memory *memory; /* accounts for everything here; may be NULL */
    int depth;
    uint32_t n;
    const uint64_t *codes; /* encoder: [n], ascending */
    cell *cells, *children;
    uint32_t *slots; /* numbers of cells */
    int slot_bits;   /* 0: bisect instead */
    size_t n_cells;
    size_t finger[27];         /* end position of the last bisection for each neighbour, in this step */
    uint64_t mask[3], unit[3]; /* bits of each axis; one cell in its direction */
} walk;

static size_t hash(const walk *w, uint64_t key)
{
    return (size_t)(key * UINT64_C(0x9e3779b97f4a7c15) >> (64 - w->slot_bits));
}

/* Bisect between bounds found by doubling steps away from the position of the same neighbour of the previous cell. */
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

/* The cell with this key, the key of neighbour 0..26 of the current cell; NULL if there is none. */
static const cell *find(walk *w, uint64_t key, int neighbour)
{
    if (w->slot_bits == 0)
        return bisect(w, key, neighbour);
    const size_t wrap = ((size_t)1 << w->slot_bits) - 1;
    size_t i = hash(w, key);
    for (int probe = 0; probe < PROBES_MAX && w->slots[i] != NO_CELL; probe++, i = (i + 1) & wrap)
        if (w->cells[w->slots[i]].key == key)
            return &w->cells[w->slots[i]];
    return NULL;
}

/* Cells without neighbours are neighbours of no cell, so they stay out of the table. */
static void fill_slots(walk *w)
{
    memset(w->finger, 0, sizeof w->finger);
    w->slot_bits = 3;
    while ((size_t)1 << w->slot_bits < 2 * w->n_cells)
        w->slot_bits++;
    const size_t size = (size_t)1 << w->slot_bits;
    memset(w->slots, 0xff, size * sizeof *w->slots);
    for (uint32_t c = 0; c < w->n_cells; c++) {
        if (w->cells[c].alone)
            continue;
        size_t i = hash(w, w->cells[c].key);
        int probe = 0;
        for (; probe < PROBES_MAX && w->slots[i] != NO_CELL; probe++)
            i = (i + 1) & (size - 1);
        if (probe == PROBES_MAX) {
            w->slot_bits = 0;
            return;
        }
        w->slots[i] = c;
    }
}

/* Along one axis, the key parts of the cells before, at and behind a cell, as far as these are in the cube. */
static void parts_along(const walk *w, int axis, uint64_t key, uint64_t part[3])
{
    const uint64_t mask = w->mask[axis];
    part[1] = key & mask;
    part[0] = (part[1] - w->unit[axis]) & mask;
    part[2] = ((part[1] | ~mask) + w->unit[axis]) & mask;
}

/* Add the information that cell number i around another one gives about the split of that one. */
static void take_neighbour(adcgs_geom_around *around, const cell *c, int i)
{
    const int layer = i / 9, straight = i % 9 == ITSELF % 9;
    if (layer != 1) {
        const int before = layer == 0;
        if (straight)
            *(before ? &around->before : &around->behind) += c->n;
        else
            *(before ? &around->ring_before : &around->ring_behind) += c->n;
    } else if (i % 2 == 0 && c->split) { /* not across an edge */
        around->lateral_left += c->left != 0;
        around->lateral_right += c->left < c->n;
    }
}

/* Search for the cells around that may exist. */
static void look_around(walk *w, cell *at, int axis, adcgs_geom_around *around)
{
    uint64_t a[3], u[3], v[3];
    parts_along(w, axis, at->key, a);
    parts_along(w, (axis + 1) % 3, at->key, u);
    parts_along(w, (axis + 2) % 3, at->key, v);
    for (uint32_t left = at->around & ~(1u << ITSELF); left; left &= left - 1) {
        const int i = __builtin_ctz(left);
        const cell *const found = find(w, a[i / 9] | u[i / 3 % 3] | v[i % 3], i);
        if (found)
            take_neighbour(around, found, i);
        else
            at->around &= ~(1u << i);
    }
    at->alone = at->n == 1 && at->around == 1u << ITSELF;
}

/* Move bit i of nine to bit 3 i. */
static uint32_t spread(uint32_t x)
{
    x = (x | x << 16) & 0x030000ff;
    x = (x | x << 8) & 0x0300f00f;
    x = (x | x << 4) & 0x030c30c3;
    return (x | x << 2) & 0x09249249;
}

/*
 * Mask of the cells that may exist around a half of a cell: the children of the cells around the cell. The step's axis comes last
 * in the numbers of the next step. Of the three layers along it, the left half has two within the cell's own layer.
 */
static uint32_t around_half(uint32_t around, int right)
{
    const uint32_t before = spread(around & LAYER), at = spread(around >> 9 & LAYER), behind = spread(around >> 18);
    return right ? at | at << 1 | behind << 2 : before | at << 1 | at << 2;
}

/* Number of codes in [first, first + n) whose bit is clear. */
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

static cell half(const cell *at, int right, uint64_t key, uint32_t n)
{
    return (cell){.key = key, .n = n, .alone = at->alone, .around = at->alone ? 0 : around_half(at->around, right)};
}

static size_t split_cells(walk *w, int step)
{
    const int axis = step % 3, left_bits = 3 * w->depth - 1 - step;
    const uint64_t bit = UINT64_C(1) << left_bits;
    size_t n_children = 0;
    uint32_t first = 0;
    for (size_t i = 0; i < w->n_cells; i++) {
        cell *at = &w->cells[i];
        adcgs_geom_around around = {0};
        if (!at->alone)
            look_around(w, at, axis, &around);
        const uint32_t given = w->codes ? count_left(w->codes + first, at->n, bit) : 0;
        at->left = adcgs_geom_code_split(&w->coder, step, at->n, bit, &around, given);
        at->split = 1;
        first += at->n;
        if (at->left)
            w->children[n_children++] = half(at, 0, at->key, at->left);
        if (at->left < at->n)
            w->children[n_children++] = half(at, 1, at->key | bit, at->n - at->left);
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
    w->cells[0] = (cell){.n = w->n, .around = 1u << ITSELF};
    w->n_cells = 1;
    for (int step = 0; step < 3 * w->depth; step++) {
        for (int axis = 0; axis < 3; axis++) {
            const int bits = (step + 2 - axis) / 3; /* number of splits of this axis so far */
            w->mask[axis] = X_MASK >> axis & ((UINT64_C(1) << 3 * w->depth) - 1);
            /* an axis not yet split has no neighbours: its part is 0 and stays 0 */
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
        return adcgs_fail(error, status, "positions of depth %d, expected 0..%d", depth, ADCGS_GEOM_DEPTH_MAX);
    if (n < 1 || n > UINT64_C(1) << 3 * depth)
        return adcgs_fail(error, status, "%u distinct positions cannot be of depth %d", n, depth);
    return ADCGS_OK;
}

/* Collect every third bit. */
static uint32_t gather(uint64_t code, int depth)
{
    uint32_t v = 0;
    for (int i = 0; i < depth; i++)
        v |= (uint32_t)(code >> 3 * i & 1) << i;
    return v;
}

adcgs_status adcgs_geom_decode(adcgs_range_dec *d, uint32_t n, int depth, uint32_t *voxels, adcgs_memory *memory,
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
    /* Every cell of the last step is one voxel with one point, because every split respected the capacities. */
    for (uint32_t i = 0; status == ADCGS_OK && i < n; i++)
        for (int axis = 0; axis < 3; axis++)
            voxels[3 * i + (uint32_t)axis] = gather(w->cells[i].key >> (2 - axis), depth);
    clear(w);
    adcgs_free(memory, w);
    return status;
}

static adcgs_status list_codes(uint64_t *codes, const uint32_t *voxels, uint32_t n, int depth, adcgs_error *error)
{
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t *voxel = voxels + 3 * (size_t)i;
        if ((voxel[0] | voxel[1] | voxel[2]) >> depth)
            return adcgs_fail(error, ADCGS_ERR_USAGE, "position %u is outside the cube of depth %d", i, depth);
        codes[i] = adcgs_morton(voxel);
        if (i && codes[i] <= codes[i - 1])
            return adcgs_fail(error, ADCGS_ERR_USAGE, "position %u does not follow its predecessor in Morton order", i);
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
