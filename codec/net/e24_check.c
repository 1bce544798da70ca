/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The E24 known-answer test (spec annex "Tables", "Known-answer network"): a
 * network of numbers from a linear congruential generator, 64 samples, and the
 * CRC-32C of its outputs, run with every kernel that this machine has.
 */
#include "base/cpu_detect.h"
#include "base/digest.h"
#include "base/strict.h"
#include "net/e24.h"

#define INPUTS 23
#define HIDDEN 37
#define CHANNELS 9
#define ANSWER 0x9e2a8e70u

static void fill(adcgs_layer *layer, int32_t *numbers, uint32_t rows, uint32_t cols, uint32_t *state)
{
    layer->w = (adcgs_tensor){.rows = rows, .cols = cols, .m = numbers};
    layer->b = (adcgs_tensor){.rows = rows, .cols = 1, .m = numbers + rows * cols};
    for (uint32_t i = 0; i < rows * cols; i++)
        layer->w.m[i] = (int32_t)adcgs_strict_draw(state, 255) - 127;
    for (uint32_t i = 0; i < rows; i++)
        layer->b.m[i] = (int32_t)adcgs_strict_draw(state, 20001) - 10000;
}

static adcgs_status check_level(const adcgs_net *net, const int16_t *x, adcgs_cpu_level level, adcgs_error *error)
{
    adcgs_e24 *e24;
    ADCGS_TRY(adcgs_e24_create(&e24, net, level, NULL, error));
    int16_t mu[CHANNELS * ADCGS_LANES];
    uint8_t si[CHANNELS * ADCGS_LANES], bytes[2 * CHANNELS * ADCGS_LANES];
    void *scratch = adcgs_alloc(NULL, 1, adcgs_e24_scratch(e24), error);
    uint32_t crc = 0;
    if (scratch) {
        adcgs_e24_eval(e24, x, mu, si, scratch);
        for (size_t i = 0; i < ADCGS_COUNTOF(mu); i++)
            adcgs_store_le16(bytes + 2 * i, (uint16_t)mu[i]);
        crc = adcgs_crc32c(adcgs_crc32c(0, bytes, sizeof bytes), si, sizeof si);
    }
    const int allocated = scratch != NULL;
    adcgs_free(NULL, scratch);
    adcgs_e24_free(&e24, NULL);
    if (!allocated)
        return adcgs_alloc_status(error);
    if (crc != ANSWER)
        return adcgs_fail(error, ADCGS_ERR_INTERNAL, "integer networks (%s): known-answer test gives 0x%08x, expected 0x%08x",
                          adcgs_cpu_name(level), crc, ANSWER);
    return ADCGS_OK;
}

adcgs_status adcgs_e24_check(adcgs_error *error)
{
    int32_t numbers[HIDDEN * (INPUTS + 1) + HIDDEN * (HIDDEN + 1) + 2 * CHANNELS * (HIDDEN + 1)];
    int16_t x[INPUTS * ADCGS_LANES];
    uint32_t state = 1;
    adcgs_net net = {.present = 1, .n_layers = 3, .in_shift = 3, .sigma_shift = 12, .sigma_offset = 32};
    fill(&net.layer[0], numbers, HIDDEN, INPUTS, &state);
    fill(&net.layer[1], numbers + HIDDEN * (INPUTS + 1), HIDDEN, HIDDEN, &state);
    fill(&net.layer[2], numbers + HIDDEN * (INPUTS + HIDDEN + 2), 2 * CHANNELS, HIDDEN, &state);
    net.layer[0].shift = 8;
    net.layer[1].shift = 7;
    net.layer[1].residual = 1;
    net.layer[2].shift = 4;
    for (size_t i = 0; i < ADCGS_COUNTOF(x); i++)
        x[i] = (int16_t)((int32_t)adcgs_strict_draw(&state, 65536) - 32768);
    for (int level = ADCGS_CPU_SCALAR; level <= (int)adcgs_cpu_best(); level++)
        ADCGS_TRY(check_level(&net, x, (adcgs_cpu_level)level, error));
    return ADCGS_OK;
}
