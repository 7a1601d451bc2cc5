/* SPDX-License-Identifier: MIT */
/*
 * show_accumulators: messages of the accumulators of the last search. A search of plots has one; a
 * search of bearings has one for all pairs of sensors together, and one for each of several pairs.
 */
#include "message_clamps.h"
#include "rhotrack/detail/approx.h"
#include "show_writers.h"

#define PART_ROWS RHO_MESSAGE_PLANE_MAX_ROWS
#define CELLS_MAX RHO_MESSAGE_ACCUMULATOR_MAX_CELLS

/* An accumulator to be shown. */
struct shown_accumulator {
    int64_t oldest_us, newest_us; /* times of its oldest and newest scan */
    const struct rho_show_source *source;
    uint32_t votes_per_unit;              /* integer units of its cells that make one vote */
    struct rho_passive_paper_space space; /* of all its cells */
    uint16_t first_rho, num_rho;          /* cells of rho that are shown */
    uint16_t height, width;               /* of its picture */
    int16_t num_scans;
    struct rho_passive_paper_pair pair;
    int16_t sensor_a_id, sensor_b_id; /* of the pair; 0: no pair */
    int8_t method, has_pair;          /* as in the messages */
    uint8_t is_of_bearings;
};

static const struct rho_paper_starts *searched_paper_starts(const struct rho_show_source *source)
{
    return source->starts && source->starts->has_searched ? source->starts : NULL;
}

/* Number of accumulators of bearings; 0 where the step has not searched. */
static unsigned num_bearing_accumulators(const struct rho_show_source *source)
{
    struct rho_passive_paper_pair pair;
    const struct rho_passive_paper *paper = source->paper;
    unsigned pairs = 0;
    if (!paper || paper->batch.num_scans != paper->batch.scans_max || !paper->batch.is_due ||
        paper->batch.newest_us != source->report->time_us) {
        return 0;
    }
    while (rho_passive_paper_pair(paper, pairs, &pair)) {
        pairs++;
    }
    return pairs > 1 ? pairs + 1u : pairs;
}

static uint16_t limit_to_picture_side(uint16_t cells)
{
    return cells < RHO_SHOW_SIDE ? cells : RHO_SHOW_SIDE;
}

/* Number of messages: one accumulator_t, and with a picture the parts of its plane_t. */
static unsigned messages_of_accumulator(const struct rho_show *show,
                                        const struct shown_accumulator *accumulator)
{
    return 1u + (show->config.picture ? rho_num_parts(accumulator->height, PART_ROWS) : 0u);
}

static void select_accumulator(const struct rho_show_source *source, unsigned number,
                               struct shown_accumulator *accumulator)
{
    static const int8_t methods[] = {[RHO_HOUGH_HT] = RHO_MESSAGE_ACCUMULATOR_HT,
                                     [RHO_HOUGH_MHT] = RHO_MESSAGE_ACCUMULATOR_MHT,
                                     [RHO_HOUGH_IHT] = RHO_MESSAGE_ACCUMULATOR_IHT,
                                     [RHO_HOUGH_NHT_A] = RHO_MESSAGE_ACCUMULATOR_NHT,
                                     [RHO_HOUGH_NHT_C] = RHO_MESSAGE_ACCUMULATOR_NHT};
    const struct rho_passive_paper *paper = source->paper;
    *accumulator = (struct shown_accumulator){.source = source};
    if (searched_paper_starts(source)) {
        const struct rho_hough *hough = &source->starts->hough;
        struct rho_window *window = &source->starts->window;
        accumulator->num_scans = (int16_t)window->num_scans;
        accumulator->oldest_us = rho_window_scan_at(window, 0)->time_us;
        accumulator->newest_us = rho_window_scan_at(window, window->num_scans - 1u)->time_us;
        accumulator->method = methods[hough->config.method];
        accumulator->space = (struct rho_passive_paper_space){.rho_max_m = hough->config.rho_max_m,
                                                              .theta_cells = hough->theta_cells,
                                                              .rho_cells = hough->rho_cells};
        accumulator->votes_per_unit = RHO_HOUGH_VOTE;
    } else {
        (void)!rho_passive_paper_space(paper, &accumulator->space); /* searched: no error */
        accumulator->num_scans = (int16_t)paper->batch.num_scans;
        accumulator->oldest_us = paper->batch.time_us[0];
        accumulator->newest_us = paper->batch.time_us[paper->batch.num_scans - 1u];
        accumulator->is_of_bearings = 1;
        accumulator->method = RHO_MESSAGE_ACCUMULATOR_PASSIVE_PAPER;
        accumulator->votes_per_unit = 1;
        accumulator->has_pair =
            number > 0 && rho_passive_paper_pair(paper, number - 1u, &accumulator->pair);
    }
    accumulator->height = limit_to_picture_side(accumulator->space.theta_cells);
    accumulator->width = limit_to_picture_side(accumulator->space.rho_cells);
    accumulator->num_rho = accumulator->space.rho_cells;
    if (accumulator->has_pair) {
        const struct rho_batch_sensor *sensors = paper->batch.sensors;
        accumulator->sensor_a_id = rho_clamp_sensor_id(sensors[accumulator->pair.a].sensor_id);
        accumulator->sensor_b_id = rho_clamp_sensor_id(sensors[accumulator->pair.b].sensor_id);
    }
}

