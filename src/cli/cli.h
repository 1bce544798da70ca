/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Command line of all programs: a table of options that parses itself and
 * prints its own help, messages, progress.
 */
#ifndef ADCGS_CLI_CLI_H
#define ADCGS_CLI_CLI_H

#include "base/thread_pool.h"

#include <stdio.h>

typedef enum adcgs_option_kind {
    ADCGS_OPTION_FLAG,    /**< target: int, set to 1 */
    ADCGS_OPTION_STRING,  /**< target: const char * */
    ADCGS_OPTION_FILE,    /**< as STRING: the name of a file or folder */
    ADCGS_OPTION_INT,     /**< target: int; suffixes k and M are powers of 1000 */
    ADCGS_OPTION_SIZE,    /**< target: uint64_t; suffixes k, M, G are powers of 1000, KiB, MiB, GiB of 1024 */
    ADCGS_OPTION_REAL,    /**< target: double */
    ADCGS_OPTION_SECONDS, /**< target: double; suffixes ms, s, m, min and h */
    ADCGS_OPTION_PAIR,    /**< target: int[2]; WIDTHxHEIGHT */
    ADCGS_OPTION_CHOICE,  /**< target: int, index into choices */
    ADCGS_OPTION_FORMER   /**< former name, or without a name former letter, of the option called `value`: accepted with a remark,
                          not listed */
} adcgs_option_kind;

/** One option. A target keeps its value if the option is not given, so defaults are set there. */
typedef struct adcgs_option {
    const char *name; /**< long name without dashes; NULL: a former letter */
    char letter;      /**< short name, 0: none; one meaning in all programs (doc/hacking/add-an-option.md) */
    adcgs_option_kind kind;
    void *target;
    double min, max;            /**< inclusive range of INT, SIZE, REAL, SECONDS and PAIR */
    const char *value;          /**< name of the value in the help; NULL for a FLAG */
    const char *help;           /**< one sentence without full stop; '\n' continues on the next line */
    const char *const *choices; /**< names of a CHOICE, ended by NULL; words of a STRING or FILE, for completion alone */
    int *given;                 /**< set to 1 when the option is given; may be NULL */
} adcgs_option;

#define ADCGS_OPTIONS_MAX 64 /**< options of a program, at most; chosen by hand, not measured */

/** A table of options that consists of groups. Zero-initialise before the first group. */
typedef struct adcgs_option_table {
    adcgs_option rows[ADCGS_OPTIONS_MAX];
    size_t n;
} adcgs_option_table;

/** Appends a group of n options. More than ADCGS_OPTIONS_MAX are a defect of the program, which then ends with exit status 1. */
void adcgs_options_add(adcgs_option_table *table, const adcgs_option *group, size_t n);

typedef enum adcgs_option_relation {
    ADCGS_OPTION_EXCLUDES,  /**< none of the options with any of the others */
    ADCGS_OPTION_APART,     /**< at most one of the options */
    ADCGS_OPTION_NEEDS,     /**< the options with at least one of the others */
    ADCGS_OPTION_GOES_WITH, /**< the options with each other and the others only; no others: alone */
} adcgs_option_relation;

/**
 * A rule for options that go together: names without dashes, separated by commas. adcgs_cli_parse() reports the first broken rule
 * in one form for all programs: "--a and --b exclude --c". A name that is no option is a defect of the program.
 */
typedef struct adcgs_option_rule {
    const char *options;
    adcgs_option_relation relation;
    const char *others; /**< NULL: none */
} adcgs_option_rule;

/**
 * A program. --help (-h) and --version (-V) are added automatically, and --quiet (-q) if quiet is set. --completion alone, which
 * the help does not list, prints the table for the shell (cli/completion.h).
 */
