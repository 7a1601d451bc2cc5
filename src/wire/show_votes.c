/* SPDX-License-Identifier: MIT */
/*
 * show_votes: the accumulators of the last search. Of plots there is one; of bearings that of all
 * pairs of sensors together, and where there are several pairs that of each.
 */
#include <string.h>

#include "rhotrack/detail/approx.h"
#include "show_parts.h"

#define PART_ROWS RHO_MESSAGE_PLANE_MAX_ROWS
#define CELLS_MAX RHO_MESSAGE_ACCUMULATOR_MAX_CELLS
#define FULL 127 /* of a row: the most votes */

/* One accumulator. */
struct plane {
    const struct rho_show_source *source;
    int is_of_bearings, has_pair;
    struct rho_passive_paper_pair pair;
    uint32_t votes_per_unit; /* parts of a vote */
};

static const struct rho_paper_starts *starts_of(const struct rho_show_source *source)
{
    return source->starts && source->starts->has_searched ? source->starts : NULL;
}

/* The step's frame is in the batch, which is full: it was searched. */
static int has_searched_bearings(const struct rho_show_source *source)
{
    struct rho_passive_paper_pair pair;
    const struct rho_passive_paper *paper = source->paper;
    return paper && paper->batch.num_scans == paper->batch.scans_max &&
           paper->batch.time_us[paper->batch.num_scans - 1u] == source->report->time_us &&
           rho_passive_paper_pair(paper, 0, &pair);
}

/* ---- which messages there are ---------------------------------------------------------------- */

static unsigned num_planes(const struct rho_show_source *source)
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

static unsigned at_most_side(unsigned cells)
{
    return cells < RHO_SHOW_SIDE ? cells : RHO_SHOW_SIDE;
}

static unsigned picture_height(const struct plane *plane)
{
    struct rho_passive_paper_space space = {.theta_cells = 1};
    if (!plane->is_of_bearings) {
        return at_most_side(plane->source->starts->hough.theta_cells);
    }
    (void)!rho_passive_paper_space(plane->source->paper, &space); /* it has searched */
    return at_most_side(space.theta_cells);
}

static unsigned picture_width(const struct plane *plane)
{
    return at_most_side(plane->is_of_bearings ? RHO_PAPER_RHO_CELLS
                                              : plane->source->starts->hough.rho_cells);
}

/* An accumulator_t, and the parts of its plane_t. */
static unsigned messages_of(const struct rho_show *show, const struct plane *plane)
{
    return 1u + (show->config.picture ? (picture_height(plane) + PART_ROWS - 1u) / PART_ROWS : 0u);
}

static struct plane plane_at(const struct rho_show_source *source, unsigned number)
{
    struct plane plane = {
        .source = source, .is_of_bearings = !starts_of(source), .votes_per_unit = RHO_HOUGH_VOTE};
    if (plane.is_of_bearings) {
        plane.votes_per_unit = 1;
        plane.has_pair =
            number > 0 && rho_passive_paper_pair(source->paper, number - 1u, &plane.pair);
    }
    return plane;
}

uint32_t rho_show_num_votes(const struct rho_show *show, const struct rho_show_source *source)
{
    const unsigned planes = starts_of(source) ? 1u : num_planes(source);
    if (planes == 0) {
        return 0;
    }
    const struct plane first = plane_at(source, 0);
    return planes * messages_of(show, &first);
}

/* ---- the picture ----------------------------------------------------------------------------- */

static enum rho_status draw_picture(const struct plane *plane, struct rho_plane *picture)
{
    if (!plane->is_of_bearings) {
        const struct rho_hough_points points = rho_paper_starts_points(plane->source->starts);
        return rho_hough_plane(&plane->source->starts->hough, &points, RHO_HOUGH_VOTES, picture);
    }
    return rho_passive_paper_plane(plane->source->paper, plane->has_pair ? &plane->pair : NULL,
                                   picture);
}

static void make_picture(struct rho_show *show, const struct plane *plane)
{
    struct rho_plane picture = {.height = (uint16_t)picture_height(plane),
                                .width = (uint16_t)picture_width(plane),
                                .votes = show->config.picture};
    show->votes_max = 0;
    if (!show->config.picture || draw_picture(plane, &picture) != RHO_OK) {
        return;
    }
    for (unsigned i = 0; i < (unsigned)picture.height * picture.width; i++) {
        show->votes_max = picture.votes[i] > show->votes_max ? picture.votes[i] : show->votes_max;
    }
}

/* ---- accumulator_t --------------------------------------------------------------------------- */

static int64_t newest_us(const struct plane *plane)
{
    const struct rho_show_source *source = plane->source;
    if (plane->is_of_bearings) {
        return source->paper->batch.time_us[source->paper->batch.num_scans - 1u];
    }
    struct rho_window *window = &source->starts->window;
    return rho_window_scan_at(window, window->num_scans - 1u)->time_us;
}

