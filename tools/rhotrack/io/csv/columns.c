/* SPDX-License-Identifier: MIT */
#include "io/csv/columns.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/common.h"
#include "base/name_hint.h"

#define TURN 6.283185307179586
#define DEG_RAD 0.017453292519943295
#define RAD_DEG (180 / 3.14159265358979323846)

#define COLUMN_TEXT(id, name) name,
static const char *const column_names[NUM_COLUMN_IDS] = {
    COLUMNS_NAMED(COLUMN_TEXT) COLUMNS_WITH_OTHER_NAMES(COLUMN_TEXT) COLUMNS_OF_TRACKS(COLUMN_TEXT)
        COLUMNS_OF_CLUTTER_MAP(COLUMN_TEXT)};

enum { NUM_NAMED = sizeof((const char *const[]){COLUMNS_NAMED(COLUMN_TEXT)}) / sizeof(char *) };

const char *column_name(enum column_id column)
{
    return column_names[column];
}

/* Name of a column in degrees that may replace the one in radians, or NULL. */
static const char *name_in_degrees(enum column_id column)
{
    return column == COL_AZIMUTH_RAD || column == COL_BEARING_RAD ? "azimuth_deg"
           : column == COL_ELEVATION_RAD                          ? "elevation_deg"
                                                                  : NULL;
}

/* Which columns a table has. */

struct columns columns_find(const struct table *table)
{
    struct columns columns = {.table = table};

    for (int i = 0; i < NUM_COLUMN_IDS; i++) {
        columns.at[i] = table_find_column(table, column_names[i]);
        if (columns.at[i] < 0 && i != COL_BEARING_RAD && name_in_degrees((enum column_id)i)) {
            columns.at[i] = table_find_column(table, name_in_degrees((enum column_id)i));
        }
    }
    if (columns.at[COL_T_S] < 0 && table->frame_rate_hz > 0) {
        columns.at[COL_T_S] = columns.at[COL_FRAME];
    }
    if (columns.at[COL_RANGE_M] >= 0 && columns.at[COL_AZIMUTH_RAD] < 0) {
        columns.at[COL_AZIMUTH_RAD] = columns.at[COL_BEARING_RAD];
        columns.at[COL_BEARING_RAD] = -1;
    }
    if (columns.at[COL_BEARING_RAD] < 0 && columns.at[COL_ELEVATION_RAD] >= 0 &&
        columns.at[COL_RANGE_M] < 0 && columns.at[COL_X_M] < 0 && columns.at[COL_LAT_DEG] < 0) {
        columns.at[COL_BEARING_RAD] = columns.at[COL_AZIMUTH_RAD];
    }
    return columns;
}

void columns_need_both(const struct columns *columns, enum column_id first, enum column_id second)
{
    bool has_first = columns->at[first] >= 0, has_second = columns->at[second] >= 0;

    if (has_first != has_second) {
        table_fail_at_row(columns->table, TABLE_HEADER, "no column '%s' beside '%s'",
                          column_names[has_first ? second : first],
                          column_names[has_first ? first : second]);
    }
}

static _Noreturn void fail_since_both(const struct columns *columns, const char *first,
                                      const char *second)
{
    table_fail_at_row(columns->table, TABLE_HEADER, "columns '%s' and '%s' exclude each other",
                      first, second);
}

void columns_refuse_both(const struct columns *columns, enum column_id first, enum column_id second)
{
    const int one = columns->at[first], other = columns->at[second];

    if (one >= 0 && other >= 0) {
        fail_since_both(columns, columns->table->names[one], columns->table->names[other]);
    }
}

void columns_refuse_two_units(const struct columns *columns, enum column_id angle)
{
    const char *degrees = name_in_degrees(angle);

    if (degrees && columns->at[angle] >= 0 && !columns_has_degrees(columns, angle) &&
        table_find_column(columns->table, degrees) >= 0) {
        fail_since_both(columns, column_names[angle], degrees);
    }
}

