/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Positions: sorting, exact round trips from one voxel to full cubes, and hostile data. */
#include "decode_positions.h"

#include "geom/geom.h"
#include "geom/logistic_data.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

static uint32_t random32(uint64_t *state)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(*state >> 33) ^ (uint32_t)(*state >> 11);
}

static uint32_t *make_voxels(size_t n)
{
    uint32_t *voxels = malloc((n + 1) * 3 * sizeof *voxels);
    assert_non_null(voxels);
    return voxels;
}

/* Sorts, drops duplicates, and returns the remaining number. */
static uint32_t tidy(uint32_t *voxels, uint32_t n)
{
    assert_true(adcgs_morton_sort(voxels, n, NULL, NULL) >= 0);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < n; i++)
        if (!kept || memcmp(voxels + 3 * i, voxels + 3 * (kept - 1), 3 * sizeof *voxels))
            memmove(voxels + 3 * kept++, voxels + 3 * i, 3 * sizeof *voxels);
    return kept;
}

/* Returns bits per point. */
static double check_cloud(const uint32_t *voxels, uint32_t n, int depth)
{
    adcgs_buffer b;
    adcgs_buffer_init(&b);
    adcgs_error error = {0};
    if (adcgs_geom_encode(&b, voxels, n, depth, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    uint32_t *back = make_voxels(n);
    if (decode_positions(b.data, b.size, n, depth, back, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    assert_memory_equal(back, voxels, (size_t)n * 3 * sizeof *voxels);
    const double bits = 8.0 * (double)b.size / n;
    free(back);
    adcgs_buffer_clear(&b);
    return bits;
}

/* The numbers in the code are those of the specification. */
/* REQ-TABL-002 */
static void test_logistic_equals_csv(void **state)
{
    (void)state;
    static const int stretch[] = {LOGISTIC_STRETCH}, squash[] = {LOGISTIC_SQUASH};
    const char *top = getenv("srcdir");
    char path[4096], line[100];
    snprintf(path, sizeof path, "%s/spec/tables/logistic.csv", top ? top : ".");
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(line, sizeof line, file));
    for (long i = 0; i < 2048; i++) {
        char *end;
        assert_non_null(fgets(line, sizeof line, file));
        assert_int_equal(strtol(line, &end, 10), i);
        assert_int_equal(strtol(end + 1, &end, 10), stretch[i]);
        assert_int_equal(strtol(end + 1, &end, 10), squash[i]);
    }
    assert_null(fgets(line, sizeof line, file));
    fclose(file);
    assert_int_equal(ADCGS_COUNTOF(stretch), 2048);
    assert_int_equal(ADCGS_COUNTOF(squash), 2048);
}

/* REQ-GEOM-002 */
static void test_sorting(void **state)
{
    (void)state;
    uint64_t seed = 1;
    const uint32_t n = 5000;
    uint32_t *voxels = make_voxels(n), *copy = make_voxels(n), *order = malloc(n * sizeof *order);
    for (uint32_t i = 0; i < 3 * n; i++)
        copy[i] = voxels[i] = random32(&seed) & 0x1fffff;
    assert_int_equal(adcgs_morton_sort(voxels, n, order, NULL), 0);
    for (uint32_t i = 0; i < n; i++) {
        assert_memory_equal(voxels + 3 * i, copy + 3 * order[i], 12);
        assert_true(i == 0 || adcgs_morton(voxels + 3 * i) > adcgs_morton(voxels + 3 * (i - 1)));
    }
    memcpy(voxels, voxels + 3, 12);
    assert_int_equal(adcgs_morton_sort(voxels, n, NULL, NULL), 1);
    static const uint32_t corner[3] = {0x1fffff, 0x1fffff, 0x1fffff}, x[3] = {1, 0, 0}, z[3] = {0, 0, 0x100000};
    assert_true(adcgs_morton(corner) == (UINT64_C(1) << 63) - 1);
    assert_true(adcgs_morton(x) == 4 && adcgs_morton(z) == UINT64_C(1) << 60);
    assert_int_equal(adcgs_morton_sort(voxels, 0, NULL, NULL), 0);
    free(voxels);
    free(copy);
    free(order);
}

/* REQ-GEOM-001, REQ-GEOM-003, REQ-GEOM-007 */
static void test_single_points(void **state)
{
    (void)state;
    for (int depth = 0; depth <= 21; depth++) {
        const uint32_t top = (1u << depth) - 1;
        const uint32_t points[][3] = {{0, 0, 0}, {top, top, top}, {top, 0, top / 2}, {top / 3, top, 0}};
        for (size_t i = 0; i < ADCGS_COUNTOF(points); i++)
            assert_true(check_cloud(points[i], 1, depth) <= 3 * depth + 7);
    }
}

/* REQ-GEOM-004, REQ-GEOM-007 */
static void test_full_cubes(void **state)
{
    (void)state;
    for (int depth = 1; depth <= 4; depth++) {
        const uint32_t side = 1u << depth, n = side * side * side;
        uint32_t *voxels = make_voxels(n);
        for (uint32_t i = 0; i < n; i++)
            for (int axis = 0; axis < 3; axis++)
                voxels[3 * i + (uint32_t)axis] = i >> axis * depth & (side - 1);
        assert_int_equal(tidy(voxels, n), n);
        assert_true(check_cloud(voxels, n, depth) == 0); /* nothing is left to code */
        /* all but one, all but every seventh */
        memmove(voxels + 3 * (n / 2), voxels + 3 * (n / 2 + 1), (n - n / 2 - 1) * 12);
        check_cloud(voxels, n - 1, depth);
        uint32_t kept = 0;
        for (uint32_t i = 0; i < n - 1; i++)
            if (i % 7)
                memmove(voxels + 3 * kept++, voxels + 3 * i, 12);
        check_cloud(voxels, kept, depth);
        free(voxels);
    }
}

/* REQ-GEOM-004, REQ-GEOM-005, REQ-GEOM-006, REQ-GEOM-007, REQ-GEOM-008, REQ-GEOM-009, REQ-GEOM-010, REQ-GEOM-011 */
static void test_random_clouds(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {2, 3, 17, 300, 5000};
    uint64_t seed = 2;
    for (size_t i = 0; i < ADCGS_COUNTOF(sizes); i++)
        for (int depth = 1; depth <= 21; depth += i < 4 ? 1 : 5) {
            uint32_t *voxels = make_voxels(sizes[i]);
            for (uint32_t p = 0; p < sizes[i]; p++) {
                /* a wavy surface and, every third, a point anywhere */
                uint32_t *v = voxels + 3 * p;
                for (int axis = 0; axis < 3; axis++)
                    v[axis] = random32(&seed) & ((1u << depth) - 1);
                if (p % 3)
                    v[2] = (v[0] + v[1]) >> 1;
            }
            check_cloud(voxels, tidy(voxels, sizes[i]), depth);
            free(voxels);
        }
}

/* Voxels whose Morton codes fall on one slot of the coder's hash table, each with a neighbour: still exact, and not slow. */
static void test_colliding_cells(void **state)
{
    (void)state;
    uint64_t inverse = 1, multiplier = UINT64_C(0x9e3779b97f4a7c15);
    for (int i = 0; i < 6; i++)
        inverse *= 2 - multiplier * inverse;
    const uint32_t n = 20000;
    uint32_t *voxels = make_voxels(n);
    uint64_t product = 0;
    for (uint32_t i = 0; i < n; i += 2) {
        uint64_t code;
        do
            code = product++ * inverse;
        while (code >> 63 || code & 1);
        for (int axis = 0; axis < 3; axis++) {
            uint32_t v = 0;
            for (int b = 0; b < 21; b++)
                v |= (uint32_t)(code >> (3 * b + 2 - axis) & 1) << b;
            voxels[3 * i + (uint32_t)axis] = voxels[3 * i + 3 + (uint32_t)axis] = v;
        }
        voxels[3 * i + 5] ^= 1;
    }
    check_cloud(voxels, tidy(voxels, n), 21);
    free(voxels);
}

/* A surface costs much less than uniform noise: about 2 bits of prediction per point here. */
static void test_surface_is_predicted(void **state)
{
    (void)state;
    uint64_t seed = 3;
    const uint32_t n = 20000;
    uint32_t *voxels = make_voxels(n);
    for (uint32_t p = 0; p < n; p++) {
        voxels[3 * p] = random32(&seed) & 1023;
        voxels[3 * p + 1] = random32(&seed) & 1023;
        voxels[3 * p + 2] = (voxels[3 * p] * 3 + voxels[3 * p + 1]) / 4;
    }
    const uint32_t kept = tidy(voxels, n);
    const double bits = check_cloud(voxels, kept, 10);
    printf("oblique plane, %u points, depth 10: %.2f bit per point\n", kept, bits);
    assert_true(bits < 12.5);
    free(voxels);
}

/* REQ-GEOM-001 */
static void test_wrong_use(void **state)
{
    (void)state;
    static const uint32_t twice[] = {1, 1, 1, 1, 1, 1}, unsorted[] = {1, 0, 0, 0, 0, 1}, outside[] = {0, 4, 0};
    adcgs_buffer b;
    adcgs_buffer_init(&b);
    assert_int_equal(adcgs_geom_encode(&b, twice, 2, 3, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_geom_encode(&b, unsorted, 2, 3, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_geom_encode(&b, outside, 1, 2, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_geom_encode(&b, outside, 0, 2, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_geom_encode(&b, outside, 1, 22, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(b.size, 0);
    uint32_t out[30];
    assert_int_equal(decode_positions(NULL, 0, 9, 1, out, NULL), ADCGS_ERR_DATA);
    assert_int_equal(decode_positions(NULL, 0, 2, 0, out, NULL), ADCGS_ERR_DATA);
    assert_int_equal(decode_positions(NULL, 0, 1, -1, out, NULL), ADCGS_ERR_DATA);
    assert_int_equal(decode_positions(NULL, 0, 0, 5, out, NULL), ADCGS_ERR_DATA);
    assert_int_equal(decode_positions(NULL, 0, 8, 1, out, NULL), ADCGS_OK);
}

/* For any bytes the decoder returns a status. If it is OK, the voxels are distinct, in order and inside the cube. */
static void try_bytes(const uint8_t *data, size_t bytes, uint32_t n, int depth)
{
    uint32_t *voxels = make_voxels(n);
    if (decode_positions(data, bytes, n, depth, voxels, NULL) == ADCGS_OK)
        for (uint32_t i = 0; i < n; i++) {
            assert_true((voxels[3 * i] | voxels[3 * i + 1] | voxels[3 * i + 2]) >> depth == 0);
            assert_true(i == 0 || adcgs_morton(voxels + 3 * i) > adcgs_morton(voxels + 3 * (i - 1)));
        }
    free(voxels);
}

/* REQ-GEOM-012, REQ-CONF-005 */
static void test_hostile_data(void **state)
{
    (void)state;
    uint64_t seed = 4;
    const uint32_t n = 200;
    uint32_t *voxels = make_voxels(n);
    for (uint32_t i = 0; i < 3 * n; i++)
        voxels[i] = random32(&seed) & 63;
    const uint32_t kept = tidy(voxels, n);
    adcgs_buffer b;
    adcgs_buffer_init(&b);
    assert_int_equal(adcgs_geom_encode(&b, voxels, kept, 6, NULL), ADCGS_OK);
    for (size_t cut = 0; cut < b.size; cut++)
        try_bytes(b.data, cut, kept, 6);
    for (size_t i = 0; i < b.size; i++)
        for (int bit = 0; bit < 8; bit += 3) {
            b.data[i] ^= (uint8_t)(1 << bit);
            try_bytes(b.data, b.size, kept, 6);
            b.data[i] ^= (uint8_t)(1 << bit);
        }
    for (int trial = 0; trial < 300; trial++) {
        for (size_t i = 0; i < b.size; i++)
            b.data[i] = (uint8_t)(trial % 5 ? random32(&seed) >> 7 : trial % 2 ? 254u : 0u);
        const int depth = 1 + trial % 21;
        try_bytes(b.data, b.size, 1 + random32(&seed) % (depth < 4 ? 1u << 3 * depth : 600), depth);
    }
    free(voxels);
    adcgs_buffer_clear(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_logistic_equals_csv),  cmocka_unit_test(test_sorting),       cmocka_unit_test(test_single_points),
        cmocka_unit_test(test_full_cubes),           cmocka_unit_test(test_random_clouds), cmocka_unit_test(test_colliding_cells),
        cmocka_unit_test(test_surface_is_predicted), cmocka_unit_test(test_wrong_use),     cmocka_unit_test(test_hostile_data),
    };
    return cmocka_run_group_tests_name("geom", tests, NULL, NULL);
}
