/* SPDX-License-Identifier: MIT */
/*
 * picture: an SVG or a PNG drawn by gnuplot, by the ending of its name. The caller writes gnuplot
 * commands; the file appears under its name when it is complete.
 */
#ifndef RHOTRACK_TOOL_PICTURE_H
#define RHOTRACK_TOOL_PICTURE_H

#include <stddef.h>
#include <stdio.h>

struct picture {
    FILE *script; /* gnuplot commands go here */
    char *path, *temporary_path, *script_path;
    int width, height; /* pixels of the SVG; a PNG has twice as many each way */
};

/* Exit 2 where the name ends in none of .svg, .png, .html. */
void picture_check_path(const char *path);

/*
 * Starts a picture of so many pixels, with the common look: fonts, grid, colours as line types 1 ..
 * 8.
 */
struct picture picture_open(const char *path, int width, int height);

/* Draws it. Exit 1 with gnuplot's complaint where that fails. */
void picture_close(struct picture *picture);

/* Titles: what it shows, and how much of it. */
void picture_set_title(const struct picture *picture, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/*
 * Colour number i of a palette that colour-blind readers can tell apart, and that differs in grey;
 * "#rrggbb".
 */
const char *picture_colour(size_t i);

/* Marker number i, gnuplot's point type. */
int picture_marker(size_t i);

#endif
