/* SPDX-License-Identifier: MIT */
/*
 * recurring_clutter_map: the table of echoes, places that return clutter again and again: their
 * estimated places, the probabilities of their return, and which of them a full table drops.
 */
#include "rhotrack/detail/recurring_clutter_map.h"

#include <stddef.h>
#include <string.h>

#include "policy.h"
#include "rhotrack/detail/approx.h"

/* Prior probabilities that an echo returns, by its class of hits; half as large after misses. */
static const float prior_probability[RHO_ECHO_HIT_CLASSES] = {0.004f, 0.04f, 0.12f, 0.2f};
/* Scans of an echo's sensor, by class of hits, after which an unseen echo is forgotten. */
static const uint8_t scans_kept[RHO_ECHO_HIT_CLASSES] = {12, 16, 30, 100};

/* Ranks of echoes when places are freed; hits beyond which an echo ranks no better. */
enum { RANKS = 64, HITS_RANKED = 16 };

#define ALL_REGIONS (RHO_ECHO_TABLES - 1)

void rho_clutter_map_init(struct rho_clutter_map *map, float v_min_mps)
{
    map->v_min_mps = v_min_mps;
    map->scans_to_blocks = BLOCK_TURNS;
}

unsigned rho_clutter_map_hit_class(unsigned hits)
{
    return hits < 2 ? 0 : hits < 3 ? 1 : hits < RHO_ECHO_KNOWN_HITS ? 2 : 3;
}

static unsigned gap_class(unsigned gap)
{
    return gap < 2 ? 0 : gap < 3 ? 1 : gap < 5 ? 2 : gap < 9 ? 3 : 4;
}

float rho_clutter_map_return_probability(const struct rho_clutter_map *map, unsigned region,
                                         unsigned hits, unsigned unseen)
{
    const unsigned c = rho_clutter_map_hit_class(hits), g = gap_class(unseen);
    const struct rho_echo_returns *all = &map->tables[0][ALL_REGIONS];
    const struct rho_echo_returns *here =
        &map->tables[0][region < ALL_REGIONS ? region : ALL_REGIONS];
    const float prior =
        (map->v_min_mps > 0.0f ? prior_probability[c] : PRIOR_PROBABILITY_STANDING) *
        (g > 0 ? 0.5f : 1.0f);
    /* counts may be below 0, as tracks take out counts of blocks that are not used yet */
    const float all_returns = all->returns[c][g] > 0.0f ? all->returns[c][g] : 0.0f;
    const float returns = here->returns[c][g] > 0.0f ? here->returns[c][g] : 0.0f;
    const float mean = (all_returns + PRIOR_LOOKS * prior) / (all->looks[c][g] + PRIOR_LOOKS);
    const float probability = (returns + REGION_LOOKS * mean) / (here->looks[c][g] + REGION_LOOKS);
    return probability < PROBABILITY_MAX ? probability : PROBABILITY_MAX;
}

void rho_clutter_map_count_look(struct rho_clutter_map *map, const struct rho_echo *echo)
{
    const unsigned c = rho_clutter_map_hit_class(echo->hits), g = gap_class(echo->unseen);
    map->tables[1][echo->region].looks[c][g] += 1.0f;
    map->tables[1][ALL_REGIONS].looks[c][g] += 1.0f;
}

void rho_clutter_map_count_return(struct rho_clutter_map *map, const struct rho_echo *echo)
{
    const unsigned c = rho_clutter_map_hit_class(echo->hits), g = gap_class(echo->unseen);
    map->tables[1][echo->region].returns[c][g] += echo->weight;
    map->tables[1][ALL_REGIONS].returns[c][g] += echo->weight;
}

/* Takes a target's returns out of a class of hits, at most as many as all blocks have. */
static void remove_returns_of_class(struct rho_clutter_map *map, unsigned region, unsigned c,
                                    float returns)
{
    const float sum = map->tables[0][region].returns[c][0] + map->tables[1][region].returns[c][0] +
                      map->tables[2][region].returns[c][0];
    if (sum > 0.0f) {
        map->tables[0][region].returns[c][0] -= returns < sum ? returns : sum;
    }
}

void rho_clutter_map_remove_returns(struct rho_clutter_map *map, unsigned region,
                                    const float returns[RHO_ECHO_HIT_CLASSES])
{
    for (unsigned c = 0; c < RHO_ECHO_HIT_CLASSES; c++) {
        remove_returns_of_class(map, region, c, returns[c]);
        remove_returns_of_class(map, ALL_REGIONS, c, returns[c]);
    }
}

