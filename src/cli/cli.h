/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * What all programs share on the command line: a table of options that parses
 * itself and prints its own help, numbers with ranges, messages, progress, the
 * interrupt flag.
 */
#ifndef ADCGS_CLI_CLI_H
#define ADCGS_CLI_CLI_H

#include "base/pool.h"

#include <stdio.h>

typedef enum adcgs_option_kind {
    ADCGS_OPTION_FLAG,   /**< target: int, set to 1 */
    ADCGS_OPTION_STRING, /**< target: const char * */
    ADCGS_OPTION_FILE,   /**< as STRING: the name of a file or folder */
    ADCGS_OPTION_INT,    /**< target: int; suffixes k and M are powers of 1000 */
    ADCGS_OPTION_SIZE,   /**< target: uint64_t; suffixes k, M, G are powers of 1000, KiB, MiB, GiB of 1024 */
    ADCGS_OPTION_REAL,   /**< target: double */
    ADCGS_OPTION_SECONDS, /**< target: double; suffixes ms, s, m, min and h */
    ADCGS_OPTION_PAIR,   /**< target: int[2]; WIDTHxHEIGHT */
    ADCGS_OPTION_CHOICE  /**< target: int, index into choices */
} adcgs_option_kind;

/** One option. Targets keep their value when the option is not given, so set the defaults there. */
typedef struct adcgs_option {
    const char *name;   /**< long name without dashes */
    char letter;        /**< short name, 0: none */
    adcgs_option_kind kind;
    void *target;
    double min, max;    /**< inclusive range of INT, SIZE, REAL, SECONDS and PAIR */
    const char *value;  /**< what the help calls the value; NULL for a FLAG */
    const char *help;   /**< one sentence without full stop; '\n' continues on the next line */
    const char *const *choices; /**< names of a CHOICE, ended by NULL; words of a STRING or FILE, for completion alone */
    int *given;         /**< set to 1 when the option is given; may be NULL */
} adcgs_option;

/**
 * A program. --help (-h) and --version (-V) are added by themselves, and --quiet (-q) where quiet is set. --completion alone,
 * which the help is silent about, prints the table for the shell (cli/completion.h).
 */
typedef struct adcgs_cli {
    const char *program;  /**< "adcgs-dec" */
    const char *operands; /**< "FILE|-" */
    const char *summary;  /**< what it does, one sentence */
    const char *details;  /**< printed after the options; may be NULL */
    const adcgs_option *options;
    size_t n_options;
    int min_operands, max_operands;
    int *quiet; /**< set to 1 by --quiet: neither progress nor remarks are printed; NULL: no such option */
} adcgs_cli;

/**
 * Parse argv; operands end up in argv[*first .. argc).
 * \return -1 to go on, else the exit code to leave with (0 after --help, --version and --completion, 2 after a mistake, which has
 * been reported).
 */
int adcgs_cli_parse(const adcgs_cli *cli, int argc, char **argv, int *first);

/** 0 fine, 1 a defect of ours, 2 usage, 3 input/output or memory, 4 invalid data, 5 unsupported. */
int adcgs_exit_code(adcgs_status status);

/* Messages are one line each: what a terminal would obey in the names and texts in them is shown as escapes (cli/text.h). */
/** Print "program: text" on stderr and return the exit code of error->status. */
int adcgs_cli_fail(const adcgs_cli *cli, const adcgs_error *error);
/** As adcgs_cli_fail() with a message of its own; with ADCGS_OK for what is no failure, and --quiet must not hide. */
int adcgs_cli_error(const adcgs_cli *cli, adcgs_status status, const char *format, ...) ADCGS_PRINTF(3, 4);
/** Write out what standard output holds back. ADCGS_ERR_IO unless all that was printed, now and earlier, has arrived. */
adcgs_status adcgs_cli_flush(adcgs_error *error);
/**
 * The exit code to leave with: `code`, or that of ADCGS_ERR_IO, which is reported, when something of a run that was fine so far
 * could not be written to standard output. The last thing that a program does.
 */
int adcgs_cli_leave(const adcgs_cli *cli, int code);
/** A remark that does not end the program: "program: text" on stderr, unless --quiet was given. */
void adcgs_cli_note(const adcgs_cli *cli, const char *format, ...) ADCGS_PRINTF(2, 3);
/** A pool of threads, 0: one for each processor. That the system starts fewer is a note. */
adcgs_status adcgs_cli_pool(const adcgs_cli *cli, adcgs_pool **out, int threads, adcgs_error *error);

/* Whole-string parsers: 0, or -1 when text is not exactly one number of the kind within [min, max]. */
int adcgs_parse_int(const char *text, int min, int max, int *out);
/** The same, or thousands (20k, 1.5k) or millions (2M) that are whole. */
int adcgs_parse_count(const char *text, int min, int max, int *out);
/** Seconds, or with a unit: 500ms, 2s, 10m or 10min, 1.5h. */
int adcgs_parse_seconds(const char *text, double min, double max, double *out);
/** Digits, or with a suffix (k, M, G, also followed by B, or Ki, Mi, Gi likewise) also a decimal fraction, rounded down: 1.5M. */
int adcgs_parse_size(const char *text, uint64_t min, uint64_t max, uint64_t *out);
int adcgs_parse_real(const char *text, double min, double max, double *out);
int adcgs_parse_pair(const char *text, int min, int max, int out[2]);
/** "T" or "A:B" as adcgs_parse_seconds() has them; *end == *begin for the former. */
int adcgs_parse_times(const char *text, double *begin, double *end);

/** Make the first so many of SIGINT, SIGTERM and SIGHUP, unless that is ignored, set a flag; one more kills. */
void adcgs_interrupt_catch(int most);
/** Make one of these print a line, which stays where it is in memory, on standard error before it kills. */
void adcgs_interrupt_word(const char *text);
/** The signal that came last, 0 if none. */
int adcgs_interrupted(void);
/** How many came. */
int adcgs_interrupts(void);

/** How far a program is: on a terminal a line that rewrites itself, else a remark now and then. */
typedef struct adcgs_progress {
    const adcgs_cli *cli;
    int is_terminal, shown;
    double last;  /**< when it was drawn */
    double every; /**< seconds from one to the next */
    double grace; /**< that adcgs_progress_keep() leaves a line to come by itself */
    char said[256]; /**< what was given last, drawn or not; "": nothing that still holds */
    double said_at;
    struct adcgs_pulse *pulse; /**< NULL unless it is kept */
} adcgs_progress;

/** Silent with --quiet. */
void adcgs_progress_init(adcgs_progress *progress, const adcgs_cli *cli);
/** At most ten times a second on a terminal; elsewhere after 5 seconds, after 10 more, and so on up to every 25 seconds. */
void adcgs_progress_show(adcgs_progress *progress, const char *format, ...) ADCGS_PRINTF(2, 3);
/** Wipe the line; call before any other message and at the end. */
void adcgs_progress_clear(adcgs_progress *progress);
/**
 * From now on, and until adcgs_progress_end(), a line comes every 30 seconds at least where there is no terminal, also while
 * nothing is shown: then it is the last one once more, with its age; of a line that ends in " ...", for work that lasts, with
 * its time so far. It stays where it is in memory meanwhile.
 */
void adcgs_progress_keep(adcgs_progress *progress);
void adcgs_progress_end(adcgs_progress *progress);

#endif
