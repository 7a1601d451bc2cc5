/* SPDX-License-Identifier: MIT */
/*
 * register_pieces: pieces of targets' paths that several radars saw, and what each says of the
 * biases.
 */
#ifndef RHOTRACK_TOOL_REGISTER_PIECES_H
#define RHOTRACK_TOOL_REGISTER_PIECES_H

#include "registration/register_data.h"

#define PIECE_TERMS 3 /* of the parabola, each axis */
#define PIECE_COEFFICIENTS (2 * PIECE_TERMS)

struct piece_plot {
    size_t radar, plot;
    double t_s;
    double weight; /* 1, less where it is far off */
};

struct piece {
    size_t first, count; /* plots */
    double middle_s;
    bool is_left_out; /* no parabola */
    double chi2;      /* weighted, of the last fit */
    double speed_mps;
    double coefficients
        /* of x, then y, in powers of seconds from the middle over PIECE_S / 2 */
        [PIECE_COEFFICIENTS];
};

struct pieces {
    size_t num_pieces, pieces_room, num_plots, plots_room;
    struct piece *pieces;
    struct piece_plot *plots;
};

struct pieces pieces_cut(const struct register_data *data);
void pieces_free(struct pieces *pieces);

/* The remaining degrees of freedom of a piece. */
double piece_freedom(const struct piece *piece);

/* Normal equations of all radars' biases: num = NUM_REGISTER_KINDS x radars, the matrix by rows. */
struct normal {
    size_t num;
    double *matrix, *right;
};

/*
 * Fits the piece with the biases as they are and its plots' weights, adds what it says to the
 * normal equations (NULL: adds nothing), and sets the weights anew. False where it cannot be
 * fitted.
 */
bool piece_fit(const struct register_data *data, struct pieces *pieces, struct piece *piece,
               struct normal *normal);

#endif