float rho_clutter_map_decay_factor(float turn_share)
{
    return 1.0f - turn_share / TURNS_REMEMBERED;
}

/* Decays a table of looks and returns and adds another one: *to = keep * *to + *from. */
static void decay_table(struct rho_echo_returns *to, float keep,
                        const struct rho_echo_returns *from)
{
    for (unsigned c = 0; c < RHO_ECHO_HIT_CLASSES; c++) {
        for (unsigned g = 0; g < RHO_ECHO_GAP_CLASSES; g++) {
            to->looks[c][g] = keep * to->looks[c][g] + from->looks[c][g];
            to->returns[c][g] = keep * to->returns[c][g] + from->returns[c][g];
        }
    }
}

static void close_count_block(struct rho_clutter_map *map)
{
    for (unsigned r = 0; r < RHO_ECHO_TABLES; r++) {
        decay_table(&map->tables[0][r], 1.0f, &map->tables[2][r]);
    }
    memcpy(map->tables[2], map->tables[1], sizeof map->tables[2]);
    memset(map->tables[1], 0, sizeof map->tables[1]);
}

void rho_clutter_map_age_counts(struct rho_clutter_map *map, float turn_share)
{
    static const struct rho_echo_returns none;
    for (unsigned r = 0; r < RHO_ECHO_TABLES; r++) {
        decay_table(&map->tables[0][r], rho_clutter_map_decay_factor(turn_share), &none);
    }
    map->scans_to_blocks -= turn_share;
    if (!(map->scans_to_blocks > 0.0f)) {
        close_count_block(map);
        if (!(map->tables[0][ALL_REGIONS].looks[0][0] > 0.0f)) {
            close_count_block(map); /* the first block of a new map is used as soon as it ends */
        }
        map->scans_to_blocks = BLOCK_TURNS;
    }
}

struct echo_view rho_clutter_map_view(const struct rho_sensor *sensor, float x_m, float y_m)
{
    const float dx_m = x_m - (sensor ? sensor->x_m : 0.0f);
    const float dy_m = y_m - (sensor ? sensor->y_m : 0.0f);
    const float range_m = rho_sqrt(dx_m * dx_m + dy_m * dy_m);
    if (!(range_m > 0.0f)) {
        return (struct echo_view){1.0f, 0.0f, 0.0f};
    }
    return (struct echo_view){dx_m / range_m, dy_m / range_m, range_m};
}

float rho_clutter_map_azimuth_turns(const struct echo_view *view)
{
    return (rho_atan2(view->along_y, view->along_x) + RHO_PI) / RHO_TWO_PI;
}

/* Index of a region on one axis: azimuth in turns, or root of the range over the maximum range. */
static unsigned region_index_on_axis(float share)
{
    return (unsigned)rho_cell_at(share * (float)RHO_ECHO_REGIONS, RHO_ECHO_REGIONS);
}

uint8_t rho_clutter_map_region_at(const struct rho_sensor *sensor, float range_max_m, float x_m,
                                  float y_m)
{
    const struct echo_view view = rho_clutter_map_view(sensor, x_m, y_m);
    return (uint8_t)(region_index_on_axis(rho_clutter_map_azimuth_turns(&view)) * RHO_ECHO_REGIONS +
                     region_index_on_axis(rho_sqrt(view.range_m / range_max_m)));
}

static void predict_axis_covariance(float axis[3], float dt_s)
{
    axis[0] += dt_s * (2.0f * axis[1] + dt_s * axis[2]);
    axis[1] += dt_s * axis[2];
}

void rho_clutter_map_predict_echo(struct rho_echo *echo, int64_t time_us)
{
    const float dt_s = rho_seconds_between(echo->time_us, time_us);
    echo->x_m += dt_s * echo->vx_mps;
    echo->y_m += dt_s * echo->vy_mps;
    predict_axis_covariance(echo->along, dt_s);
    predict_axis_covariance(echo->across, dt_s);
    echo->time_us = time_us;
}

/*
 * Kalman update of an echo's covariance on one axis with a plot that lies off_m from it. Sets
 * move[] to the corrections of place and speed.
 */
