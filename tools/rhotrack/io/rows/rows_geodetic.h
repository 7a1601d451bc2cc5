/* SPDX-License-Identifier: MIT */
/*
 * rows_geodetic: converts latitudes and longitudes (geodetic_columns.h) in rows of
 * plots, polar plots and truth to cells of the local frame, as messages have them.
 */
#ifndef RHOTRACK_TOOL_ROWS_GEODETIC_H
#define RHOTRACK_TOOL_ROWS_GEODETIC_H

#include <stdbool.h>

#include "io/csv/geodetic_columns.h"
#include "io/rows/rows_in_memory.h"

struct rows_geodetic {
    const struct rows_kind *kind;
    const struct parameters *parameters;
    struct geodetic_columns *geodetic; /* NULL for a kind without latitudes */
};

/* Finds the latitude and longitude columns of a table; errors as geodetic_open has them. */
struct rows_geodetic rows_geodetic_open(const struct table *table, const struct rows_kind *kind,
                                        const struct parameters *parameters);
void rows_geodetic_close(struct rows_geodetic *geodetic);

/* Whether latitude and longitude replace a column, which the file then need not have. */
bool rows_geodetic_replaces(const struct rows_geodetic *geodetic, const struct rows_column *column);

/*
 * Fills a row's cells of the local frame from its latitudes and longitudes; the file's other cells
 * and the sensor's position must be set before. Returns false and sets the reason where the row is
 * bad.
 */
bool rows_geodetic_fill_cells(const struct rows_geodetic *geodetic, const struct row_check *check,
                              int32_t sensor_id, double *cells);

#endif
