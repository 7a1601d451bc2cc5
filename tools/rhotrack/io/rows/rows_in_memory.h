/* SPDX-License-Identifier: MIT */
/*
 * rows_in_memory: the rows of one kind (plots, polar plots, bearings, truth or tracks) of a CSV
 * file or of LCM messages.
 *
 * Rows come from a file (rows_from_csv.h) or from messages (rows_from_messages.h), and go to a file
 * (rows_to_csv.h) or, scan by scan, to messages (rows_to_messages.h). Cells are doubles, which hold
 * float32 and int32 exactly; an empty cell is NaN. A value that is 0 in a message since it was not
 * given is an empty cell.
 */
#ifndef RHOTRACK_TOOL_ROWS_IN_MEMORY_H
#define RHOTRACK_TOOL_ROWS_IN_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "io/csv/columns.h"
#include "rhotrack/message.h"

enum rows_column_flag {
    COLUMN_NEEDED = 1 << 0,      /* the header must have the column */
    COLUMN_FILLED = 1 << 1,      /* no cell may be empty */
    COLUMN_MEASURED = 1 << 2,    /* a row without any such cell is a scan without detections */
    COLUMN_OF_SCAN = 1 << 3,     /* equal in all rows of a scan */
    COLUMN_OF_PLOTS = 1 << 4,    /* equal in all rows of a scan that have a measurement */
    COLUMN_INT16 = 1 << 5,       /* whole numbers of int16 */
    COLUMN_INT32 = 1 << 6,       /* whole numbers of int32 */
    COLUMN_STATUS = 1 << 7,      /* a word for RHO_MESSAGE_TRACK_TENTATIVE and so on */
    COLUMN_NO_ROOM = 1 << 8,     /* messages cannot hold the column */
    COLUMN_ALWAYS = 1 << 9,      /* always written; other columns where a cell is not empty */
    COLUMN_NOT_ZERO = 1 << 10,   /* written where a cell is neither empty nor 0 */
    COLUMN_COVARIANCE = 1 << 11, /* written where covariances are requested */
    COLUMN_ANGLE = 1 << 12,      /* an angle, wrapped to half a turn either side */
    COLUMN_WIDER = 1 << 13,      /* only messages of the wider kind hold the column */
    COLUMN_STAYS = 1 << 14       /* messages that are not wide have it equal in a sensor's scans */
};

struct rows_column {
    enum column_id id;
    unsigned flags; /* enum rows_column_flag values, or-ed */
    int group;      /* columns of one group, not 0, are written together */
};

struct row {
    int64_t time_us;     /* the row's own time */
    int64_t received_us; /* reception time, where known */
    int32_t sensor_id, epoch, scan;
    int32_t turn;   /* number of the antenna's turn, where rows are gathered into turns; else 0 */
    uint32_t line;  /* line in the file; 0: from a message */
    uint64_t order; /* rank among rows of one time */
    size_t cells;   /* index of its first cell in rows.cells */
};

struct rows {
    const struct rows_kind *kind;
    /* reception times are known, and rows are in that order; else in the order of time */
    bool has_received;
    struct row *list;
    double *cells;
    size_t count, capacity, num_cells, cells_capacity;
};

/* Rows of one scan of a sensor, or of one list of targets or tracks: they become messages. */
struct rows_scan {
    int64_t utime;
    int64_t due_us;      /* time of its messages: reception of its last row, else utime */
    struct row head;     /* its first row, whose sector and sensor position are the scan's */
    size_t first, count; /* its rows with a measurement, in rows.list */
    size_t order;        /* rank among scans that are due at one time */
    int16_t num_parts;
};

struct rows_part {
    const struct rows *rows;
    const struct rows_scan *scan;
    size_t first, count; /* the part's rows, in rows.list */
    int16_t part;
};

/*
 * A message that was converted to rows: one for the scan itself (its position, its sector), and one
 * for each element of its list.
 */
struct rows_message {
    struct row key;      /* sensor_id, epoch, scan; time_us is the message's utime */
    int64_t received_us; /* reception time, or utime where not known */
    int16_t part, num_parts;
    size_t first, count; /* rows of the elements; the row of the scan itself is before them */
    uint64_t arrival;
};

struct rows_kind {
    const char *name;    /* "plots" */
    const char *channel; /* channel's name; with has_sensor the part before the sensor's number */
    enum rho_message_type type;
    bool has_sensor; /* scans of a sensor; else lists */
    bool has_epoch;
    bool has_one_time; /* rows have no times of their own */
    bool has_received; /* files may have reception times of rows */
    size_t rows_max;   /* largest number of rows in one scan; 0: as many as fit 32767 parts */
    const struct rows_column *columns;
    int num_columns;

    /*
     * Why the cells of a row are invalid together, or NULL. NULL function: they always are valid.
     */
    const char *(*why_not)(const double *cells);

    /*
     * The quantities that a row measures, which must be equal in a scan. NULL function: always
     * equal.
     */
    int (*pattern)(const double *cells);

    size_t part_max; /* largest number of rows in one message */

    /* Whether one message can hold both rows. NULL function: always. */
    bool (*fit)(const double *cells, const double *others);

    /*
     * Encodes a part as a message. Returns its size, or 0 and the name of the field that is out of
     * range.
     */
    size_t (*encode)(const struct rows_part *part, uint8_t *buffer, const char **field);

    /*
     * Decodes a message and adds its rows. Errors as the codec's; *field is set for
     * RHO_ERROR_VALUE.
     */
    enum rho_status (*decode)(const uint8_t *data, size_t size, struct rows *rows,
                              struct rows_message *message, const char **field);

