/* SPDX-License-Identifier: MIT */
/*
 * show_accumulators: messages of the accumulators of the last search. A search of plots has one; a
 * search of bearings has one for all pairs of sensors together, and one for each of several pairs.
 */
#include <string.h>

#include "message_clamps.h"
#include "rhotrack/detail/approx.h"
#include "show_writers.h"

#define PART_ROWS RHO_MESSAGE_PLANE_MAX_ROWS
#define CELLS_MAX RHO_MESSAGE_ACCUMULATOR_MAX_CELLS
#define FULL 127 /* value of a picture's cell with the most votes */

/* An accumulator to be shown. */
struct shown_accumulator {
    const struct rho_show_source *source;
    int is_of_bearings, has_pair;
    struct rho_passive_paper_pair pair;
    uint32_t votes_per_unit; /* integer units of the accumulator's cells that make one vote */
};

static const struct rho_paper_starts *searched_paper_starts(const struct rho_show_source *source)
{
    return source->starts && source->starts->has_searched ? source->starts : NULL;
}

/* 1 where the step's frame is in a full batch, and bearings were searched. */
static int has_searched_bearings(const struct rho_show_source *source)
{
    struct rho_passive_paper_pair pair;
    const struct rho_passive_paper *paper = source->paper;
    return paper && paper->batch.num_scans == paper->batch.scans_max &&
           paper->batch.time_us[paper->batch.num_scans - 1u] == source->report->time_us &&
           rho_passive_paper_pair(paper, 0, &pair);
}

/* ---- which messages there are ---------------------------------------------------------------- */

static unsigned num_bearing_accumulators(const struct rho_show_source *source)
{
    struct rho_passive_paper_pair pair;
    unsigned pairs = 0;
    if (!has_searched_bearings(source)) {
        return 0;
    }
    while (rho_passive_paper_pair(source->paper, pairs, &pair)) {
        pairs++;
    }
    return pairs > 1 ? pairs + 1u : 1u;
}

static unsigned limit_to_picture_side(unsigned cells)
{
    return cells < RHO_SHOW_SIDE ? cells : RHO_SHOW_SIDE;
}

static unsigned picture_height(const struct shown_accumulator *accumulator)
{
    struct rho_passive_paper_space space = {.theta_cells = 1};
    if (!accumulator->is_of_bearings) {
        return limit_to_picture_side(accumulator->source->starts->hough.theta_cells);
    }
    (void)!rho_passive_paper_space(accumulator->source->paper,
                                   &space); /* cannot fail after a search */
    return limit_to_picture_side(space.theta_cells);
}

static unsigned picture_width(const struct shown_accumulator *accumulator)
{
    return limit_to_picture_side(accumulator->is_of_bearings
                                     ? RHO_PAPER_RHO_CELLS
                                     : accumulator->source->starts->hough.rho_cells);
}

/* Number of messages: one accumulator_t, and with a picture the parts of its plane_t. */
static unsigned num_messages_of_accumulator(const struct rho_show *show,
                                            const struct shown_accumulator *accumulator)
{
    return 1u +
           (show->config.picture ? (picture_height(accumulator) + PART_ROWS - 1u) / PART_ROWS : 0u);
}

static struct shown_accumulator select_accumulator(const struct rho_show_source *source,
                                                   unsigned number)
{
    struct shown_accumulator accumulator = {.source = source,
                                            .is_of_bearings = !searched_paper_starts(source),
                                            .votes_per_unit = RHO_HOUGH_VOTE};
    if (accumulator.is_of_bearings) {
        accumulator.votes_per_unit = 1;
        accumulator.has_pair =
            number > 0 && rho_passive_paper_pair(source->paper, number - 1u, &accumulator.pair);
    }
    return accumulator;
}

uint32_t rho_show_count_accumulator_messages(const struct rho_show *show,
                                             const struct rho_show_source *source)
{
    const unsigned planes = searched_paper_starts(source) ? 1u : num_bearing_accumulators(source);
    if (planes == 0) {
        return 0;
    }
    const struct shown_accumulator first = select_accumulator(source, 0);
    return planes * num_messages_of_accumulator(show, &first);
}

/* ---- the picture ----------------------------------------------------------------------------- */

static enum rho_status fill_picture(const struct shown_accumulator *accumulator,
                                    struct rho_votes_picture *picture)
{
    if (!accumulator->is_of_bearings) {
        const struct rho_hough_points points = rho_paper_starts_points(accumulator->source->starts);
        return rho_hough_plane(&accumulator->source->starts->hough, &points, RHO_HOUGH_VOTES,
                               picture);
    }
    return rho_passive_paper_plane(accumulator->source->paper,
                                   accumulator->has_pair ? &accumulator->pair : NULL, picture);
}

