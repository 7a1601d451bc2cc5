/* SPDX-License-Identifier: MIT */
/*
 * rows: the rows of a CSV file, or of LCM messages, of one kind: plots, polar plots, bearings,
 * truth or tracks.
 *
 * Rows come from a file (rows_read.h) or from messages (rows_from_messages.h), and go to a file
 * (rows_write.h) or, scan by scan, to messages (rows_scans.h). Cells are doubles, which hold
 * float32 and int32 as they are; a cell that is empty is NaN. What is 0 in a message because it was
 * not said is empty here.
 */
#ifndef RHOTRACK_TOOL_ROWS_H
#define RHOTRACK_TOOL_ROWS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "rhotrack/message.h"

enum rows_column_flag {
    COLUMN_NEEDED = 1 << 0,      /* the header has it */
    COLUMN_FILLED = 1 << 1,      /* no cell is empty */
    COLUMN_MEASURED = 1 << 2,    /* a row without any of these is a scan that saw nothing */
    COLUMN_OF_SCAN = 1 << 3,     /* the same in all rows of a scan */
    COLUMN_OF_PLOTS = 1 << 4,    /* the same, but for a row that saw nothing */
    COLUMN_INT16 = 1 << 5,       /* whole numbers */
    COLUMN_INT32 = 1 << 6,       /* the same */
    COLUMN_STATUS = 1 << 7,      /* a word: RHO_MESSAGE_TRACK_TENTATIVE and so on */
    COLUMN_NO_ROOM = 1 << 8,     /* messages do not have it */
    COLUMN_ALWAYS = 1 << 9,      /* written; all others where a cell is not empty */
    COLUMN_NOT_ZERO = 1 << 10,   /* where a cell is neither empty nor 0 */
    COLUMN_COVARIANCE = 1 << 11, /* where asked for */
    COLUMN_ANGLE = 1 << 12       /* of any turn */
};

struct rows_column {
    const char *name;
    unsigned flags;                       /* enum rows_column_flag */
    int group;                            /* not 0: written where another one of the group is */
    const char *degrees;                  /* the column that may stand for it */
    double (*from_degrees)(double value); /* what that one says */
};

struct row {
    int64_t time_us;     /* its own */
    int64_t received_us; /* where that is known */
    int32_t sensor_id, epoch, scan;
    int32_t turn;   /* of a sensor whose rows are gathered into turns; else 0 */
    uint32_t line;  /* of the file; 0 of a message */
    uint64_t order; /* among rows of one time */
    size_t cells;   /* where they begin */
};

struct rows {
    const struct rows_kind *kind;
    bool
        /* it is known when rows were received; they are in that order, else in that of time */
        has_received;
    struct row *list;
    double *cells;
    size_t count, capacity, num_cells, cells_capacity;
};

/* Rows of one sensor's look, or of one list: what messages are made of. */
struct rows_scan {
    int64_t utime;
    int64_t due_us;      /* its messages': when its last row was received, else utime */
    struct row head;     /* its first row, whose sector and place are the scan's */
    size_t first, count; /* in rows.list, those that saw something */
    size_t order;        /* among scans that are due at one time */
    int16_t num_parts;
};

struct rows_part {
    const struct rows *rows;
    const struct rows_scan *scan;
    size_t first, count; /* in rows.list */
    int16_t part;
};

/*
 * A message that became rows: one for the scan itself (its place, its sector), and one for each
 * element of the list.
 */
struct rows_message {
    struct row key;      /* sensor_id, epoch, scan; time_us is its utime */
    int64_t received_us; /* else its utime */
    int16_t part, num_parts;
    size_t first, count; /* of the elements' rows; the scan's own is before them */
    uint64_t arrival;
};

struct rows_kind {
    const char *name;    /* "plots" */
    const char *channel; /* of has_sensor what stands before the number */
    enum rho_message_type type;
    bool has_sensor; /* scans of sensors, else lists */
    bool has_epoch;
    bool has_one_time; /* no row has a time of its own */
    bool has_received; /* files may say when rows were received */
    size_t rows_max;   /* in one scan; 0: as many as fit 32767 parts */
    const struct rows_column *columns;
    int num_columns;

    /* Why a row cannot be, or NULL. No function: all can. */
    const char *(*why_not)(const double *cells);

    /* The quantities that a row measures, equal in all of a scan. No function: always equal. */
    int (*pattern)(const double *cells);

    /* How many of the scan's rows from this one on go into one message: at least one. */
    size_t (*fit)(const struct rows_part *rest);

    /* A part as a message. Returns its size, or 0 and the name of the field that cannot be so. */
    size_t (*encode)(const struct rows_part *part, uint8_t *buffer, const char **field);

    /* A message as rows. Errors as the codec's; VALUE names the field. */
    enum rho_status (*decode)(const uint8_t *data, size_t size, struct rows *rows,
                              struct rows_message *message, const char **field);
};

#define ROWS_MESSAGE_BYTES 1472
#define ROWS_MAX_COLUMNS 48

enum { ROWS_PLOTS = 0, ROWS_POLAR, ROWS_BEARINGS, ROWS_TRUTH, ROWS_TRACKS, NUM_ROWS_KINDS };
extern const struct rows_kind *const rows_kinds[NUM_ROWS_KINDS];
extern const struct rows_kind rows_kind_plots, rows_kind_polar, rows_kind_bearings, rows_kind_truth,
    rows_kind_tracks;

/* The kind whose messages have this channel, or NULL. */
const struct rows_kind *rows_kind_of_channel(const char *channel);

/* "confirmed" and so on of RHO_MESSAGE_TRACK_CONFIRMED ..., which are 1 .. ROWS_STATUS_MAX. */
#define ROWS_STATUS_MAX RHO_MESSAGE_TRACK_DELETED
const char *rows_status_name(int status);

/* The index of a column that the kind has. */
int rows_find_column(const struct rows_kind *kind, const char *name);

/* How two numbers are ordered, for qsort. */
int rows_compare_numbers(int64_t one, int64_t other);

void rows_start(struct rows *rows, const struct rows_kind *kind);
void rows_free(struct rows *rows);

/* Adds a row with empty cells and returns these, valid until the next row. */
double *rows_add(struct rows *rows, const struct row *row);
double *rows_cells(const struct rows *rows, const struct row *row);

/* The row has a plot, a bearing, a target or a track. */
bool rows_saw_something(const struct rows *rows, const struct row *row);

/* ---- For the kinds ---- */

/* Nothing is said by an empty cell, and by a 0 that means so. */
bool rows_is_cell_empty(double cell);
float rows_float_or_zero(double cell);     /* 0 where empty */
double rows_cell_unless_zero(float value); /* empty where +0 */
bool rows_is_plus_zero(float value);       /* +0, no other */

/* Adds the row of an element, at its own time, or of the message itself. */
double *rows_add_message_row(struct rows *rows, const struct rows_message *message, int32_t dt_us);

/* By how much a plot's own time is after its scan's. */
int32_t rows_plot_offset_us(const struct rows_part *part, size_t index);

/* The cells of the part's row by its place in the part. */
const double *rows_part_cells(const struct rows_part *part, size_t index);

/* The cells that stand for the scan: those of its first row. */
const double *rows_first_row_cells(const struct rows_part *part);

#endif
