/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Untrusted files of splats, in all formats. Mutations of archives are inside their files; checksums are repaired. */
#include "config.h" /* for HAVE_SOG */

#include "fuzz.h"

#include "media/splats/splats.h"

#ifdef HAVE_SOG
#include <zlib.h>
#endif

#include <math.h>

const char *const adcgs_fuzz_seeds[] = {"tests/fuzz/seeds/splats", "tests/fuzz/seeds/ply", NULL};

/** Accepted splats fulfil the promises of the header. */
static void check(const adcgs_splats *s)
{
    FUZZ_REQUIRE(s->n > 0 && s->n <= ADCGS_SPLATS_MAX && (s->degree == 0) == (s->harmonics == NULL));
    for (uint32_t i = 0; i < s->n; i++) {
        float length = 0.0f;
        FUZZ_REQUIRE(s->opacity[i] >= 0.0f && s->opacity[i] <= 1.0f);
        for (int a = 0; a < 3; a++) {
            FUZZ_REQUIRE(isfinite(s->mean[a][i]) && isfinite(s->colour[a][i]));
            FUZZ_REQUIRE(isnormal(s->scale[a][i]) && s->scale[a][i] > 0.0f);
        }
        for (int a = 0; a < 4; a++)
            length += s->rotation[a][i] * s->rotation[a][i];
        FUZZ_REQUIRE(fabsf(length - 1.0f) < 1e-5f);
    }
}

#ifdef HAVE_SOG

/* Of ZIP's directory. */
#define ENTRY 46
#define LOCAL 30
#define END 22

/** The bytes of a stored file by its entry in the directory; NULL if they do not lie in the archive. */
static uint8_t *stored_bytes(uint8_t *data, size_t size, const uint8_t *entry, size_t *bytes)
{
    const size_t local = adcgs_load_le32(entry + 42);
    *bytes = adcgs_load_le32(entry + 20);
    if (adcgs_load_le16(entry + 10) || local > size || size - local < LOCAL)
        return NULL;
    const size_t head = LOCAL + (size_t)adcgs_load_le16(data + local + 26) + adcgs_load_le16(data + local + 28);
    return size - local >= head && size - local - head >= *bytes ? data + local + head : NULL;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max, unsigned int seed)
{
    unsigned n = 0;
    if (size < ENTRY || memcmp(data, "PK", 2) || seed % 4 == 0)
        return LLVMFuzzerMutate(data, size, max);
    if (!memcmp(data + size - END, "PK\5\6", 4))
        memset(data + size - 2, 0, 2); /* the length of the comment, which fuzz_main.c changes */
    for (size_t at = 0; at + ENTRY <= size; at++) {
        size_t bytes;
        uint8_t *file;
        if (memcmp(data + at, "PK\1\2", 4) || !(file = stored_bytes(data, size, data + at, &bytes)))
            continue;
        if (bytes && seed / 4 % 8 == n++) {
            file[(seed >> 5) % bytes] ^= (uint8_t)(seed >> 16);
            LLVMFuzzerMutate(file, bytes, bytes);
        }
        adcgs_store_le32(data + at + 16, (uint32_t)crc32(0, file, (uInt)bytes));
    }
    return size;
}

#endif

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    adcgs_splats splats;
    adcgs_error error = {ADCGS_OK, ""};
    uint8_t *text = fuzz_file(data, size);
    const adcgs_status status = adcgs_splats_parse(&splats, text, size, "fuzz.ply", &error);
    FUZZ_REQUIRE(status == ADCGS_OK || (error.status == status && error.text[0] && !strchr(error.text, '\n')));
    FUZZ_REQUIRE(status == ADCGS_OK || (splats.n == 0 && splats.block == NULL && splats.harmonics == NULL));
    if (status == ADCGS_OK)
        check(&splats);
    adcgs_splats_free(&splats);
    free(text);
    return 0;
}
