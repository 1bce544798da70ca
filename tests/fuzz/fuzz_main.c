/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Runs a fuzz target without a fuzzing engine, on the given files and folders or on the target's seeds. Each file is tested
 * unchanged, and with several mutations that depend only on the file. libFuzzer's main replaces this weak one.
 *
 * ADCGS_FUZZ_ROUNDS is the number of mutations of each seed. Without it, ADCGS_FULL=1 tries three times as many.
 */
#define _POSIX_C_SOURCE 200809L

#include "fuzz.h"

#include "base/digest.h"

#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

#define INPUT_MAX ((size_t)1 << 22)
#define ROUNDS 6 /* with ADCGS_FULL; chosen by hand: a minute of fuzz_decode */
#define ROUNDS_SHORT 2

/* Absent in targets whose inputs are not streams. */
__attribute__((weak)) size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max, unsigned int seed);

typedef struct replay {
    int rounds;
    unsigned long inputs, files;
} replay;

static uint32_t draw(uint64_t *state, uint32_t n)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)((*state >> 33) % n);
}

/** One change, determined by the bytes themselves. */
__attribute__((weak)) size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max)
{
    static const uint8_t telling[] = {0, 1, 2, 127, 128, 129, 254, 255};
    uint64_t state = adcgs_crc32c((uint32_t)size, data, size);
    const size_t at = size ? draw(&state, (uint32_t)size) : 0, n = 1 + draw(&state, 8);
    switch (size ? draw(&state, 5) : 4) {
    case 0:
        data[at] ^= (uint8_t)(1U << draw(&state, 8));
        return size;
    case 1:
        data[at] = telling[draw(&state, sizeof telling)];
        return size;
    case 2:
        for (size_t i = at; i < size && i < at + n; i++)
            data[i] = (uint8_t)draw(&state, 256);
        return size;
    case 3:
        memmove(data + at, data + at + ADCGS_MIN(n, size - at), size - at - ADCGS_MIN(n, size - at));
        return size - ADCGS_MIN(n, size - at);
    default:
        if (max - size < n)
            return size;
        memmove(data + at + n, data + at, size - at);
        memset(data + at, telling[draw(&state, sizeof telling)], n);
        return size + n;
    }
}

static void try_input(replay *r, const uint8_t *data, size_t size)
{
    uint8_t *copy = malloc(size + (size == 0)); /* exact size, so that a sanitizer detects a read beyond the end */
    FUZZ_REQUIRE(copy != NULL);
    memcpy(copy, data, size);
    LLVMFuzzerTestOneInput(copy, size);
    free(copy);
    r->inputs++;
}

static void replay_bytes(replay *r, const uint8_t *seed, size_t size)
{
    const size_t max = size + 4096;
    uint8_t *data = malloc(max);
    uint64_t state = adcgs_crc32c(1, seed, size);
    FUZZ_REQUIRE(data != NULL);
    try_input(r, seed, size);
    for (int round = 0; round < r->rounds; round++) {
        size_t n = size;
        memcpy(data, seed, size);
        for (uint32_t changes = 1 + draw(&state, 3); changes > 0; changes--) {
            const unsigned int chance = (unsigned int)draw(&state, UINT32_MAX);
            if (n > 0)
                data[n - 1] ^= (uint8_t)chance; /* the last byte selects the target's options, and makes rounds differ */
            n = LLVMFuzzerCustomMutator ? LLVMFuzzerCustomMutator(data, n, max, chance) : LLVMFuzzerMutate(data, n, max);
        }
        try_input(r, data, n);
    }
    free(data);
}

static void replay_file(replay *r, const char *path)
{
    FILE *file = fopen(path, "rb");
    uint8_t *data = malloc(INPUT_MAX);
    if (!file || !data) {
        fprintf(stderr, "%s: cannot be read\n", path);
        exit(3);
    }
    const size_t size = fread(data, 1, INPUT_MAX, file);
    fclose(file);
    r->files++;
    replay_bytes(r, data, size);
    free(data);
}

static void replay_path(replay *r, const char *path)
{
    struct stat info = {0}; /* MemorySanitizer does not know every name of stat() in the C library */
    if (stat(path, &info) != 0 || !S_ISDIR(info.st_mode)) {
        replay_file(r, path);
        return;
    }
    struct dirent **names;
    const int n = scandir(path, &names, NULL, alphasort);
    for (int i = 0; i < n; i++) {
        char inside[4096];
        snprintf(inside, sizeof inside, "%s/%s", path, names[i]->d_name);
        if (names[i]->d_name[0] != '.')
            replay_path(r, inside);
        free(names[i]);
    }
    if (n >= 0)
        free(names);
}

__attribute__((weak)) int main(int argc, char **argv)
{
    const char *top = getenv("srcdir"), *rounds = getenv("ADCGS_FUZZ_ROUNDS");
    replay r = {.rounds = rounds ? atoi(rounds) : getenv("ADCGS_FULL") ? ROUNDS : ROUNDS_SHORT};
    for (int i = 1; i < argc; i++)
        replay_path(&r, argv[i]);
    for (size_t i = 0; argc == 1 && adcgs_fuzz_seeds[i]; i++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", top ? top : ".", adcgs_fuzz_seeds[i]);
        if (access(path, R_OK) == 0) /* a target without regressions does not have that folder */
            replay_path(&r, path);
    }
    printf("%lu inputs from %lu files\n", r.inputs, r.files);
    return r.files > 0 ? 0 : 1;
}
