/* SPDX-License-Identifier: MIT */
#include "io/output/initiated_output.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "io/asterix/asterix_track_writer.h"
#include "io/log/lcm_log.h"
#include "io/output/geojson_tracks_writer.h"
#include "io/output/tracks_output.h"
#include "pipeline/pipeline.h"
#include "rhotrack/message.h"

struct initiated_output {
    struct output output;
    const char *path;
    bool is_log;
    struct lcm_log_writer log;
    struct rho_message_peak_list list; /* peaks that are not written yet */
};

struct initiated_output *initiated_output_open(const char *path)
{
    struct initiated_output *found = must_calloc(1, sizeof *found);

    if (geojson_path_is_geojson(path)) {
        fail(EXIT_USAGE, "%s: initiate writes CSV files and LCM logs; GeoJSON is made of tracks",
             path);
    }
    if (asterix_track_writer_is_path(path)) {
        fail(EXIT_USAGE, "%s: initiate writes CSV files and LCM logs; CAT062 is made of tracks",
             path);
    }
    output_refuse_other_format(path, "NAME.csv and NAME.lcm");
    found->path = path;
    found->is_log = tracks_output_path_is_log(path);
    found->output = output_open(path);
    found->log = (struct lcm_log_writer){.file = found->output.file};
    found->list.scan = 1;
    if (!found->is_log) {
        initiated_write_header(found->output.file);
    }
    return found;
}

static void write_peak_list(struct initiated_output *found)
{
    uint8_t buffer[RHO_MESSAGE_PEAK_LIST_MAX_SIZE];
    size_t size;

    must_succeed(rho_message_peak_list_encode(&found->list, buffer, sizeof buffer, &size), "peaks");
    lcm_log_must_write(&found->log, found->path, found->list.utime, RHO_MESSAGE_PEAK_LIST_CHANNEL,
                       buffer, size);
    found->list.num_peaks = 0;
}

void initiated_output_add_row(struct initiated_output *found, const struct initiated *row)
{
    if (!found->is_log) {
        initiated_write_row(found->output.file, row);
        return;
    }
    if (found->list.num_peaks == RHO_MESSAGE_PEAK_LIST_MAX_PEAKS) {
        write_peak_list(found);
    }
    found->list.utime = row->time_us;
    found->list.peaks[found->list.num_peaks++] = (struct rho_message_peak){
        .rho_m = row->rho_m,
        .theta_rad = row->theta_rad,
        .speed_mps = row->has_state ? hypotf(row->vx_mps, row->vy_mps) : 0.0f,
        .score_nat = (float)row->score,
        .scans_hit = (int16_t)row->scans,
        .sensor_pairs = (int16_t)row->sensor_pairs};
}

void initiated_output_close(struct initiated_output *found)
{
    if (found->is_log) {
        write_peak_list(found); /* an empty list, too, tells that no track was found */
    }
    output_close(&found->output);
    free(found);
}