static void make_picture_and_votes_max(struct rho_show *show,
                                       const struct shown_accumulator *accumulator)
{
    struct rho_votes_picture picture = {.height = (uint16_t)picture_height(accumulator),
                                        .width = (uint16_t)picture_width(accumulator),
                                        .votes = show->config.picture};
    show->votes_max = 0;
    if (!show->config.picture || fill_picture(accumulator, &picture) != RHO_OK) {
        return;
    }
    for (unsigned i = 0; i < (unsigned)picture.height * picture.width; i++) {
        show->votes_max = picture.votes[i] > show->votes_max ? picture.votes[i] : show->votes_max;
    }
}

/* ---- accumulator_t --------------------------------------------------------------------------- */

static int64_t newest_scan_us(const struct shown_accumulator *accumulator)
{
    const struct rho_show_source *source = accumulator->source;
    if (accumulator->is_of_bearings) {
        return source->paper->batch.time_us[source->paper->batch.num_scans - 1u];
    }
    struct rho_window *window = &source->starts->window;
    return rho_window_scan_at(window, window->num_scans - 1u)->time_us;
}

/* Votes of a number of integer units of the accumulator's cells. */
static float votes_from_units(const struct shown_accumulator *accumulator, uint32_t units)
{
    return (float)units / (float)accumulator->votes_per_unit;
}

static int8_t message_method_of(const struct shown_accumulator *accumulator)
{
    if (accumulator->is_of_bearings) {
        return RHO_MESSAGE_ACCUMULATOR_PASSIVE_PAPER;
    }
    switch (accumulator->source->starts->hough.config.method) {
    case RHO_HOUGH_HT:
        return RHO_MESSAGE_ACCUMULATOR_HT;
    case RHO_HOUGH_MHT:
        return RHO_MESSAGE_ACCUMULATOR_MHT;
    case RHO_HOUGH_IHT:
        return RHO_MESSAGE_ACCUMULATOR_IHT;
    case RHO_HOUGH_NHT_A:
    case RHO_HOUGH_NHT_C:
    default:
        return RHO_MESSAGE_ACCUMULATOR_NHT;
    }
}

static void set_head_of_plots(const struct shown_accumulator *accumulator,
                              struct rho_message_accumulator_head *head)
{
    struct rho_paper_starts *starts = accumulator->source->starts;
    const struct rho_hough_config *config = &starts->hough.config;
    const float share = config->tau * votes_from_units(accumulator, starts->result.votes_max);
    head->num_scans = (int16_t)starts->window.num_scans;
    head->oldest_utime = rho_window_scan_at(&starts->window, 0)->time_us;
    head->rho_min_m = -config->rho_max_m;
    head->rho_max_m = config->rho_max_m;
    head->theta_cells = rho_clamp_to_int16(starts->hough.theta_cells);
    head->rho_cells = rho_clamp_to_int16(starts->hough.rho_cells);
    head->votes_max = votes_from_units(accumulator, starts->result.votes_max);
    head->votes_min = share > config->votes_min ? share : config->votes_min;
    head->num_cells_total = rho_clamp_to_int16(starts->result.num_peaks);
}

static void set_head_of_bearings(const struct shown_accumulator *accumulator,
                                 const struct rho_show *show,
                                 const struct rho_passive_paper_space *space,
                                 struct rho_message_accumulator_head *head)
{
    const struct rho_passive_paper *paper = accumulator->source->paper;
    head->num_scans = (int16_t)paper->batch.num_scans;
    head->oldest_utime = paper->batch.time_us[0];
    head->origin_x_m = space->origin_x_m;
    head->origin_y_m = space->origin_y_m;
    head->rho_min_m = -space->rho_max_m;
    head->rho_max_m = space->rho_max_m;
    head->theta_cells = rho_clamp_to_int16(space->theta_cells);
    head->rho_cells = rho_clamp_to_int16(space->rho_cells);
    head->votes_max = (float)show->votes_max;
    head->votes_min = (float)paper->votes_min;
    head->num_cells_total = rho_clamp_to_int16(paper->num_lines);
    if (!show->config.picture && paper->num_lines > 0 && !accumulator->has_pair) {
        head->votes_max = (float)paper->lines[0].votes_sum;
    }
}

