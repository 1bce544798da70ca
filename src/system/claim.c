/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Claim files that name the process and the machine that hold a resource. */
#include "config.h"

#include "system/claim.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#ifndef BEAT    /* a test sets a shorter one */
#define BEAT 10 /* seconds between two touches */
#endif
#define WATCH (1.25 * BEAT)     /* seconds within which a live owner on another machine touches its claim once */
#define WATCH_LONG (6.0 * BEAT) /* the same for a claim whose time lies in the future, so its age is unknown */
#define LOOK 0.1                /* seconds between two checks of a watched claim */
#define TRIES 5                 /* attempts to take a claim, in case others appear and vanish in between */
#define TEXT_MAX 400            /* bytes of a claim file */
#define ENDED ULLONG_MAX
/* Skips the 18 fields of /proc/PID/stat (proc(5)) between state, field 3, and starttime. */
#define SKIP_18 " %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s"

typedef struct owner {
    char host[80], since[32], place[120]; /* place: boot id and process id namespace */
    long process;
    unsigned long long began; /* start of the process, in the kernel's ticks; 0: unknown */
} owner;

struct adcgs_claim {
    char *path, *what, *mine; /* mine: our own file name next to path */
    char text[TEXT_MAX];      /* content of the file */
    pthread_t beat;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    int beats, ends;
};

/* ---- Content of the file ---- */

/** First line of a system file without its newline, or "-". */
static void read_line(const char *path, char *out, size_t size)
{
    FILE *const file = fopen(path, "r");
    if (!file || !fgets(out, (int)size, file))
        snprintf(out, size, "-");
    out[strcspn(out, "\n")] = '\0';
    if (file)
        fclose(file);
}

/** Start of a process, in ticks since boot; 0: unknown; ENDED: it has ended, and its parent has not waited for it yet. */
static unsigned long long find_begin(long process)
{
    char name[48], text[1024], state = '-';
    unsigned long long began = 0;
    snprintf(name, sizeof name, "/proc/%ld/stat", process);
    FILE *const file = fopen(name, "r");
    const size_t n = file ? fread(text, 1, sizeof text - 1, file) : 0;
    if (file)
        fclose(file);
    text[n] = '\0';
    const char *const behind = strrchr(text, ')'); /* the program's name may contain any characters */
    if (!behind || sscanf(behind + 1, " %c" SKIP_18 " %llu", &state, &began) != 2)
        return 0;
    return state == 'Z' || state == 'X' ? ENDED : began;
}

/** Describe this process. Process ids are comparable only where `place` is equal: same boot, same container. */
static void find_own(owner *own)
{
    const time_t now = time(NULL);
    struct tm utc;
    char boot[48], space[64];
    const ssize_t n = readlink("/proc/self/ns/pid", space, sizeof space - 1);
    space[n > 0 ? n : 0] = '\0';
    read_line("/proc/sys/kernel/random/boot_id", boot, sizeof boot);
    snprintf(own->place, sizeof own->place, "%s/%s", boot, n > 0 ? space : "-");
    own->process = (long)getpid();
    own->began = find_begin(own->process);
    if (gethostname(own->host, sizeof own->host))
        snprintf(own->host, sizeof own->host, "-");
    own->host[sizeof own->host - 1] = '\0';
    strftime(own->since, sizeof own->since, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
}

/** Read a claim and its owner; -1 if the file is gone. An incomplete file gives "?" as the host. */
static int read_claim(const char *path, char text[TEXT_MAX], owner *who, struct stat *s)
{
    const int fd = open(path, O_RDONLY | O_CLOEXEC); /* opening it makes the client ask the server again */
    const ssize_t n = fd < 0 || fstat(fd, s) ? -1 : read(fd, text, TEXT_MAX - 1);
    if (fd >= 0)
        close(fd);
    if (n < 0)
        return -1;
    text[n] = '\0';
    *who = (owner){.host = ""};
    if (sscanf(text, "%79s %ld %31s %119s %llu", who->host, &who->process, who->since, who->place, &who->began) < 3)
        *who = (owner){.host = "?", .since = "?"};
    return 0;
}

/** Create a file that does not exist yet; 0, or -1 with errno set. */
static int create(const char *path, const char *text)
{
    const size_t n = strlen(text);
    const int fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0)
        return -1;
    errno = 0;
    const int bad = write(fd, text, n) != (ssize_t)n, reason = errno ? errno : EIO;
    if (!close(fd) && !bad)
        return 0;
    unlink(path);
    errno = reason;
    return -1;
}

