/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Body of the blend kernel (spec clause "Blending"): each 4x4 block of a tile
 * walks the splats whose mask has its bit, front to back, with transmittance
 * and colour in registers.
 */
#include "render/alpha.h"
#include "render/raster_isa.h"

/* Splats and masks of a tile apart, so that vectors of either can be read. */
static void split_entries(const adcgs_tile_entry *entries, uint32_t n, uint32_t *splats, uint32_t *masks)
{
    for (uint32_t i = 0; i < n; i++) {
        splats[i] = entries[i].splat;
        masks[i] = entries[i].mask;
    }
    for (uint32_t i = n; i & 15; i++)
        masks[i] = 0;
}

#if ADCGS_LANES_ISA == 512
static uint32_t select_block(uint32_t *list, const uint32_t *splats, const uint32_t *masks, uint32_t n, int block)
{
    const __m512i bit = _mm512_set1_epi32(1 << block);
    uint32_t count = 0;
    for (uint32_t i = 0; i < n; i += 16) {
        const __mmask16 hit = _mm512_test_epi32_mask(_mm512_load_si512(masks + i), bit);
        _mm512_storeu_si512(list + count, _mm512_maskz_compress_epi32(hit, _mm512_load_si512(splats + i)));
        count += (uint32_t)__builtin_popcount(hit);
    }
    return count;
}
#else
static uint32_t select_block(uint32_t *list, const uint32_t *splats, const uint32_t *masks, uint32_t n, int block)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < n; i++) {
        list[count] = splats[i];
        count += masks[i] >> block & 1;
    }
    return count;
}
#endif

typedef struct block_state {
    vf t, rgb[3];
} block_state;

LANES_INLINE vf opacity_at(const adcgs_splat2d *s, vf px, vf py)
{
    return splat_alpha(s, vf_sub(px, vf_set1(s->x)), vf_sub(py, vf_set1(s->y)));
}

/*
 * list[n] is one more splat, any. The opacity of each splat is computed while the one before is blended: nothing in it waits
 * for the transmittance.
 */
LANES_INLINE block_state blend_block(const adcgs_splat2d *splats, const uint32_t *list, uint32_t n, float x, float y, vf t)
{
    const vf px = vf_add(vf_load(pixel_x), vf_set1(x)), py = vf_add(vf_load(pixel_y), vf_set1(y)), t_min = vf_set1(ADCGS_T_MIN);
    vf red = vf_set1(0.0f), green = red, blue = red, alpha = opacity_at(splats + list[0], px, py);
    for (uint32_t i = 0; i < n; i++) {
        if (!vm_any(vf_ge(t, t_min)))
            break;
        const adcgs_splat2d *s = splats + list[i];
        const vf next = opacity_at(splats + list[i + 1], px, py), weight = vf_mul(alpha, t);
        red = vf_fma(vf_set1(s->rgb[0]), weight, red);
        green = vf_fma(vf_set1(s->rgb[1]), weight, green);
        blue = vf_fma(vf_set1(s->rgb[2]), weight, blue);
        t = vf_fnma(alpha, t, t);
        alpha = next;
    }
    return (block_state){t, {red, green, blue}};
}

static void write_block(const adcgs_blend_job *job, int x, int y, const block_state *state)
{
    const size_t plane = (size_t)job->width * (size_t)job->height, at = (size_t)y * (size_t)job->width + (size_t)x;
    const size_t stride = (size_t)job->width;
    const int columns = job->width - x, lines = job->height - y;
    for (int c = 0; c < 3; c++) {
        /* Adding zero makes -0 into +0: neither a black background nor a splat that adds nothing decides a zero's sign. */
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

static void blend(const adcgs_blend_job *job, int tile, uint32_t *scratch)
{
    const uint32_t first = job->tile_start[tile], n = job->tile_start[tile + 1] - first, half = (n + 31) & ~(uint32_t)15;
    uint32_t *splats = scratch, *masks = scratch + half, *list = scratch + 2 * (size_t)half;
    split_entries(job->entries + first, n, splats, masks);
    const int tile_x = tile % job->tiles_x * ADCGS_TILE, tile_y = tile / job->tiles_x * ADCGS_TILE;
    for (int block = 0; block < 16; block++) {
        const int x = tile_x + 4 * (block & 3), y = tile_y + 4 * (block >> 2);
        block_state state = {vf_set1(0.0f), {vf_set1(0.0f), vf_set1(0.0f), vf_set1(0.0f)}};
        if (x < job->width && y < job->height) {
            const uint32_t count = select_block(list, splats, masks, n, block);
            list[count] = n ? splats[0] : 0;
            state = blend_block(job->splats, list, count, (float)x, (float)y,
                                initial_transmittance(x, y, job->width, job->height));
            write_block(job, x, y, &state);
        }
        if (job->transmittance)
            vf_store(job->transmittance + ((size_t)tile * 16 + (size_t)block) * 16, state.t);
    }
}
