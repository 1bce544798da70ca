/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Input that arrives at any time. */
#include "config.h"

#include "system/pipe.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#define WAIT_MILLISECONDS 100 /* longest wait of a read; chosen by hand, not measured */

int adcgs_pipe_is(const char *path)
{
    struct stat status;
    if (!strcmp(path, "-"))
        return 1;
    return !stat(path, &status) && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

adcgs_status adcgs_pipe_open(adcgs_pipe *pipe, const char *path, adcgs_error *error)
{
    const int is_input = !strcmp(path, "-");
    *pipe = (adcgs_pipe){.name = is_input ? "standard input" : path, .fd = STDIN_FILENO, .own = !is_input};
    if (is_input)
        return ADCGS_OK;
    pipe->fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* does not wait for a writer */
    if (pipe->fd >= 0)
        return ADCGS_OK;
    pipe->own = 0;
    return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: cannot open: %s", path, strerror(errno));
}

void adcgs_pipe_close(adcgs_pipe *pipe)
{
    if (pipe->own)
        close(pipe->fd);
    pipe->own = 0;
}

adcgs_status adcgs_pipe_read(adcgs_pipe *pipe, void *buffer, size_t bytes, size_t *got, adcgs_error *error)
{
    struct pollfd which = {.fd = pipe->fd, .events = POLLIN};
    *got = 0;
    if (pipe->ended || poll(&which, 1, WAIT_MILLISECONDS) <= 0)
        return ADCGS_OK;
    const ssize_t n = read(pipe->fd, buffer, bytes);
    pipe->ended = n == 0;
    if (n >= 0)
        *got = (size_t)n;
    else if (errno != EINTR && errno != EAGAIN)
        return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: cannot read: %s", pipe->name, strerror(errno));
    return ADCGS_OK;
}
