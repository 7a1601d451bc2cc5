/* SPDX-License-Identifier: MIT */
/*
 * The initiator's inside: what one search carries around. Private to src/initiation/initiator*.c.
 */
#ifndef RHOTRACK_INITIATOR_SEARCH_H
#define RHOTRACK_INITIATOR_SEARCH_H

#include "rhotrack/initiator.h"

/* 99.9 % of the squared distances of a target's plots, two dimensions. */
#define GATE_CHI2 13.8155f

struct search {
    struct rho_initiator *initiator;
    enum rho_search kind;
    /* scans that must have voted: the newest, or none in particular */
    unsigned wanted_mask;
    unsigned num_scans;          /* N: scans held */
    unsigned min_scans;          /* M */
    float time_s[RHO_MAX_SCANS]; /* of the scans, after the newest: <= 0 */
    float log_pd, log_miss;      /* ln pd, ln(1 - pd) */
    float log_prior;             /* ln of the births' density over area and velocity */
    /* displacement covariance by process noise */
    float process_m2[RHO_MAX_SCANS * (RHO_MAX_SCANS + 1) / 2];
    float fit_process_m2; /* its largest residual variance about a fitted line */
    uint16_t skip_flags;  /* plots that look-ups pass over */
};

/* A straight track at speed: position at the newest scan's time. */
struct line_fit {
    float x_m, y_m, vx_mps, vy_mps;
};

/* The plots of a hypothesis, by age order. */
struct plot_set {
    unsigned mask;
    unsigned hits;
    uint16_t plot[RHO_MAX_SCANS];
};

/* initiator_density.c: what the scans tell of clutter, and what follows from it */
void rho_initiator_prepare(struct search *search);
float rho_initiator_log_density(const struct search *search, const struct plot_set *set,
                                unsigned m);

/* initiator_fit.c: least squares and the score */
void rho_initiator_prepare_process(struct search *search);
float rho_initiator_process_gap_m2(const struct search *search, unsigned a, unsigned m, unsigned b);
int rho_initiator_settle(struct search *search, struct plot_set *set, struct line_fit *fit);
void rho_initiator_collect(struct search *search, const struct line_fit *fit, float factor,
                           struct plot_set *set);
int rho_initiator_score(const struct search *search, const struct plot_set *set,
                        int32_t *score_mnat);

/* initiator_select.c: the list of candidates */
void rho_initiator_offer(struct search *search, struct plot_set *set);
void rho_initiator_select(struct search *search);

const struct rho_window_plot *rho_initiator_plot(const struct search *search,
                                                 const struct plot_set *set, unsigned m);

#endif