bool columns_has_degrees(const struct columns *columns, enum column_id angle)
{
    return columns->at[angle] >= 0 && name_in_degrees(angle) &&
           strcmp(columns->table->names[columns->at[angle]], name_in_degrees(angle)) == 0;
}

double column_radians(enum column_id angle, double degrees)
{
    return angle == COL_AZIMUTH_RAD || angle == COL_BEARING_RAD
               ? remainder(TURN / 4 - degrees * (TURN / 360), TURN)
               : degrees * DEG_RAD;
}

void columns_fold_over_zenith(double *elevation_rad, double *azimuth_rad)
{
    const double quarter = (double)1.5707964f; /* the float nearest to it, as files may have it */

    if (*elevation_rad > quarter) {
        *elevation_rad = TURN / 2 - *elevation_rad;
        *azimuth_rad = remainder(*azimuth_rad + TURN / 2, TURN);
    }
}

/* Other names and units. */

/*
 * Kinds of quantities, for their units. COMPASS: clockwise from north. SIZE: an angle without a
 * direction, such as a sigma.
 */
enum dimension { NUMBER, TIME, LENGTH, SPEED, DEGREES, RADIANS, COMPASS, COMPASS_TO_EAST, SIZE };

static const struct {
    const char *unit;
    enum dimension dimension;
    double factor, offset;
} units[] = {
    {"", NUMBER, 1, 0},
    {"db", NUMBER, 1, 0},
    {"", TIME, 1, 0},
    {"s", TIME, 1, 0},
    {"sec", TIME, 1, 0},
    {"utc", TIME, 1, 0},
    {"ms", TIME, 1e-3, 0},
    {"us", TIME, 1e-6, 0},
    {"", LENGTH, 1, 0},
    {"m", LENGTH, 1, 0},
    {"km", LENGTH, 1000, 0},
    {"nmi", LENGTH, 1852, 0},
    {"nm", LENGTH, 1852, 0},
    {"ft", LENGTH, 0.3048, 0},
    {"", SPEED, 1, 0},
    {"mps", SPEED, 1, 0},
    {"m_s", SPEED, 1, 0},
    {"kmh", SPEED, 1 / 3.6, 0},
    {"km_h", SPEED, 1 / 3.6, 0},
    {"kn", SPEED, 1852.0 / 3600, 0},
    {"kt", SPEED, 1852.0 / 3600, 0},
    {"deg", DEGREES, 1, 0},
    {"rad", RADIANS, 1, 0},
    {"rad", COMPASS, RAD_DEG, 0},
    {"deg", COMPASS_TO_EAST, -1 / RAD_DEG, 90 / RAD_DEG},
    {"rad", SIZE, 1, 0},
    {"deg", SIZE, 1 / RAD_DEG, 0},
};

/*
 * Words that files use for a column, with the kind of units that may follow; an angle without a
 * unit is not accepted.
 */
