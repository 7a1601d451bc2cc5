/* SPDX-License-Identifier: MIT */
/*
 * genetic_search: a genetic search for the sky, a series of scans, that costs most, for the
 * programs worst_*_search: `search SEED SKIES` searches, `sky GENES` measures one that was found.
 *
 * There are eight parents. A child has the genes of a parent, some of them drawn anew, moved or
 * from another parent, and replaces the parent of the lowest cost when it costs more. The same seed
 * finds the same skies. Each sky that is worse than all before is printed: its instructions, the
 * work of their step and the genes.
 *
 * A program includes this after its `enum gene`, and then defines ranges and measure_sky.
 */
#ifndef GENETIC_SEARCH_H
#define GENETIC_SEARCH_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "count.h"
#include "node_settings_defaults.h"
#include "rhotrack/detail/approx.h"

static const struct range {
    float low, high;
    int is_log;
} ranges[GENES]; /* of the genes' values */

static int failed; /* 1: a step was refused */

struct sky {
    uint8_t genes[GENES];
    uint32_t instructions, work; /* of the costliest step or time */
};

static float gene_value(const struct sky *sky, enum gene gene)
{
    const struct range *range = &ranges[gene];
    const float share = (float)sky->genes[gene] / 255.0f;
    return range->is_log ? range->low * rho_exp(share * rho_log(range->high / range->low))
                         : range->low + (range->high - range->low) * share;
}

static unsigned gene_as_whole_number(const struct sky *sky, enum gene gene)
{
    return (unsigned)gene_value(sky, gene);
}

/* Tracks through the scans of a sky, and stores its instructions and work. */
static void measure_sky(struct sky *sky);

static void print_cost_and_genes_of_sky(const struct sky *sky)
{
    printf("%lu instructions, work %lu of %lu, sky ", (unsigned long)sky->instructions,
           (unsigned long)sky->work, (unsigned long)NODE_WORK_MAX);
    for (int i = 0; i < GENES; i++) {
        printf("%02x", sky->genes[i]);
    }
    printf("\n");
}

/* ---- the search ------------------------------------------------------------------------------ */

#define PARENTS 8u
#define FIRST_SKIES 40u

static uint32_t search_state;

static unsigned draw_below(unsigned end)
{
    search_state = search_state * 1664525u + 1013904223u;
    return (unsigned)((uint64_t)(search_state >> 8) * end >> 24);
}

static void draw_genes(struct sky *sky)
{
    for (int i = 0; i < GENES; i++) {
        sky->genes[i] = (uint8_t)draw_below(256);
    }
}

/* A copy of a parent with 1 to 3 genes drawn anew, moved by up to 20, or taken from the other. */
static void draw_child_with_mutated_genes(struct sky *child, const struct sky *parent,
                                          const struct sky *other)
{
    *child = *parent;
    for (unsigned changes = 1u + draw_below(3); changes > 0; changes--) {
        const unsigned gene = draw_below(GENES), way = draw_below(4);
        const int moved = (int)child->genes[gene] + (int)draw_below(41) - 20;
        child->genes[gene] = way == 0   ? (uint8_t)draw_below(256)
                             : way == 1 ? other->genes[gene]
                                        : (uint8_t)(moved < 0     ? 0
                                                    : moved > 255 ? 255
                                                                  : moved);
    }
}

static struct sky *cheapest_parent_sky(struct sky *parents)
{
    struct sky *least = parents;
    for (unsigned i = 1; i < PARENTS; i++) {
        least = parents[i].instructions < least->instructions ? &parents[i] : least;
    }
    return least;
}

static void search_for_worst_sky(unsigned num_skies)
{
    static struct sky parents[PARENTS];
    uint32_t worst = 0;
    for (unsigned n = 0; n < num_skies && !failed; n++) {
        struct sky child, *least = cheapest_parent_sky(parents);
        if (n < FIRST_SKIES) {
            draw_genes(&child);
        } else {
            draw_child_with_mutated_genes(&child, &parents[draw_below(PARENTS)],
                                          &parents[draw_below(PARENTS)]);
        }
        measure_sky(&child);
        if (child.instructions > worst) {
            worst = child.instructions;
            print_cost_and_genes_of_sky(&child);
        }
        if (child.instructions > least->instructions) {
            *least = child;
        }
    }
}

static int parse_genes(struct sky *sky, const char *text)
{
    for (int i = 0; i < GENES; i++, text += 2) {
        const char byte[3] = {text[0], text[0] ? text[1] : '\0', '\0'};
        char *end;
        sky->genes[i] = (uint8_t)strtoul(byte, &end, 16);
        if (end != byte + 2) {
            return 0;
        }
    }
    return *text == '\0';
}

static int search_main(int argc, char **argv)
{
    struct sky sky;
    if (argc == 4 && strcmp(argv[1], "search") == 0) {
        search_state = (uint32_t)strtoul(argv[2], NULL, 10);
        search_for_worst_sky((unsigned)strtoul(argv[3], NULL, 10));
    } else if (argc == 3 && strcmp(argv[1], "sky") == 0 && parse_genes(&sky, argv[2])) {
        measure_sky(&sky);
        print_cost_and_genes_of_sky(&sky);
        count_print_totals();
    } else {
        fprintf(stderr, "worst: give search, a seed and a number of skies, or sky and %d genes\n",
                GENES);
        return 2;
    }
    if (failed) {
        fprintf(stderr, "worst: a step was refused\n");
    }
    return failed;
}

#endif
