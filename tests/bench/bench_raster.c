/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Speed of the renderer, forward and backward, beside a plain tile rasteriser
 * (16x16 tiles, squares of three standard deviations, one pixel at a time) on
 * the same projected splats. Prints medians of wall time; run on a quiet machine.
 *
 *     bench_raster [level]        level: scalar, avx2 or avx512
 */
#include "train/raster.h"
#include "unit/pixels_scene.h"

#include <stdio.h>
#include <time.h>

#define RUNS 21
#define OVERLAP 36.0

static double now_ms(void)
{
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static double median(double *v)
{
    qsort(v, RUNS, sizeof *v, compare);
    return v[RUNS / 2];
}

/* ---- The plain rasteriser ---- */

typedef struct plain {
    const adcgs_kept *kept;
    uint32_t *start, *list;
    int width, height;
} plain;

/* Tiles of the square of three standard deviations around a splat: [x0, x1) x [y0, y1). */
static void plain_tiles(const adcgs_splat2d *s, const adcgs_kept *k, int tile[4])
{
    /* The larger eigenvalue of the covariance from the scaled conic. */
    const double a = -1.3862943611 * s->a, b = -0.69314718056 * s->b, c = -1.3862943611 * s->c;
    const double half = 0.5 * (a + c), least = half - sqrt(fmax(0.0, half * half - a * c + b * b));
    const double radius = ceil(3.0 / sqrt(fmax(least, 1e-12)));
    tile[0] = (int)fmin(fmax(floor((s->x - radius) / 16.0), 0.0), k->tiles_x);
    tile[1] = (int)fmin(fmax(floor((s->y - radius) / 16.0), 0.0), k->tiles_y);
    tile[2] = (int)fmin(fmax(floor((s->x + radius) / 16.0) + 1.0, 0.0), k->tiles_x);
    tile[3] = (int)fmin(fmax(floor((s->y + radius) / 16.0) + 1.0, 0.0), k->tiles_y);
}

static void plain_bin(plain *p)
{
    const adcgs_kept *k = p->kept;
    const int tiles = k->tiles_x * k->tiles_y;
    int tile[4];
    p->start = calloc((size_t)tiles + 2, sizeof *p->start);
    for (uint32_t i = 0; i < k->n_splats; i++) {
        plain_tiles(k->splats + i, k, tile);
        for (int y = tile[1]; y < tile[3]; y++)
            for (int x = tile[0]; x < tile[2]; x++)
                p->start[y * k->tiles_x + x + 2]++;
    }
    for (int t = 0; t < tiles; t++)
        p->start[t + 2] += p->start[t + 1];
    p->list = malloc(((size_t)p->start[tiles + 1] + 1) * sizeof *p->list);
    for (uint32_t i = 0; i < k->n_splats; i++) {
        plain_tiles(k->splats + i, k, tile);
        for (int y = tile[1]; y < tile[3]; y++)
            for (int x = tile[0]; x < tile[2]; x++)
                p->list[p->start[y * k->tiles_x + x + 1]++] = i;
    }
}

static void plain_pixel(const plain *p, int tile, int x, int y, const float background[3], float *rgb)
{
    const size_t plane = (size_t)p->width * (size_t)p->height, at = (size_t)y * (size_t)p->width + (size_t)x;
    float t = 1.0f, colour[3] = {0.0f, 0.0f, 0.0f};
    for (uint32_t i = p->start[tile]; i < p->start[tile + 1] && t >= 1e-4f; i++) {
        const adcgs_splat2d *s = p->kept->splats + p->list[i];
        const float dx = (float)x + 0.5f - s->x, dy = (float)y + 0.5f - s->y;
        const float alpha = exp2f(s->a * dx * dx + s->b * dx * dy + s->c * dy * dy + s->log2_opacity);
        if (alpha < 1.0f / 255.0f)
            continue;
        for (int c = 0; c < 3; c++)
            colour[c] += s->rgb[c] * alpha * t;
        t *= 1.0f - alpha;
    }
    for (size_t c = 0; c < 3; c++)
        rgb[c * plane + at] = colour[c] + t * background[c];
}

static double plain_forward(const adcgs_kept *kept, const adcgs_view *view, const float background[3], float *rgb)
{
    const double start = now_ms();
    plain p = {.kept = kept, .width = view->width, .height = view->height};
    plain_bin(&p);
    for (int y = 0; y < p.height; y++)
        for (int x = 0; x < p.width; x++)
            plain_pixel(&p, y / 16 * kept->tiles_x + x / 16, x, y, background, rgb);
    free(p.start);
    free(p.list);
    return now_ms() - start;
}

/* ---- Ours ---- */

typedef struct bench {
    adcgs_primitives primitives;
    adcgs_view view;
    adcgs_raster *raster;
    adcgs_raster_back *back;
    adcgs_raster_grads grads;
    float *rgb, *grad, *plain;
} bench;

static const float background[3] = {0.1f, 0.2f, 0.3f};

static void check(adcgs_status status)
{
    if (status == ADCGS_OK)
        return;
    fprintf(stderr, "bench_raster: %s\n", adcgs_status_name(status));
    exit(1);
}

static double forward_ms(bench *b, int keep)
{
    double ms[RUNS];
    for (int i = 0; i < RUNS; i++) {
        const double start = now_ms();
        check(adcgs_raster_forward(b->raster, &b->primitives, &b->view, background, 0.3f, b->rgb, keep, NULL));
        ms[i] = now_ms() - start;
    }
    return median(ms);
}

static double both_ms(bench *b)
{
    double ms[RUNS];
    for (int i = 0; i < RUNS; i++) {
        const double start = now_ms();
        check(adcgs_raster_forward(b->raster, &b->primitives, &b->view, background, 0.3f, b->rgb, 1, NULL));
        check(adcgs_raster_backward(b->back, b->raster, &b->primitives, &b->view, background, 0.3f, b->rgb, b->grad, &b->grads,
                                    NULL));
        ms[i] = now_ms() - start;
    }
    return median(ms);
}

/* Listed (pixel, splat) pairs, before blocks stop. */
static double pairs(const adcgs_kept *k)
{
    uint64_t blocks = 0;
    for (uint32_t i = 0; i < k->tile_start[k->tiles_x * k->tiles_y]; i++)
        for (uint32_t mask = k->entries[i].mask; mask; mask &= mask - 1)
            blocks++;
    return 16.0 * (double)blocks;
}

static void run(uint32_t n, int size, int threads, adcgs_cpu_level level)
{
    static const double origin[3] = {0.0, 0.0, 0.0};
    const size_t values = 3 * (size_t)size * (size_t)size;
    scene_splats scene = scene_room(n, OVERLAP, 1);
    const adcgs_camera camera = scene_camera(size, size);
    adcgs_pool *pool;
    adcgs_kept kept;
    bench b = {.primitives = scene_primitives(&scene)};
    float *grads = adcgs_alloc(NULL, (size_t)scene.n * (SCENE_ARRAYS + 2), sizeof(float), NULL);
    for (size_t i = 0; i < 3; i++) {
        b.grads.mean[i] = grads + i * scene.n;
        b.grads.scale[i] = grads + (3 + i) * scene.n;
        b.grads.colour[i] = grads + (11 + i) * scene.n;
    }
    for (size_t i = 0; i < 4; i++)
        b.grads.rotation[i] = grads + (6 + i) * scene.n;
    b.grads.opacity = grads + (size_t)10 * scene.n;
    b.grads.weight = grads + (size_t)14 * scene.n;
    b.grads.screen = grads + (size_t)15 * scene.n;
    b.rgb = malloc(values * sizeof(float));
    b.plain = malloc(values * sizeof(float));
    b.grad = malloc(values * sizeof(float));
    for (size_t i = 0; i < values; i++)
        b.grad[i] = sinf((float)i);
    check(adcgs_view_init(&b.view, &camera, origin, 1.0, NULL));
    check(adcgs_pool_create(&pool, threads, NULL));
    check(adcgs_raster_create(&b.raster, level, pool, NULL, NULL));
    check(adcgs_raster_back_create(&b.back, level, pool, NULL));
    const double both = both_ms(&b), forward = forward_ms(&b, 0);
    check(adcgs_raster_forward(b.raster, &b.primitives, &b.view, background, 0.3f, b.rgb, 1, NULL));
    adcgs_raster_kept(b.raster, &kept);
    const double count = pairs(&kept), plain_ms = plain_forward(&kept, &b.view, background, b.plain);
    printf("%6u splats %4d^2 %d threads: ", n, size, threads);
    printf("forward %7.3f ms %5.2f ns/pair, ", forward, 1e6 * forward / count);
    printf("both %7.3f ms %5.2f ns/pair, ", both, 1e6 * both / count);
    printf("plain %8.2f ms, ratio %5.1f\n", plain_ms, plain_ms / forward);
    adcgs_raster_back_free(&b.back);
    adcgs_raster_free(&b.raster);
    adcgs_pool_free(&pool);
    adcgs_free(NULL, grads);
    adcgs_free(NULL, scene.data);
    free(b.rgb);
    free(b.plain);
    free(b.grad);
}

int main(int argc, char **argv)
{
    static const uint32_t counts[] = {5000, 20000, 50000};
    static const int sizes[] = {200, 400, 800};
    adcgs_cpu_level level = ADCGS_CPU_AUTO;
    if (argc > 1 && adcgs_cpu_parse(argv[1], &level)) {
        fprintf(stderr, "usage: bench_raster [scalar|avx2|avx512]\n");
        return 2;
    }
    for (int threads = 1; threads <= 2; threads++)
        for (size_t s = 0; s < ADCGS_COUNTOF(sizes); s++)
            for (size_t n = 0; n < ADCGS_COUNTOF(counts); n++)
                run(counts[n], sizes[s], threads, level);
    return 0;
}