static const struct {
    const char *word;
    enum column_id column;
    enum dimension dimension;
} words[] = {
    {"t", COL_T_S, TIME},
    {"time", COL_T_S, TIME},
    {"timestamp", COL_T_S, TIME},
    {"datetime", COL_T_S, TIME},
    {"frame", COL_FRAME, NUMBER},
    {"frame_number", COL_FRAME, NUMBER},
    {"framenumber", COL_FRAME, NUMBER},
    {"frame_id", COL_FRAME, NUMBER},
    {"sensor_id", COL_SENSOR_ID, NUMBER},
    {"sensor", COL_SENSOR_ID, NUMBER},
    {"radar", COL_SENSOR_ID, NUMBER},
    {"radar_id", COL_SENSOR_ID, NUMBER},
    {"station", COL_SENSOR_ID, NUMBER},
    {"station_id", COL_SENSOR_ID, NUMBER},
    {"x", COL_X_M, LENGTH},
    {"y", COL_Y_M, LENGTH},
    {"z", COL_Z_M, LENGTH},
    {"vx", COL_VX_MPS, SPEED},
    {"vy", COL_VY_MPS, SPEED},
    {"vz", COL_VZ_MPS, SPEED},
    {"range", COL_RANGE_M, LENGTH},
    {"distance", COL_RANGE_M, LENGTH},
    {"rho", COL_RANGE_M, LENGTH},
    {"azimuth", COL_AZIMUTH_RAD, DEGREES},
    {"az", COL_AZIMUTH_RAD, DEGREES},
    {"theta", COL_AZIMUTH_RAD, DEGREES},
    {"azimuth_compass", COL_AZIMUTH_RAD, COMPASS},
    {"azimuth_clockwise", COL_AZIMUTH_RAD, COMPASS},
    {"azimuth", COL_AZIMUTH_RAD, RADIANS},
    {"az", COL_AZIMUTH_RAD, RADIANS},
    {"elevation", COL_ELEVATION_RAD, DEGREES},
    {"el", COL_ELEVATION_RAD, DEGREES},
    {"elevation", COL_ELEVATION_RAD, RADIANS},
    {"el", COL_ELEVATION_RAD, RADIANS},
    {"range_rate", COL_RANGE_RATE_MPS, SPEED},
    {"doppler", COL_RANGE_RATE_MPS, SPEED},
    {"lat", COL_LAT_DEG, NUMBER},
    {"latitude", COL_LAT_DEG, NUMBER},
    {"lat", COL_LAT_DEG, DEGREES},
    {"latitude", COL_LAT_DEG, DEGREES},
    {"lon", COL_LON_DEG, NUMBER},
    {"lng", COL_LON_DEG, NUMBER},
    {"longitude", COL_LON_DEG, NUMBER},
    {"lon", COL_LON_DEG, DEGREES},
    {"longitude", COL_LON_DEG, DEGREES},
    {"alt", COL_ALT_M, LENGTH},
    {"altitude", COL_ALT_M, LENGTH},
    {"snr", COL_SNR_DB, NUMBER},
    {"bearing", COL_BEARING_RAD, RADIANS},
    {"bearing", COL_BEARING_RAD, COMPASS_TO_EAST},
    {"sensor_x", COL_SENSOR_X_M, LENGTH},
    {"sensor_y", COL_SENSOR_Y_M, LENGTH},
    {"sensor_lat", COL_SENSOR_LAT_DEG, NUMBER},
    {"sensor_lon", COL_SENSOR_LON_DEG, NUMBER},
    {"station_lat", COL_SENSOR_LAT_DEG, NUMBER},
    {"station_lon", COL_SENSOR_LON_DEG, NUMBER},
    {"station_lat", COL_SENSOR_LAT_DEG, DEGREES},
    {"station_lon", COL_SENSOR_LON_DEG, DEGREES},
    {"sigma", COL_SIGMA_RAD, SIZE},
    {"sigma_azimuth", COL_SIGMA_AZIMUTH_RAD, SIZE},
};

#define NAME_BYTES 40

/*
 * Normalises a column name: "Range [km]" to range_km, a degree sign to deg. Returns false where the
 * name is too long, or empty.
 */
static bool normalise_column_name(const char *name, char plain[NAME_BYTES])
{
    size_t used = 0;

    for (const char *c = name; *c; c++) {
        if (used + 5 > NAME_BYTES) {
            return false;
        }
        if (strncmp(c, "\xC2\xB0", 2) == 0) {
            memcpy(plain + used, "deg", 3);
            used += 3;
            c++;
        } else if (isalnum((unsigned char)*c)) {
            plain[used++] = (char)tolower((unsigned char)*c);
        } else if (used > 0 && plain[used - 1] != '_') {
            plain[used++] = '_';
        }
    }
    used -= used > 0 && plain[used - 1] == '_';
    plain[used] = '\0';
    return used > 0;
}

struct unit {
    double factor, offset; /* factor 0: no known unit */
};

