/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Makes the conformance vectors and their manifest from the recipes. */
#include "config.h"

#include "answers.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>

#define VECTORS_MAX 1024

typedef struct maker {
    const char *source, *directory; /**< folder of recipes/; folder of vectors/ and the manifest */
    FILE *manifest;
    int n, made, failed;
    char *id[VECTORS_MAX];
} maker;

static adcgs_status write_file(const maker *m, const char *id, const adcgs_buffer *file, adcgs_error *error)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/vectors/%s.adcgs", m->directory, id);
    FILE *const out = fopen(path, "wb");
    const int good = out && fwrite(file->data, 1, file->size, out) == file->size;
    if (!out || fclose(out) != 0 || !good)
        return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: cannot write", path);
    return ADCGS_OK;
}

/* Makes one vector; its entry goes to the manifest only if every step succeeds. */
static adcgs_status make(maker *m, const char *id, adcgs_error *error)
{
    static adcgs_plan plan;
    char directory[4000], *entry = NULL;
    size_t bytes = 0;
    adcgs_recipe recipe;
    adcgs_buffer file;
    adcgs_buffer_init(&file);
    snprintf(directory, sizeof directory, "%s/recipes", m->source);
    adcgs_status status = adcgs_recipe_read(&recipe, directory, id, error);
    if (status == ADCGS_OK) {
        FILE *const out = open_memstream(&entry, &bytes);
        status = adcgs_plan_build(&plan, &recipe, &file, error);
        if (status == ADCGS_OK && out)
            status = adcgs_answers_print(out, &plan, &file, error);
        if (!out || fclose(out) != 0)
            status = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: no memory for its entry", id);
        adcgs_plan_clear(&plan);
    }
    if (status == ADCGS_OK)
        status = write_file(m, id, &file, error);
    if (status == ADCGS_OK)
        fprintf(m->manifest, "%s\n%s", m->made++ ? "," : "", entry);
    free(entry);
    adcgs_buffer_clear(&file);
    adcgs_recipe_clear(&recipe);
    return status;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static int list_recipes(maker *m)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/recipes", m->source);
    DIR *const directory = opendir(path);
    if (!directory)
        return -1;
    for (struct dirent *entry; (entry = readdir(directory)) && m->n < VECTORS_MAX;) {
        char *const dot = strrchr(entry->d_name, '.');
        if (!dot || strcmp(dot, ".txt") || !*adcgs_answers_verdict(entry->d_name))
            continue;
        *dot = 0;
        m->id[m->n] = strdup(entry->d_name);
        m->n += m->id[m->n] != NULL;
    }
    closedir(directory);
    qsort(m->id, (size_t)m->n, sizeof m->id[0], by_name);
    return 0;
}

int main(int argc, char **argv)
{
    static maker m;
    char path[4096];
    adcgs_error error = {ADCGS_OK, ""};
    if (argc < 3) {
        fprintf(stderr, "usage: make_vectors SOURCE DIR [ID ...]\n"
                        "SOURCE holds the folder recipes, DIR the folder vectors. Without ID all recipes are made.\n");
        return 2;
    }
    m.source = argv[1];
    m.directory = argv[2];
    snprintf(path, sizeof path, "%s/manifest.json", m.directory);
    m.manifest = fopen(path, "w");
    if (!m.manifest || (argc == 3 && list_recipes(&m) != 0)) {
        fprintf(stderr, "make_vectors: %s: cannot write, or no folder recipes in %s\n", path, m.source);
        return 3;
    }
    for (; m.n < argc - 3; m.n++)
        m.id[m.n] = strdup(argv[3 + m.n]);
    fprintf(m.manifest, "{ \"format\": 1,\n  \"vectors\": [");
    for (int i = 0; i < m.n; i++) {
        if (make(&m, m.id[i], &error) != ADCGS_OK) {
            fprintf(stderr, "make_vectors: %s\n", error.text);
            m.failed++;
        }
        free(m.id[i]);
    }
    fprintf(m.manifest, " ] }\n");
    const int closed = fclose(m.manifest) == 0;
    return closed && m.failed == 0 ? 0 : 1;
}