static float votes_of(const struct plane *plane, uint32_t parts)
{
    return (float)parts / (float)plane->votes_per_unit;
}

static int8_t method_of(const struct plane *plane)
{
    if (plane->is_of_bearings) {
        return RHO_MESSAGE_ACCUMULATOR_PASSIVE_PAPER;
    }
    switch (plane->source->starts->hough.config.method) {
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

static void set_plots_space(const struct plane *plane, struct rho_message_accumulator_head *head)
{
    struct rho_paper_starts *starts = plane->source->starts;
    const struct rho_hough_config *config = &starts->hough.config;
    const float share = config->tau * votes_of(plane, starts->result.votes_max);
    head->num_scans = (int16_t)starts->window.num_scans;
    head->oldest_utime = rho_window_scan_at(&starts->window, 0)->time_us;
    head->rho_min_m = -config->rho_max_m;
    head->rho_max_m = config->rho_max_m;
    head->theta_cells = rho_show_short(starts->hough.theta_cells);
    head->rho_cells = rho_show_short(starts->hough.rho_cells);
    head->votes_max = votes_of(plane, starts->result.votes_max);
    head->votes_min = share > config->votes_min ? share : config->votes_min;
    head->num_cells_total = rho_show_short(starts->result.num_peaks);
}

static void set_bearings_space(const struct plane *plane, const struct rho_show *show,
                               const struct rho_passive_paper_space *space,
                               struct rho_message_accumulator_head *head)
{
    const struct rho_passive_paper *paper = plane->source->paper;
    head->num_scans = (int16_t)paper->batch.num_scans;
    head->oldest_utime = paper->batch.time_us[0];
    head->origin_x_m = space->origin_x_m;
    head->origin_y_m = space->origin_y_m;
    head->rho_min_m = -space->rho_max_m;
    head->rho_max_m = space->rho_max_m;
    head->theta_cells = rho_show_short(space->theta_cells);
    head->rho_cells = rho_show_short(space->rho_cells);
    head->votes_max = (float)show->votes_max;
    head->votes_min = (float)paper->votes_min;
    head->num_cells_total = rho_show_short(paper->num_lines);
    if (!show->config.picture && paper->num_lines > 0 && !plane->has_pair) {
        head->votes_max = (float)paper->lines[0].votes_sum;
    }
}

static enum rho_status add_peaks(const struct plane *plane, struct rho_message_writer *writer)
{
    const struct rho_paper_starts *starts = plane->source->starts;
    enum rho_status status = RHO_OK;
    for (uint32_t i = 0; i < starts->result.num_peaks && status == RHO_OK; i++) {
        const struct rho_hough_track *line = &starts->lines[i].line;
        const struct rho_message_accumulator_cell cell = {
            .rho_m = rho_hough_rho_m(&starts->hough, starts->peaks[i].rho_cell),
            .theta_rad = rho_hough_theta_rad(&starts->hough, starts->peaks[i].theta_cell),
            .votes = votes_of(plane, starts->peaks[i].votes),
            .scan_mask = line->mask,
            .plots = rho_show_short(line->num_plots),
            .track_id = (int32_t)(starts->lines[i].track_id & INT32_MAX)};
        status = rho_message_accumulator_add(writer, &cell);
    }
    return status;
}

/* rho of a line is from the origin of the local frame; here it is from that of the cells. */
static enum rho_status add_lines(const struct plane *plane,
                                 const struct rho_passive_paper_space *space,
                                 struct rho_message_writer *writer)
{
    const struct rho_passive_paper *paper = plane->source->paper;
    enum rho_status status = RHO_OK;
    for (unsigned i = 0; i < paper->num_lines && status == RHO_OK; i++) {
        const struct rho_passive_paper_line *line = &paper->lines[i];
        const struct rho_message_accumulator_cell cell = {
            .rho_m = line->rho_m - rho_passive_paper_rho_m(0.0f, 0.0f, space->origin_x_m,
                                                           space->origin_y_m, line->theta_rad),
            .theta_rad = line->theta_rad,
            .votes = (float)line->votes_sum,
            .scan_mask = line->scans,
            .plots = rho_show_short(line->crossings),
            .track_id = (int32_t)(line->track_id & INT32_MAX)};
        status = rho_message_accumulator_add(writer, &cell);
    }
    return status;
}

static enum rho_status add_cells(const struct plane *plane,
                                 const struct rho_passive_paper_space *space,
                                 const struct rho_accumulator_peak *peaks, uint32_t num_peaks,
                                 struct rho_message_writer *writer)
{
    const float theta_rad = RHO_PI / (float)space->theta_cells;
    const float rho_m = plane->source->paper->config.rho_cell_m;
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

/* Cells of a pair are found first: their number is in the head. */
static enum rho_status write_bearings(const struct rho_show *show, const struct plane *plane,
                                      struct rho_message_accumulator_head *head,
                                      const struct rho_show_output *output,
                                      struct rho_message_writer *writer)
{
    struct rho_accumulator_peak peaks[CELLS_MAX];
    struct rho_passive_paper_space space;
    uint32_t num_peaks = 0;
    enum rho_status status = rho_passive_paper_space(plane->source->paper, &space);
    if (status == RHO_OK && plane->has_pair) {
        status = rho_passive_paper_cells(plane->source->paper, &plane->pair, peaks, CELLS_MAX,
                                         &num_peaks);
    }
    if (status != RHO_OK) {
        return status;
    }
    set_bearings_space(plane, show, &space, head);
    if (plane->has_pair) {
        head->num_cells_total = rho_show_short(num_peaks);
    }
    status = rho_message_accumulator_begin(writer, output->buffer, output->capacity, head);
    if (status != RHO_OK) {
        return status;
    }
    return plane->has_pair ? add_cells(plane, &space, peaks, num_peaks, writer)
                           : add_lines(plane, &space, writer);
}

static const char *write_accumulator(const struct rho_show *show, const struct plane *plane,
                                     const struct rho_show_output *output)
{
    const struct rho_show_source *source = plane->source;
    struct rho_message_writer writer;
    struct rho_message_accumulator_head head = {.utime = newest_us(plane),
                                                .scan = source->step,
                                                .epoch = source->epoch,
                                                .method = method_of(plane),
                                                .has_pair = (int8_t)plane->has_pair,
                                                .not_sent = output->not_sent};
    enum rho_status status;
    if (plane->has_pair) {
        const struct rho_batch_sensor *sensors = source->paper->batch.sensors;
        head.sensor_a_id = rho_show_id(sensors[plane->pair.a].sensor_id);
        head.sensor_b_id = rho_show_id(sensors[plane->pair.b].sensor_id);
    }
    if (plane->is_of_bearings) {
        status = write_bearings(show, plane, &head, output, &writer);
    } else {
        set_plots_space(plane, &head);
        status = rho_message_accumulator_begin(&writer, output->buffer, output->capacity, &head);
        if (status == RHO_OK) {
            status = add_peaks(plane, &writer);
        }
    }
    return status == RHO_OK && rho_message_end(&writer, output->size) == RHO_OK
               ? RHO_MESSAGE_ACCUMULATOR_CHANNEL
               : NULL;
}

/* ---- plane_t --------------------------------------------------------------------------------- */

/* A plane with fewer cells than a row has places: a cell fills several. */
static struct rho_message_plane_row row_of(const struct rho_show *show, unsigned y, unsigned width)
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

static const char *write_rows(const struct rho_show *show, const struct plane *plane, unsigned part,
                              const struct rho_show_output *output)
{
    const struct rho_show_source *source = plane->source;
    const unsigned height = picture_height(plane), width = picture_width(plane);
    struct rho_message_writer writer;
    struct rho_message_plane_head head = {.utime = newest_us(plane),
                                          .scan = source->step,
                                          .epoch = source->epoch,
                                          .method = method_of(plane),
                                          .has_pair = (int8_t)plane->has_pair,
                                          .votes_max = votes_of(plane, show->votes_max),
                                          .part = (int16_t)part,
                                          .num_parts =
                                              (int16_t)((height + PART_ROWS - 1u) / PART_ROWS)};
    if (plane->has_pair) {
        const struct rho_batch_sensor *sensors = source->paper->batch.sensors;
        head.sensor_a_id = rho_show_id(sensors[plane->pair.a].sensor_id);
        head.sensor_b_id = rho_show_id(sensors[plane->pair.b].sensor_id);
    }
    enum rho_status status =
        rho_message_plane_begin(&writer, output->buffer, output->capacity, &head);
    for (unsigned y = part * PART_ROWS;
         y < height && y < (part + 1u) * PART_ROWS && status == RHO_OK; y++) {
        const struct rho_message_plane_row row = row_of(show, y, width);
        status = rho_message_plane_add(&writer, &row);
    }
    return status == RHO_OK && rho_message_end(&writer, output->size) == RHO_OK
               ? RHO_MESSAGE_PLANE_CHANNEL
               : NULL;
}

const char *rho_show_write_votes(struct rho_show *show, const struct rho_show_source *source,
                                 uint32_t number, const struct rho_show_output *output)
{
    const struct plane first = plane_at(source, 0);
    const unsigned messages = messages_of(show, &first);
    const struct plane plane = plane_at(source, number / messages);
    if (number % messages > 0) {
        return write_rows(show, &plane, number % messages - 1u, output);
    }
    make_picture(show, &plane);
    return write_accumulator(show, &plane, output);
}
