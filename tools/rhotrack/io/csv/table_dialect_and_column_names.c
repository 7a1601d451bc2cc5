/* SPDX-License-Identifier: MIT */
#include "io/csv/table_dialect_and_column_names.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/common.h"
#include "base/name_hint.h"

/* ---- Cells ---- */

char table_dialect_find_delimiter(const char *line, size_t length)
{
    static const char delimiters[] = ",;\t";

    for (const char *delimiter = delimiters; *delimiter; delimiter++) {
        bool is_quoted = false;

        for (size_t i = 0; i < length; i++) {
            is_quoted ^= line[i] == '"';
            if (line[i] == *delimiter && !is_quoted) {
                return *delimiter;
            }
        }
    }
    return memchr(line, '"', length) ? ',' : ' ';
}

size_t table_dialect_join_blanks(const char *line, size_t length, char *copy)
{
    size_t used = 0;

    for (size_t i = 0; i < length; i++) {
        if (line[i] == '\r' || line[i] == '\n') {
            copy[used++] = line[i];
        } else if (line[i] != ' ' && line[i] != '\t') {
            if (used > 0 && (line[i - 1] == ' ' || line[i - 1] == '\t')) {
                copy[used++] = ',';
            }
            copy[used++] = line[i];
        }
    }
    return used;
}

void table_dialect_point_for_comma(char *cell)
{
    char *comma = strchr(cell, ',');

    if (comma && cell[strspn(cell, "+-0123456789,eE")] == '\0' && !strchr(comma + 1, ',')) {
        *comma = '.';
    }
}

/* ---- Names of columns ---- */

#define RAD_DEG (180 / 3.14159265358979323846)

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
    const char *word, *column;
    enum dimension dimension;
} words[] = {
    {"t", "t_s", TIME},
    {"time", "t_s", TIME},
    {"timestamp", "t_s", TIME},
    {"datetime", "t_s", TIME},
    {"sensor_id", "sensor_id", NUMBER},
    {"sensor", "sensor_id", NUMBER},
    {"radar", "sensor_id", NUMBER},
    {"radar_id", "sensor_id", NUMBER},
    {"x", "x_m", LENGTH},
    {"y", "y_m", LENGTH},
    {"z", "z_m", LENGTH},
    {"vx", "vx_mps", SPEED},
    {"vy", "vy_mps", SPEED},
    {"vz", "vz_mps", SPEED},
    {"range", "range_m", LENGTH},
    {"distance", "range_m", LENGTH},
    {"rho", "range_m", LENGTH},
    {"azimuth", "azimuth_deg", DEGREES},
    {"az", "azimuth_deg", DEGREES},
    {"theta", "azimuth_deg", DEGREES},
    {"azimuth_compass", "azimuth_deg", COMPASS},
    {"azimuth_clockwise", "azimuth_deg", COMPASS},
    {"azimuth", "azimuth_rad", RADIANS},
    {"az", "azimuth_rad", RADIANS},
    {"elevation", "elevation_deg", DEGREES},
    {"el", "elevation_deg", DEGREES},
    {"elevation", "elevation_rad", RADIANS},
    {"el", "elevation_rad", RADIANS},
    {"range_rate", "range_rate_mps", SPEED},
    {"doppler", "range_rate_mps", SPEED},
    {"lat", "lat_deg", NUMBER},
    {"latitude", "lat_deg", NUMBER},
    {"lat", "lat_deg", DEGREES},
    {"latitude", "lat_deg", DEGREES},
    {"lon", "lon_deg", NUMBER},
    {"lng", "lon_deg", NUMBER},
    {"longitude", "lon_deg", NUMBER},
    {"lon", "lon_deg", DEGREES},
    {"longitude", "lon_deg", DEGREES},
    {"alt", "alt_m", LENGTH},
    {"altitude", "alt_m", LENGTH},
    {"snr", "snr_db", NUMBER},
    {"bearing", "bearing_rad", RADIANS},
    {"bearing", "bearing_rad", COMPASS_TO_EAST},
    {"sensor_x", "sensor_x_m", LENGTH},
    {"sensor_y", "sensor_y_m", LENGTH},
    {"sensor_lat", "sensor_lat_deg", NUMBER},
    {"sensor_lon", "sensor_lon_deg", NUMBER},
    {"sigma", "sigma_rad", SIZE},
    {"sigma_azimuth", "sigma_azimuth_rad", SIZE},
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
                return words[i].column;
            }
        }
    }
    return NULL;
}

