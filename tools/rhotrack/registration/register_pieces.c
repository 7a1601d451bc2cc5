/* SPDX-License-Identifier: MIT */
#include "registration/register_pieces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "registration/cholesky.h"

#define PIECE_S 30.0
#define PLOTS_MIN 2    /* of a radar in a piece, for two radars of it at least */
#define SPARE_MIN 4    /* measurements of a piece more than it has coefficients */
#define FAR_SIGMAS 3.0 /* plots farther off count with the weight of one there: Huber */

/* ---- cutting ---- */

static int by_time(const void *a, const void *b)
{
    const struct piece_plot *one = a, *other = b;

    if (one->t_s < other->t_s || one->t_s > other->t_s) {
        return one->t_s > other->t_s ? 1 : -1;
    }
    if (one->radar != other->radar) {
        return one->radar > other->radar ? 1 : -1;
    }
    return (one->plot > other->plot) - (one->plot < other->plot);
}

static void add_track(const struct register_data *data, const struct radar_track *track,
                      struct pieces *pieces)
{
    const struct radar_data *radar = &data->radars[track->radar];

    for (size_t i = 0; i < track->count; i++) {
        struct corrected at = register_correct(data, radar, &radar->plots[track->plots[i]]);

        pieces->plots =
            must_grow(pieces->plots, pieces->num_plots, &pieces->plots_room, sizeof *pieces->plots);
        pieces->plots[pieces->num_plots++] = (struct piece_plot){
            .radar = track->radar, .plot = track->plots[i], .t_s = at.t_s, .weight = 1.0};
    }
}

/* Do enough radars have enough plots here to say anything of biases? */
static bool is_common(const struct register_data *data, const struct pieces *pieces,
                      const struct piece *piece)
{
    size_t enough = 0;

    for (size_t radar = 0; radar < data->num_radars; radar++) {
        size_t count = 0;

        for (size_t i = 0; i < piece->count; i++) {
            count += pieces->plots[piece->first + i].radar == radar;
        }
        enough += count >= PLOTS_MIN;
    }
    return enough >= 2 && 2 * piece->count >= PIECE_COEFFICIENTS + SPARE_MIN;
}

/* The plots of one target, from `first` on. */
static void cut(const struct register_data *data, struct pieces *pieces, size_t first)
{
    const struct piece_plot *plots = pieces->plots;

    qsort(pieces->plots + first, pieces->num_plots - first, sizeof *pieces->plots, by_time);
    while (first < pieces->num_plots) {
        struct piece piece = {.first = first, .middle_s = plots[first].t_s + PIECE_S / 2.0};

        while (first < pieces->num_plots && plots[first].t_s < piece.middle_s + PIECE_S / 2.0) {
            first++;
        }
        piece.count = first - piece.first;
        if (is_common(data, pieces, &piece)) {
            pieces->pieces = must_grow(pieces->pieces, pieces->num_pieces, &pieces->pieces_room,
                                       sizeof *pieces->pieces);
            pieces->pieces[pieces->num_pieces++] = piece;
        }
    }
}

struct pieces pieces_cut(const struct register_data *data)
{
    struct pieces pieces = {0};

    for (size_t target = 0; target < data->num_tracks; target++) {
        size_t first = pieces.num_plots;

        for (size_t i = target; i < data->num_tracks; i++) {
            if (data->tracks[i].target == target) {
                add_track(data, &data->tracks[i], &pieces);
            }
        }
        if (pieces.num_plots > first) {
            cut(data, &pieces, first);
        }
    }
    return pieces;
}

void pieces_free(struct pieces *pieces)
{
    free(pieces->pieces);
    free(pieces->plots);
}

double piece_freedom(const struct piece *piece)
{
    return 2.0 * (double)piece->count - PIECE_COEFFICIENTS;
}

/* ---- fitting ---- */

/* One plot against the parabola: two measurements, along and across, in sigmas. */
struct opened {
    struct corrected at;
    double unit[2][2]; /* along and across, over sigma */
    double basis[PIECE_TERMS], slope[PIECE_TERMS];
    double reach; /* metres across for a radian, over sigma */
};

