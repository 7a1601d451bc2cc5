/* SPDX-License-Identifier: MIT */
/*
 * Private to the asterix modules: how long each item of a category is, in the order of its profile.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_ITEMS_H
#define RHOTRACK_TOOL_ASTERIX_ITEMS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum asterix_form {
    ASTERIX_NONE = 0,    /* a place that the profile leaves free */
    ASTERIX_FIXED,       /* `bytes` of them */
    ASTERIX_EXTENDED,    /* bytes, of which the last has its last bit clear */
    ASTERIX_REPEATED,    /* a count, then so many times `bytes` */
    ASTERIX_REPEATED_FX, /* times `bytes`, the last of which has its last bit clear */
    ASTERIX_EXPLICIT,    /* its own length in the first byte */
    ASTERIX_ANY,         /* a count, then so many times a place of the profile and its item */
    ASTERIX_COMPOUND     /* as a record: which parts are there, then these */
};

struct asterix_item {
    const char *name; /* "120" */
    enum asterix_form form;
    uint8_t bytes;
    uint8_t num_parts;
    const struct asterix_item *parts; /* of a compound; none is a compound again */
};

struct asterix_category {
    uint8_t category;
    uint8_t num_items;
    const struct asterix_item *items;
};

/* NULL where the category is not known. CAT001 has two profiles. */
const struct asterix_category *asterix_category_find(uint8_t category, bool is_track);

/* Places in the profiles. */
enum { I001_020 = 1, I001_ITEMS = 21, I001_TRACK_ITEMS = 22 };
enum { I002_010 = 0, I002_000, I002_020, I002_030, I002_041, I002_ITEMS = 14 };
enum { I034_010 = 0, I034_000, I034_030, I034_020, I034_041, I034_120 = 10, I034_ITEMS = 14 };
enum {
    I048_010 = 0,
    I048_140,
    I048_020,
    I048_040,
    I048_070,
    I048_090,
    I048_220 = 7,
    I048_161 = 10,
    I048_110 = 18,
    I048_120,
    I048_ITEMS = 28
};
enum {
    I062_010 = 0,
    I062_070 = 3,
    I062_105,
    I062_100,
    I062_185,
    I062_210,
    I062_040 = 11,
    I062_080,
    I062_130 = 17,
    I062_220 = 19,
    I062_500 = 26,
    I062_ITEMS = 35
};

#endif