/* ---- --columns ---- */

/* Names of columns that readers use and that no entry of `words` gives. */
static const char *const others[] = {"azimuth_rad",
                                     "bearing_rad",
                                     "elevation_rad",
                                     "sigma_m",
                                     "sigma_mps",
                                     "sigma_range_m",
                                     "sigma_azimuth_rad",
                                     "sigma_elevation_rad",
                                     "sigma_rad",
                                     "sector_from_rad",
                                     "sector_to_rad",
                                     "scan",
                                     "epoch",
                                     "received_s",
                                     "sensor_x_m",
                                     "sensor_y_m",
                                     "sensor_z_m",
                                     "sensor_lat_deg",
                                     "sensor_lon_deg",
                                     "sensor_alt_m",
                                     "sigma_alt_m",
                                     "target_id",
                                     "track_id",
                                     "status",
                                     "sigma_range_rate_mps"};

#define NUM_WORDS (sizeof words / sizeof *words)
#define NUM_OTHERS (sizeof others / sizeof *others)

/* All accepted names by index; NULL after the last. */
static const char *known_name_at(size_t index)
{
    return index < NUM_OTHERS                   ? others[index]
           : index < NUM_OTHERS + NUM_WORDS     ? words[index - NUM_OTHERS].column
           : index < NUM_OTHERS + 2 * NUM_WORDS ? words[index - NUM_OTHERS - NUM_WORDS].word
                                                : NULL;
}