static enum rho_status add_peaks_of_plots(const struct shown_accumulator *accumulator,
                                          struct rho_message_writer *writer)
{
    const struct rho_paper_starts *starts = accumulator->source->starts;
    enum rho_status status = RHO_OK;
    for (uint32_t i = 0; i < starts->result.num_peaks && status == RHO_OK; i++) {
        const struct rho_hough_track *line = &starts->lines[i].line;
        const struct rho_message_accumulator_cell cell = {
            .rho_m = rho_hough_rho_m(&starts->hough, starts->peaks[i].rho_cell),
            .theta_rad = rho_hough_theta_rad(&starts->hough, starts->peaks[i].theta_cell),
            .votes = votes_from_units(accumulator, starts->peaks[i].votes),
            .scan_mask = line->mask,
            .plots = rho_clamp_to_int16(line->num_plots),
            .track_id = (int32_t)(starts->lines[i].track_id & INT32_MAX)};
        status = rho_message_accumulator_add(writer, &cell);
    }
    return status;
}

/* Adds the found lines, with rho from the accumulator's origin, not that of the local frame. */
static enum rho_status add_found_lines_as_cells(const struct shown_accumulator *accumulator,
                                                const struct rho_passive_paper_space *space,
                                                struct rho_message_writer *writer)
{
    const struct rho_passive_paper *paper = accumulator->source->paper;
    enum rho_status status = RHO_OK;
    for (unsigned i = 0; i < paper->num_lines && status == RHO_OK; i++) {
        const struct rho_passive_paper_line *line = &paper->lines[i];
        const struct rho_message_accumulator_cell cell = {
            .rho_m = line->rho_m - rho_passive_paper_rho_m(0.0f, 0.0f, space->origin_x_m,
                                                           space->origin_y_m, line->theta_rad),
            .theta_rad = line->theta_rad,
            .votes = (float)line->votes_sum,
            .scan_mask = line->scans,
            .plots = rho_clamp_to_int16(line->crossings),
            .track_id = (int32_t)(line->track_id & INT32_MAX)};
        status = rho_message_accumulator_add(writer, &cell);
    }
    return status;
}

static enum rho_status add_cells_of_pair(const struct shown_accumulator *accumulator,
                                         const struct rho_passive_paper_space *space,
                                         const struct rho_accumulator_peak *peaks,
                                         uint32_t num_peaks, struct rho_message_writer *writer)
{
    const float theta_rad = RHO_PI / (float)space->theta_cells;
    const float rho_m = accumulator->source->paper->config.rho_cell_m;
    enum rho_status status = RHO_OK;
    for (uint32_t i = 0; i < num_peaks && status == RHO_OK; i++) {
        const struct rho_message_accumulator_cell cell = {
            .rho_m = ((float)peaks[i].rho_cell + 0.5f) * rho_m - space->rho_max_m,
            .theta_rad = ((float)peaks[i].theta_cell + 0.5f) * theta_rad,
            .votes = (float)peaks[i].votes,
            .scan_mask = (int32_t)peaks[i].mask};
        status = rho_message_accumulator_add(writer, &cell);
    }
    return status;
}

/* Writes an accumulator of bearings. A pair's cells are found first: the head has their number. */
static enum rho_status write_accumulator_message_of_bearings(
    const struct rho_show *show, const struct shown_accumulator *accumulator,
    struct rho_message_accumulator_head *head, const struct rho_show_output *output,
    struct rho_message_writer *writer)
{
    struct rho_accumulator_peak peaks[CELLS_MAX];
    struct rho_passive_paper_space space;
    uint32_t num_peaks = 0;
    enum rho_status status = rho_passive_paper_space(accumulator->source->paper, &space);
    if (status == RHO_OK && accumulator->has_pair) {
        status = rho_passive_paper_cells(accumulator->source->paper, &accumulator->pair, peaks,
                                         CELLS_MAX, &num_peaks);
    }
    if (status != RHO_OK) {
        return status;
    }
    set_head_of_bearings(accumulator, show, &space, head);
    if (accumulator->has_pair) {
        head->num_cells_total = rho_clamp_to_int16(num_peaks);
    }
    status = rho_message_accumulator_begin(writer, output->buffer, output->capacity, head);
    if (status != RHO_OK) {
        return status;
    }
    return accumulator->has_pair ? add_cells_of_pair(accumulator, &space, peaks, num_peaks, writer)
                                 : add_found_lines_as_cells(accumulator, &space, writer);
}