static void update_axis_covariance(float axis[3], float variance_m2, float off_m,
                                   float corrections[2])
{
    const float sum = axis[0] + variance_m2, place = axis[0] / sum, speed = axis[1] / sum;
    corrections[0] = place * off_m;
    corrections[1] = speed * off_m;
    axis[2] -= speed * axis[1];
    /* rounding: the noise may be as small as millimetres */
    axis[2] = axis[2] > 0.0f ? axis[2] : 0.0f;
    axis[1] *= 1.0f - place;
    axis[0] = (1.0f - place) * axis[0] + PLACE_NOISE * variance_m2;
}

void rho_clutter_map_update_echo(struct rho_echo *echo, const struct rho_sensor *sensor,
                                 const struct rho_plot *plot)
{
    const struct echo_view view = rho_clutter_map_view(sensor, echo->x_m, echo->y_m);
    const float dx_m = plot->x_m - echo->x_m, dy_m = plot->y_m - echo->y_m;
    float along[2], across[2];
    update_axis_covariance(echo->along, plot->sigma_range_m * plot->sigma_range_m,
                           dx_m * view.along_x + dy_m * view.along_y, along);
    update_axis_covariance(echo->across, plot->sigma_cross_m * plot->sigma_cross_m,
                           dy_m * view.along_x - dx_m * view.along_y, across);
    echo->x_m += along[0] * view.along_x - across[0] * view.along_y;
    echo->y_m += along[0] * view.along_y + across[0] * view.along_x;
    echo->vx_mps += along[1] * view.along_x - across[1] * view.along_y;
    echo->vy_mps += along[1] * view.along_y + across[1] * view.along_x;
    echo->hits = (uint16_t)(echo->hits < UINT16_MAX ? echo->hits + 1 : UINT16_MAX);
    echo->unseen = 0;
}

int rho_clutter_map_is_echo_lost(const struct rho_echo *echo)
{
    return echo->unseen > scans_kept[rho_clutter_map_hit_class(echo->hits)];
}

void rho_clutter_map_start_echo(const struct rho_clutter_map *map, struct rho_echo *echo,
                                int32_t sensor_id, int64_t time_us, const struct rho_plot *plot)
{
    const float speed_mps = ECHO_SPEED_SHARE * map->v_min_mps;
    *echo = (struct rho_echo){
        .time_us = time_us,
        .sensor_id = sensor_id,
        .x_m = plot->x_m,
        .y_m = plot->y_m,
        .along = {plot->sigma_range_m * plot->sigma_range_m, 0.0f, speed_mps * speed_mps},
        .across = {plot->sigma_cross_m * plot->sigma_cross_m, 0.0f, speed_mps * speed_mps},
        .plot = -1,
        .hits = 1,
        .was_looked_at = 1,
    };
}

/* Rank of an echo when places are freed, by misses for hits: higher ranks are dropped first. */
static unsigned echo_drop_rank(const struct rho_echo *echo, int64_t time_us)
{
    const unsigned hits = echo->hits < HITS_RANKED ? echo->hits : HITS_RANKED;
    unsigned missed = echo->unseen;
    if (!echo->was_looked_at && echo->region != UINT8_MAX) {
        const float unseen_s = rho_seconds_between(echo->time_us, time_us);
        missed += 1u + (unsigned)rho_cell_at(unseen_s / MISSED_S, RANKS + 1);
    }
    const unsigned rank = missed * 8u / hits;
    return rank < RANKS ? rank : RANKS - 1u;
}

/* True where an echo may be dropped for another one: the newest scan did not see it. */
static int may_drop_echo(const struct rho_echo *echo)
{
    return echo->hits > 0 && (echo->unseen > 0 || !echo->was_looked_at);
}

void rho_clutter_map_free_places(struct rho_clutter_map *map, uint32_t num, int64_t time_us)
{
    uint16_t of_rank[RANKS] = {0};
    uint32_t is_free = 0;
    unsigned rank = RANKS;
    for (unsigned i = 0; i < RHO_ECHO_PLACES; i++) {
        const struct rho_echo *echo = &map->echoes[i];
        is_free += echo->hits == 0;
        if (may_drop_echo(echo)) {
            of_rank[echo_drop_rank(echo, time_us)]++;
        }
    }
    while (rank > 0 && is_free < num) {
        is_free += of_rank[--rank];
    }
    /* echoes of the lowest dropped rank that stay, as enough places are free without them */
    uint32_t to_spare = is_free > num ? is_free - num : 0;
    for (unsigned i = 0; i < RHO_ECHO_PLACES; i++) {
        struct rho_echo *echo = &map->echoes[i];
        if (!may_drop_echo(echo) || echo_drop_rank(echo, time_us) < rank) {
            continue;
        }
        if (echo_drop_rank(echo, time_us) == rank && to_spare > 0) {
            to_spare--;
            continue;
        }
        echo->hits = 0;
        map->echoes_dropped = rho_count(map->echoes_dropped, 1);
    }
}

