/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Body of the blend kernel (spec clause "Blending"): each 4x4 block of a tile
 * walks the splats whose mask has its bit, front to back, with transmittance
 * and colour in registers.
 */
#include "render/alpha.h"
#include "render/raster_isa.h"
#if ADCGS_LANES_ISA == 256
#include "render/bits_of.h"
#endif

/*
 * Number of a tile's splats that are processed at a time. Their records and lists stay in the first-level cache while all blocks
 * go through them, and blocks without remaining transmittance skip the later pieces.
 */
#define PIECE 128

typedef struct tile_piece {
    alignas(64) uint32_t splats[PIECE];
    alignas(64) uint32_t masks[PIECE];
    alignas(64) uint32_t list[PIECE + 16]; /* splats of one block, with padding for vectors stored past the last */
    uint32_t n;
} tile_piece;

/* Store splats and masks separately, so that either can be loaded as vectors. The padding past the last splat touches nothing. */
static void take_piece(tile_piece *piece, const adcgs_tile_entry *entries, uint32_t n, const adcgs_splat2d *splats)
{
    for (uint32_t i = 0; i < n; i++) {
        __builtin_prefetch(splats + entries[i].splat);
        piece->splats[i] = entries[i].splat;
        piece->masks[i] = entries[i].mask;
    }
    for (uint32_t i = n; i & 15; i++)
        piece->splats[i] = piece->masks[i] = 0;
    piece->n = n;
}

/* List the splats that touch a block; returns their number. */
#if ADCGS_LANES_ISA == 512
static uint32_t select_block(tile_piece *piece, int block)
{
    const __m512i bit = _mm512_set1_epi32(1 << block);
    uint32_t count = 0;
    for (uint32_t i = 0; i < piece->n; i += 16) {
        const __mmask16 hit = _mm512_test_epi32_mask(_mm512_load_si512(piece->masks + i), bit);
        _mm512_storeu_si512(piece->list + count, _mm512_maskz_compress_epi32(hit, _mm512_load_si512(piece->splats + i)));
        count += (uint32_t)__builtin_popcount(hit);
    }
    return count;
}
#elif ADCGS_LANES_ISA == 256
static uint32_t select_block(tile_piece *piece, int block)
{
    const __m256i digits = _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28);
    const __m128i to_sign = _mm_cvtsi32_si128(31 - block);
    uint32_t count = 0;
    for (uint32_t i = 0; i < piece->n; i += 8) {
        const __m256i masks = _mm256_sll_epi32(_mm256_load_si256((const __m256i *)(piece->masks + i)), to_sign);
        const uint32_t hit = (uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(masks));
        /* A lane's number is its index's low three bits: bits that the shift leaves above them do not matter. */
        const __m256i from = _mm256_srlv_epi32(_mm256_set1_epi32((int)bits_of[hit]), digits);
        const __m256i splats = _mm256_load_si256((const __m256i *)(piece->splats + i));
        _mm256_storeu_si256((__m256i *)(piece->list + count), _mm256_permutevar8x32_epi32(splats, from));
        count += (uint32_t)__builtin_popcount(hit);
    }
    return count;
}
#else
static uint32_t select_block(tile_piece *piece, int block)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < piece->n; i++) {
        piece->list[count] = piece->splats[i];
        count += piece->masks[i] >> block & 1;
    }
    return count;
}
#endif

typedef struct block_state {
    vf t, rgb[3];
} block_state;

LANES_INLINE vf power_at(const adcgs_splat2d *s, vf px, vf py)
{
    return splat_power(s, vf_sub(px, vf_set1(s->x)), vf_sub(py, vf_set1(s->y)));
}

/* Number of splats whose opacities in a block are computed together. */
#define TOGETHER 8

/*
 * Blend n splats of a list; returns whether transmittance remains. The opacities of several splats are computed first: they do
 * not depend on the transmittance. Interleaved with the blending they would stall the processor.
 */
