/* SPDX-License-Identifier: MIT */
/*
 * clutter_memory: the density of clutter over the last hundred scans, which shows
 * standing objects and hot spots that are too small for the few plots of a window.
 *
 * Plots that leave the window without having started a track were clutter. They are counted in
 * cells much smaller than those of the density map, and all counts are halved regularly. Where a
 * cell has significantly more plots than the window's density explains, the density of its count is
 * taken. So the memory only raises densities: clutter that has ended is forgotten slowly, and the
 * window shows new clutter.
 */
#include <string.h>

#include "clutter_density.h"
#include "policy.h"

static int memory_index(float cells)
{
    return cells >= 0.0f && cells < (float)RHO_MAX_CLUTTER_CELLS ? (int)cells : -1;
}

/* Index of the memory's cell at a place; -1 outside of the cells. */
static int cell_of_place(const struct rho_clutter_memory *memory, float x_m, float y_m)
{
    const int column = memory_index((x_m - memory->x_min_m) * memory->columns_per_m);
    const int row = memory_index((y_m - memory->y_min_m) * memory->rows_per_m);
    return column < 0 || row < 0 ? -1 : row * RHO_MAX_CLUTTER_CELLS + column;
}

static void halve_counts(struct rho_clutter_memory *memory)
{
    for (unsigned c = 0; c < RHO_CLUTTER_MEMORY_CELLS; c++) {
        memory->count[c] /= 2;
    }
    memory->num_scans /= 2;
}

void rho_clutter_memory_add(struct rho_initiator *initiator)
{
    struct rho_clutter_memory *memory = &initiator->memory;
    const struct rho_window_scan *scan = rho_window_scan_at(&initiator->window, 0);
    const struct rho_extent *extent = &initiator->window.extent;
    const float width_m = rho_extent_width_m(extent, 1.0f);
    const float height_m = rho_extent_height_m(extent, 1.0f), cells = (float)RHO_MAX_CLUTTER_CELLS;
    /* the cells are laid out anew where the area has outgrown them, or they are too wide for it */
    if (memory->num_scans == 0 || extent->x_min_m < memory->x_min_m ||
        extent->y_min_m < memory->y_min_m ||
        extent->x_max_m > memory->x_min_m + cells / memory->columns_per_m ||
        extent->y_max_m > memory->y_min_m + cells / memory->rows_per_m ||
        cells / memory->columns_per_m > MEMORY_TOO_WIDE * width_m ||
        cells / memory->rows_per_m > MEMORY_TOO_WIDE * height_m) {
        memset(memory, 0, sizeof *memory);
        memory->x_min_m = extent->x_min_m - MEMORY_MARGIN * width_m;
        memory->y_min_m = extent->y_min_m - MEMORY_MARGIN * height_m;
        memory->columns_per_m = cells / ((1.0f + 2.0f * MEMORY_MARGIN) * width_m);
        memory->rows_per_m = cells / ((1.0f + 2.0f * MEMORY_MARGIN) * height_m);
    }
    if (memory->num_scans == MEMORY_SCANS_MAX) {
        halve_counts(memory);
    }
    memory->num_scans++;
    for (unsigned i = 0; i < scan->num_plots; i++) {
        const int cell = cell_of_place(memory, scan->plots[i].x_m, scan->plots[i].y_m);
        if (cell < 0 || (scan->marks[i] & RHO_WINDOW_INITIATED)) {
            continue;
        }
        if (memory->count[cell] == UINT16_MAX) {
            /* all cells are halved, so that their counts stay in proportion */
            halve_counts(memory);
        }
        memory->count[cell]++;
    }
}

float rho_clutter_memory_raise(const struct rho_initiator *initiator, float x_m, float y_m,
                               float density_per_m2)
{
    const struct rho_clutter_memory *memory = &initiator->memory;
    if (RHO_MAX_CLUTTER_CELLS == 0 || memory->num_scans == 0) {
        return density_per_m2;
    }
    const int cell = cell_of_place(memory, x_m, y_m);
    if (cell < 0) {
        return density_per_m2;
    }
    const float scans_m2 = (float)memory->num_scans / (memory->columns_per_m * memory->rows_per_m);
    /* a plot is added to both counts: few plots then weigh little, and the divisor is never 0 */
    const float expected = density_per_m2 * scans_m2 + 1.0f;
    const float count = (float)memory->count[cell] + 1.0f, excess = count - expected;
    return excess > 0.0f && excess * excess > MEMORY_SIGMAS * MEMORY_SIGMAS * expected
               ? density_per_m2 * count / expected
               : density_per_m2;
}
