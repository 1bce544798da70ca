/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Writes a small scene of every kind, each into a folder of its kind's name: `make-scenes FOLDER`. What it prints is a line for
 * each: the folder's name, and below it the scene ("." for the folder itself). Kinds of videos are left out where none can be
 * written.
 */
#include "../unit/layout_kinds.h"

static int make(const char *where, const layout *l)
{
    snprintf(folder, sizeof folder, "%s/%s", where, l->name);
    if (mkdir(folder, 0777)) {
        perror(folder);
        return -1;
    }
    if (l->videos && !put_video("probe.mp4", 0, 1, RIG_WIDTH, RIG_HEIGHT))
        return rmdir(folder);
    if (l->videos && unlink(in("probe.mp4")))
        return -1;
    l->put();
    printf("%s %s\n", l->name, *l->scene ? l->scene : ".");
    return 0;
}

int main(int argc, char **argv)
{
    if (argc != 2 || strlen(argv[1]) > 200) {
        fprintf(stderr, "usage: make-scenes FOLDER\n");
        return 2;
    }
    for (int i = 0; i < LAYOUTS; i++)
        if (make(argv[1], &layouts[i]))
            return 3;
    return 0;
}
