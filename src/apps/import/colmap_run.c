/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Runs COLMAP's programs one after another: features, matches, cameras. No display and no GPU is needed. */
#include "config.h"

#include "apps/import/colmap_run.h"

#include "apps/import/child.h"
#include "apps/import/vocabulary.h"
#include "system/interrupt.h"
#include "system/paths.h"

#include <errno.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define WORDS_MAX 32      /* words of a command */
#define SEQUENCE_LEAST 30 /* images of a film from which on only neighbours in time are matched */
#define OVERLAP "10"      /* images after each; and those 1, 2, 4, 8, ... 512 images later (quadratic overlap) */
#define MAPPER_GROWTH 1.5 /* exponent of the number of images in the mapper's time: each adjustment of all takes longer */
#define SMALLEST_MODEL "3"
#define GLOMAP "glomap"
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
    double growth;    /* of the time with the number of images; see phase.h */
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

/** Finds two numbers in "[12/200]", "[2/5, 3/5]" (blocks of pairs), or one in "(34)". */
static int read_count(const char *text, uint32_t *done, uint32_t *all)
{
    unsigned a[4];
    const int n = sscanf(text, "[%6u/%6u, %6u/%6u", &a[0], &a[1], &a[2], &a[3]);
    if (n == 4 && a[0] && a[2]) {
        *done = (a[0] - 1) * a[3] + a[2];
        *all = a[1] * a[3];
    } else if (n >= 2) {
        *done = a[0];
        *all = a[1];
    } else
        return sscanf(text, "(%6u", done) == 1;
    return 1;
}

/** Reads the progress from lines such as "Processed file [12/200]", "Registering image #7 (34)". */
static int hear(void *user, const char *line)
{
    step *s = user;
    adcgs_import_job *job = s->job;
    const char *mark = s->mark ? strstr(line, s->mark) : NULL, *open = mark ? strpbrk(mark, "[(") : NULL;
    uint32_t done, all = job->sources.n;
    if (open && read_count(open, &done, &all))
        adcgs_import_show(&job->phase, job->progress, s->name, done, all, s->growth);
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
    adcgs_import_show(&job->phase, job->progress, s->name, 0, 0, s->growth);
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
    step s = {.job = job, .program = program, .name = name, .mark = mark, .growth = 1.0};
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

/** Finds out whether glomap is installed and wanted. */
static adcgs_status ask_glomap(adcgs_colmap_program *out, const adcgs_import_options *options, adcgs_error *error)
{
    char *const words[] = {GLOMAP, "mapper", "-h", NULL};
    adcgs_colmap_program found = {0};
    int code;
    if (options->mapper == ADCGS_IMPORT_COLMAP)
        return ADCGS_OK;
    const adcgs_status status = adcgs_child_run(words, NULL, hear_options, &found, &code, error);
    out->has_glomap = status == ADCGS_OK && found.is_known;
    if (options->mapper == ADCGS_IMPORT_GLOMAP && !out->has_glomap)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED,
                          "--mapper glomap: no such program on the path: install it, or leave the option out");
    return ADCGS_OK;
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
    if (!out->is_known)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED,
                          "%s: its feature_extractor takes no --database_path, expected COLMAP 3.6 or later", options->colmap);
    return ask_glomap(out, options, error);
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

/** True if the images are one after another in time, also in the order of their names, which is COLMAP's. */
static int is_sequence(const adcgs_source_images *sources)
{
    int follows = sources->n >= SEQUENCE_LEAST && sources->n_cameras == 1 &&
                  (sources->kind == ADCGS_FOOTAGE_FILM || (sources->kind == ADCGS_FOOTAGE_PICTURES && sources->is_numbered));
    for (uint32_t i = 1; follows && i < sources->n; i++)
        follows = strcmp(sources->list[i - 1].stem, sources->list[i].stem) < 0;
    return follows;
}

