/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Untrusted files of splats over time: every reader, and its states at three times. */
#include "config.h"

#include "fuzz.h"

#include "media/dynamic/dynamic_splats.h"

#include <math.h>
#if defined(HAVE_SPZ) || defined(HAVE_SOG)
#include <zlib.h>
#endif

const char *const adcgs_fuzz_seeds[] = {"tests/fuzz/seeds/dynamic", "tests/fuzz/seeds/splats", "tests/fuzz/regressions/dynamic",
                                        NULL};

/* ---- Archives ---- */

/* Origin: definition (ZIP, APPNOTE.TXT 4.3.7, 4.3.12, 4.3.16). */
#define LOCAL 30   /* bytes of a file's header, without its name */
#define CENTRAL 46 /* bytes of an entry of the directory, without its name */
#define END 22     /* bytes of the record after the directory, without a comment */

/** Corrects the checksums of stored files and the length of the comment, which else would hide faults of the readers. */
static void repair_archive(uint8_t *data, size_t size)
{
    if (size >= END && !memcmp(data + size - END, "PK\5\6", 4))
        adcgs_store_le16(data + size - 2, 0);
#if defined(HAVE_SPZ) || defined(HAVE_SOG)
    for (size_t at = 0; size >= CENTRAL && at <= size - CENTRAL; at++) {
        uint8_t *const entry = data + at;
        if (memcmp(entry, "PK\1\2", 4) || adcgs_load_le16(entry + 10))
            continue;
        const size_t bytes = adcgs_load_le32(entry + 20), local = adcgs_load_le32(entry + 42);
        if (local > size || size - local < LOCAL)
            continue;
        const size_t begin = local + LOCAL + adcgs_load_le16(data + local + 26) + adcgs_load_le16(data + local + 28);
        if (begin <= size && bytes <= size - begin)
            adcgs_store_le32(entry + 16, (uint32_t)crc32(0, data + begin, (uInt)bytes));
    }
#endif
}

/* ---- States ---- */

/** A state fulfils the promises of the header. */
static void check(const adcgs_dynamic *dynamic, const adcgs_splats *s)
{
    FUZZ_REQUIRE(s->n <= ADCGS_SPLATS_MAX && (s->degree == 0) == (s->harmonics == NULL));
    FUZZ_REQUIRE(!dynamic->has_identity || s->n == dynamic->n);
    for (uint32_t i = 0; i < s->n; i++) {
        float length = 0.0f;
        FUZZ_REQUIRE(s->opacity[i] >= 0.0f && s->opacity[i] <= 1.0f);
        for (int a = 0; a < 3; a++) {
            FUZZ_REQUIRE(isfinite(s->mean[a][i]) && isfinite(s->colour[a][i]));
            FUZZ_REQUIRE(isfinite(s->scale[a][i]) && s->scale[a][i] > 0.0f);
        }
        for (int a = 0; a < 4; a++)
            length += s->rotation[a][i] * s->rotation[a][i];
        FUZZ_REQUIRE(fabsf(length - 1.0f) < 1e-5f);
    }
    for (size_t i = 0; s->harmonics && i < (size_t)s->n * 3 * (size_t)((s->degree + 1) * (s->degree + 1) - 1); i++)
        FUZZ_REQUIRE(isfinite(s->harmonics[i]));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    adcgs_dynamic *dynamic;
    adcgs_error error = {ADCGS_OK, ""};
    uint8_t *const copy = fuzz_file(data, size);
    const adcgs_dynamic_options options = {.partial = size && data[size - 1] & 1, .frames = size % 8 == 7};
    if (size >= 4 && !memcmp(copy, "PK\3\4", 4))
        repair_archive(copy, size);
    const adcgs_status status = adcgs_dynamic_parse(&dynamic, copy, size, "fuzz", &options, &error);
    FUZZ_REQUIRE((status == ADCGS_OK) == (dynamic != NULL));
    FUZZ_REQUIRE(status == ADCGS_OK || (error.status == status && error.text[0] && !strchr(error.text, '\n')));
    FUZZ_REQUIRE(!dynamic || (dynamic->frames >= 1 && dynamic->frames <= ADCGS_DYNAMIC_FRAMES_MAX));
    for (int i = 0; dynamic && i < 3; i++) {
        adcgs_splats s;
        if (adcgs_dynamic_at(dynamic, 0.5 * i * adcgs_dynamic_duration(dynamic), &s, &error) == ADCGS_OK)
            check(dynamic, &s);
        else
            FUZZ_REQUIRE(error.text[0] && !strchr(error.text, '\n') && s.n == 0 && s.block == NULL);
        adcgs_splats_free(&s);
    }
    adcgs_dynamic_free(&dynamic);
    free(copy);
    return 0;
}