/* Finds the unit that follows a word in a column name. */
static struct unit find_unit(const char *rest, enum dimension dimension)
{
    rest += *rest == '_';
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        if (units[i].dimension == dimension && strcmp(units[i].unit, rest) == 0) {
            return (struct unit){units[i].factor, units[i].offset};
        }
    }
    return (struct unit){0, 0};
}

static bool is_unit_known(struct unit unit)
{
    return unit.factor < 0 || unit.factor > 0;
}

/* Whether the name is the word, alone or followed by a unit. */
static bool begins_with_word(const char *plain, const char *word)
{
    const size_t length = strlen(word);

    return strncmp(plain, word, length) == 0 && (plain[length] == '\0' || plain[length] == '_');
}

/* Name of the column that a word stands for, in radians or in degrees. */
static const char *name_of_word(size_t word)
{
    const enum dimension dimension = words[word].dimension;
    const char *degrees = name_in_degrees(words[word].column);

    return degrees && (dimension == DEGREES || dimension == COMPASS)
               ? degrees
               : column_names[words[word].column];
}

static const char *column_for_name(const char *name, struct unit *unit)
{
    char plain[NAME_BYTES];

    if (!normalise_column_name(name, plain)) {
        return NULL;
    }
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (begins_with_word(plain, words[i].word)) {
            *unit = find_unit(plain + strlen(words[i].word), words[i].dimension);
            if (is_unit_known(*unit)) {
                return name_of_word(i);
            }
        }
    }
    return NULL;
}

#define NUM_WORDS (sizeof words / sizeof *words)

/* All accepted names by index; NULL after the last. */
static const char *known_name_at(size_t index)
{
    return index < NUM_NAMED                   ? column_names[index]
           : index < NUM_NAMED + NUM_WORDS     ? name_of_word(index - NUM_NAMED)
           : index < NUM_NAMED + 2 * NUM_WORDS ? words[index - NUM_NAMED - NUM_WORDS].word
                                               : NULL;
}

static bool is_known_column_name(const char *name)
{
    struct unit unit;

    for (size_t i = 0; i < NUM_NAMED; i++) {
        if (strcmp(name, column_names[i]) == 0) {
            return true;
        }
    }
    return column_for_name(name, &unit) != NULL;
}

#define COLUMNS_MAX 40

static struct {
    const char *name, *column;
} renamed[COLUMNS_MAX];
static size_t num_renamed;
static bool is_renaming_done; /* a file had the columns of --columns */
static char names_seen[240];  /* column names of the newest file without them */

void columns_set_option(const char *text)
{
    char *copy = must_copy_text(text), *rest = copy, *pair; /* kept as long as the program runs */

    while ((pair = strsep(&rest, ",")) != NULL) {
        char *column = strchr(pair, '=');

        if (!column || column == pair || !column[1] || num_renamed == COLUMNS_MAX) {
            fail(EXIT_USAGE,
                 "--columns '%s': give NAME=COLUMN, NAME being rhotrack's and COLUMN the file's, "
                 "and commas between them, %d at most",
                 pair, COLUMNS_MAX);
        }
        *column++ = '\0';
        if (!is_known_column_name(pair)) {
            const char *nearest = name_hint_nearest(pair, known_name_at);

            fail(EXIT_USAGE,
                 "--columns '%s=%s': rhotrack reads no column '%s'%s%s%s; tools/README.md lists "
                 "them",
                 pair, column, pair, nearest ? ", did you mean '" : "", nearest ? nearest : "",
                 nearest ? "'?" : "");
        }
        renamed[num_renamed].name = pair;
        renamed[num_renamed++].column = column;
    }
}

/* Writes the names of a table's columns, separated by commas. */
static void list_columns_of_file(const struct table *table, char *text, size_t bytes)
{
    size_t used = 0;

    *text = '\0';
    for (size_t i = 0; i < table->num_columns && used < bytes; i++) {
        used += (size_t)snprintf(text + used, bytes - used, "%s%.40s", i > 0 ? ", " : "",
                                 table->names[i]);
    }
}

