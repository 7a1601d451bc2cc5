/* SPDX-License-Identifier: MIT */
/*
 * Searches scenes of passive_scene.h by the paper's passive method, and compares its lines with the
 * targets' paths.
 */
#ifndef SEARCH_BY_PASSIVE_PAPER_H
#define SEARCH_BY_PASSIVE_PAPER_H

#include "passive_scene.h"
#include "rhotrack/passive_paper.h"

static inline struct rho_passive_paper_config paper_config(void)
{
    struct rho_passive_paper_config config;
    rho_passive_paper_config_default(&config);
    return config;
}

static inline enum rho_status push_to_paper(struct rho_passive_paper *paper,
                                            const struct scene *scene, unsigned k)
{
    struct full_frame full;
    fill_frame(scene, k, &full);
    return rho_passive_paper_push(paper, &full.frame, full.fates);
}

static inline enum rho_status search_by_paper(struct rho_passive_paper *paper,
                                              const struct rho_passive_paper_config *config,
                                              const struct scene *scene)
{
    enum rho_status status = rho_passive_paper_init(paper, sizeof *paper, config);
    for (unsigned k = 0; k < scene->scans && status == RHO_OK; k++) {
        status = push_to_paper(paper, scene, k);
    }
    return status == RHO_OK ? rho_passive_paper_search(paper) : status;
}

/* Distance of two lines in theta and rho, by the nearer of (rho, theta) and (-rho, theta +- pi). */
static inline void line_distance(double theta_rad, double rho_m, double other_theta_rad,
                                 double other_rho_m, double *off_rad, double *off_m)
{
    double turn_rad = remainder(theta_rad - other_theta_rad, 2.0 * PI);
    double sign = fabs(turn_rad) > 0.5 * PI ? -1.0 : 1.0;
    *off_rad = fabs(remainder(turn_rad, PI));
    *off_m = fabs(sign * rho_m - other_rho_m);
}

/* True if a line is within 6 degrees and 3 km of a target's path. */
static inline int is_near_path(const struct rho_passive_paper_line *line,
                               const struct target *target)
{
    double theta_rad = atan2(target->vx_mps, -target->vy_mps), off_rad, off_m;
    double rho_m = target->x_m * cos(theta_rad) + target->y_m * sin(theta_rad);
    line_distance((double)line->theta_rad, (double)line->rho_m, theta_rad, rho_m, &off_rad, &off_m);
    return off_rad < 6.0 * DEG_RAD && off_m < 3000.0;
}

static inline int are_lines_sound(const struct rho_passive_paper *paper)
{
    int are_sound = paper->num_lines <= RHO_MAX_PASSIVE_LINES;
    for (unsigned i = 0; are_sound && i < paper->num_lines; i++) {
        const struct rho_passive_paper_line *line = &paper->lines[i];
        are_sound = isfinite(line->rho_m) && line->theta_rad >= 0.0f &&
                    line->theta_rad < (float)PI && isfinite(line->x_m) && isfinite(line->y_m) &&
                    isfinite(line->vx_mps) && isfinite(line->vy_mps) &&
                    line->votes >= paper->votes_min && line->crossings > 0 && line->scans > 0 &&
                    line->scans < 1u << paper->batch.num_scans && line->has_state <= 1 &&
                    (i == 0 || line->votes_sum <= paper->lines[i - 1].votes_sum);
    }
    return are_sound;
}

#endif
