/* SPDX-License-Identifier: MIT */
#include "evaluation/alignment.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"

int64_t alignment_tolerance_us(const struct parameters *parameters)
{
    int64_t tolerance_us = llround(parameters->value[PARAMETER_TIME_TOLERANCE_S] * 1e6);

    return tolerance_us > ALIGNMENT_LEAST_US ? tolerance_us : ALIGNMENT_LEAST_US;
}

static int64_t time_at(struct alignment_times times, size_t index)
{
    int64_t time_us;

    memcpy(&time_us, (const char *)times.first_us + index * times.stride, sizeof time_us);
    return time_us;
}

/*
 * Index of the first entry whose time is nearest to time_us; entries before `from` are not
 * searched.
 */
static size_t find_nearest_time(struct alignment_times times, size_t from, int64_t time_us)
{
    size_t at = from;

    for (size_t i = from; i < times.count; i++) {
        if (llabs(time_at(times, i) - time_us) < llabs(time_at(times, at) - time_us)) {
            at = i;
        }
        if (time_at(times, i) > time_us) {
            break;
        }
    }
    return at;
}

size_t alignment_find_unmatched(struct alignment_times tracks, struct alignment_times truth,
                                int64_t most_us)
{
    size_t at = 0;

    for (size_t i = 0; i < tracks.count && truth.count > 0; i++) {
        at = find_nearest_time(truth, at, time_at(tracks, i));
        if (llabs(time_at(truth, at) - time_at(tracks, i)) > most_us) {
            return i;
        }
    }
    return tracks.count;
}

void alignment_fail_unmatched(const struct table *tracks, size_t row, int64_t most_us)
{
    table_fail_at_row(tracks, row,
                      "the truth has no time within %g ms of this row (time_tolerance_s)",
                      (double)most_us * 1e-3);
}

struct alignment alignment_list_rows(struct alignment_times tracks, struct alignment_times truth,
                                     int64_t most_us)
{
    struct alignment alignment = {.count = 0};
    size_t capacity = 0, from = 0;

    for (size_t i = 0; i < truth.count && tracks.count > 0; i++) {
        int64_t time_us = time_at(truth, i), at_us;

        if (i > 0 && time_us == time_at(truth, i - 1)) {
            continue;
        }
        from = find_nearest_time(tracks, from, time_us);
        at_us = time_at(tracks, from);
        for (size_t k = from;
             k < tracks.count && time_at(tracks, k) == at_us && llabs(at_us - time_us) <= most_us;
             k++) {
            alignment.list = must_make_room_for_one(alignment.list, alignment.count, &capacity,
                                                    sizeof *alignment.list);
            alignment.list[alignment.count++] = (struct aligned_row){.row = k, .to_us = time_us};
        }
    }
    return alignment;
}
