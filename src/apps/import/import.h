/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Makes a scene from footage with unknown cameras: images, a video of a moving camera, or synchronised videos of fixed cameras.
 * Images are extracted, rotated upright and reduced to a maximum size. COLMAP estimates the cameras. A scene file describes the
 * result. The folder appears complete or not at all. Until then it has the output's name with ".importing" appended and holds
 * COLMAP's log; the next run with the same footage continues from it.
 */
#ifndef ADCGS_APPS_IMPORT_IMPORT_H
#define ADCGS_APPS_IMPORT_IMPORT_H

#include "cli/cli.h"
#include "media/video/fps.h"

/** Models with more parameters describe a lens better, given many images; from few images, parameters may be fitted wrongly. */
typedef enum adcgs_import_lens {
    ADCGS_IMPORT_RADIAL,
    ADCGS_IMPORT_PINHOLE,
    ADCGS_IMPORT_OPENCV,
    ADCGS_IMPORT_FISHEYE,
} adcgs_import_lens;

typedef enum adcgs_import_mapper {
    ADCGS_IMPORT_AUTO, /**< glomap where it is installed, else COLMAP's mapper */
    ADCGS_IMPORT_COLMAP,
    ADCGS_IMPORT_GLOMAP,
} adcgs_import_mapper;

typedef struct adcgs_import_options {
    char *const *inputs; /**< files and folders, as on the command line */
    int n_inputs;
    const char *output;     /**< folder to create */
    const char *colmap;     /**< name or path of the program */
    const char *vocab_tree; /**< file for COLMAP, or NULL: one of those that are installed */
    int mapper;             /**< adcgs_import_mapper */
    const char *masks;      /**< a folder, or NULL */
    int side;               /**< maximum width and height of images */
    int frames;             /**< maximum number of frames from a moving camera's video */
    int test_every;         /**< every test_every-th view or fixed camera is for testing; 0: none */
    int lens;               /**< adcgs_import_lens */
    int own_lens;           /**< each camera of a rig has intrinsics of its own */
    int anyway;             /**< accepts poses without parallax, and of few images */
    int threads;            /**< for COLMAP; 0: one per processor */
    adcgs_fps fps;          /**< of images taken one after another; unknown: all at one time */
} adcgs_import_options;

/** Quality of the poses. */
typedef struct adcgs_import_report {
    const char *kind;         /**< "pictures", "film" or "rig" */
    uint32_t pictures, posed; /**< images given to COLMAP, and those with a pose */
    uint32_t cameras, found;  /**< fixed cameras of a rig, and those with a pose; otherwise 0 */
    const char *mapper;       /**< program that found the cameras: "colmap" or "glomap" */
    uint32_t models;          /**< models made by it; the largest is used */
    uint32_t points;          /**< initial points for training */
    double error;             /**< mean reprojection error in pixels */
    double track;             /**< mean number of images that see a point */
    double angle;             /**< median triangulation angle of points, degrees */
    double spread;            /**< for a rig: spread of its cameras' poses over time, relative to the cameras' mean distance */
    double seconds;           /**< of the footage */
    int width, height;        /**< of the first image */
    const char *hdr;          /**< "HLG" or "PQ" if a video has high dynamic range, which is converted; else NULL */
    int has_sound;            /**< the scene has the sound of a video */
    char sound_fault[200];    /**< why a sound was left out; empty: none was */
    int is_numbered;          /**< images without times whose names only count: possibly frames of a video */
} adcgs_import_report;

/**
 * Median triangulation angle, in degrees, below which the depth of points is mostly noise. A step of half a
 * metre to the side at a distance of 20 metres gives 1.4. Chosen by hand, not measured.
 */
#define ADCGS_IMPORT_ANGLE_LEAST 1.5
/** Least share of the images, or fixed cameras, with a pose; chosen by hand, not measured. */
#define ADCGS_IMPORT_POSED_LEAST 0.5

/**
 * Returns ADCGS_ERR_USAGE for conflicting operands or an existing output, ADCGS_ERR_UNSUPPORTED without COLMAP, ADCGS_ERR_DATA
 * if COLMAP finds no poses.
 */
adcgs_status adcgs_import(const adcgs_import_options *options, adcgs_progress *progress, adcgs_import_report *report,
                          adcgs_error *error);

#endif
