/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The loss of an image: divides it into strips, runs them on the pool, and sums in a fixed order. */
#include "config.h"

#include "grad/loss.h"

#include "grad/loss_strip.h"

#define CHANNELS 3                                             /* red, green, blue; definition */
#define STRIPS_MAX (CHANNELS * (16384 / ADCGS_LOSS_STRIP + 1)) /* strips of the largest image; arithmetic */
#define SIZE_MAX_PIXELS 16384 /* pixels: maximum width and height; definition, as in the stream syntax */
/* Rows of a unit when there is no SSIM; chosen by hand, not measured. */
#define BAND 32

struct adcgs_loss {
    adcgs_pool *pool;
    adcgs_loss_strip_fn kernel;
    adcgs_loss_scratch *scratch; /* [threads] */
    adcgs_loss_strip strip[STRIPS_MAX];
};

static adcgs_loss_strip_fn kernel_of(adcgs_cpu_level level)
{
#ifdef HAVE_AVX512
    if (level >= ADCGS_CPU_AVX512)
        return adcgs_loss_strip_avx512;
#endif
#ifdef HAVE_AVX2
    if (level >= ADCGS_CPU_AVX2)
        return adcgs_loss_strip_avx2;
#endif
    (void)level;
    return adcgs_loss_strip_scalar;
}

adcgs_status adcgs_loss_create(adcgs_loss **out, adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error)
{
    adcgs_cpu_level level;
    *out = NULL;
    ADCGS_TRY(adcgs_cpu_resolve(cpu, &level, error));
    adcgs_loss *const loss = adcgs_alloc(NULL, 1, sizeof *loss, error);
    if (!loss)
        return adcgs_alloc_status(error);
    loss->pool = pool;
    loss->kernel = kernel_of(level);
    loss->scratch = adcgs_alloc(NULL, (size_t)adcgs_pool_threads(pool), sizeof *loss->scratch, error);
    if (!loss->scratch) {
        adcgs_free(NULL, loss);
        return adcgs_alloc_status(error);
    }
    *out = loss;
    return ADCGS_OK;
}

void adcgs_loss_free(adcgs_loss **loss)
{
    if (*loss) {
        adcgs_free(NULL, (*loss)->scratch);
        adcgs_free(NULL, *loss);
    }
    *loss = NULL;
}

static void run_strip(void *arg, int index, int thread)
{
    adcgs_loss *const loss = arg;
    loss->kernel(&loss->strip[index], loss->scratch + thread);
}

/* Without SSIM: strip->first and count are rows. */
static void run_band(void *arg, int index, int thread)
{
    adcgs_loss *const loss = arg;
    adcgs_loss_strip *const s = &loss->strip[index];
    (void)thread;
    s->l1 = s->mse = s->ssim = 0.0;
    for (int row = s->first; row < s->first + s->count; row++) {
        const size_t from = (size_t)row * (size_t)s->width;
        double l1 = 0.0, mse = 0.0;
        for (size_t i = from; i < from + (size_t)s->width; i++) {
            const float d = s->image[i] - s->target[i];
            s->grad[i] = s->square_scale * d + (d > 0.0f ? s->l1_scale : d < 0.0f ? -s->l1_scale : 0.0f);
            l1 += d < 0.0f ? -d : d;
            mse += (double)d * d;
        }
        s->l1 += l1;
        s->mse += mse;
    }
}

/* Divides `size` into units of at most `most`. Returns the size of a unit. */
static int unit_size(int size, int most)
{
    const int units = (size + most - 1) / most;
    return (size + units - 1) / units;
}

/* Places stripes over a strip's columns and the columns of their windows, within the image if it is wide enough. */
static void place_stripes(adcgs_loss_strip *s)
{
    const int seen = ADCGS_MIN(s->count + 4 * ADCGS_LOSS_HALO, s->width), pairs = 2 * ADCGS_LOSS_LANES;
    s->stripe = ADCGS_MAX(2 * ((seen + pairs - 1) / pairs), ADCGS_LOSS_HALO + 1);
    s->begin = ADCGS_MAX(0, ADCGS_MIN(s->first - 2 * ADCGS_LOSS_HALO, s->width - ADCGS_LOSS_LANES * s->stripe));
}

adcgs_status adcgs_loss_image(adcgs_loss *loss, const float *image, const float *target, int width, int height,
                              const adcgs_loss_shares *shares, float *grad, adcgs_loss_value *value, adcgs_error *error)
{
    if (width < 1 || height < 1 || width > SIZE_MAX_PIXELS || height > SIZE_MAX_PIXELS)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "loss: image of %dx%d, expected 1..%d", width, height, SIZE_MAX_PIXELS);
    const size_t plane = (size_t)width * (size_t)height;
    const float errors = (1.0f - shares->ssim) * (float)(1.0 / (CHANNELS * (double)plane));
    const int bands = shares->ssim == 0.0f, length = bands ? height : width;
    const int unit = unit_size(length, bands                     ? ADCGS_MAX(BAND, height / 64)
                                       : width > ADCGS_LOSS_SPAN ? ADCGS_LOSS_STRIP
                                                                 : ADCGS_LOSS_SPAN);
    int n = 0;
    for (int c = 0; c < CHANNELS; c++)
        for (int first = 0; first < length; first += unit)
            loss->strip[n++] = (adcgs_loss_strip){.image = image + (size_t)c * plane,
                                                  .target = target + (size_t)c * plane,
                                                  .grad = grad + (size_t)c * plane,
                                                  .width = width,
                                                  .height = height,
                                                  .first = first,
                                                  .count = ADCGS_MIN(unit, length - first),
                                                  .l1_scale = (1.0f - shares->square) * errors,
                                                  .square_scale = shares->square / ADCGS_LOSS_EVEN * errors,
                                                  .ssim_scale = -shares->ssim * (float)(1.0 / (CHANNELS * (double)plane))};
    for (int i = 0; i < n && !bands; i++)
        place_stripes(&loss->strip[i]);
    adcgs_pool_run(loss->pool, bands ? run_band : run_strip, loss, n);
    *value = (adcgs_loss_value){0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i < n; i++) {
        value->l1 += loss->strip[i].l1;
        value->mse += loss->strip[i].mse;
        value->ssim += loss->strip[i].ssim;
    }
    const double count = CHANNELS * (double)plane;
    value->l1 /= count;
    value->mse /= count;
    value->ssim /= count;
    const double square = (double)shares->square, ssim = (double)shares->ssim;
    value->loss = (1.0 - ssim) * ((1.0 - square) * value->l1 + square * value->mse / (2.0 * (double)ADCGS_LOSS_EVEN)) +
                  (bands ? 0.0 : ssim * (1.0 - value->ssim));
    return ADCGS_OK;
}
