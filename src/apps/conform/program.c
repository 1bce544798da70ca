/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Tries one conformance vector on a program with the protocol of the spec clause "Conformance". */
#include "config.h"

#include "apps/conform/conform.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define ANSWERS_MAX (1 << 20) /* bytes of a program's answers; chosen by hand, not measured */

/** One run of the program. */
typedef struct run {
    char in[4096], request[64], out[64];
    char *command;
    char *answers; /**< the program's output */
    size_t bytes;
    int status; /**< from waitpid() */
    int timed_out;
    char *what;
} run;

static adcgs_outcome wrong(const run *r, adcgs_outcome outcome, const char *format, const char *detail)
{
    snprintf(r->what, ADCGS_WHAT, format, detail);
    return outcome;
}

/* ---- The command ---- */

/* Appends a path as one word of the shell. */
static void put_quoted(FILE *out, const char *path)
{
    fputc('\'', out);
    for (; *path; path++) {
        if (*path == '\'')
            fputs("'\\'", out);
        fputc(*path, out);
    }
    fputc('\'', out);
}

/* Returns the command with its paths. *has_out: it names a file for its answers. */
static char *fill_command(const char *command, const run *r, int *has_out)
{
    const struct {
        const char *name, *path;
    } places[] = {{"{in}", r->in}, {"{request}", r->request}, {"{requests}", r->request}, {"{out}", r->out}};
    char *text = NULL;
    size_t bytes = 0, i;
    FILE *const out = open_memstream(&text, &bytes);
    *has_out = 0;
    while (out && *command) {
        for (i = 0; i < ADCGS_COUNTOF(places) && strncmp(command, places[i].name, strlen(places[i].name)); i++)
            ;
        if (i == ADCGS_COUNTOF(places)) {
            fputc(*command++, out);
            continue;
        }
        put_quoted(out, places[i].path);
        command += strlen(places[i].name);
        *has_out |= places[i].path == r->out;
    }
    if (out)
        fclose(out);
    return text;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Runs in the child, in a process group of its own, so that the whole group can be killed. */
static void become(const char *command, int output)
{
    const int nothing = open("/dev/null", O_RDWR);
    setpgid(0, 0);
    dup2(nothing, 0);
    dup2(output, 1);
    dup2(nothing, 2);
    execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    _exit(127);
}

/* Reads until the end or the deadline, and drops output beyond ANSWERS_MAX. */
static void collect(run *r, int fd, double deadline)
{
    char buffer[4096];
    for (;;) {
        struct pollfd p = {.fd = fd, .events = POLLIN};
        const double left = deadline - now();
        const int ready = left > 0 ? poll(&p, 1, (int)(1000 * left) + 1) : 0;
        if (ready < 0 && errno == EINTR)
            continue;
        const ssize_t n = ready > 0 ? read(fd, buffer, sizeof buffer) : -1;
        r->timed_out = ready <= 0;
        if (n <= 0)
            return;
        const size_t kept = ADCGS_MIN((size_t)n, ANSWERS_MAX - r->bytes);
        memcpy(r->answers + r->bytes, buffer, kept);
        r->bytes += kept;
    }
}

/* Waits for the program's end: it may close its output and continue. */
static void await(run *r, pid_t child, double deadline)
{
    const struct timespec moment = {.tv_nsec = 1000000};
    pid_t done = 0;
    while (!r->timed_out && (done = waitpid(child, &r->status, WNOHANG)) == 0) {
        r->timed_out = now() > deadline;
        nanosleep(&moment, NULL);
    }
    if (r->timed_out) {
        kill(-child, SIGKILL);
        kill(child, SIGKILL);
        waitpid(child, &r->status, 0);
    }
}

static int execute(run *r, int timeout)
{
    int ends[2];
    const double deadline = now() + timeout;
    fflush(NULL);
    if (pipe(ends) != 0)
        return -1;
    const pid_t child = fork();
    if (child == 0)
        become(r->command, ends[1]);
    close(ends[1]);
    if (child > 0) {
        setpgid(child, child);
        collect(r, ends[0], deadline);
        await(r, child, deadline);
    }
    close(ends[0]);
    return child > 0 ? 0 : -1;
}

/* ---- Requests and expected answers ---- */

/* The contents of a request, in addition to the stream. */
typedef struct asked {
    int point, complete;
    const adcgs_fewer *fewer; /* NULL: all layers */
} asked;

static void put_cameras(FILE *out, const adcgs_vector *v)
{
    for (int i = 0; i < v->n_cameras; i++) {
        const adcgs_camera *const c = &v->cameras[i];
        fprintf(out, "camera %d %d %.17g %.17g %.17g %.17g %.17g", (int)c->width, (int)c->height, c->fx, c->fy, c->cx, c->cy,
                c->near_plane);
        for (int k = 0; k < 12; k++)
            fprintf(out, " %.17g", c->cam_to_world[k]);
        fprintf(out, "\n");
    }
}

static void put_requests(FILE *out, const adcgs_vector *v, const asked *how)
{
    if (how->complete)
        fprintf(out, "complete\n");
    if (how->fewer) {
        fprintf(out, "layers %d\nmodel\n", how->fewer->layers);
        for (int i = 0; how->point >= 2 && i < how->fewer->n_splats; i++)
            fprintf(out, "splats %.17g\n", how->fewer->splats[i].time);
        return;
    }
    put_cameras(out, v);
    fprintf(out, "trace\n%s", how->point >= 1 ? "model\n" : "");
    for (int i = 0; how->point >= 2 && i < v->n_splats; i++)
        fprintf(out, "splats %.17g\n", v->splats[i].time);
    for (int i = 0; how->point >= 3 && i < v->n_frames; i++)
        fprintf(out, "frame %d %.17g\n", v->frames[i].camera, v->frames[i].time);
}

static void put_fewer(FILE *out, const adcgs_fewer *fewer, int point)
{
    for (int i = 0; i < fewer->n_models; i++)
        fprintf(out, "model %d %s\n", i, fewer->models[i]);
    for (int i = 0; point >= 2 && i < fewer->n_splats; i++)
        fprintf(out, "splats %.17g %s\n", fewer->splats[i].time, fewer->splats[i].md5);
}

static void put_answers(FILE *out, const adcgs_vector *v, int point)
{
    fprintf(out, "trace %u %s\n", v->elements, v->trace);
    for (int i = 0; point >= 1 && i < v->n_models; i++)
        fprintf(out, "model %d %s\n", i, v->models[i]);
    for (int i = 0; point >= 2 && i < v->n_splats; i++)
        fprintf(out, "splats %.17g %s\n", v->splats[i].time, v->splats[i].md5);
    for (int i = 0; point >= 3 && i < v->n_frames; i++)
        fprintf(out, "frame %d %.17g %s\n", v->frames[i].camera, v->frames[i].time, v->frames[i].md5);
}

static char *expected_answers(const adcgs_vector *v, const asked *how, adcgs_status status)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *const out = open_memstream(&text, &bytes);
    if (!out)
        return NULL;
    if (status != ADCGS_OK)
        fprintf(out, "fault %s\n", adcgs_vector_class_name(status));
    else if (how->fewer)
        put_fewer(out, how->fewer, how->point);
    else
        put_answers(out, v, how->point);
    return fclose(out) == 0 ? text : NULL;
}