    /* The same rows as messages with room for COLUMN_WIDER and rows' own times; NULL: none. */
    const struct rows_kind *wider;
};

#define ROWS_MESSAGE_BYTES 1472
#define ROWS_MAX_COLUMNS 48

enum { ROWS_PLOTS = 0, ROWS_POLAR, ROWS_BEARINGS, ROWS_TRUTH, ROWS_TRACKS, NUM_ROWS_KINDS };
extern const struct rows_kind *const rows_kinds[NUM_ROWS_KINDS];
extern const struct rows_kind rows_kind_plots, rows_kind_polar, rows_kind_bearings, rows_kind_truth,
    rows_kind_tracks;

/* The kind whose messages, or those of its wider kind, use this channel, or NULL. */
const struct rows_kind *rows_kind_of_channel(const char *channel);

/* Whether a channel is one of this very kind. */
bool rows_kind_has_channel(const struct rows_kind *kind, const char *channel);

/*
 * Name of a track's status, "confirmed" and so on; RHO_MESSAGE_TRACK_... are 1 .. ROWS_STATUS_MAX.
 */
#define ROWS_STATUS_MAX RHO_MESSAGE_TRACK_DELETED
const char *rows_track_status_name(int status);

/* Index of a column, which the kind must have. */
int rows_column_index(const struct rows_kind *kind, enum column_id id);

/* Order of two numbers as qsort wants it: negative, 0 or positive. */
int rows_compare_int64(int64_t one, int64_t other);

void rows_init(struct rows *rows, const struct rows_kind *kind);
void rows_free(struct rows *rows);

/* Adds a row with empty cells, and returns the cells, valid until the next row is added. */
double *rows_add_row(struct rows *rows, const struct row *row);
double *rows_cells(const struct rows *rows, const struct row *row);

/* Whether the row has a plot, a bearing, a target or a track. */
bool rows_row_has_measurement(const struct rows *rows, const struct row *row);

/* Whether files are written with a column because of this cell. */
bool rows_is_cell_written(const struct rows_column *column, double cell);

/* The kind of message that holds the row: rows.kind, or the wider one. */
const struct rows_kind *rows_kind_of_row(const struct rows *rows, const struct row *row);

/* For the kinds. */

/* Conversions between cells and message values: an empty cell and +0 both mean not given. */
bool rows_is_cell_empty(double cell);
float rows_float_or_zero(double cell);       /* 0 for an empty cell */
double rows_zero_to_empty_cell(float value); /* empty for +0 */
bool rows_is_plus_zero(float value);         /* +0, not -0 */

/* Sets the two cells of a sector, unless it is not given. */
void rows_put_sector(double cells[2], float from_rad, float to_rad);

/*
 * Begins the rows of a message that has `count` elements: sets its key and its part, and adds the
 * row of the scan itself, whose cells it returns.
 */
double *rows_begin_message(struct rows *rows, struct rows_message *message, const struct row *key,
                           int16_t part, int16_t num_parts, int count);

/* The key of a message of a sensor's scan. */
#define ROWS_SENSOR_KEY(message)                                                                   \
    (struct row)                                                                                   \
    {                                                                                              \
        .time_us = (message).utime, .sensor_id = (message).sensor_id, .epoch = (message).epoch,    \
        .scan = (message).scan                                                                     \
    }

/* The fields that begin a message of a part of a sensor's scan: the reverse of ROWS_SENSOR_KEY. */
#define ROWS_SENSOR_FIELDS(part)                                                                   \
    .utime = (part)->scan->utime, .scan = (part)->scan->head.scan,                                 \
    .epoch = (part)->scan->head.epoch, .sensor_id = (int16_t)(part)->scan->head.sensor_id

/* Adds the row of an element, dt_us after the message's utime. */
double *rows_add_message_row(struct rows *rows, const struct rows_message *message, int32_t dt_us);

/*
 * Defines how a kind checks and encodes its message, as rows_kind.encode says, and decodes and
 * checks it, as rows_kind.decode says.
 */
#define ROWS_CHECKED_CODEC(type)                                                                   \
    static size_t encode_checked_##type(const struct rho_message_##type *message, uint8_t *buffer, \
                                        const char **field)                                        \
    {                                                                                              \
        struct rho_message_place place;                                                            \
        size_t size = 0;                                                                           \
                                                                                                   \
        if (rho_message_##type##_validate(message, &place) != RHO_OK) {                            \
            *field = rho_message_##type##_field(&place);                                           \
            return 0;                                                                              \
        }                                                                                          \
        return rho_message_##type##_encode(message, buffer, ROWS_MESSAGE_BYTES, &size) == RHO_OK   \
                   ? size                                                                          \
                   : 0;                                                                            \
    }                                                                                              \
                                                                                                   \
    static enum rho_status decode_checked_##type(                                                  \
        const uint8_t *data, size_t size, struct rho_message_##type *message, const char **field)  \
    {                                                                                              \
        struct rho_message_place place;                                                            \
        enum rho_status status = rho_message_##type##_decode(data, size, message);                 \
                                                                                                   \
        if (status == RHO_OK) {                                                                    \
            status = rho_message_##type##_validate(message, &place);                               \
            *field = status == RHO_OK ? *field : rho_message_##type##_field(&place);               \
        }                                                                                          \
        return status;                                                                             \
    }

/* Time of a part's plot after the time of its scan. */
int32_t rows_plot_offset_us(const struct rows_part *part, size_t index);

/* Cells of a part's row, by its index in the part. */
const double *rows_part_cells(const struct rows_part *part, size_t index);

/* Cells of the scan's first row, which hold what all rows share. */
const double *rows_scan_first_row_cells(const struct rows_part *part);

#endif
