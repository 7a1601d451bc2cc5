/* SPDX-License-Identifier: MIT */
/*
 * rows_geodetic: rows of plots, polar plots and truth whose file has latitudes and longitudes
 * (geodetic.h): what they mean goes into the cells of the local frame, as messages have them.
 */
#ifndef RHOTRACK_TOOL_ROWS_GEODETIC_H
#define RHOTRACK_TOOL_ROWS_GEODETIC_H

#include <stdbool.h>

#include "io/csv/geodetic.h"
#include "io/rows/rows.h"

struct rows_geodetic {
    const struct rows_kind *kind;
    const struct parameters *parameters;
    struct geodetic *geodetic; /* NULL: of a kind that has none */
};

/* The columns of a table of this kind; errors as geodetic_open has them. */
struct rows_geodetic rows_geodetic_open(const struct table *table, const struct rows_kind *kind,
                                        const struct parameters *parameters);
void rows_geodetic_close(struct rows_geodetic *geodetic);

/* The cell's column is not needed in the file: latitude and longitude stand for it. */
bool rows_geodetic_stands_for(const struct rows_geodetic *geodetic,
                              const struct rows_column *column);

/*
 * Fills the row's cells, once those are in that the file has, and the sensor's place. False: bad,
 * the reason is set.
 */
bool rows_geodetic_fill(const struct rows_geodetic *geodetic, const struct row_check *check,
                        int32_t sensor_id, double *cells);

#endif