/* ---- Comparison ---- */

static adcgs_outcome compare_lines(const run *r, const char *expected)
{
    const char *found = r->answers;
    char line[160];
    for (int number = 1; *expected || *found; number++) {
        const size_t e = strcspn(expected, "\n"), f = strcspn(found, "\n");
        if (e != f || strncmp(expected, found, e)) {
            snprintf(line, sizeof line, "line %d of the answers is \"%.*s\", expected \"%.*s\"", number, (int)ADCGS_MIN(f, 60),
                     found, (int)ADCGS_MIN(e, 60), expected);
            return wrong(r, ADCGS_OUTCOME_WRONG, "%s", line);
        }
        expected += e + (expected[e] != 0);
        found += f + (found[f] != 0);
    }
    return ADCGS_OUTCOME_OK;
}

static adcgs_outcome judge(const run *r, const char *expected, adcgs_status status)
{
    char number[32];
    if (r->timed_out)
        return wrong(r, ADCGS_OUTCOME_TIMEOUT, "no end in time%s", "");
    const int code = WIFEXITED(r->status) ? WEXITSTATUS(r->status) : 128;
    snprintf(number, sizeof number, "%d", WIFSIGNALED(r->status) ? WTERMSIG(r->status) : code - 128);
    if (code >= 128)
        return wrong(r, ADCGS_OUTCOME_CRASHED, "ended by signal %s", number);
    const int wanted = status == ADCGS_OK ? 0 : status == ADCGS_ERR_UNSUPPORTED ? 5 : 4;
    snprintf(number, sizeof number, "%d, expected %d", code, wanted);
    if (code != wanted)
        return wrong(r, ADCGS_OUTCOME_WRONG, "exit status %s", number);
    return compare_lines(r, expected);
}