uint32_t rho_show_count_accumulators(const struct rho_show *show,
                                     const struct rho_show_source *source)
{
    const unsigned planes = searched_paper_starts(source) ? 1u : num_bearing_accumulators(source);
    if (planes == 0) {
        return 0;
    }
    struct shown_accumulator first;
    select_accumulator(source, 0, &first);
    return planes * messages_of_accumulator(show, &first);
}

/* Fills the picture from the window of cells that it shows. */
static enum rho_status fill_picture(const struct shown_accumulator *accumulator,
                                    struct rho_votes_picture *picture)
{
    const struct rho_show_source *source = accumulator->source;
    if (accumulator->is_of_bearings) {
        return rho_passive_paper_plane(source->paper,
                                       accumulator->has_pair ? &accumulator->pair : NULL, picture);
    }
    const struct rho_hough_points points = rho_paper_starts_points(source->starts);
    return rho_hough_plane(&source->starts->hough, &points, RHO_HOUGH_VOTES, picture);
}

/*
 * Narrows the window of a picture of all cells to those between the outer columns that have votes,
 * at least one cell a column. A short range would else fill few columns.
 */
static void narrow_window(struct rho_votes_picture *picture)
{
    const unsigned width = picture->width, cells = picture->rho_cells;
    unsigned first = width, end = 0;
    for (unsigned i = 0; i < picture->height * width; i++) {
        if (picture->votes[i] > 0) {
            first = i % width < first ? i % width : first;
            end = i % width < end ? end : i % width + 1u;
        }
    }
    if (end > 0) {
        unsigned from = (first * cells + width - 1u) / width;
        unsigned to = (end * cells + width - 1u) / width;
        to = to < from + width ? from + width : to;
        to = to < cells ? to : cells;
        from = to < from + width ? to - width : from;
        picture->first_rho = (uint16_t)from;
        picture->rho_cells = (uint16_t)(to - from);
    }
}

static void make_picture(struct rho_show *show, struct shown_accumulator *accumulator)
{
    struct rho_votes_picture picture = {
        .height = accumulator->height, .width = accumulator->width, .votes = show->config.picture};
    show->votes_max = 0;
    if (!picture.votes || fill_picture(accumulator, &picture) != RHO_OK) {
        return;
    }
    narrow_window(&picture);
    if (picture.rho_cells < accumulator->num_rho && fill_picture(accumulator, &picture) != RHO_OK) {
        return; /* cannot fail: the window is within the plane */
    }
    accumulator->first_rho = picture.first_rho;
    accumulator->num_rho = picture.rho_cells;
    for (unsigned i = 0; i < (unsigned)picture.height * picture.width; i++) {
        show->votes_max = picture.votes[i] > show->votes_max ? picture.votes[i] : show->votes_max;
    }
}

/* accumulator_t */

