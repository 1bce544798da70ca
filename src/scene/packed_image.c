/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Samples of an image in 8 or 16 bits, or as binary32. */
#include "config.h"

#include "scene/packed_image.h"

#include "scene/image_values.h"

#include <stdlib.h>
#include <sys/mman.h>

#define FULL_8 255.0f    /* largest sample of 8 bits; arithmetic */
#define FULL_16 65535.0f /* largest sample of 16 bits; arithmetic */

/* ---- Samples ---- */

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/** The nearest multiple of 1/full, of a value that may be anything. */
static inline int32_t round_to(float value, float full)
{
    const float low = value > 0.0f ? value : 0.0f;
    return (int32_t)((low < 1.0f ? low : 1.0f) * full + 0.5f);
}

/** Packs n samples that lie `step` apart. \return true if no bit is lost */
static int pack(void *to, int bytes, const float *from, size_t n, size_t step)
{
    uint32_t lost = 0;
    for (size_t i = 0; bytes == 1 && i < n; i++) {
        const int32_t level = round_to(from[i * step], FULL_8);
        ((uint8_t *)to)[i] = (uint8_t)level;
        lost |= bits_of((float)level / FULL_8) ^ bits_of(from[i * step]);
    }
    for (size_t i = 0; bytes == 2 && i < n; i++) {
        const int32_t level = round_to(from[i * step], FULL_16);
        ((uint16_t *)to)[i] = (uint16_t)level;
        lost |= bits_of((float)level / FULL_16) ^ bits_of(from[i * step]);
    }
    for (size_t i = 0; bytes == 4 && i < n; i++)
        ((float *)to)[i] = from[i * step];
    return !lost;
}

/* ---- Images ---- */

/*
 * Large images have pages of their own, which go back to the system at once. In the heap they would leave gaps, into which images
 * of another size do not fit. Bytes; chosen by hand, not measured.
 */
#define OWN_PAGES ((size_t)1 << 17)

static void *get_memory(size_t bytes)
{
    if (bytes < OWN_PAGES)
        return malloc(bytes);
    void *const pages = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return pages == MAP_FAILED ? NULL : pages;
}

static void free_memory(void *memory, size_t bytes)
{
    if (bytes < OWN_PAGES)
        free(memory);
    else if (memory)
        munmap(memory, bytes);
}

static size_t plane_of(const adcgs_packed_image *p)
{
    return (size_t)p->width * (size_t)p->height;
}

/** A row of a channel. */
static char *row_of(const adcgs_packed_image *p, int channel, int y)
{
    return (char *)p->data + ((size_t)channel * plane_of(p) + (size_t)y * (size_t)p->width) * (size_t)p->bytes;
}

adcgs_status adcgs_packed_image_init(adcgs_packed_image *packed, int width, int height, int channels, const char *path,
                                     adcgs_error *error)
{
    *packed = (adcgs_packed_image){.width = width, .height = height, .channels = channels, .bytes = 1};
    packed->data = get_memory(adcgs_packed_image_size(packed));
    return packed->data ? ADCGS_OK
                        : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %dx%d pixels", path, width, height);
}

void adcgs_packed_image_clear(adcgs_packed_image *packed)
{
    free_memory(packed->data, adcgs_packed_image_size(packed));
    *packed = (adcgs_packed_image){0};
}

size_t adcgs_packed_image_size(const adcgs_packed_image *packed)
{
    return plane_of(packed) * (size_t)packed->channels * (size_t)packed->bytes;
}

/** Replaces the samples by twice as wide ones. */
static adcgs_status widen(adcgs_packed_image *packed, const char *path, adcgs_error *error)
{
    adcgs_packed_image wide = *packed;
    float *const row = malloc((size_t)packed->width * sizeof *row);
    wide.bytes = 2 * packed->bytes;
    wide.data = get_memory(adcgs_packed_image_size(&wide));
    for (int c = 0; row && wide.data && c < packed->channels; c++)
        for (int y = 0; y < packed->rows; y++) {
            adcgs_values_widen(row, 1, row_of(packed, c, y), packed->bytes, (size_t)packed->width);
            pack(row_of(&wide, c, y), wide.bytes, row, (size_t)packed->width, 1);
        }
    free(row);
    if (!row || !wide.data) {
        free_memory(wide.data, adcgs_packed_image_size(&wide));
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %dx%d pixels", path, packed->width, packed->height);
    }
    free_memory(packed->data, adcgs_packed_image_size(packed));
    *packed = wide;
    return ADCGS_OK;
}

static int append_row(adcgs_packed_image *packed, const float *from)
{
    int fits = 1;
    for (int c = 0; c < packed->channels; c++)
        fits &= pack(row_of(packed, c, packed->rows), packed->bytes, from + c, (size_t)packed->width, (size_t)packed->channels);
    return fits;
}

adcgs_status adcgs_packed_image_append(adcgs_packed_image *packed, const float *from, int n, const char *path, adcgs_error *error)
{
    for (int i = 0; i < n; i++, packed->rows++)
        while (!append_row(packed, from + (size_t)i * (size_t)packed->width * (size_t)packed->channels))
            ADCGS_TRY(widen(packed, path, error));
    return ADCGS_OK;
}

void adcgs_packed_image_rows(const adcgs_packed_image *packed, int y, int n, float *to)
{
    const size_t width = (size_t)packed->width, channels = (size_t)packed->channels;
    for (int i = 0; i < n; i++, to += width * channels)
        for (int c = 0; c < packed->channels; c++)
            adcgs_values_widen(to + c, channels, row_of(packed, c, y + i), packed->bytes, width);
}

void adcgs_packed_image_planes(const adcgs_packed_image *packed, float *to)
{
    adcgs_values_widen(to, 1, packed->data, packed->bytes, plane_of(packed) * (size_t)packed->channels);
}