static int read_out(run *r)
{
    FILE *const file = fopen(r->out, "rb");
    if (!file)
        return -1;
    r->bytes = fread(r->answers, 1, ANSWERS_MAX, file);
    fclose(file);
    return 0;
}

static adcgs_outcome run_once(const adcgs_program *program, const adcgs_vector *v, run *r, int complete, const adcgs_fewer *fewer)
{
    const adcgs_status status = complete && v->truncated ? ADCGS_ERR_TRUNCATED : v->status;
    const asked how = {.point = program->point, .complete = complete, .fewer = fewer};
    int has_out = 0;
    char *const expected = expected_answers(v, &how, status);
    FILE *const request = fopen(r->request, "w");
    adcgs_outcome outcome = wrong(r, ADCGS_OUTCOME_WRONG, "%s: cannot write", r->request);
    if (request)
        put_requests(request, v, &how);
    r->command = fill_command(program->command, r, &has_out);
    r->answers = calloc(ANSWERS_MAX + 1, 1);
    r->bytes = 0;
    if (request && fclose(request) == 0 && expected && r->command && r->answers) {
        if (execute(r, program->timeout) != 0)
            wrong(r, ADCGS_OUTCOME_WRONG, "cannot start it: %s", strerror(errno));
        else if (has_out && !r->timed_out && read_out(r) != 0)
            wrong(r, ADCGS_OUTCOME_WRONG, "%s: no such file", r->out);
        else {
            *r->what = 0;
            outcome = judge(r, expected, status);
        }
    }
    free(expected);
    free(r->command);
    free(r->answers);
    return outcome;
}

adcgs_outcome adcgs_program_try(const adcgs_program *program, const adcgs_manifest *manifest, const adcgs_vector *vector,
                                char what[ADCGS_WHAT])
{
    char directory[] = "/tmp/adcgs-conform-XXXXXX";
    run r = {.what = what};
    if (!mkdtemp(directory))
        return wrong(&r, ADCGS_OUTCOME_WRONG, "cannot make a folder: %s", strerror(errno));
    snprintf(r.in, sizeof r.in, "%s/%s", manifest->directory, vector->file);
    snprintf(r.request, sizeof r.request, "%s/request", directory);
    snprintf(r.out, sizeof r.out, "%s/out", directory);
    adcgs_outcome outcome = run_once(program, vector, &r, 0, NULL);
    if (outcome == ADCGS_OUTCOME_OK && vector->truncated)
        outcome = run_once(program, vector, &r, 1, NULL);
    for (int i = 0; program->layers && program->point >= 1 && outcome == ADCGS_OUTCOME_OK && i < vector->n_fewer; i++)
        outcome = run_once(program, vector, &r, 0, &vector->fewer[i]);
    unlink(r.request);
    unlink(r.out);
    rmdir(directory);
    return outcome;
}
