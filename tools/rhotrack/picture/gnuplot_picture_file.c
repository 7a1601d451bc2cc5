/* SPDX-License-Identifier: MIT */
#include "picture/gnuplot_picture_file.h"

#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/common.h"

/* The palette of Okabe and Ito, ordered so that neighbours also differ in grey. */
static const char *const colours[] = {"#0072b2", "#d55e00", "#009e73", "#000000",
                                      "#cc79a7", "#56b4e9", "#e69f00", "#7f7f7f"};
static const int markers[] = {7, 5, 9, 11, 13, 6, 4, 8};

#define NUM_COLOURS (sizeof colours / sizeof colours[0])

const char *picture_colour(size_t i)
{
    return colours[i % NUM_COLOURS];
}

int picture_marker(size_t i)
{
    return markers[i % NUM_COLOURS];
}

void picture_check_path(const char *path)
{
    if (!path_ends_with(path, ".svg") && !path_ends_with(path, ".png") &&
        !path_ends_with(path, ".html")) {
        fail(EXIT_USAGE, "%s: a picture is NAME.svg, NAME.png or (a page) NAME.html", path);
    }
}

/* A PNG is drawn at twice the size, so that it is sharp on fine screens. */
static void set_gnuplot_terminal(const struct picture *picture)
{
    const bool is_png = path_ends_with(picture->path, ".png");
    const int scale = is_png ? 2 : 1;

    fprintf(picture->script, "set terminal %s size %d,%d enhanced background '#ffffff' %s\n",
            is_png ? "pngcairo" : "svg", picture->width * scale, picture->height * scale,
            is_png ? "font 'Helvetica,11' fontscale 2 linewidth 2 pointscale 2"
                   : "font 'Helvetica,15'");
}

struct picture picture_open(const char *path, int width, int height)
{
    struct picture picture = {
        .script = tmpfile(),
        .output = output_open(path),
        .path = path,
        .width = width,
        .height = height,
    };
    if (!picture.script) {
        fail(EXIT_RUNTIME, "%s: no temporary file for gnuplot: %s", path, strerror(errno));
    }
    set_gnuplot_terminal(&picture);
    fprintf(picture.script, "set border 3 lc rgb '#444444'\nset tics nomirror out scale 0.6\n"
                            "set grid lc rgb '#dddddd' lt 1 lw 0.7\n"
                            "set key outside right top vertical Left reverse\n");
    for (size_t i = 0; i < NUM_COLOURS; i++) {
        fprintf(picture.script, "set linetype %zu lc rgb '%s' pt %d lw 1.3\n", i + 1, colours[i],
                markers[i]);
    }
    return picture;
}

/* Runs gnuplot from the script to the output file; on failure exits, and nothing is left. */
static void run_gnuplot(const struct picture *picture)
{
    pid_t child = fork();
    int status = 0;
    if (child == 0) {
        if (dup2(fileno(picture->script), STDIN_FILENO) >= 0 &&
            dup2(fileno(picture->output.file), STDOUT_FILENO) >= 0) {
            execlp("gnuplot", "gnuplot", "/dev/stdin", (char *)NULL);
        }
        _exit(127);
    }
    if (child < 0 || waitpid(child, &status, 0) < 0) {
        fail(EXIT_RUNTIME, "gnuplot: %s", strerror(errno));
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        fail(EXIT_RUNTIME, "%s: gnuplot could not draw it%s", picture->path,
             WIFEXITED(status) && WEXITSTATUS(status) == 127
                 ? ": it is not installed (apt-get install gnuplot-nox)"
                 : "");
    }
}

void picture_set_title(const struct picture *picture, const char *format, ...)
{
    va_list arguments;

    fprintf(picture->script, "set title \"");
    va_start(arguments, format);
    vfprintf(picture->script, format, arguments);
    va_end(arguments);
    fprintf(picture->script, "\" noenhanced tc rgb '#333333'\n");
}

void picture_draw_and_close(struct picture *picture)
{
    if (fflush(picture->script) || ferror(picture->script)) {
        fail(EXIT_RUNTIME, "%s: commands for gnuplot cannot be written: %s", picture->path,
             strerror(errno));
    }
    rewind(picture->script);
    run_gnuplot(picture);
    (void)fclose(picture->script);
    output_close(&picture->output);
}