LANES_INLINE int blend_block(block_state *state, const adcgs_splat2d *splats, const uint32_t *list, uint32_t n, float x, float y)
{
    const vf px = vf_add(vf_load(pixel_x), vf_set1(x)), py = vf_add(vf_load(pixel_y), vf_set1(y)), t_min = vf_set1(ADCGS_T_MIN);
    alignas(64) float opacity[TOGETHER][16];
    vf t = state->t, red = state->rgb[0], green = state->rgb[1], blue = state->rgb[2];
    int light = 1;
    for (uint32_t i = 0; i < n && light; i += TOGETHER) {
        const uint32_t some = ADCGS_MIN(n - i, TOGETHER);
        for (uint32_t k = 0; k < some; k++)
            vf_store(opacity[k], power_at(splats + list[i + k], px, py));
        for (uint32_t k = 0; k < some; k++)
            vf_store(opacity[k], alpha_of_power(vf_load(opacity[k])));
        for (uint32_t k = 0; k < some && light; k++) {
            const adcgs_splat2d *s = splats + list[i + k];
            const vf alpha = vf_load(opacity[k]), weight = vf_mul(alpha, t);
            red = vf_fma(vf_set1(s->rgb[0]), weight, red);
            green = vf_fma(vf_set1(s->rgb[1]), weight, green);
            blue = vf_fma(vf_set1(s->rgb[2]), weight, blue);
            t = vf_fnma(alpha, t, t);
            light = vm_any(vf_ge(t, t_min));
        }
    }
    *state = (block_state){t, {red, green, blue}};
    return light;
}

static void write_block(const adcgs_blend_job *job, int x, int y, const block_state *state)
{
    const size_t plane = (size_t)job->width * (size_t)job->height, at = (size_t)y * (size_t)job->width + (size_t)x;
    const size_t stride = (size_t)job->width;
    const int columns = job->width - x, lines = job->height - y;
    for (int c = 0; c < 3; c++) {
        /* Adding zero turns -0 into +0: neither a black background nor a splat that adds nothing decides a zero's sign. */
        const vf value = vf_add(vf_fma(state->t, vf_set1(job->background[c]), state->rgb[c]), vf_set1(0.0f));
        float *to = job->rgb + (size_t)c * plane + at;
        if (columns >= 4 && lines >= 4) {
            float *const rows[4] = {to, to + stride, to + 2 * stride, to + 3 * stride};
            vf_store_rows(rows, value);
            continue;
        }
        alignas(64) float v[16];
        vf_store(v, value);
        for (int j = 0; j < 4 && j < lines; j++)
            for (int i = 0; i < 4 && i < columns; i++)
                to[(size_t)j * stride + (size_t)i] = v[4 * j + i];
    }
}

/* Blend a piece of a tile's splats into its blocks; returns the blocks with remaining transmittance. */
LANES_INLINE uint32_t blend_piece(block_state *blocks, uint32_t alive, tile_piece *piece, const adcgs_splat2d *splats,
                                  const float at[2])
{
    for (uint32_t left = alive; left; left &= left - 1) {
        const int block = __builtin_ctz(left);
        const uint32_t n = select_block(piece, block);
        const float x = at[0] + (float)(4 * (block & 3)), y = at[1] + (float)(4 * (block >> 2));
        if (!blend_block(blocks + block, splats, piece->list, n, x, y))
            alive &= ~((uint32_t)1 << block);
    }
    return alive;
}

static void blend(const adcgs_blend_job *job, int tile)
{
    const int tile_x = tile % job->tiles_x * ADCGS_TILE, tile_y = tile / job->tiles_x * ADCGS_TILE;
    const float at[2] = {(float)tile_x, (float)tile_y};
    const uint32_t end = job->tile_start[tile + 1];
    block_state blocks[16];
    tile_piece piece;
    uint32_t alive = 0;
    for (int block = 0; block < 16; block++) {
        const int x = tile_x + 4 * (block & 3), y = tile_y + 4 * (block >> 2), seen = x < job->width && y < job->height;
        const vf none = vf_set1(0.0f);
        blocks[block] = (block_state){seen ? initial_transmittance(x, y, job->width, job->height) : none, {none, none, none}};
        alive |= (uint32_t)seen << block;
    }
    for (uint32_t i = job->tile_start[tile]; i < end && alive; i += PIECE) {
        take_piece(&piece, job->entries + i, ADCGS_MIN(end - i, PIECE), job->splats);
        alive = blend_piece(blocks, alive, &piece, job->splats, at);
    }
    for (int block = 0; block < 16; block++) {
        const int x = tile_x + 4 * (block & 3), y = tile_y + 4 * (block >> 2);
        if (x < job->width && y < job->height)
            write_block(job, x, y, &blocks[block]);
        if (job->transmittance)
            vf_store(job->transmittance + ((size_t)tile * 16 + (size_t)block) * 16, blocks[block].t);
    }
}
