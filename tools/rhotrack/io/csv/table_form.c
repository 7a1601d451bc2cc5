/* SPDX-License-Identifier: MIT */
#include "io/csv/table_form.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/common.h"

/* ---- Cells ---- */

char table_form_delimiter(const char *line, size_t length)
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

size_t table_form_join_blanks(const char *line, size_t length, char *copy)
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

void table_form_point(char *cell)
{
    char *comma = strchr(cell, ',');

    if (comma && cell[strspn(cell, "+-0123456789,eE")] == '\0' && !strchr(comma + 1, ',')) {
        *comma = '.';
    }
}

/* ---- Names of columns ---- */

enum dimension { NUMBER, TIME, LENGTH, SPEED, DEGREES, RADIANS };

static const struct {
    const char *unit;
    enum dimension dimension;
    double factor;
} units[] = {
    {"", NUMBER, 1},
    {"db", NUMBER, 1},
    {"", TIME, 1},
    {"s", TIME, 1},
    {"sec", TIME, 1},
    {"utc", TIME, 1},
    {"ms", TIME, 1e-3},
    {"us", TIME, 1e-6},
    {"", LENGTH, 1},
    {"m", LENGTH, 1},
    {"km", LENGTH, 1000},
    {"nmi", LENGTH, 1852},
    {"nm", LENGTH, 1852},
    {"ft", LENGTH, 0.3048},
    {"", SPEED, 1},
    {"mps", SPEED, 1},
    {"m_s", SPEED, 1},
    {"kmh", SPEED, 1 / 3.6},
    {"km_h", SPEED, 1 / 3.6},
    {"kn", SPEED, 1852.0 / 3600},
    {"kt", SPEED, 1852.0 / 3600},
    {"deg", DEGREES, 1},
    {"rad", RADIANS, 1},
};

/* Words that files have for a column; an angle without a unit is not guessed. */
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
};

#define NAME_BYTES 40

/* "Range [km]" is range_km, a degree sign deg; false where the name is too long. */
static bool plain_name(const char *name, char plain[NAME_BYTES])
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

/* The unit of that dimension behind a word: its factor, or 0 where it is none. */
static double unit_factor(const char *rest, enum dimension dimension)
{
    rest += *rest == '_';
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        if (units[i].dimension == dimension && strcmp(units[i].unit, rest) == 0) {
            return units[i].factor;
        }
    }
    return 0;
}

static const char *column_of(const char *name, double *factor)
{
    char plain[NAME_BYTES];

    if (!plain_name(name, plain)) {
        return NULL;
    }
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        size_t length = strlen(words[i].word);

        if (strncmp(plain, words[i].word, length) != 0 ||
            (plain[length] != '\0' && plain[length] != '_')) {
            continue;
        }
        *factor = unit_factor(plain + length, words[i].dimension);
        if (*factor > 0) {
            return words[i].column;
        }
    }
    return NULL;
}

/* A header that the readers know needs no other names; extra columns of any name are ignored. */
static bool is_known(const struct table *table)
{
    static const char *const places[] = {"x_m",         "range_m",   "lat_deg",
                                         "bearing_rad", "target_id", "track_id"};
    bool has_place = false;

    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        has_place |= table_find(table, places[i]) >= 0;
    }
    return has_place && table_find(table, "t_s") >= 0;
}

void table_form_name_columns(struct table *table)
{
    if (is_known(table)) {
        return;
    }
    for (size_t i = 0; i < table->num_columns; i++) {
        double factor = 1;
        const char *column = column_of(table->names[i], &factor);

        if (!column || table_find(table, column) >= 0) {
            continue; /* not known, or there already: the first one counts */
        }
        table->names[i] = column;
        if (factor < 1 || factor > 1) {
            if (!table->factors) {
                table->factors = must_calloc(table->num_columns, sizeof *table->factors);
            }
            table->factors[i] = factor;
        }
    }
}

void table_form_names_of(const char *column, char *text, size_t bytes)
{
    size_t used = 0;

    *text = '\0';
    for (size_t i = 0; i < sizeof words / sizeof *words && used < bytes; i++) {
        if (strcmp(words[i].column, column) == 0 && strcmp(words[i].word, column) != 0) {
            used += (size_t)snprintf(text + used, bytes - used, "%s%s", used > 0 ? ", " : "",
                                     words[i].word);
        }
    }
}
