/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Command lines of a sweep's runs, and the processes that execute them. */
#include "config.h"

#include "apps/sweep/command.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

/** Leaves the ranks of mpirun or srun: children of a sweep are independent processes, for which no other rank waits. */
static void leave_ranks(void)
{
    unsetenv("OMPI_COMM_WORLD_SIZE");
    unsetenv("PMIX_RANK");
}

static void redirect(const char *path, int descriptor, int flags)
{
    const int file = open(path, O_WRONLY | O_CREAT | flags, 0666);
    if (file < 0 || dup2(file, descriptor) < 0)
        _exit(126);
    close(file);
}

adcgs_status adcgs_sweep_spawn(char *const argv[], const char *out, const char *log, int *exit_code, adcgs_error *error)
{
    int state = 0;
    const pid_t child = fork();
    if (child < 0)
        return adcgs_fail(error, ADCGS_ERR_IO, "cannot start %s: %s", argv[0], strerror(errno));
    if (child == 0) {
        if (out)
            redirect(out, STDOUT_FILENO, O_TRUNC);
        if (log)
            redirect(log, STDERR_FILENO, O_APPEND);
        leave_ranks();
        execvp(argv[0], argv);
        _exit(127);
    }
    while (waitpid(child, &state, 0) < 0)
        if (errno != EINTR)
            return adcgs_fail(error, ADCGS_ERR_IO, "%s: %s", argv[0], strerror(errno));
    *exit_code = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
    return ADCGS_OK;
}

void adcgs_command_word(adcgs_command *c, const char *text)
{
    if (c->n + 1 < (int)ADCGS_COUNTOF(c->argv))
        c->argv[c->n++] = (char *)(uintptr_t)text; /* exec takes pointers to char, and does not change the characters */
    c->argv[c->n] = NULL;
}

void adcgs_command_option(adcgs_command *c, const char *name, const char *value)
{
    if (!value || !*value)
        return;
    adcgs_command_word(c, name);
    adcgs_command_word(c, value);
}

void adcgs_command_number(adcgs_command *c, const char *name, double value, double from)
{
    if (value < from || c->n_text == (int)ADCGS_COUNTOF(c->text))
        return;
    char *const text = c->text[c->n_text++];
    snprintf(text, sizeof c->text[0], "%.17g", value);
    adcgs_command_option(c, name, text);
}

void adcgs_command_choice(adcgs_command *c, const adcgs_sweep_run *run, const char *const *only)
{
    char name[ADCGS_SWEEP_NAME];
    for (const char *at = run->choice; (at = adcgs_sweep_choice_next(at, name, c->value[c->n_chosen]));) {
        const char *const *wanted = only;
        while (wanted && *wanted && strcmp(*wanted, name) != 0)
            wanted++;
        if (!adcgs_sweep_axis_is_option(name) || (wanted && !*wanted))
            continue;
        snprintf(c->name[c->n_chosen], sizeof c->name[0], "--%s", name);
        adcgs_command_option(c, c->name[c->n_chosen], c->value[c->n_chosen]);
        if (++c->n_chosen == ADCGS_SWEEP_AXES)
            return;
    }
}

void adcgs_command_settings(adcgs_command *c, const adcgs_sweep *sweep, const adcgs_sweep_run *run)
{
    char name[ADCGS_SWEEP_NAME], value[ADCGS_SWEEP_NAME];
    int n = snprintf(c->set, sizeof c->set, "%s", sweep->set ? sweep->set : "");
    for (const char *at = run->choice; (at = adcgs_sweep_choice_next(at, name, value)) && n < (int)sizeof c->set;)
        if (!adcgs_sweep_axis_is_option(name))
            n += snprintf(c->set + n, sizeof c->set - (size_t)n, "%s%s=%s", n ? "," : "", name, value);
    adcgs_command_option(c, "--set", c->set);
}

void adcgs_command_threads(adcgs_command *c, const adcgs_sweep *sweep, const adcgs_sweep_run *run)
{
    char value[ADCGS_SWEEP_NAME];
    if (!adcgs_sweep_choice_find(run->choice, "threads", value))
        adcgs_command_number(c, "--threads", sweep->threads, 1);
}