static bool is_known_column_name(const char *name)
{
    struct unit unit;

    for (size_t i = 0; i < NUM_OTHERS; i++) {
        if (strcmp(name, others[i]) == 0) {
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

void table_dialect_set_columns_option(const char *text)
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

void table_dialect_list_columns_of_file(const struct table *table, char *text, size_t bytes)
{
    size_t used = 0;

    *text = '\0';
    for (size_t i = 0; i < table->num_columns && used < bytes; i++) {
        used += (size_t)snprintf(text + used, bytes - used, "%s%.40s", i > 0 ? ", " : "",
                                 table->names[i]);
    }
}

/* Exit 2 where a file has some of the columns of --columns, but not all. */
static void fail_if_columns_option_is_only_partly_found(const struct table *table, size_t found,
                                                        const char *missing)
{
    if (found > 0 && missing) {
        char names[240];

        table_dialect_list_columns_of_file(table, names, sizeof names);
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
    fail_if_columns_option_is_only_partly_found(table, found, missing);

    for (size_t i = 0; i < num_renamed; i++) {
        const int column = table_find_column(table, renamed[i].column);

        if (column < 0) {
            table_dialect_list_columns_of_file(table, names_seen, sizeof names_seen);
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

void table_dialect_fail_if_columns_option_unused(void)
{
    if (num_renamed > 0 && !is_renaming_done) {
        fail(EXIT_USAGE, "--columns: no file has a column '%s'%s%s", renamed[0].column,
             *names_seen ? "; there are: " : "", names_seen);
    }
}

static bool is_name_given_by_columns_option(const char *name)
{
    for (size_t i = 0; i < num_renamed; i++) {
        if (renamed[i].name == name) {
            return true;
        }
    }
    return false;
}

/* ---- A header ---- */

/*
 * Whether the header already names a time and a place as the readers do; other columns then keep
 * their names, except the sensor's, since extra columns may have any name.
 */
static bool header_names_time_and_place(const struct table *table)
{
    static const char *const places[] = {"x_m",         "range_m",   "lat_deg",
                                         "bearing_rad", "target_id", "track_id"};
    bool has_place = false;

    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        has_place |= table_find_column(table, places[i]) >= 0;
    }
    return has_place && table_find_column(table, "t_s") >= 0;
}

static void set_column_unit(struct table *table, size_t column, struct unit unit)
{
    if (!table->factors) {
        table->factors = must_calloc(table->num_columns, sizeof *table->factors);
        table->offsets = must_calloc(table->num_columns, sizeof *table->offsets);
    }
    table->factors[column] = unit.factor;
    table->offsets[column] = unit.offset;
}

void table_dialect_name_columns(struct table *table)
{
    rename_columns_by_option(table);
    const bool is_left = header_names_time_and_place(table);

    for (size_t i = 0; i < table->num_columns; i++) {
        struct unit unit = {1, 0};
        const char *column;

        column = column_for_name(table->names[i], &unit);
        if (is_left && !is_name_given_by_columns_option(table->names[i]) &&
            (!column || strcmp(column, "sensor_id") != 0)) {
            continue;
        }
        if (!column || table_find_column(table, column) >= 0) {
            continue; /* not known, or there already: the first column of a name counts */
        }
        table->names[i] = column;
        if (unit.factor < 1 || unit.factor > 1) {
            set_column_unit(table, i, unit);
        }
    }
}

static const char *known_column_word_at(size_t index)
{
    return index < NUM_WORDS ? words[index].word : NULL;
}

/* Whether a name of the file is a word for that column, or nearly one, with any unit. */
static bool may_mean_column(const char *name, const char *column)
{
    char plain[NAME_BYTES];
    const char *nearest;

    if (!normalise_column_name(name, plain)) {
        return false;
    }
    nearest = name_hint_nearest(plain, known_column_word_at);
    for (size_t i = 0; i < NUM_WORDS; i++) {
        if (strcmp(words[i].column, column) == 0 &&
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
static void format_angle_hint(const char *name, const char *column, char *text, size_t bytes)
{
    const int length = (int)(strlen(column) - strlen("_rad"));
    const bool is_elevation = text_begins_with(column, "elevation");
    const char *compass = is_elevation ? "" : " (clockwise from north)";
    const char *east = is_elevation ? "" : " (counter-clockwise from east)";
    char plain[NAME_BYTES];
    const char *unit = normalise_column_name(name, plain) ? strrchr(plain, '_') : NULL;

    if (unit && strcmp(unit, "_deg") == 0) {
        snprintf(text, bytes, "did you mean '%.40s'? --columns '%.*s_deg=%.40s'%s", name, length,
                 column, name, compass);
        return;
    }
    snprintf(text, bytes,
             "did you mean '%.40s'? --columns '%.*s_deg=%.40s'%s or '%.*s_rad=%.40s'%s", name,
             length, column, name, compass, length, column, name, east);
}

static bool is_angle_column(const char *column)
{
    return strcmp(column, "azimuth_rad") == 0 || strcmp(column, "bearing_rad") == 0 ||
           strcmp(column, "elevation_rad") == 0;
}

void table_dialect_hint_column(const struct table *table, const char *column, char *text,
                               size_t bytes)
{
    struct unit unit;

    for (size_t i = 0; i < table->num_columns; i++) {
        if (may_mean_column(table->names[i], column) &&
            column_for_name(table->names[i], &unit) == NULL) {
            if (is_angle_column(column)) {
                format_angle_hint(table->names[i], column, text, bytes);
            } else {
                snprintf(text, bytes, "did you mean '%.40s'? --columns '%s=%.40s'", table->names[i],
                         column, table->names[i]);
            }
            return;
        }
    }
    snprintf(text, bytes, "--columns %s=NAME takes another", column);
}

void table_dialect_other_names(const char *column, char *text, size_t bytes)
{
    size_t used = 0;

    *text = '\0';
    for (size_t i = 0; i < sizeof words / sizeof *words && used < bytes; i++) {
        char name[NAME_BYTES];
        const enum dimension dimension = words[i].dimension;
        const char *unit = is_unit_known(find_unit("", dimension))        ? ""
                           : dimension == RADIANS || dimension == COMPASS ? "_rad"
                                                                          : "_deg";

        snprintf(name, sizeof name, "%s%s", words[i].word, unit);
        if (strcmp(words[i].column, column) == 0 && strcmp(name, column) != 0) {
            used += (size_t)snprintf(text + used, bytes - used, "%s%s", used > 0 ? ", " : "", name);
        }
    }
}
