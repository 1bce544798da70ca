/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs: runs the program of a verb, adcgs-VERB, in the folder of this program or in PATH. */
#include "config.h"

#include "cli/cli.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define VERBS_MAX 16       /* rows of the table below, and the end of a list; definition */
#define VERB_LENGTH_MAX 32 /* bytes of a verb that is compared with others; chosen by hand, not measured */

typedef struct verb {
    const char *name, *purpose;
} verb;

/* In the order of their use. */
static const verb verbs[] = {
    {"import", "make a scene of images or videos with unknown cameras"},
    {"check", "judge the footage of a scene before training"},
    {"enc", "train a scene and write it as a stream"},
    {"dec", "decode, render and play a stream"},
    {"info", "print the contents of a stream"},
    {"eval", "compare a stream with the images of a scene"},
    {"share", "make a page for browsers of a stream"},
    {"join", "join the parts of a plan to one stream"},
    {"sweep", "encode a scene at several rates and plot the curve"},
    {"conform", "check a decoder against conformance vectors"},
    {"demo-scene", "render a built-in scene"},
};

/* ---- Finding programs ---- */

/** Writes FOLDER/adcgs-VERB. \return whether there is such a program. */
static int is_program(char path[PATH_MAX], const char *folder, size_t length, const char *name)
{
    const int n = snprintf(path, PATH_MAX, "%.*s/adcgs-%s", (int)length, folder, name);
    return n > 0 && n < PATH_MAX && !access(path, X_OK);
}

/** The folder of this program: of the file itself where there is /proc, else of the name by which it was called. May be empty. */
static void find_folder(char folder[PATH_MAX], const char *called)
{
    const ssize_t n = readlink("/proc/self/exe", folder, PATH_MAX - 1);
    if (n > 0)
        folder[n] = 0;
    else if (snprintf(folder, PATH_MAX, "%s", called) >= PATH_MAX)
        folder[0] = 0;
    char *last = strrchr(folder, '/');
    *(last ? last : folder) = 0;
}

/** Finds adcgs-VERB. \return whether there is one; its path is in `path`. */
static int find_program(char path[PATH_MAX], const char *called, const char *name)
{
    char folder[PATH_MAX];
    find_folder(folder, called);
    if (strchr(name, '/'))
        return 0;
    if (folder[0] && is_program(path, folder, strlen(folder), name))
        return 1;
    for (const char *at = getenv("PATH"); at;) {
        const size_t length = strcspn(at, ":");
        if (length && is_program(path, at, length, name))
            return 1;
        at = at[length] ? at + length + 1 : NULL;
    }
    return 0;
}

/* ---- Unknown verbs ---- */

/** Characters to insert, delete or replace that make one word of the other. */
static size_t edit_distance(const char *a, const char *b)
{
    size_t row[VERB_LENGTH_MAX + 1];
    const size_t n = strlen(b);
    for (size_t j = 0; j <= n; j++)
        row[j] = j;
    for (size_t i = 0; a[i]; i++) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < n; j++) {
            const size_t replaced = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = ADCGS_MIN(replaced, ADCGS_MIN(diagonal, row[j]) + 1);
        }
    }
    return row[n];
}

/** The verb that begins with the word, or that begins the word; else the nearest one within two characters; else NULL. */
static const char *nearest(const char *word)
{
    const char *found = NULL;
    size_t least = 3;
    if (!word[0] || strlen(word) > VERB_LENGTH_MAX)
        return NULL;
    for (size_t i = 0; i < ADCGS_COUNTOF(verbs); i++) {
        const char *name = verbs[i].name;
        const int begins = !strncmp(word, name, ADCGS_MIN(strlen(word), strlen(name)));
        const size_t distance = begins ? 0 : edit_distance(word, name);
        if (distance < least && (begins || distance < strlen(name))) {
            least = distance;
            found = name;
        }
    }
    return found;
}

static int refuse(const adcgs_cli *cli, const char *word)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(verbs); i++)
        if (!strcmp(verbs[i].name, word))
            return adcgs_cli_error(cli, ADCGS_ERR_UNSUPPORTED,
                                   "adcgs-%s is neither in the folder of this program nor in PATH: install it", word);
    const char *meant = nearest(word);
    if (meant)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "%s: unknown verb; the nearest is %s; try 'adcgs help'", word, meant);
    return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "%s: unknown verb; try 'adcgs help'", word);
}

/* ---- Command line ---- */

/** Runs adcgs-VERB with arguments; its name replaces the first one. Returns only after a failure. */
static int run(const adcgs_cli *cli, const char *called, const char *name, char **arguments)
{
    char path[PATH_MAX];
    if (!find_program(path, called, name))
        return refuse(cli, name);
    arguments[0] = path;
    execv(path, arguments);
    return adcgs_cli_error(cli, ADCGS_ERR_IO, "%s: cannot run: %s", path, strerror(errno));
}

/** Options without a verb. The help and the completion list the verbs whose programs are found. */
static int parse(adcgs_cli *cli, int argc, char **argv)
{
    const char *words[VERBS_MAX] = {"help"};
    char text[2048] = "Verbs ('adcgs help VERB' prints the options of one):", path[PATH_MAX];
    size_t n = 1, at = strlen(text);
    int first;
    _Static_assert(ADCGS_COUNTOF(verbs) + 2 <= VERBS_MAX, "words ends in NULL");
    for (size_t i = 0; i < ADCGS_COUNTOF(verbs); i++)
        if (find_program(path, argv[0], verbs[i].name) && at < sizeof text) {
            at += (size_t)snprintf(text + at, sizeof text - at, "\n  %-12s%s", verbs[i].name, verbs[i].purpose);
            words[n++] = verbs[i].name;
        }
    cli->details = text;
    cli->operand_words = words;
    const int code = adcgs_cli_parse(cli, argc, argv, &first);
    return code >= 0 ? code : refuse(cli, argv[first]);
}

int main(int argc, char **argv)
{
    adcgs_cli cli = {.program = "adcgs",
                     .operands = "VERB [ARGUMENT...]",
                     .summary = "Run the program of a verb: 'adcgs enc' is 'adcgs-enc'.",
                     .min_operands = 1,
                     .max_operands = 1};
    char help[] = "--help", *ask[] = {argv[0], help, NULL};
    if (argc > 1 && argv[1][0] != '-' && strcmp(argv[1], "help") != 0)
        return run(&cli, argv[0], argv[1], argv + 1);
    if (argc == 3 && argv[1][0] != '-' && argv[2][0] != '-') /* help VERB */
        return run(&cli, argv[0], argv[2], ask);
    if (argc > 1 && argv[1][0] != '-') /* help, help --completion */
        return argc == 2 ? parse(&cli, 2, ask) : parse(&cli, argc - 1, argv + 1);
    return parse(&cli, argc, argv);
}