/* Votes of a number of integer units of the accumulator's cells. */
static float votes_from_units(const struct shown_accumulator *accumulator, uint32_t units)
{
    return (float)units / (float)accumulator->votes_per_unit;
}

static enum rho_status write_plots(const struct shown_accumulator *accumulator,
                                   struct rho_message_accumulator_head *head,
                                   struct rho_show_output *output)
{
    struct rho_paper_starts *starts = accumulator->source->starts;
    const struct rho_hough_config *config = &starts->hough.config;
    const float share = config->tau * votes_from_units(accumulator, starts->result.votes_max);
    head->votes_max = votes_from_units(accumulator, starts->result.votes_max);
    head->votes_min = share > config->votes_min ? share : config->votes_min;
    head->num_cells_total = rho_clamp_to_int16(starts->result.num_peaks);
    enum rho_status status =
        rho_message_accumulator_begin(&output->writer, output->buffer, output->capacity, head);
    for (uint32_t i = 0; i < starts->result.num_peaks && status == RHO_OK; i++) {
        const struct rho_hough_track *line = &starts->lines[i].line;
        const struct rho_message_accumulator_cell cell = {
            .rho_m = rho_hough_rho_m(&starts->hough, starts->peaks[i].rho_cell),
            .theta_rad = rho_hough_theta_rad(&starts->hough, starts->peaks[i].theta_cell),
            .votes = votes_from_units(accumulator, starts->peaks[i].votes),
            .scan_mask = line->mask,
            .plots = rho_clamp_to_int16(line->num_plots),
            .track_id = (int32_t)(starts->lines[i].track_id & INT32_MAX)};
        status = rho_message_accumulator_add(&output->writer, &cell);
    }
    return status;
}

/* Writes an accumulator of bearings. A pair's cells are found first: the head has their number. */
static enum rho_status write_bearings(const struct rho_show *show,
                                      const struct shown_accumulator *accumulator,
                                      struct rho_message_accumulator_head *head,
                                      struct rho_show_output *output)
{
    struct rho_passive_paper *paper = accumulator->source->paper;
    const struct rho_passive_paper_space space = accumulator->space;
    struct rho_accumulator_peak peaks[CELLS_MAX];
    uint32_t num_peaks = 0;
    enum rho_status status = RHO_OK;
    if (accumulator->has_pair) {
        status = rho_passive_paper_cells(paper, &accumulator->pair, peaks, CELLS_MAX, &num_peaks);
    }
    if (status != RHO_OK) {
        return status;
    }
    head->votes_max = !show->config.picture && paper->num_lines > 0 && !accumulator->has_pair
                          ? (float)paper->lines[0].votes_sum
                          : (float)show->votes_max;
    head->votes_min = (float)paper->votes_min;
    head->num_cells_total =
        rho_clamp_to_int16(accumulator->has_pair ? num_peaks : paper->num_lines);
    status = rho_message_accumulator_begin(&output->writer, output->buffer, output->capacity, head);
    for (uint32_t i = 0; i < num_peaks && status == RHO_OK; i++) {
        const float theta_rad = RHO_PI / (float)space.theta_cells;
        const struct rho_message_accumulator_cell cell = {
            .rho_m = ((float)peaks[i].rho_cell + 0.5f) * paper->config.rho_cell_m - space.rho_max_m,
            .theta_rad = ((float)peaks[i].theta_cell + 0.5f) * theta_rad,
            .votes = (float)peaks[i].votes,
            .scan_mask = (int32_t)peaks[i].mask};
        status = rho_message_accumulator_add(&output->writer, &cell);
    }
    /* the found lines, with rho from the accumulator's origin, not that of the local frame */
    for (unsigned i = 0; !accumulator->has_pair && i < paper->num_lines && status == RHO_OK; i++) {
        const struct rho_passive_paper_line *line = &paper->lines[i];
        const struct rho_message_accumulator_cell cell = {
            .rho_m = line->rho_m - rho_passive_paper_rho_m(0.0f, 0.0f, space.origin_x_m,
                                                           space.origin_y_m, line->theta_rad),
            .theta_rad = line->theta_rad,
            .votes = (float)line->votes_sum,
            .scan_mask = line->scans,
            .plots = rho_clamp_to_int16(line->crossings),
            .track_id = (int32_t)(line->track_id & INT32_MAX)};
        status = rho_message_accumulator_add(&output->writer, &cell);
    }
    return status;
}

