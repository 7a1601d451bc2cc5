/* SPDX-License-Identifier: MIT */
/*
 * Private to the asterix modules: the profiles of categories, which give each item's place in the
 * field specification and its length.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_ITEM_LENGTHS_H
#define RHOTRACK_TOOL_ASTERIX_ITEM_LENGTHS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum asterix_form {
    ASTERIX_NONE = 0,    /* spare place of the profile, without an item */
    ASTERIX_FIXED,       /* `bytes` bytes */
    ASTERIX_EXTENDED,    /* bytes up to the first whose last bit is clear */
    ASTERIX_REPEATED,    /* a count, then that many parts of `bytes` bytes */
    ASTERIX_REPEATED_FX, /* parts of `bytes` bytes, up to the first whose last bit is clear */
    ASTERIX_EXPLICIT,    /* the first byte gives the item's length */
    /* random field sequence: a count, then that many places of the profile, each with its item */
    ASTERIX_ANY,
    ASTERIX_COMPOUND /* compound item: a field specification, then the parts that it names */
};

struct asterix_item {
    const char *name; /* number in the standard, like "120" */
    enum asterix_form form;
    uint8_t bytes;
    uint8_t num_parts;
    /* parts of a compound item; they are not compound themselves */
    const struct asterix_item *parts;
};

struct asterix_category {
    uint8_t category;
    uint8_t num_items;
    const struct asterix_item *items;
};

/*
 * Profile of a category, or NULL where it is not known. CAT001 has one profile for plots and one
 * for tracks.
 */
const struct asterix_category *asterix_category_find_profile(uint8_t category,
                                                             bool is_cat001_track);

/* Indices of items in the profiles: Iccc_nnn is item nnn of category ccc. */
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