static const char *
write_accumulator_message_and_give_channel(const struct rho_show *show,
                                           const struct shown_accumulator *accumulator,
                                           const struct rho_show_output *output)
{
    const struct rho_show_source *source = accumulator->source;
    struct rho_message_writer writer;
    struct rho_message_accumulator_head head = {.utime = newest_scan_us(accumulator),
                                                .scan = source->step,
                                                .epoch = source->epoch,
                                                .method = message_method_of(accumulator),
                                                .has_pair = (int8_t)accumulator->has_pair,
                                                .not_sent = output->not_sent};
    enum rho_status status;
    if (accumulator->has_pair) {
        const struct rho_batch_sensor *sensors = source->paper->batch.sensors;
        head.sensor_a_id = rho_int16_sensor_id_or_minus_1(sensors[accumulator->pair.a].sensor_id);
        head.sensor_b_id = rho_int16_sensor_id_or_minus_1(sensors[accumulator->pair.b].sensor_id);
    }
    if (accumulator->is_of_bearings) {
        status = write_accumulator_message_of_bearings(show, accumulator, &head, output, &writer);
    } else {
        set_head_of_plots(accumulator, &head);
        status = rho_message_accumulator_begin(&writer, output->buffer, output->capacity, &head);
        if (status == RHO_OK) {
            status = add_peaks_of_plots(accumulator, &writer);
        }
    }
    return status == RHO_OK && rho_message_end(&writer, output->size) == RHO_OK
               ? RHO_MESSAGE_ACCUMULATOR_CHANNEL
               : NULL;
}

/* ---- plane_t --------------------------------------------------------------------------------- */

/* Scales a row of the picture to 0 .. 127; in a narrow one each cell fills several columns. */
static struct rho_message_plane_row picture_row_message(const struct rho_show *show, unsigned y,
                                                        unsigned width)
{
    struct rho_message_plane_row row;
    for (unsigned x = 0; x < RHO_SHOW_SIDE; x++) {
        const uint64_t votes = show->config.picture[y * width + x * width / RHO_SHOW_SIDE];
        row.votes[x] =
            (int8_t)(show->votes_max > 0 ? (votes * FULL + show->votes_max - 1u) / show->votes_max
                                         : 0);
    }
    return row;
}

static const char *write_picture_rows(const struct rho_show *show,
                                      const struct shown_accumulator *accumulator, unsigned part,
                                      const struct rho_show_output *output)
{
    const struct rho_show_source *source = accumulator->source;
    const unsigned height = picture_height(accumulator), width = picture_width(accumulator);
    struct rho_message_writer writer;
    struct rho_message_plane_head head = {
        .utime = newest_scan_us(accumulator),
        .scan = source->step,
        .epoch = source->epoch,
        .method = message_method_of(accumulator),
        .has_pair = (int8_t)accumulator->has_pair,
        .votes_max = votes_from_units(accumulator, show->votes_max),
        .part = (int16_t)part,
        .num_parts = (int16_t)((height + PART_ROWS - 1u) / PART_ROWS)};
    if (accumulator->has_pair) {
        const struct rho_batch_sensor *sensors = source->paper->batch.sensors;
        head.sensor_a_id = rho_int16_sensor_id_or_minus_1(sensors[accumulator->pair.a].sensor_id);
        head.sensor_b_id = rho_int16_sensor_id_or_minus_1(sensors[accumulator->pair.b].sensor_id);
    }
    enum rho_status status =
        rho_message_plane_begin(&writer, output->buffer, output->capacity, &head);
    for (unsigned y = part * PART_ROWS;
         y < height && y < (part + 1u) * PART_ROWS && status == RHO_OK; y++) {
        const struct rho_message_plane_row row = picture_row_message(show, y, width);
        status = rho_message_plane_add(&writer, &row);
    }
    return status == RHO_OK && rho_message_end(&writer, output->size) == RHO_OK
               ? RHO_MESSAGE_PLANE_CHANNEL
               : NULL;
}

const char *rho_show_write_accumulator_or_picture(struct rho_show *show,
                                                  const struct rho_show_source *source,
                                                  uint32_t number,
                                                  const struct rho_show_output *output)
{
    const struct shown_accumulator first = select_accumulator(source, 0);
    const unsigned messages = num_messages_of_accumulator(show, &first);
    const struct shown_accumulator accumulator = select_accumulator(source, number / messages);
    if (number % messages > 0) {
        return write_picture_rows(show, &accumulator, number % messages - 1u, output);
    }
    make_picture_and_votes_max(show, &accumulator);
    return write_accumulator_message_and_give_channel(show, &accumulator, output);
}
