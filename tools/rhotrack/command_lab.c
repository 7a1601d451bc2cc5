/* SPDX-License-Identifier: MIT */
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/common.h"
#include "commands.h"

static const char *const names[] = {"experiment", "bench"};

const char *command_lab_name(size_t index)
{
    return index < sizeof names / sizeof *names ? names[index] : NULL;
}

bool command_lab_has(const char *name)
{
    for (size_t i = 0; command_lab_name(i); i++) {
        if (strcmp(name, command_lab_name(i)) == 0) {
            return true;
        }
    }
    return false;
}

void command_lab(char **argv)
{
    char path[PATH_MAX + sizeof "-lab"];
    ssize_t length = readlink("/proc/self/exe", path, PATH_MAX);

    if (length > 0) {
        memcpy(path + length, "-lab", sizeof "-lab");
        execv(path, argv);
    }
    fail(EXIT_RUNTIME,
         "%s: the lab is a program of its own, rhotrack-lab beside this one, which `make` builds "
         "and `make install` leaves out (%s)",
         argv[1], strerror(errno));
}