/** tree: the vocabulary by which the matcher finds places that the film shows again; or NULL. */
static adcgs_status match_with(adcgs_import_job *job, const adcgs_colmap_program *program, const places *p, const char *tree)
{
    char threads[16];
    const int follows = is_sequence(&job->sources);
    step s = begin(job, program, follows ? "sequential_matcher" : "exhaustive_matcher", "matching", "Matching");
    add_option(&s, "--database_path", p->database);
    if (follows) {
        add_option(&s, "--SequentialMatching.overlap", OVERLAP);
        add_option(&s, "--SequentialMatching.quadratic_overlap", "1");
    }
    if (follows && tree) {
        add_option(&s, "--SequentialMatching.loop_detection", "1");
        add_option(&s, "--SequentialMatching.vocab_tree_path", tree);
    }
    add_option(&s, "--SiftMatching.use_gpu", "0");
    snprintf(threads, sizeof threads, "%d", job->options->threads);
    if (job->options->threads)
        add_option(&s, "--SiftMatching.num_threads", threads);
    return run(&s);
}

/** A tree that was found, and that COLMAP cannot use, is left out. */
static adcgs_status match(adcgs_import_job *job, const adcgs_colmap_program *program, const places *p)
{
    char *found = NULL;
    if (job->options->vocab_tree)
        return match_with(job, program, p, job->options->vocab_tree);
    if (is_sequence(&job->sources))
        ADCGS_TRY(adcgs_import_find_vocabulary(&found, program->is_renamed, job->error));
    adcgs_status status = match_with(job, program, p, found);
    if (status == ADCGS_ERR_DATA && found) {
        adcgs_progress_clear(job->progress);
        adcgs_cli_note(job->progress->cli, "%s: COLMAP cannot use this vocabulary tree; matching without it", found);
        status = match_with(job, program, p, NULL);
    }
    free(found);
    return status;
}

static adcgs_status map_by_colmap(adcgs_import_job *job, const adcgs_colmap_program *program, const places *p)
{
    char threads[16];
    step s = begin(job, program, "mapper", "cameras", "Registering image");
    s.growth = MAPPER_GROWTH;
    add_option(&s, "--database_path", p->database);
    add_option(&s, "--image_path", p->images);
    add_option(&s, "--output_path", p->sparse);
    add_option(&s, "--Mapper.min_model_size", SMALLEST_MODEL);
    snprintf(threads, sizeof threads, "%d", job->options->threads);
    if (job->options->threads)
        add_option(&s, "--Mapper.num_threads", threads);
    job->report->mapper = "colmap";
    return run(&s);
}

/** Places all cameras at once, which takes less time for many images. Its progress has no numbers. */
static adcgs_status map_by_glomap(adcgs_import_job *job, const adcgs_colmap_program *program, const places *p)
{
    step s = {.job = job, .program = program, .name = "cameras", .growth = 1.0};
    add_word(&s, GLOMAP);
    add_word(&s, "mapper");
    add_option(&s, "--database_path", p->database);
    add_option(&s, "--image_path", p->images);
    add_option(&s, "--output_path", p->sparse);
    job->report->mapper = GLOMAP;
    ADCGS_TRY(run(&s));
    return adcgs_is_there_at("%s/0", p->sparse)
               ? ADCGS_OK
               : adcgs_fail(job->error, ADCGS_ERR_DATA, "%s found no cameras; its output is in %s", GLOMAP, job->log);
}

static adcgs_status map(adcgs_import_job *job, const adcgs_colmap_program *program, const places *p)
{
    if (!program->has_glomap)
        return map_by_colmap(job, program, p);
    const adcgs_status status = map_by_glomap(job, program, p);
    if (status != ADCGS_ERR_DATA || job->options->mapper == ADCGS_IMPORT_GLOMAP)
        return status;
    adcgs_progress_clear(job->progress);
    adcgs_cli_note(job->progress->cli, "%s: continuing with COLMAP's mapper", job->error->text);
    ADCGS_TRY(adcgs_import_remove(job, "sparse")); /* unfinished models */
    ADCGS_TRY(adcgs_import_make_folder(job, "sparse"));
    return map_by_colmap(job, program, p);
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