/* ---- State of the owner ---- */

typedef enum answer { NOBODY, DEAD, ALIVE, UNKNOWN } answer;

/**
 * State of a process on this machine. UNKNOWN: it runs on another machine, or the claim has too little information. Uses no
 * clock.
 */
static answer ask_system(const owner *who)
{
    owner own;
    find_own(&own);
    if (strcmp(own.host, who->host) != 0 || (who->place[0] && strcmp(own.place, who->place) != 0) || who->process <= 0)
        return UNKNOWN;
    if (who->process == own.process || (kill((pid_t)who->process, 0) && errno == ESRCH))
        return DEAD;
    if (!who->place[0] || !who->began || !own.began) /* the process id may have been reused */
        return UNKNOWN;
    const unsigned long long began = find_begin(who->process);
    return !began ? UNKNOWN : began == who->began ? ALIVE : DEAD;
}

/** True if nobody touches a claim for `seconds` by the monotonic clock; the clock of the files can be set. */
static int stays_untouched(const adcgs_claim *c, const struct stat *before, double seconds)
{
    const struct timespec nap = {.tv_nsec = (long)(1e9 * LOOK)};
    const double end = adcgs_seconds() + seconds;
    struct stat now;
    char text[TEXT_MAX];
    owner who;
    while (adcgs_seconds() < end) {
        nanosleep(&nap, NULL);
        if (read_claim(c->path, text, &who, &now) || now.st_mtim.tv_sec != before->st_mtim.tv_sec ||
            now.st_mtim.tv_nsec != before->st_mtim.tv_nsec || now.st_ino != before->st_ino)
            return 0;
    }
    return 1;
}

/**
 * State of a claim's owner. Creates our own file, whose time is that of the file system, except if there is no claim or the
 * system reports the owner dead. So a process that is killed then leaves no file behind.
 */
static answer read_owner(const adcgs_claim *c, owner *who, double *age)
{
    char text[TEXT_MAX];
    struct stat theirs, ours;
    if (read_claim(c->path, text, who, &theirs))
        return NOBODY;
    const answer known = ask_system(who);
    if (known == DEAD)
        return DEAD;
    unlink(c->mine);
    if (create(c->mine, c->text) || stat(c->mine, &ours))
        return UNKNOWN;
    *age = difftime(ours.st_mtime, theirs.st_mtime);
    if (known == ALIVE)
        return ALIVE;
    if (*age >= -BEAT && *age <= ADCGS_CLAIM_SECONDS)
        return ALIVE;
    return stays_untouched(c, &theirs, *age < 0 ? WATCH_LONG : WATCH) ? DEAD : ALIVE;
}

static adcgs_status refuse(const adcgs_claim *c, const owner *who, double age, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_IO, "%s: another run has %s: process %ld on %s, since %s, seen %.0f s ago", c->path,
                      c->what, who->process, who->host, who->since, age > 0 ? age : 0.0);
}

/* ---- Claims ---- */

static void clear(adcgs_claim *c)
{
    if (c) {
        free(c->path);
        free(c->what);
        free(c->mine);
        free(c);
    }
}

static adcgs_claim *make(const char *path, const char *what)
{
    owner own;
    adcgs_claim *const c = calloc(1, sizeof *c);
    const size_t n = strlen(path) + sizeof own.host + 32;
    find_own(&own);
    if (c && (c->path = strdup(path)) && (c->what = strdup(what)) && (c->mine = malloc(n))) {
        snprintf(c->mine, n, "%s.%s-%ld", path, own.host, own.process);
        snprintf(c->text, sizeof c->text, "%s %ld %s %s %llu\n", own.host, own.process, own.since, own.place, own.began);
        return c;
    }
    clear(c);
    return NULL;
}

static int is_ours(const adcgs_claim *c)
{
    char text[TEXT_MAX];
    owner who;
    struct stat s;
    return !read_claim(c->path, text, &who, &s) && !strcmp(text, c->text);
}

