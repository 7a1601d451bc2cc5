/* SPDX-License-Identifier: MIT */
#include "io/csv/frame_gaps.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

struct frame_gap frame_gaps_before_row(struct frame_gaps *gaps, const struct columns *columns,
                                       int32_t sensor_id, int64_t time_us)
{
    const int *at = columns->at;
    struct frame_gap gap = {.rate_hz = columns->table->frame_rate_hz, .first = gaps->frame + 1};
    int64_t frame, missing;

    if (!table_is_frame_number(columns->table, at[COL_T_S]) || at[COL_SCAN] >= 0 ||
        at[COL_RECEIVED_S] >= 0) {
        return gap;
    }
    frame = llround((double)time_us * 1e-6 * gap.rate_hz);
    if (gaps->has_last && frame < gaps->frame) {
        return gap;
    }
    missing =
        gaps->has_last && gaps->sensor_id == sensor_id && frame > gap.first ? frame - gap.first : 0;
    gap.count = (int)(missing < FRAME_GAP_MAX ? missing : FRAME_GAP_MAX);
    gaps->looks += (uint64_t)gap.count;
    gaps->beyond += (uint64_t)(missing - gap.count);
    *gaps = (struct frame_gaps){true, sensor_id, frame, gaps->looks, gaps->beyond};
    return gap;
}

int64_t frame_gap_time_us(const struct frame_gap *gap, int index)
{
    return llround((double)(gap->first + index) * 1e6 / gap->rate_hz);
}

void frame_gaps_report(const struct frame_gaps *gaps, const char *path)
{
    if (gaps->looks == 0) {
        return;
    }
    fprintf(stderr,
            "rhotrack: %s: %" PRIu64 " frame%s without good rows count%s as looks without plots",
            path, gaps->looks, gaps->looks == 1 ? "" : "s", gaps->looks == 1 ? "s" : "");
    if (gaps->beyond > 0) {
        fprintf(stderr, ", %" PRIu64 " not, being past the first %d of a gap", gaps->beyond,
                FRAME_GAP_MAX);
    }
    fputc('\n', stderr);
}
