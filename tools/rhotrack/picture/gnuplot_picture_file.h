/* SPDX-License-Identifier: MIT */
/*
 * gnuplot_picture_file: an SVG or PNG drawn by gnuplot, chosen by the ending of its name. The
 * caller writes gnuplot commands; the file appears under its name when it is complete. gnuplot
 * reads its standard input and writes its standard output, and never sees a name: it runs names
 * such as '|command' and '<command' in a shell.
 */
#ifndef RHOTRACK_TOOL_GNUPLOT_PICTURE_FILE_H
#define RHOTRACK_TOOL_GNUPLOT_PICTURE_FILE_H

#include <stddef.h>
#include <stdio.h>

#include "base/common.h"

struct picture {
    FILE *script; /* file without a name, to which gnuplot commands are written */
    struct output output;
    const char *path;  /* of the caller */
    int width, height; /* pixels of the SVG; a PNG has twice as many each way */
};

/* Exits with 2 where the name ends in none of .svg, .png, .html. */
void picture_check_path(const char *path);

/*
 * Starts a picture of width x height pixels with the common style: fonts, grid, colours as line
 * types 1 .. 8. The path must outlive it.
 */
struct picture picture_open(const char *path, int width, int height);

/* Draws the picture with gnuplot and frees it; exits with 1 and gnuplot's message on failure. */
void picture_draw_and_close(struct picture *picture);

/* Sets the title, formatted as by printf. */
void picture_set_title(const struct picture *picture, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/*
 * Colour i, as "#rrggbb", of a palette whose eight colours colour-blind readers can tell apart, in
 * grey too.
 */
const char *picture_colour(size_t i);

/* Marker i, a point type of gnuplot. */
int picture_marker(size_t i);

#endif
