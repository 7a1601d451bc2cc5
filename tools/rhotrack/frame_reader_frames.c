/* SPDX-License-Identifier: MIT */
/* Scans to frames. */
#include <stdlib.h>

#include "common.h"
#include "frame_reader_parts.h"

void frame_reader_place_bearings(struct frame_reader *reader)
{
    size_t start = 0;

    reader->bearings = must_alloc((reader->num_members + 1) * sizeof *reader->bearings);
    for (size_t i = 0; i < reader->num_entries; i++) {
        reader->entries[i].first_bearing = start;
        reader->entries[i].scan.bearings = reader->bearings + start;
        start += reader->entries[i].scan.num_bearings;
    }
    for (size_t i = 0; i < reader->num_members; i++) {
        const struct frame_member *member = &reader->members[i];
        struct frame_entry *entry = &reader->entries[member->entry];
        struct rho_bearing *bearing = &reader->bearings[entry->first_bearing++];

        *bearing = member->bearing;
        bearing->offset_us += (int32_t)(member->time_us - entry->scan.time_us);
    }
    free(reader->members);
    reader->members = NULL;
}

static int compare_entries(const void *a, const void *b)
{
    const struct frame_entry *first = a, *second = b;

    if (first->scan.time_us != second->scan.time_us) {
        return first->scan.time_us < second->scan.time_us ? -1 : 1;
    }
    return first->order < second->order ? -1 : 1;
}

static int compare_scans(const void *a, const void *b)
{
    const struct rho_bearing_scan *first = a, *second = b;

    return (first->sensor_id > second->sensor_id) - (first->sensor_id < second->sensor_id);
}

/* True where the scan is a further one of the frame that is open; it is not before it. */
static bool belongs(const struct frame_reader *reader, const struct rho_frame *frame,
                    const struct rho_bearing_scan *scan)
{
    if (scan->time_us - reader->tolerance_us > frame->time_us) {
        return false;
    }
    for (size_t i = 0; i < frame->num_scans; i++) {
        if (frame->scans[i].sensor_id == scan->sensor_id) {
            return false;
        }
    }
    return true;
}

/* A sensor's scan at the time of another one of its own, of another file: which of them was before cannot be told. */
static const struct frame_entry *find_twin(const struct frame_reader *reader, size_t index)
{
    const struct frame_entry *entry = &reader->entries[index];

    for (size_t i = index;
         i-- > 0 && entry[-1].scan.time_us == reader->entries[index].scan.time_us;) {
        entry--;
        if (entry->scan.sensor_id == reader->entries[index].scan.sensor_id) {
            return entry;
        }
    }
    return NULL;
}

/* Entries are in the order of time; twins of earlier ones are refused, or left out and counted. */
static void leave_out_twins(struct frame_reader *reader)
{
    size_t kept = 0;

    for (size_t i = 0; i < reader->num_entries; i++) {
        const struct frame_entry *entry = &reader->entries[i], *twin;

        reader->entries[kept] = *entry;
        twin = find_twin(reader, kept);
        if (!twin) {
            kept++;
            continue;
        }
        entry = &reader->entries[kept];
        if (!reader->keep_going) {
            fail(EXIT_USAGE, "%s:%u: sensor %d has another scan at %.6f s: line %u of %s",
                 entry->path, (unsigned)entry->line, (int)entry->scan.sensor_id,
                 (double)entry->scan.time_us * 1e-6, (unsigned)twin->line, twin->path);
        }
        reader->rows_skipped += entry->scan.num_bearings ? entry->scan.num_bearings : 1;
        reader->num_members -= entry->scan.num_bearings;
    }
    reader->num_entries = kept;
}

/* The scan goes behind those of the open frame, or into one of its own. */
static void add_to_frame(struct frame_reader *reader, size_t index)
{
    struct rho_bearing_scan *scan = &reader->scans[index];
    struct rho_frame *frame = &reader->frames[reader->num_frames];

    if (reader->num_frames > 0 && belongs(reader, frame - 1, scan)) {
        frame[-1].num_scans++;
        return;
    }
    *frame = (struct rho_frame){.time_us = scan->time_us, .num_scans = 1, .scans = scan};
    reader->num_frames++;
}

void frame_reader_make_frames(struct frame_reader *reader)
{
    qsort(reader->entries, reader->num_entries, sizeof *reader->entries, compare_entries);
    leave_out_twins(reader);
    reader->scans = must_alloc(reader->num_entries * sizeof *reader->scans);
    reader->frames = must_alloc(reader->num_entries * sizeof *reader->frames);
    for (size_t i = 0; i < reader->num_entries; i++) {
        reader->scans[i] = reader->entries[i].scan;
        add_to_frame(reader, i);
    }
    for (size_t i = 0, first = 0; i < reader->num_frames; i++) {
        size_t num_scans = reader->frames[i].num_scans;

        qsort(reader->scans + first, num_scans, sizeof *reader->scans, compare_scans);
        reader->frames_incomplete += num_scans < reader->num_sensors;
        first += num_scans;
    }
}