/* Exit 2 where a file has some of the columns of --columns, but not all. */
static void check_option_found_whole(const struct table *table, size_t found, const char *missing)
{
    if (found > 0 && missing) {
        char names[240];

        list_columns_of_file(table, names, sizeof names);
        fail(EXIT_USAGE, "%s:%u: --columns: there is no column '%s'; the file has: %s", table->path,
             (unsigned)table->header_line, missing, names);
    }
}

static void rename_columns_by_option(struct table *table)
{
    size_t found = 0;
    const char *missing = NULL;

    for (size_t i = 0; i < num_renamed; i++) {
        if (table_find_column(table, renamed[i].column) >= 0) {
            found++;
        } else {
            missing = renamed[i].column;
        }
    }
    check_option_found_whole(table, found, missing);

    for (size_t i = 0; i < num_renamed; i++) {
        const int column = table_find_column(table, renamed[i].column);

        if (column < 0) {
            list_columns_of_file(table, names_seen, sizeof names_seen);
            return;
        }
        if (table_find_column(table, renamed[i].name) >= 0) {
            fail(EXIT_USAGE, "%s:%u: --columns: the file already has a column '%s'", table->path,
                 (unsigned)table->header_line, renamed[i].name);
        }
        table->names[column] = renamed[i].name;
    }
    is_renaming_done = true;
}

void columns_check_option_used(void)
{
    if (num_renamed > 0 && !is_renaming_done) {
        fail(EXIT_USAGE, "--columns: no file has a column '%s'%s%s", renamed[0].column,
             *names_seen ? "; there are: " : "", names_seen);
    }
}

static bool is_name_of_option(const char *name)
{
    for (size_t i = 0; i < num_renamed; i++) {
        if (renamed[i].name == name) {
            return true;
        }
    }
    return false;
}

/*
 * Whether the header already names a time and a place as the readers do; other columns then keep
 * their names, except the sensor's, since extra columns may have any name.
 */
static bool is_header_named(const struct table *table)
{
    static const enum column_id places[] = {COL_X_M,         COL_RANGE_M,   COL_LAT_DEG,
                                            COL_BEARING_RAD, COL_TARGET_ID, COL_TRACK_ID};
    bool has_place = false;

    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        has_place |= table_find_column(table, column_names[places[i]]) >= 0;
    }
    return has_place && table_find_column(table, column_names[COL_T_S]) >= 0;
}

void columns_rename(struct table *table)
{
    rename_columns_by_option(table);
    const bool is_left = is_header_named(table);

    for (size_t i = 0; i < table->num_columns; i++) {
        struct unit unit = {1, 0};
        const char *column;

        column = column_for_name(table->names[i], &unit);
        if (is_left && !is_name_of_option(table->names[i]) &&
            (!column || strcmp(column, column_names[COL_SENSOR_ID]) != 0)) {
            continue;
        }
        if (!column || table_find_column(table, column) >= 0) {
            continue; /* not known, or there already: the first column of a name counts */
        }
        table->names[i] = column;
        if (unit.factor < 1 || unit.factor > 1) {
            if (!table->factors) {
                table->factors = must_calloc(table->num_columns, sizeof *table->factors);
                table->offsets = must_calloc(table->num_columns, sizeof *table->offsets);
            }
            table->factors[i] = unit.factor;
            table->offsets[i] = unit.offset;
        }
    }
}

static const char *known_column_word_at(size_t index)
{
    return index < NUM_WORDS ? words[index].word : NULL;
}

/* Whether a name of the file is a word for that column, or nearly one, with any unit. */
static bool may_mean_column(const char *name, enum column_id column)
{
    char plain[NAME_BYTES];
    const char *nearest;

    if (!normalise_column_name(name, plain)) {
        return false;
    }
    nearest = name_hint_nearest(plain, known_column_word_at);
    for (size_t i = 0; i < NUM_WORDS; i++) {
        if (words[i].column == column && name_of_word(i) == column_names[column] &&
            (begins_with_word(plain, words[i].word) ||
             (nearest && strlen(plain) > 2 && strcmp(nearest, words[i].word) == 0))) {
            return true;
        }
    }
    return false;
}

