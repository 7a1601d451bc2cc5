/* SPDX-License-Identifier: MIT */
/*
 * initiator_votes: before a search: what is known beforehand, and how many scans must vote for a track.
 */
#include "initiator_search.h"
#include "rhotrack/approx.h"

/* M is the smallest number of votes, down from N, with at most this many chance tracks a search; N where there is
 * none. */
#define CHANCE_TRACKS_MAX 0.1f

/* ln of the targets expected in the area and window before any plot was seen: a half, so that one target and none are
 * equally likely. */
#define LOG_TARGETS_EXPECTED LOG_HALF

/* ---- how many votes --------------------------------------------------------------------------- */

/* Chi-square limit of 95 % for even degrees of freedom d = 2 h - 4: Wilson and Hilferty's approximation. */
static float chi2_95(unsigned degrees)
{
    float f = 2.0f / (9.0f * (float)degrees);
    float root = 1.0f - f + 1.6449f * rho_sqrt(f);
    return (float)degrees * root * root * root;
}

/*
 * ln of the expected number of chance tracks with votes in h given scans: density^h sigma^(2h-4) V(c) A pi (v_max^2 -
 * v_min^2) h Stt, V the ball of 2h - 4 dimensions, Stt the spread of the scan times (src/DESIGN.md derives it).
 */
static float log_chance(const struct search *search, unsigned h, float sigma_m, float spread_s2)
{
    const struct rho_initiator_config *config = &search->initiator->config;
    float degrees = (float)(2u * h - 4u);
    float log_ball = 0.5f * degrees * (LOG_PI + rho_log(chi2_95(2u * h - 4u))) -
                     rho_initiator_log_factorial(h - 2u);
    float speeds = config->v_max_mps * config->v_max_mps - config->v_min_mps * config->v_min_mps;
    return (float)h * rho_log(search->initiator->density_per_m2) + degrees * rho_log(sigma_m) +
           log_ball + rho_log(rho_initiator_area_m2(search->initiator)) + LOG_PI + rho_log(speeds) +
           rho_log((float)h * spread_s2);
}

static float largest_sigma_m(const struct search *search)
{
    float sigma_m = RHO_LIMIT_SIGMA_MIN;
    for (unsigned m = 0; m < search->num_scans; m++) {
        float scan_m = rho_window_scan_at(&search->initiator->window, m)->sigma_max_m;
        sigma_m = scan_m > sigma_m ? scan_m : sigma_m;
    }
    return rho_sqrt(sigma_m * sigma_m + search->fit_process_m2);
}

/* Sum over the h - subsets of N scans is taken as C(N, h) times the subset spread evenly over the window. */
static float chance_tracks(const struct search *search, unsigned h)
{
    float span_s = search->time_s[search->num_scans - 1u] - search->time_s[0];
    float spread_s2 = (float)(h * (h + 1u)) * span_s * span_s / (12.0f * (float)(h - 1u));
    float log_subsets = rho_initiator_log_factorial(search->num_scans) -
                        rho_initiator_log_factorial(h) -
                        rho_initiator_log_factorial(search->num_scans - h);
    return rho_exp(log_subsets + log_chance(search, h, largest_sigma_m(search), spread_s2));
}

static unsigned choose_min_scans(const struct search *search)
{
    unsigned m = search->num_scans;
    float chance = m > 3 ? chance_tracks(search, m) : 0.0f;
    while (m > 3) {
        chance += chance_tracks(search, m - 1u);
        if (!(chance <= CHANCE_TRACKS_MAX)) {
            break;
        }
        m--;
    }
    return m;
}

/* ln of the space that clutter and births are spread over beyond the plane and its velocities. */
float rho_initiator_log_room(const struct search *search, int has_z, unsigned heights,
                             unsigned range_rates)
{
    float v_max_mps = search->initiator->config.v_max_mps;
    float room = (float)range_rates * rho_log(2.0f * v_max_mps);
    if (has_z) {
        room += ((float)heights - 1.0f) * rho_log(RHO_CLUTTER_HEIGHT_M) -
                rho_log(2.0f * CLIMB_SHARE * v_max_mps);
    }
    return room;
}

/* ---- before a search -------------------------------------------------------------------------- */

void rho_initiator_prepare(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    const struct rho_initiator_config *config = &initiator->config;
    rho_initiator_begin_density(search);
    rho_initiator_prepare_reach(search);
    for (unsigned m = 0; m < search->num_scans; m++) {
        float sensor_pd = rho_window_scan_at(&initiator->window, m)->sensor.pd;
        float pd = sensor_pd > 0.0f ? sensor_pd : config->pd;
        search->log_pd[m] = rho_log(pd);
        search->log_miss[m] = rho_log(1.0f - pd);
    }
    /* targets are anywhere in the area, their velocities anywhere in the ring of allowed speeds */
    search->log_prior =
        LOG_TARGETS_EXPECTED - rho_log(rho_initiator_area_m2(initiator)) - LOG_PI -
        rho_log(config->v_max_mps * config->v_max_mps - config->v_min_mps * config->v_min_mps);
    search->min_scans = config->min_scans    ? config->min_scans
                        : search->keeps_rate ? 3u
                                             : choose_min_scans(search);
}
