/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Writes a small scene of every kind, each into a folder named after its kind: `make-scenes FOLDER`. Prints a line for each
 * scene: the folder's name, and the path of the scene below it ("." for the folder itself). Kinds with videos are left out if
 * this build cannot write videos.
 */
#include "../unit/scene/layout_kinds.h"

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