/* A taught echo stands. Its region is found at the first look: the sensor may be unknown yet. */
static void teach_echo(struct rho_echo *echo, int32_t sensor_id, float x_m, float y_m,
                       float along_m2, float across_m2, uint16_t hits)
{
    memset(echo, 0, sizeof *echo);
    echo->sensor_id = sensor_id;
    echo->x_m = x_m;
    echo->y_m = y_m;
    echo->along[0] = along_m2;
    echo->across[0] = across_m2;
    echo->plot = -1;
    echo->hits = hits;
    echo->region = UINT8_MAX;
}

enum rho_status rho_clutter_map_teach(struct rho_clutter_map *map, int32_t sensor_id, float x_m,
                                      float y_m, float sigma_range_m, float sigma_cross_m,
                                      uint16_t hits)
{
    if (!map) {
        return RHO_ERROR_NULL;
    }
    if (!rho_is_coordinate(x_m) || !rho_is_coordinate(y_m) ||
        !rho_is_within(sigma_range_m, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_SIGMA_MAX) ||
        !rho_is_within(sigma_cross_m, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_SIGMA_MAX) || hits == 0) {
        return RHO_ERROR_VALUE;
    }
    rho_clutter_map_free_places(map, 1, map->time_us);
    for (unsigned i = 0; i < RHO_ECHO_PLACES; i++) {
        if (map->echoes[i].hits == 0) {
            teach_echo(&map->echoes[i], sensor_id, x_m, y_m, rho_square(sigma_range_m),
                       rho_square(sigma_cross_m), hits);
            return RHO_OK;
        }
    }
    map->echoes_dropped = rho_count(map->echoes_dropped, 1);
    return RHO_OK;
}

const struct rho_echo *rho_clutter_map_next_known(const struct rho_clutter_map *map,
                                                  uint32_t *place)
{
    while (map && place && *place < RHO_ECHO_PLACES) {
        const struct rho_echo *echo = &map->echoes[(*place)++];
        if (echo->hits >= RHO_ECHO_KNOWN_HITS) {
            return echo;
        }
    }
    return NULL;
}

int rho_clutter_map_is_echo_standing(const struct rho_echo *echo)
{
    return echo && !(echo->vx_mps * echo->vx_mps + echo->vy_mps * echo->vy_mps >
                     MOVES_SIGMAS2 * (echo->along[2] + echo->across[2]));
}

void rho_clutter_map_learned_looks_and_returns(const struct rho_clutter_map *map, unsigned region,
                                               unsigned hits, unsigned unseen, float *looks,
                                               float *returns)
{
    const unsigned c = rho_clutter_map_hit_class(hits), g = gap_class(unseen);
    float sum_looks = 0.0f, sum_returns = 0.0f;
    for (unsigned part = 0; map && region < RHO_ECHO_TABLES && part < 3; part++) {
        sum_looks += map->tables[part][region].looks[c][g];
        sum_returns += map->tables[part][region].returns[c][g];
    }
    /* tracks may have taken out more returns than were counted */
    sum_returns = sum_returns > 0.0f ? sum_returns : 0.0f;
    if (looks) {
        *looks = sum_looks;
    }
    if (returns) {
        *returns = sum_returns < sum_looks ? sum_returns : sum_looks;
    }
}

enum rho_status rho_clutter_map_teach_returns(struct rho_clutter_map *map, unsigned region,
                                              unsigned hits, unsigned unseen, float looks,
                                              float returns)
{
    const unsigned c = rho_clutter_map_hit_class(hits), g = gap_class(unseen);
    if (!map) {
        return RHO_ERROR_NULL;
    }
    if (region >= RHO_ECHO_TABLES || hits == 0 || unseen == 0 ||
        !rho_is_within(looks, 0.0f, ECHO_LOOKS_MAX) || !rho_is_within(returns, 0.0f, looks)) {
        return RHO_ERROR_VALUE;
    }
    map->tables[0][region].looks[c][g] = looks;
    map->tables[0][region].returns[c][g] = returns;
    return RHO_OK;
}