typedef struct adcgs_cli {
    const char *program;  /**< "adcgs-dec" */
    const char *operands; /**< "FILE|-" */
    const char *summary;  /**< purpose of the program, one sentence */
    const char *details;  /**< printed after the options; may be NULL */
    const adcgs_option *options;
    size_t n_options;               /**< at most ADCGS_OPTIONS_MAX */
    const adcgs_option_rule *rules; /**< in the order of their checks; may be NULL */
    size_t n_rules;
    int min_operands, max_operands;
    int *quiet;                       /**< set to 1 by --quiet, which suppresses progress and remarks; NULL: no such option */
    const char *const *operand_words; /**< words of the first operand, ended by NULL, for completion; NULL: it is a file */
} adcgs_cli;

/**
 * Parse argv; operands end up in argv[*first .. argc).
 * \return -1 to continue, else the exit code to leave with (0 after --help, --version and --completion, 2 after a usage error,
 * which has been reported).
 */
int adcgs_cli_parse(const adcgs_cli *cli, int argc, char **argv, int *first);

/** 0 success, 1 a defect of ours, 2 usage, 3 input/output or memory, 4 invalid data, 5 unsupported. */
int adcgs_exit_code(adcgs_status status);

/* Each message has one line: control characters in its names and texts are escaped (system/text.h). */
/** Print "program: text" on stderr and return the exit code of error->status. */
int adcgs_cli_fail(const adcgs_cli *cli, const adcgs_error *error);
/**
 * As adcgs_cli_fail() with a message of its own; with ADCGS_OK for a message that is no failure, but must appear with --quiet.
 */
int adcgs_cli_error(const adcgs_cli *cli, adcgs_status status, const char *format, ...) ADCGS_PRINTF(3, 4);
/** Flush standard output. ADCGS_ERR_IO if any output, now or earlier, could not be written. */
adcgs_status adcgs_cli_flush(adcgs_error *error);
/**
 * The exit code to leave with: `code`, or that of ADCGS_ERR_IO if a so far successful run could not write to standard output. The
 * function reports that error. Call it last.
 */
int adcgs_cli_leave(const adcgs_cli *cli, int code);
/** A remark that does not end the program: "program: text" on stderr, suppressed by --quiet. */
void adcgs_cli_note(const adcgs_cli *cli, const char *format, ...) ADCGS_PRINTF(2, 3);
/** A pool of threads, 0: one per processor. Prints a note if the system starts fewer. */
adcgs_status adcgs_cli_pool(const adcgs_cli *cli, adcgs_pool **out, int threads, adcgs_error *error);

/** Progress of a program: on a terminal a line that rewrites itself, else an occasional remark. */
typedef struct adcgs_progress {
    const adcgs_cli *cli;
    int is_terminal, shown;
    double last;    /**< time of the last line */
    double every;   /**< seconds between two lines */
    double grace;   /**< seconds that adcgs_progress_keep() waits for a line from the program */
    char said[256]; /**< the last text given, shown or not; "": none valid */
    double said_at;
    struct adcgs_pulse *pulse; /**< NULL without adcgs_progress_keep() */
} adcgs_progress;

/** No output with --quiet. */
void adcgs_progress_init(adcgs_progress *progress, const adcgs_cli *cli);
/**
 * Shows at most ten lines a second on a terminal; elsewhere the first after 5 seconds, the next 10 later, and so on up to every
 * 25 seconds.
 */
void adcgs_progress_show(adcgs_progress *progress, const char *format, ...) ADCGS_PRINTF(2, 3);
/** Format the time left for a progress line, "  1:05 left"; "" if seconds is NaN. Returns text or "". */
const char *adcgs_progress_eta(double seconds, char text[32]);
/** Erase the line; call before any other message and at the end. */
void adcgs_progress_clear(adcgs_progress *progress);
/**
 * From now until adcgs_progress_end(), print a line at least every 30 seconds if there is no terminal, also while the program
 * shows none. The last line is then repeated with its age. A line that ends in " ...", for lasting work, is repeated with its
 * elapsed time. progress must not move in memory.
 */
void adcgs_progress_keep(adcgs_progress *progress);
void adcgs_progress_end(adcgs_progress *progress);

#endif
