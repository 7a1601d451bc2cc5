/* SPDX-License-Identifier: MIT */
/*
 * clutter: how dense is clutter here, and which plots start no track? Private from src/tracker on.
 */
#ifndef RHOTRACK_CLUTTER_H
#define RHOTRACK_CLUTTER_H

#include "look.h"

/* clutter.c: opens the look's clutter, before claims */
void rho_clutter_open(struct rho_tracker *tracker, struct rho_look *look, struct rho_work *work);
/* ln of the density of clutter at a plot of the look, from that of the background there. */
float rho_clutter_log_at_plot(const struct rho_look *look, float log_background, uint32_t row);

/* expected_clutter.c: density of clutter plots at a place, without echoes and strobes, 1/m^2 */
float rho_clutter_background(const struct rho_look *look, float x_m, float y_m);
/* Density of clutter at a plot's place, without echoes and strobes, 1/m^2; above 0. */
float rho_clutter_background_at(const struct rho_look *look, const struct rho_plot *plot);
/* ln of the density of clutter at the track's place, in the part of the scan that is claimed. */
float rho_clutter_log_at_track(const struct rho_look *look, const struct rho_track *track);
/* Clutter plots expected within three standard deviations of the track's place; 0 of bearings. */
float rho_clutter_in_gate(const struct rho_look *look, const struct rho_track *track);
/* Measures the clutter density of a later part of the scan, from its held plots. */
void rho_clutter_measure_part(struct rho_look *look);
/* Smooths the number of unclaimed plots, after new tracks have started. */
void rho_clutter_count_unclaimed(struct rho_tracker *tracker, const struct rho_look *look);
/* Moves a mean of ten scans by a tenth of its difference to the newest value. */
void rho_clutter_smooth_mean(float *mean, float newest);

/* echo_clutter.c (RHO_MAX_ECHOES): the clutter map in a step */
int rho_echoes_is_sound_track(const struct rho_track *track);
/* Computes the density of echoes and strobes at the plots of a scan (first part), before claims. */
void rho_echoes_predict(struct rho_tracker *tracker, const struct rho_look *look,
                        struct rho_work *work);
/* ln of the density with echoes, strobes, second plots over that without; 0 in later parts. */
float rho_echoes_log_ratio_at(const struct rho_look *look, uint32_t row);
/* Stores rho_echoes_log_ratio_at of the scan's plots with the held plots in the window. */
void rho_echoes_store_ratios(const struct rho_look *look);
/* Updates the clutter map with the scan's plots, after new tracks have started. */
void rho_echoes_update(struct rho_tracker *tracker, const struct rho_look *look);
/*
 * Likelihood ratio of a range rate that is off_mps from the expected one, against clutter that is
 * uniform in all range rates. Half of such rates are taken to be as expected, with the variance and
 * that of 1 m/s, and half to be uniform, too.
 */
float rho_echoes_rate_ratio(const struct rho_look *look, float off_mps, float variance);
/* Sums into a new track the probabilities that its candidate's plots were returns of echoes. */
void rho_echoes_sum_returns(const struct rho_look *look, const struct rho_candidate *candidate,
                            struct rho_track *track);

/*
 * second_plots.c (RHO_MAX_ECHOES): learns how often second plots of a target come near claimed
 * ones, raises the clutter density there, and ends the younger of two tracks of one target
 */
struct step;
void rho_second_plots_take_look(struct step *step);
int rho_second_plots_are_sound(const struct rho_second_plots *table);
int rho_second_is_sound_track(const struct rho_track *track);
/* After a start: raises the density at the window's plots near the candidate's: second plots. */
void rho_second_plots_raise_window(const struct rho_look *look, struct rho_work *work,
                                   const struct rho_candidate *candidate);

#endif
