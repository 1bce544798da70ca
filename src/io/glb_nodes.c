/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Nodes, and their matrices. */
#include "config.h"

#include "io/glb_nodes.h"

#include "io/quaternion.h"

#include <math.h>
#include <stdlib.h>

static const double unit[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

static adcgs_status bad(const adcgs_glb *g, adcgs_status status, const char *what)
{
    return adcgs_fail(g->error, status, "%s: glTF: %s", g->path, what);
}

/** n finite numbers of a node, or if it has none of that name what is in out. */
static adcgs_status numbers(const adcgs_glb *g, json_t *node, const char *name, double *out, size_t n)
{
    json_t *const array = json_object_get(node, name);
    for (size_t i = 0; array && i < n; i++) {
        json_t *const value = json_array_get(array, i);
        out[i] = json_number_value(value);
        if (json_array_size(array) != n || !json_is_number(value) || !isfinite(out[i]))
            return adcgs_fail(g->error, ADCGS_ERR_DATA, "%s: glTF: a node's %s: expected %zu numbers", g->path, name, n);
    }
    return ADCGS_OK;
}

/** out = a b, out may be b. */
static void multiply(const double a[12], const double b[12], double out[12])
{
    double product[12];
    for (int i = 0; i < 12; i++) {
        const double *const row = a + i / 4 * 4, *const column = b + i % 4;
        product[i] = row[0] * column[0] + row[1] * column[4] + row[2] * column[8] + (i % 4 == 3 ? row[3] : 0.0);
    }
    memcpy(out, product, sizeof product);
}

/** By translation, rotation x y z w, and scale. */
static adcgs_status compose(const adcgs_glb *g, json_t *node, double out[12])
{
    double t[3] = {0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1}, turn[9];
    ADCGS_TRY(numbers(g, node, "translation", t, 3));
    ADCGS_TRY(numbers(g, node, "rotation", q, 4));
    ADCGS_TRY(numbers(g, node, "scale", s, 3));
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0.0))
        return bad(g, ADCGS_ERR_DATA, "a node's rotation: expected a quaternion");
    adcgs_quaternion_matrix((const double[]){q[3] / length, q[0] / length, q[1] / length, q[2] / length}, turn);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            out[4 * i + j] = turn[3 * i + j] * s[j];
        out[4 * i + 3] = t[i];
    }
    return ADCGS_OK;
}

static adcgs_status matrix_of(const adcgs_glb *g, json_t *node, double out[12])
{
    double columns[16];
    if (!json_object_get(node, "matrix"))
        return compose(g, node, out);
    ADCGS_TRY(numbers(g, node, "matrix", columns, 16));
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            out[4 * i + j] = columns[4 * j + i];
    if (columns[3] != 0.0 || columns[7] != 0.0 || columns[11] != 0.0 || columns[15] != 1.0)
        return bad(g, ADCGS_ERR_DATA, "a node's matrix: expected a last row of 0 0 0 1");
    return ADCGS_OK;
}

/** The index of each node's parent, the count of nodes for none. */
static adcgs_status find_parents(const adcgs_glb *g, json_t *nodes, size_t *parents)
{
    const size_t n = json_array_size(nodes);
    size_t i, j;
    json_t *node, *child;
    for (i = 0; i < n; i++)
        parents[i] = n;
    json_array_foreach(nodes, i, node) {
        json_array_foreach(json_object_get(node, "children"), j, child) {
            const json_int_t index = json_is_integer(child) ? json_integer_value(child) : -1;
            if (index < 0 || (size_t)index >= n)
                return bad(g, ADCGS_ERR_DATA, "a child of a node that there is not");
            parents[index] = i;
        }
    }
    return ADCGS_OK;
}

static adcgs_status find_place(double matrix[12], const adcgs_glb *g, json_t *nodes, size_t *parents, size_t mesh)
{
    const size_t n = json_array_size(nodes);
    size_t i, uses = 0;
    json_t *node;
    ADCGS_TRY(find_parents(g, nodes, parents));
    json_array_foreach(nodes, i, node) {
        const json_t *const used = json_object_get(node, "mesh");
        size_t steps = 0;
        if (!json_is_integer(used) || (uint64_t)json_integer_value(used) != mesh)
            continue;
        if (uses++)
            return bad(g, ADCGS_ERR_UNSUPPORTED, "splats of several nodes, expected one");
        for (size_t at = i; at < n; at = parents[at]) {
            double one[12] = {0};
            if (steps++ > n)
                return bad(g, ADCGS_ERR_DATA, "nodes that are their own parents");
            ADCGS_TRY(matrix_of(g, json_array_get(nodes, at), one));
            multiply(one, matrix, matrix);
        }
    }
    return ADCGS_OK;
}

adcgs_status adcgs_glb_place(double matrix[12], int *moves, const adcgs_glb *g, size_t mesh)
{
    json_t *const nodes = json_object_get(g->root, "nodes");
    size_t *const parents = malloc((json_array_size(nodes) + 1) * sizeof *parents);
    memcpy(matrix, unit, sizeof unit);
    const adcgs_status status = parents ? find_place(matrix, g, nodes, parents, mesh) : bad(g, ADCGS_ERR_MEMORY, "out of memory");
    free(parents);
    *moves = 0;
    for (int i = 0; i < 12; i++)
        *moves |= matrix[i] != unit[i];
    return status;
}