static enum rho_status write_accumulator(const struct rho_show *show,
                                         const struct shown_accumulator *accumulator,
                                         struct rho_show_output *output)
{
    const struct rho_passive_paper_space *space = &accumulator->space;
    const float cell_m = 2.0f * space->rho_max_m / (float)space->rho_cells;
    const unsigned end_rho = (unsigned)accumulator->first_rho + accumulator->num_rho;
    struct rho_message_accumulator_head head = {
        .utime = accumulator->newest_us,
        .scan = accumulator->source->step,
        .epoch = accumulator->source->epoch,
        .method = accumulator->method,
        .has_pair = accumulator->has_pair,
        .sensor_a_id = accumulator->sensor_a_id,
        .sensor_b_id = accumulator->sensor_b_id,
        .num_scans = accumulator->num_scans,
        .oldest_utime = accumulator->oldest_us,
        .origin_x_m = space->origin_x_m,
        .origin_y_m = space->origin_y_m,
        .rho_min_m = (float)accumulator->first_rho * cell_m - space->rho_max_m,
        .rho_max_m = (float)end_rho * cell_m - space->rho_max_m,
        .theta_cells = rho_clamp_to_int16(space->theta_cells),
        .rho_cells = rho_clamp_to_int16(accumulator->num_rho),
        .not_sent = output->not_sent};
    output->channel = RHO_MESSAGE_ACCUMULATOR_CHANNEL;
    return accumulator->is_of_bearings ? write_bearings(show, accumulator, &head, output)
                                       : write_plots(accumulator, &head, output);
}

/* plane_t */

static enum rho_status write_picture_rows(const struct rho_show *show,
                                          const struct shown_accumulator *accumulator,
                                          unsigned part, struct rho_show_output *output)
{
    const unsigned height = accumulator->height, width = accumulator->width;
    const struct rho_message_plane_head head = {
        .utime = accumulator->newest_us,
        .scan = accumulator->source->step,
        .epoch = accumulator->source->epoch,
        .method = accumulator->method,
        .has_pair = accumulator->has_pair,
        .sensor_a_id = accumulator->sensor_a_id,
        .sensor_b_id = accumulator->sensor_b_id,
        .votes_max = votes_from_units(accumulator, show->votes_max),
        .part = (int16_t)part,
        .num_parts = (int16_t)rho_num_parts(height, PART_ROWS)};
    output->channel = RHO_MESSAGE_PLANE_CHANNEL;
    enum rho_status status =
        rho_message_plane_begin(&output->writer, output->buffer, output->capacity, &head);
    for (unsigned y = part * PART_ROWS;
         y < height && y < (part + 1u) * PART_ROWS && status == RHO_OK; y++) {
        struct rho_message_plane_row row;
        /* Scaled to 0 .. INT8_MAX; in a narrow picture each cell fills several columns. */
        for (unsigned x = 0; x < RHO_SHOW_SIDE; x++) {
            const uint64_t votes = show->config.picture[y * width + x * width / RHO_SHOW_SIDE];
            row.votes[x] =
                (int8_t)(show->votes_max > 0
                             ? (votes * INT8_MAX + show->votes_max - 1u) / show->votes_max
                             : 0);
        }
        status = rho_message_plane_add(&output->writer, &row);
    }
    return status;
}

enum rho_status rho_show_write_accumulator(struct rho_show *show,
                                           const struct rho_show_source *source, uint32_t number,
                                           struct rho_show_output *output)
{
    struct shown_accumulator accumulator;
    select_accumulator(source, 0, &accumulator);
    const unsigned messages = messages_of_accumulator(show, &accumulator);
    select_accumulator(source, number / messages, &accumulator);
    if (number % messages > 0) {
        return write_picture_rows(show, &accumulator, number % messages - 1u, output);
    }
    make_picture(show, &accumulator);
    return write_accumulator(show, &accumulator, output);
}
