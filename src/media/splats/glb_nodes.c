/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Nodes of a GLB file and their matrices. */
#include "config.h"

#include "media/splats/glb_nodes.h"

#include "geometry/pose_product.h"
#include "geometry/quaternion_matrix.h"

#include <math.h>
#include <stdlib.h>

#define DEPTH_MAX 256 /* maximum number of parents above a node; other files have about ten; chosen by hand, not measured */

/* The unit matrix, row-major 3x4; definition. */
static const double unit[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

static adcgs_status bad(const adcgs_glb *g, adcgs_status status, const char *what)
{
    return adcgs_fail(g->error, status, "%s: glTF: %s", g->path, what);
}

/** Read n finite numbers of a node; out stays unchanged if the node has no array of that name. */
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

/** Matrix from translation, rotation (x y z w) and scale. */
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

/** The index of each node's parent; the number of nodes for none. */
static adcgs_status find_parents(const adcgs_glb *g, json_t *nodes, size_t *parents)
{
    const size_t n = json_array_size(nodes);
    size_t i, j;
    json_t *node, *child;
    for (i = 0; i < n; i++)
        parents[i] = n;
    json_array_foreach(nodes, i, node)
    {
        json_array_foreach(json_object_get(node, "children"), j, child)
        {
            const json_int_t index = json_is_integer(child) ? json_integer_value(child) : -1;
            if (index < 0 || (size_t)index >= n)
                return bad(g, ADCGS_ERR_DATA, "a node lists a child that does not exist");
            parents[index] = i;
        }
    }
    return ADCGS_OK;
}

static int uses(json_t *node, size_t mesh)
{
    const json_t *const used = json_object_get(node, "mesh");
    return json_is_integer(used) && (uint64_t)json_integer_value(used) == mesh;
}

/** The nodes of a file, with their parents and the roots of the scene. */
typedef struct graph {
    json_t *nodes;
    size_t *parents;   /**< the number of nodes for none */
    uint8_t *in_scene; /**< for nodes without a parent; all if there is no scene */
} graph;

static void find_scene(const adcgs_glb *g, graph *to)
{
    json_t *const scenes = json_object_get(g->root, "scenes"), *value;
    const size_t n = json_array_size(to->nodes), chosen = (size_t)json_integer_value(json_object_get(g->root, "scene"));
    size_t i;
    memset(to->in_scene, !json_array_size(scenes), n);
    json_array_foreach(json_object_get(json_array_get(scenes, chosen), "nodes"), i,
                       value) if (json_is_integer(value) && (uint64_t)json_integer_value(value) < n)
        to->in_scene[json_integer_value(value)] = 1;
}

/** The matrix of a node, with its parents' transforms applied. *root: its topmost parent. */
static adcgs_status place_node(double matrix[12], size_t *root, const adcgs_glb *g, const graph *of, size_t at)
{
    const size_t n = json_array_size(of->nodes);
    memcpy(matrix, unit, sizeof unit);
    for (int steps = 0; at < n; at = of->parents[at]) {
        double one[12] = {0};
        if ((size_t)steps > n)
            return bad(g, ADCGS_ERR_DATA, "a node is its own ancestor");
        if (steps++ > DEPTH_MAX)
            return bad(g, ADCGS_ERR_UNSUPPORTED, "nodes with more than 256 parents one above the other");
        ADCGS_TRY(matrix_of(g, json_array_get(of->nodes, at), one));
        adcgs_pose_product(one, matrix, matrix);
        *root = at;
    }
    return ADCGS_OK;
}

/** all: nodes of the whole file, else of its scene. */
static adcgs_status find_places(adcgs_glb_places *out, const adcgs_glb *g, const graph *of, size_t mesh, int all)
{
    size_t i, root = 0, n = 0;
    json_t *node;
    json_array_foreach(of->nodes, i, node)
    {
        double matrix[12];
        if (!uses(node, mesh))
            continue;
        if (n++ == ADCGS_GLB_PLACES)
            return bad(g, ADCGS_ERR_UNSUPPORTED, "splats in more than 4096 nodes");
        ADCGS_TRY(place_node(matrix, &root, g, of, i));
        if (all || of->in_scene[root])
            memcpy(out->matrix[out->n++], matrix, sizeof matrix);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_glb_places_find(adcgs_glb_places *out, const adcgs_glb *g, size_t mesh)
{
    graph of = {.nodes = json_object_get(g->root, "nodes")};
    const size_t n = json_array_size(of.nodes) + 1;
    of.parents = malloc(n * sizeof *of.parents);
    of.in_scene = malloc(n);
    *out = (adcgs_glb_places){.matrix = malloc(ADCGS_GLB_PLACES * sizeof *out->matrix)};
    adcgs_status status = of.parents && of.in_scene && out->matrix ? find_parents(g, of.nodes, of.parents)
                                                                   : bad(g, ADCGS_ERR_MEMORY, "out of memory");
    if (status == ADCGS_OK)
        find_scene(g, &of);
    for (int all = 0; status == ADCGS_OK && all < 2 && !out->n; all++)
        status = find_places(out, g, &of, mesh, all);
    free(of.parents);
    free(of.in_scene);
    if (status == ADCGS_OK && !out->n)
        memcpy(out->matrix[out->n++], unit, sizeof unit);
    return status;
}

void adcgs_glb_places_clear(adcgs_glb_places *places)
{
    free(places->matrix);
    *places = (adcgs_glb_places){0};
}

int adcgs_glb_moves(const double matrix[12])
{
    int moves = 0;
    for (int i = 0; i < 12; i++)
        moves |= matrix[i] != unit[i];
    return moves;
}