/* Puts the counts of all blocks into the first table, as a saved map has them. */
static void merge_blocks(struct rho_clutter_map *map)
{
    const unsigned num = RHO_ECHO_TABLES * (sizeof map->tables[0][0] / sizeof(float));
    float *sums = (float *)map->tables;
    for (unsigned i = 0; i < num; i++) {
        sums[i] += sums[num + i];
        sums[i] += sums[2u * num + i];
    }
    memset(map->tables[1], 0, 2u * sizeof map->tables[1]);
    for (unsigned region = 0; region < RHO_ECHO_TABLES; region++) {
        float *looks = map->tables[0][region].looks[0];
        float *returns = map->tables[0][region].returns[0];
        for (unsigned i = 0; i < RHO_ECHO_HIT_CLASSES * RHO_ECHO_GAP_CLASSES; i++) {
            returns[i] = rho_smaller(rho_larger(returns[i], 0.0f), looks[i]);
        }
    }
}

void rho_clutter_map_restart(struct rho_clutter_map *map)
{
    const float v_min_mps = map->v_min_mps;
    unsigned kept = 0;
    merge_blocks(map);
    for (unsigned i = 0; i < RHO_ECHO_PLACES; i++) {
        const struct rho_echo *echo = &map->echoes[i];
        if (echo->hits >= RHO_ECHO_KNOWN_HITS && rho_clutter_map_is_echo_standing(echo)) {
            teach_echo(&map->echoes[kept++], echo->sensor_id, echo->x_m, echo->y_m, echo->along[0],
                       echo->across[0], echo->hits);
        }
    }
    memset(&map->echoes[kept], 0, (RHO_ECHO_PLACES - kept) * sizeof map->echoes[0]);
    memset(map, 0, offsetof(struct rho_clutter_map, tables));
    rho_clutter_map_init(map, v_min_mps);
}

static int is_sound_axis_covariance(const float axis[3])
{
    return rho_are_finite(axis, 3) && axis[0] > 0.0f && axis[2] >= 0.0f;
}

int rho_clutter_map_is_sound(const struct rho_clutter_map *map)
{
    if (!rho_is_stored_time(map->time_us) || map->first_echo >= RHO_ECHO_PLACES ||
        !rho_is_within(map->v_min_mps, 0.0f, RHO_LIMIT_SPEED_MPS) ||
        !rho_is_within(map->rate_plots, 0.0f, ECHO_LOOKS_MAX) ||
        !rho_is_within(map->exact_plots, 0.0f, map->rate_plots) ||
        !rho_are_finite(&map->scans_to_blocks, 1)) {
        return 0;
    }
    for (unsigned block = 0; block < 3; block++) {
        for (unsigned region = 0; region < RHO_ECHO_TABLES; region++) {
            const struct rho_echo_returns *table = &map->tables[block][region];
            for (unsigned c = 0; c < RHO_ECHO_HIT_CLASSES * RHO_ECHO_GAP_CLASSES; c++) {
                const unsigned h = c / RHO_ECHO_GAP_CLASSES, g = c % RHO_ECHO_GAP_CLASSES;
                if (!rho_is_within(table->looks[h][g], 0.0f, ECHO_LOOKS_MAX) ||
                    !rho_is_within(table->returns[h][g], -ECHO_LOOKS_MAX, ECHO_LOOKS_MAX)) {
                    return 0;
                }
            }
        }
    }
    for (unsigned i = 0; i < RHO_ECHO_PLACES; i++) {
        const struct rho_echo *echo = &map->echoes[i];
        const float place[4] = {echo->x_m, echo->y_m, echo->vx_mps, echo->vy_mps};
        if (echo->hits > 0 &&
            (!rho_is_stored_time(echo->time_us) || !rho_are_finite(place, 4) ||
             !is_sound_axis_covariance(echo->along) || !is_sound_axis_covariance(echo->across) ||
             !rho_is_within(echo->weight, 0.0f, ECHO_LOOKS_MAX) || echo->plot >= RHO_MAX_PLOTS ||
             (echo->region >= RHO_ECHO_TABLES - 1 && echo->region != UINT8_MAX))) {
            return 0;
        }
    }
    return 1;
}