/** Thread that touches the file until `ends` is set or another process owns the file. */
static void *keep_alive(void *argument)
{
    adcgs_claim *const c = argument;
    struct timespec until;
    pthread_mutex_lock(&c->lock);
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_sec += BEAT;
    while (!c->ends) {
        if (pthread_cond_timedwait(&c->changed, &c->lock, &until) != ETIMEDOUT)
            continue;
        if (!is_ours(c))
            break;
        utimensat(AT_FDCWD, c->path, NULL, 0); /* the server's time, not ours */
        clock_gettime(CLOCK_MONOTONIC, &until);
        until.tv_sec += BEAT;
    }
    pthread_mutex_unlock(&c->lock);
    return NULL;
}

/** Start the thread that touches the file, with all signals blocked: other threads handle them. */
static adcgs_status begin(adcgs_claim *c, adcgs_error *error)
{
    sigset_t all, before;
    pthread_condattr_t steady;
    pthread_mutex_init(&c->lock, NULL);
    pthread_condattr_init(&steady);
    pthread_condattr_setclock(&steady, CLOCK_MONOTONIC); /* beats do not depend on the time of day */
    pthread_cond_init(&c->changed, &steady);
    pthread_condattr_destroy(&steady);
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    c->beats = !pthread_create(&c->beat, NULL, keep_alive, c);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return c->beats ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: cannot start a thread", c->path);
}

/** Take over a dead claim. Several processes may find it: the last one to rename owns it, and the others see that. */
static int take_over(const adcgs_claim *c)
{
    const struct timespec while_others_rename = {.tv_nsec = 300000000};
    if ((create(c->mine, c->text) && errno != EEXIST) || rename(c->mine, c->path))
        return 0;
    nanosleep(&while_others_rename, NULL);
    return is_ours(c);
}

static adcgs_status acquire(adcgs_claim *c, adcgs_error *error)
{
    owner who = {.process = 0};
    double age = 0;
    for (int i = 0; i < TRIES; i++) {
        if (!create(c->path, c->text))
            return ADCGS_OK;
        if (errno != EEXIST)
            break;
        const answer found = read_owner(c, &who, &age);
        if (found == UNKNOWN)
            break;
        if (found == ALIVE)
            return refuse(c, &who, age, error);
        if (found == DEAD && take_over(c))
            return ADCGS_OK;
    }
    return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot create: %s", c->path, strerror(errno));
}

adcgs_status adcgs_claim_take(adcgs_claim **claim, const char *path, const char *what, adcgs_error *error)
{
    adcgs_claim *const c = make(path, what);
    *claim = NULL;
    if (!c)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    adcgs_status status = acquire(c, error);
    unlink(c->mine);
    if (status == ADCGS_OK) {
        *claim = c;
        status = begin(c, error);
        if (status != ADCGS_OK)
            adcgs_claim_drop(claim);
    } else
        clear(c);
    return status;
}

adcgs_status adcgs_claim_absent(const char *path, const char *what, adcgs_error *error)
{
    owner who;
    double age = 0;
    if (access(path, F_OK))
        return ADCGS_OK;
    adcgs_claim *const c = make(path, what);
    if (!c)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    const answer found = read_owner(c, &who, &age);
    const adcgs_status status = found == ALIVE ? refuse(c, &who, age, error)
                                : found == UNKNOWN
                                    ? adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot create: %s", c->mine, strerror(errno))
                                    : ADCGS_OK;
    unlink(c->mine);
    clear(c);
    return status;
}

adcgs_status adcgs_claim_check(const adcgs_claim *claim, adcgs_error *error)
{
    return is_ours(claim)
               ? ADCGS_OK
               : adcgs_fail(error, ADCGS_ERR_IO, "%s: another process has taken over %s: it considered this process dead",
                            claim->path, claim->what);
}

void adcgs_claim_drop(adcgs_claim **claim)
{
    adcgs_claim *const c = *claim;
    *claim = NULL;
    if (!c)
        return;
    pthread_mutex_lock(&c->lock);
    c->ends = 1;
    pthread_cond_signal(&c->changed);
    pthread_mutex_unlock(&c->lock);
    if (c->beats)
        pthread_join(c->beat, NULL);
    if (is_ours(c))
        unlink(c->path);
    pthread_cond_destroy(&c->changed);
    pthread_mutex_destroy(&c->lock);
    clear(c);
}
