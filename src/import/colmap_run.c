/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Runs COLMAP's programs one after another: features, matches, cameras. No display and no GPU is needed. */
#include "config.h"

#include "import/colmap_run.h"

#include "import/child.h"
#include "data/paths.h"

#include <errno.h>
#include <stdlib.h>

#define WORDS_MAX 32
#define EXHAUSTIVE_MOST 80 /* most images of a video for exhaustive matching; above it, only neighbours in time are matched */
#define OVERLAP "12"       /* images before and after; also images at twice, four times, ... this distance */
#define SMALLEST_MODEL "3"
#define FISHEYE_FOCAL \
    0.4 /* focal length over the longer side from which COLMAP starts if no other is known, for fields
                             of view up to half the sphere */

static const char *const renamed[][2] = {
    {"--SiftExtraction.use_gpu", "--FeatureExtraction.use_gpu"},
    {"--SiftExtraction.num_threads", "--FeatureExtraction.num_threads"},
    {"--SiftMatching.use_gpu", "--FeatureMatching.use_gpu"},
    {"--SiftMatching.num_threads", "--FeatureMatching.num_threads"},
};

/** A running step. */
typedef struct step {
    adcgs_import_job *job;
    const adcgs_colmap_program *program;
    const char *name; /* for the progress line */
    const char *mark; /* text in front of the number in progress lines */
    int n;            /* number of words */
    char *words[WORDS_MAX + 1];
    FILE *log;
    int no_pair;    /* the mapper found no two images to begin with */
    char last[200]; /* last line with an error */
} step;

static void add_word(step *s, const char *word)
{
    if (s->n < WORDS_MAX)
        s->words[s->n++] = (char *)(uintptr_t)word; /* posix_spawnp() takes pointers to char but does not modify the characters */
    s->words[s->n] = NULL;
}

static void add_option(step *s, const char *name, const char *value)
{
    for (size_t i = 0; s->program->is_renamed && i < ADCGS_COUNTOF(renamed); i++)
        if (!strcmp(name, renamed[i][0]))
            name = renamed[i][1];
    add_word(s, name);
    add_word(s, value);
}

/** Reads the progress from lines such as "Processed file [12/200]", "Registering image #7 (34)". */
static int hear(void *user, const char *line)
{
    step *s = user;
    adcgs_import_job *job = s->job;
    const char *mark = s->mark ? strstr(line, s->mark) : NULL, *open = mark ? strpbrk(mark, "[(") : NULL;
    if (open) {
        const int n = atoi(open + 1);
        const char *slash = strchr(open, '/');
        adcgs_progress_show(job->progress, "%-9s %6d/%d", s->name, n,
                            *open == '[' && slash ? atoi(slash + 1) : (int)job->sources.n);
    }
    s->no_pair |= strstr(line, "No good initial image pair") != NULL;
    if (strstr(line, "ERROR") || strstr(line, "rror:") || strstr(line, "Failed"))
        snprintf(s->last, sizeof s->last, "%.199s", line);
    return adcgs_interrupted();
}

static adcgs_status run(step *s)
{
    adcgs_import_job *job = s->job;
    int code;
    s->log = fopen(job->log, "a");
    if (!s->log)
        return adcgs_fail(job->error, ADCGS_ERR_IO, "%s: cannot write: %s", job->log, strerror(errno));
    adcgs_progress_show(job->progress, "%-9s", s->name);
    adcgs_status status = adcgs_child_run(s->words, s->log, hear, s, &code, job->error);
    const int lost = ferror(s->log); /* the log is written line by line; closing reports only the last error */
    if ((fclose(s->log) || lost) && status == ADCGS_OK)
        status = adcgs_fail(job->error, ADCGS_ERR_IO, "%s: cannot write: %s", job->log, strerror(errno));
    ADCGS_TRY(status);
    ADCGS_TRY(adcgs_import_goes_on(job));
    if (!code)
        return ADCGS_OK;
    if (s->no_pair)
        return adcgs_fail(job->error, ADCGS_ERR_DATA,
                          "no two images have enough parallax: the camera hardly moves sideways; walk around the subject, "
                          "or choose a longer piece. COLMAP's output is in %s",
                          job->log);
    return adcgs_fail(job->error, ADCGS_ERR_DATA, "%s %s failed with exit code %d%s%s; its output is in %s", s->words[0],
                      s->words[1], code, *s->last ? ": " : "", s->last, job->log);
}

static step begin(adcgs_import_job *job, const adcgs_colmap_program *program, const char *command, const char *name,
                  const char *mark)
{
    step s = {.job = job, .program = program, .name = name, .mark = mark};
    add_word(&s, job->options->colmap);
    add_word(&s, command);
    return s;
}

/* ---- The program ---- */

static int hear_options(void *user, const char *line)
{
    adcgs_colmap_program *program = user;
    program->is_known |= strstr(line, "--database_path") != NULL;
    program->is_renamed |= strstr(line, "--FeatureExtraction.use_gpu") != NULL;
    return adcgs_interrupted();
}