static struct opened open_plot(const struct register_data *data, const struct piece *piece,
                               const struct piece_plot *plot)
{
    const struct radar_data *radar = &data->radars[plot->radar];
    const struct radar_plot *measured = &radar->plots[plot->plot];
    struct opened opened = {.at = register_correct(data, radar, measured)};
    double u = (opened.at.t_s - piece->middle_s) / (PIECE_S / 2.0);

    opened.unit[0][0] = opened.at.cos_azimuth / measured->sigma_range_m;
    opened.unit[0][1] = opened.at.sin_azimuth / measured->sigma_range_m;
    opened.unit[1][0] = -opened.at.sin_azimuth / measured->sigma_cross_m;
    opened.unit[1][1] = opened.at.cos_azimuth / measured->sigma_cross_m;
    opened.reach = opened.at.range_m / measured->sigma_cross_m;
    opened.basis[0] = 1.0;
    for (int k = 1; k < PIECE_TERMS; k++) {
        opened.basis[k] = opened.basis[k - 1] * u;
        opened.slope[k] = (double)k * opened.basis[k - 1] / (PIECE_S / 2.0);
    }
    return opened;
}

/* By how much the parabola's value changes with each coefficient, in the row's sigmas. */
static void row_of(const struct opened *opened, int row, double values[PIECE_COEFFICIENTS])
{
    for (int k = 0; k < PIECE_TERMS; k++) {
        values[k] = opened->unit[row][0] * opened->basis[k];
        values[PIECE_TERMS + k] = opened->unit[row][1] * opened->basis[k];
    }
}

static double measured_at(const struct opened *opened, int row)
{
    return opened->unit[row][0] * opened->at.x_m + opened->unit[row][1] * opened->at.y_m;
}

/*
 * The place is large beside what is looked for: taken from the piece's first plot, not to lose
 * digits.
 */
static void take_from(struct opened *opened, const struct corrected *from)
{
    opened->at.x_m -= from->x_m;
    opened->at.y_m -= from->y_m;
}

/* The coefficients by the plots' weights; the factor of their normal matrix stays for later. */
static bool fit_coefficients(const struct opened *opened, const struct piece_plot *plots,
                             struct piece *piece,
                             double factor[PIECE_COEFFICIENTS * PIECE_COEFFICIENTS])
{
    memset(factor, 0, sizeof(double) * PIECE_COEFFICIENTS * PIECE_COEFFICIENTS);
    memset(piece->coefficients, 0, sizeof piece->coefficients);
    for (size_t i = 0; i < piece->count; i++) {
        for (int row = 0; row < 2; row++) {
            double values[PIECE_COEFFICIENTS], value = measured_at(&opened[i], row);

            row_of(&opened[i], row, values);
            for (int j = 0; j < PIECE_COEFFICIENTS; j++) {
                piece->coefficients[j] += plots[i].weight * values[j] * value;
                for (int k = 0; k < PIECE_COEFFICIENTS; k++) {
                    factor[j * PIECE_COEFFICIENTS + k] += plots[i].weight * values[j] * values[k];
                }
            }
        }
    }
    if (!cholesky_factor(factor, PIECE_COEFFICIENTS)) {
        return false;
    }
    cholesky_solve(factor, PIECE_COEFFICIENTS, piece->coefficients);
    return true;
}

static void velocity_of(const struct piece *piece, const struct opened *opened, double v_mps[2])
{
    for (int axis = 0; axis < 2; axis++) {
        v_mps[axis] = 0.0;
        for (int k = 1; k < PIECE_TERMS; k++) {
            v_mps[axis] += piece->coefficients[axis * PIECE_TERMS + k] * opened->slope[k];
        }
    }
}

/* How a plot's row changes with its radar's biases. */
static void bias_row_of(const struct piece *piece, const struct opened *opened, int row,
                        double values[NUM_REGISTER_KINDS])
{
    double v_mps[2];

    velocity_of(piece, opened, v_mps);
    values[REGISTER_RANGE] =
        row == 0 ? -hypot(opened->unit[0][0], opened->unit[0][1]) : 0.0; /* -1 / sigma */
    values[REGISTER_AZIMUTH] = row == 1 ? -opened->reach : 0.0;
    values[REGISTER_TIME] = opened->unit[row][0] * v_mps[0] + opened->unit[row][1] * v_mps[1];
}