/*
 * Writes advice on a missing angle: its unit and reference are never guessed, so a column in
 * degrees is suggested as such, and for any other column both forms.
 */
static void format_angle_hint(const char *name, enum column_id column, char *text, size_t bytes)
{
    const char *angle = column_names[column];
    const int length = (int)(strlen(angle) - strlen("_rad"));
    const char *compass = column == COL_ELEVATION_RAD ? "" : " (clockwise from north)";
    const char *east = column == COL_ELEVATION_RAD ? "" : " (counter-clockwise from east)";
    char plain[NAME_BYTES];
    const char *unit = normalise_column_name(name, plain) ? strrchr(plain, '_') : NULL;

    if (unit && strcmp(unit, "_deg") == 0) {
        snprintf(text, bytes, "did you mean '%.40s'? --columns '%.*s_deg=%.40s'%s", name, length,
                 angle, name, compass);
        return;
    }
    snprintf(text, bytes,
             "did you mean '%.40s'? --columns '%.*s_deg=%.40s'%s or '%.*s_rad=%.40s'%s", name,
             length, angle, name, compass, length, angle, name, east);
}

/*
 * Writes advice on a missing column: the column of the file that it may be, and the option to say
 * so.
 */
static void format_column_hint(const struct table *table, enum column_id column, char *text,
                               size_t bytes)
{
    struct unit unit;

    for (size_t i = 0; i < table->num_columns; i++) {
        if (may_mean_column(table->names[i], column) &&
            column_for_name(table->names[i], &unit) == NULL) {
            if (column == COL_AZIMUTH_RAD || column == COL_BEARING_RAD ||
                column == COL_ELEVATION_RAD) {
                format_angle_hint(table->names[i], column, text, bytes);
            } else {
                snprintf(text, bytes, "did you mean '%.40s'? --columns '%s=%.40s'", table->names[i],
                         column_names[column], table->names[i]);
            }
            return;
        }
    }
    snprintf(text, bytes, "--columns %s=NAME takes another", column_names[column]);
}

/* Writes other accepted names of a column, like "time, timestamp"; "" where there are none. */
static void list_other_names(enum column_id column, char *text, size_t bytes)
{
    size_t used = 0;

    *text = '\0';
    for (size_t i = 0; i < NUM_WORDS && used < bytes; i++) {
        char name[NAME_BYTES];
        const enum dimension dimension = words[i].dimension;
        const char *unit = is_unit_known(find_unit("", dimension))        ? ""
                           : dimension == RADIANS || dimension == COMPASS ? "_rad"
                                                                          : "_deg";

        snprintf(name, sizeof name, "%s%s", words[i].word, unit);
        if (words[i].column == column && name_of_word(i) == column_names[column] &&
            strcmp(name, column_names[column]) != 0) {
            used += (size_t)snprintf(text + used, bytes - used, "%s%s", used > 0 ? ", " : "", name);
        }
    }
}

int columns_need(const struct columns *columns, enum column_id column)
{
    char others[160], hint[260], found[240];

    if (columns->at[column] >= 0) {
        return columns->at[column];
    }
    if (column == COL_T_S && columns->at[COL_FRAME] >= 0 && columns->table->frame_rate_hz >= 0) {
        table_fail_at_row(columns->table, TABLE_HEADER,
                          "no column 't_s'; of plots 'frame' tells the time, and needs "
                          "frame_rate_hz: --set frame_rate_hz=10, or what the radar's rate is");
    }
    list_other_names(column, others, sizeof others);
    list_columns_of_file(columns->table, found, sizeof found);
    format_column_hint(columns->table, column, hint, sizeof hint);
    table_fail_at_row(columns->table, TABLE_HEADER, "no column '%s'%s%s%s; the file has: %s; %s",
                      column_names[column], *others ? " (or " : "", others, *others ? ")" : "",
                      found, hint);
}