adcgs_status adcgs_import_ask(adcgs_colmap_program *out, const adcgs_import_options *options, adcgs_error *error)
{
    char *const words[] = {(char *)(uintptr_t)options->colmap, "feature_extractor", "-h", NULL};
    int code;
    *out = (adcgs_colmap_program){0};
    setenv("QT_QPA_PLATFORM", "offscreen", 0); /* COLMAP starts as a graphical program, but there may be no display */
    const adcgs_status status = adcgs_child_run(words, NULL, hear_options, out, &code, error);
    if (status == ADCGS_ERR_UNSUPPORTED)
        return adcgs_fail(error, status,
                          "%s: no such program; it is needed to estimate the cameras: install COLMAP (on "
                          "Debian: apt-get install colmap), or name it with --colmap",
                          options->colmap);
    ADCGS_TRY(status);
    return out->is_known ? ADCGS_OK
                         : adcgs_fail(error, ADCGS_ERR_UNSUPPORTED,
                                      "%s: its feature_extractor takes no "
                                      "--database_path, expected COLMAP 3.6 or later",
                                      options->colmap);
}

/* ---- The steps ---- */

/** COLMAP's names of adcgs_import_lens. */
static const char *const lens_models[] = {"SIMPLE_RADIAL", "PINHOLE", "OPENCV", "OPENCV_FISHEYE"};

typedef struct places {
    char *database, *images, *masks, *sparse;
} places;

static adcgs_status extract(adcgs_import_job *job, const adcgs_colmap_program *program, const places *p)
{
    const double known = job->sources.cameras[0].focal;
    const double said = known > 0.0 ? known : job->options->lens == ADCGS_IMPORT_FISHEYE ? FISHEYE_FOCAL : 0.0;
    char threads[16], focal[32];
    step s = begin(job, program, "feature_extractor", "features", "Processed file");
    add_option(&s, "--database_path", p->database);
    add_option(&s, "--image_path", p->images);
    if (job->has_masks)
        add_option(&s, "--ImageReader.mask_path", p->masks);
    add_option(&s, "--ImageReader.single_camera_per_folder", "1");
    add_option(&s, "--ImageReader.camera_model", lens_models[job->options->lens]);
    if (said > 0.0) { /* used if the image made for COLMAP has no focal length */
        snprintf(focal, sizeof focal, "%.6g", said);
        add_option(&s, "--ImageReader.default_focal_length_factor", focal);
    }
    add_option(&s, "--SiftExtraction.use_gpu", "0");
    snprintf(threads, sizeof threads, "%d", job->options->threads);
    if (job->options->threads)
        add_option(&s, "--SiftExtraction.num_threads", threads);
    return run(&s);
}

static adcgs_status match(adcgs_import_job *job, const adcgs_colmap_program *program, const places *p)
{
    char threads[16];
    const int follows = job->sources.kind == ADCGS_FOOTAGE_FILM && job->sources.n > EXHAUSTIVE_MOST;
    step s = begin(job, program, follows ? "sequential_matcher" : "exhaustive_matcher", "matching", "Matching");
    add_option(&s, "--database_path", p->database);
    if (follows)
        add_option(&s, "--SequentialMatching.overlap", OVERLAP);
    add_option(&s, "--SiftMatching.use_gpu", "0");
    snprintf(threads, sizeof threads, "%d", job->options->threads);
    if (job->options->threads)
        add_option(&s, "--SiftMatching.num_threads", threads);
    return run(&s);
}

static adcgs_status map(adcgs_import_job *job, const adcgs_colmap_program *program, const places *p)
{
    char threads[16];
    step s = begin(job, program, "mapper", "cameras", "Registering image");
    add_option(&s, "--database_path", p->database);
    add_option(&s, "--image_path", p->images);
    add_option(&s, "--output_path", p->sparse);
    add_option(&s, "--Mapper.min_model_size", SMALLEST_MODEL);
    snprintf(threads, sizeof threads, "%d", job->options->threads);
    if (job->options->threads)
        add_option(&s, "--Mapper.num_threads", threads);
    return run(&s);
}

adcgs_status adcgs_import_poses(adcgs_import_job *job, const adcgs_colmap_program *program)
{
    places p = {adcgs_path("%s/database.db", job->folder), adcgs_path("%s/images", job->folder),
                adcgs_path("%s/masks", job->folder), adcgs_path("%s/sparse", job->folder)};
    adcgs_status status = p.database && p.images && p.masks && p.sparse
                              ? adcgs_import_make_folder(job, "sparse")
                              : adcgs_fail(job->error, ADCGS_ERR_MEMORY, "%s: out of memory", job->folder);
    if (status == ADCGS_OK)
        status = extract(job, program, &p);
    if (status == ADCGS_OK)
        status = match(job, program, &p);
    if (status == ADCGS_OK)
        status = map(job, program, &p);
    free(p.database);
    free(p.images);
    free(p.masks);
    free(p.sparse);
    return status;
}