static double residual(const struct piece *piece, const struct opened *opened, int row)
{
    double values[PIECE_COEFFICIENTS], off = measured_at(opened, row);

    row_of(opened, row, values);
    for (int k = 0; k < PIECE_COEFFICIENTS; k++) {
        off -= values[k] * piece->coefficients[k];
    }
    return off;
}

/*
 * Adds a piece's normal equations: B'B - B'A (A'A)^-1 A'B of all biases, and -B'e. `mixed` is A'B,
 * a column for each bias.
 */
static void add_projected(const struct piece_plot *plots, const struct opened *opened,
                          const struct piece *piece, const double *factor, double *mixed,
                          struct normal *normal)
{
    size_t num = normal->num;

    memset(mixed, 0, sizeof *mixed * num * PIECE_COEFFICIENTS);
    for (size_t i = 0; i < piece->count; i++) {
        size_t base = plots[i].radar * NUM_REGISTER_KINDS;

        for (int row = 0; row < 2; row++) {
            double values[PIECE_COEFFICIENTS], biases[NUM_REGISTER_KINDS];
            double off = residual(piece, &opened[i], row);

            row_of(&opened[i], row, values);
            bias_row_of(piece, &opened[i], row, biases);
            for (size_t j = 0; j < NUM_REGISTER_KINDS; j++) {
                double weighted = plots[i].weight * biases[j];

                normal->right[base + j] -= weighted * off;
                for (size_t k = 0; k < NUM_REGISTER_KINDS; k++) {
                    normal->matrix[(base + j) * num + base + k] += weighted * biases[k];
                }
                for (size_t k = 0; k < PIECE_COEFFICIENTS; k++) {
                    mixed[(base + j) * PIECE_COEFFICIENTS + k] += weighted * values[k];
                }
            }
        }
    }
    /* with the factor L: |L^-1 A'B| squared */
    for (size_t j = 0; j < num; j++) {
        cholesky_forward(factor, PIECE_COEFFICIENTS, &mixed[j * PIECE_COEFFICIENTS]);
    }
    for (size_t j = 0; j < num; j++) {
        for (size_t k = 0; k < num; k++) {
            for (size_t m = 0; m < PIECE_COEFFICIENTS; m++) {
                normal->matrix[j * num + k] -=
                    mixed[j * PIECE_COEFFICIENTS + m] * mixed[k * PIECE_COEFFICIENTS + m];
            }
        }
    }
}

static void weigh(struct piece_plot *plots, const struct opened *opened, struct piece *piece)
{
    piece->chi2 = 0.0;
    for (size_t i = 0; i < piece->count; i++) {
        double d = hypot(residual(piece, &opened[i], 0), residual(piece, &opened[i], 1));

        plots[i].weight = d > FAR_SIGMAS ? FAR_SIGMAS / d : 1.0;
        piece->chi2 += plots[i].weight * d * d;
    }
}

bool piece_fit(const struct register_data *data, struct pieces *pieces, struct piece *piece,
               struct normal *normal)
{
    struct piece_plot *plots = &pieces->plots[piece->first];
    struct opened *opened = must_calloc(piece->count, sizeof *opened);
    struct corrected from;
    double factor[PIECE_COEFFICIENTS * PIECE_COEFFICIENTS];
    bool is_fitted;

    for (size_t i = 0; i < piece->count; i++) {
        opened[i] = open_plot(data, piece, &plots[i]);
    }
    from = opened[0].at;
    for (size_t i = 0; i < piece->count; i++) {
        take_from(&opened[i], &from);
    }
    is_fitted = fit_coefficients(opened, plots, piece, factor);
    if (is_fitted) {
        if (normal) {
            double *mixed = must_calloc(normal->num * PIECE_COEFFICIENTS, sizeof *mixed);

            add_projected(plots, opened, piece, factor, mixed, normal);
            free(mixed);
        }
        double v_mps[2];

        velocity_of(piece, &opened[piece->count / 2], v_mps);
        piece->speed_mps = hypot(v_mps[0], v_mps[1]);
        weigh(plots, opened, piece);
    }
    free(opened);
    return is_fitted;
}
