/* SPDX-License-Identifier: MIT */
#include "settings/parameters.h"

#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/name_hint.h"
#include "base/parse.h"

static const struct parameter_text texts[NUM_PARAMETERS] = {
#define X(id, name, unit, value, min, max, is_integer, has_default, text)                          \
    {name, unit, text, value, min, max, is_integer, has_default, NULL, false},
    PARAMETERS(X)
#undef X
};

static const struct parameter_text sensor_texts[NUM_SENSOR_PARAMETERS] = {
#define X(id, name, unit, min, max, text)                                                          \
    {name, unit, text, 0, min, max, false, false, NULL, false},
    SENSOR_PARAMETERS(X)
#undef X
};

/* The words that a parameter of words accepts, "a|b|c"; NULL for numeric parameters. */
static const char *parameter_choices(enum parameter_id id)
{
    switch (id) {
    case PARAMETER_NHT_READING:
        return "a|c";
    case PARAMETER_VOTE:
        return "scans|counts";
    case PARAMETER_PRUNE:
        return "safe|literal|none";
    case PARAMETER_INITIATORS:
        return "pairs|sensor|one";
    case PARAMETER_METHOD:
        return "kernel|ht|mht|iht|nht";
    case PARAMETER_BEARINGS_METHOD:
        return "passive|passive-paper";
    case PARAMETER_GATE:
        return "best|hough|nearest|none";
    case PARAMETER_STANDING:
        return "clutter|targets";
    case PARAMETER_INPUT_MODEL:
        return "literal|physical";
    case PARAMETER_ASTERIX_SCANS:
        return "sector|turn";
    case PARAMETER_PLANES:
        return "xy|xz|yz";
    default:
        return NULL;
    }
}

struct parameter_text parameters_text(enum parameter_id id)
{
    struct parameter_text text = texts[id];

    text.choices = parameter_choices(id);
    text.is_sum = id == PARAMETER_PLANES;
    return text;
}

/* Formats a sum of powers of 2 as the words for its bits, joined by +. */
static void format_sum_of_choices(const char *words, unsigned sum,
                                  char buffer[PARAMETER_VALUE_BYTES])
{
    size_t length = 0;

    buffer[0] = '\0';
    for (; sum && length < PARAMETER_VALUE_BYTES; sum >>= 1) {
        size_t bytes = strcspn(words, "|");

        if (sum & 1u) {
            length += (size_t)snprintf(buffer + length, PARAMETER_VALUE_BYTES - length, "%s%.*s",
                                       length ? "+" : "", (int)bytes, words);
        }
        words += bytes + (words[bytes] == '|');
    }
}

const char *parameters_value_text(const struct parameter_text *text, double value,
                                  char buffer[PARAMETER_VALUE_BYTES])
{
    const char *word = text->choices;

    if (!word) {
        snprintf(buffer, PARAMETER_VALUE_BYTES, "%.9g", value); /* which may be beyond any int */
    } else if (text->is_sum) {
        format_sum_of_choices(word, (unsigned)value, buffer);
    } else {
        for (int i = (int)value; i > 0; i--) {
            word = strchr(word, '|') + 1;
        }
        snprintf(buffer, PARAMETER_VALUE_BYTES, "%.*s", (int)strcspn(word, "|"), word);
    }
    return buffer;
}

struct parameter_text parameters_sensor_text(enum sensor_parameter_id id)
{
    return sensor_texts[id];
}

const char *parameters_name(enum parameter_id id)
{
    return texts[id].name;
}

const char *parameters_source_name(enum parameter_source source)
{
    static const char *const names[] = {
        [SOURCE_UNSET] = "unset",   [SOURCE_DEFAULT] = "default", [SOURCE_METHOD] = "method",
        [SOURCE_PRESET] = "preset", [SOURCE_CONFIG] = "config",   [SOURCE_SET] = "set",
    };

    return names[source];
}

static const char *parameter_name_at(size_t index)
{
    return index < NUM_PARAMETERS        ? texts[index].name
           : index == NUM_PARAMETERS     ? "sensors_allowed"
           : index == NUM_PARAMETERS + 1 ? "reflectors"
                                         : NULL;
}

static const char *sensor_parameter_name_at(size_t index)
{
    return index < NUM_SENSOR_PARAMETERS    ? sensor_texts[index].name
           : index == NUM_SENSOR_PARAMETERS ? "name"
                                            : NULL;
}

/* Index of a parameter's name; -1, with the reason and a suggestion, where it is unknown. */
static int index_of_parameter_name(const char *key, name_by_index name, char *reason)
{
    const char *known, *hint;

    for (size_t i = 0; (known = name(i)); i++) {
        if (!strcmp(key, known)) {
            return (int)i;
        }
    }
    hint = name_hint_nearest(key, name);
    snprintf(reason, PARAMETER_REASON_BYTES, "unknown parameter '%.60s'%s%s%s", key,
             hint ? ", did you mean '" : "", hint ? hint : "", hint ? "'?" : "");
    return -1;
}

/* Index of a word of `bytes` characters among the choices "a|b|c"; -1 where it is none of them. */
static int index_of_choice(const char *words, const char *word, size_t bytes)
{
    for (int i = 0;; i++, words++) {
        size_t length = strcspn(words, "|");

        if (bytes == length && strncmp(words, word, length) == 0) {
            return i;
        }
        words += length;
        if (*words == '\0') {
            return -1;
        }
    }
}

/* Parses "a+b" as the sum of 2^index of its words among the choices; -1 for an unknown word. */
static int parse_sum_of_choices(const char *words, const char *cell)
{
    unsigned sum = 0;

    for (;; cell++) {
        size_t bytes = strcspn(cell, "+");
        int index = index_of_choice(words, cell, bytes);

        if (index < 0) {
            return -1;
        }
        sum |= 1u << index;
        cell += bytes;
        if (*cell == '\0') {
            return (int)sum;
        }
    }
}

static bool parse_choice_value(const struct parameter_text *text, const char *cell, double *value,
                               char *reason)
{
    *value = text->is_sum ? parse_sum_of_choices(text->choices, cell)
                          : index_of_choice(text->choices, cell, strlen(cell));
    if (*value < 0) {
        snprintf(reason, PARAMETER_REASON_BYTES, "%s '%.60s' is not one of %s%s", text->name, cell,
                 text->choices, text->is_sum ? ", or several joined by +" : "");
    }
    return *value >= 0;
}

static bool parse_parameter_value(const struct parameter_text *text, const char *cell,
                                  double *value, char *reason)
{
    double number;
    const char *why;

    if (text->choices) {
        return parse_choice_value(text, cell, value, reason);
    }
    why = parse_number_or_give_reason(cell, &number);
    if (why) {
        snprintf(reason, PARAMETER_REASON_BYTES, "%s '%.60s' %s", text->name, cell, why);
    } else if (text->is_integer && number != floor(number)) {
        snprintf(reason, PARAMETER_REASON_BYTES, "%s '%.60s' is not a whole number", text->name,
                 cell);
    } else if (number < text->min || number > text->max) {
        snprintf(reason, PARAMETER_REASON_BYTES, "%s %.60s is outside %.9g .. %.9g %s", text->name,
                 cell, text->min, text->max, strcmp(text->unit, "-") ? text->unit : "");
    } else {
        *value = number;
        return true;
    }
    reason[strlen(reason) - (reason[strlen(reason) - 1] == ' ')] = '\0';
    return false;
}

/*
 * Fails for range-rate spans above 0 and below RHO_LIMIT_SPAN_MIN_MPS: range rates so ambiguous
 * carry no information.
 */
static bool check_range_rate_span(double span_mps, char *reason)
{
    bool is_span = span_mps <= 0.0 || span_mps >= (double)RHO_LIMIT_SPAN_MIN_MPS;

    if (!is_span) {
        snprintf(reason, PARAMETER_REASON_BYTES,
                 "range_rate_span_mps %.9g is neither 0 nor %g or more", span_mps,
                 (double)RHO_LIMIT_SPAN_MIN_MPS);
    }
    return is_span;
}

static void store_by_precedence(double *value, enum parameter_source *source, double number,
                                enum parameter_source from)
{
    if (from >= *source) {
        *value = number;
        *source = from;
    }
}

static const struct sensor_parameters *find_sensor(const struct parameters *parameters,
                                                   int32_t sensor_id)
{
    for (size_t i = 0; i < parameters->num_sensors; i++) {
        if (parameters->sensors[i].sensor_id == sensor_id) {
            return &parameters->sensors[i];
        }
    }
    return NULL;
}

/* Finds a sensor's parameters, or adds an empty entry; NULL where there is no room. */
static struct sensor_parameters *find_or_add_sensor(struct parameters *parameters,
                                                    int32_t sensor_id)
{
    const struct sensor_parameters *found = find_sensor(parameters, sensor_id);
    struct sensor_parameters *sensor;

    if (found) {
        return &parameters->sensors[found - parameters->sensors];
    }
    if (parameters->num_sensors == RHO_MAX_SENSORS) {
        return NULL;
    }
    sensor = &parameters->sensors[parameters->num_sensors++];
    *sensor = (struct sensor_parameters){.sensor_id = sensor_id};
    return sensor;
}

static const struct sensor_name *find_sensor_name(const struct parameters *parameters,
                                                  int32_t sensor_id)
{
    for (size_t i = 0; i < parameters->num_names; i++) {
        if (parameters->names[i].sensor_id == sensor_id) {
            return &parameters->names[i];
        }
    }
    return NULL;
}

static bool is_utf8(const char *text)
{
    const locale_t locale = newlocale(LC_CTYPE_MASK, "C.UTF-8", (locale_t)0);
    locale_t before;
    bool is_text = false;

    if (locale) {
        before = uselocale(locale);
        is_text = mbstowcs(NULL, text, 0) != (size_t)-1;
        uselocale(before);
        freelocale(locale);
    }
    return is_text;
}

/*
 * Reason why a text cannot be a sensor's name, which is printed in lines and in quoted labels;
 * NULL: it can.
 */
static const char *why_not_sensor_name(const char *value)
{
    if (strlen(value) >= SENSOR_NAME_BYTES) {
        return "is too long";
    }
    for (const char *c = value; *c; c++) {
        if ((unsigned char)*c < ' ' || *c == 127 || *c == '"' || *c == '\\') {
            return "has characters that a name cannot have";
        }
    }
    return !*value ? "is empty" : is_utf8(value) ? NULL : "is not UTF-8";
}

static bool assign_sensor_name(struct parameters *parameters, int32_t sensor_id, const char *value,
                               enum parameter_source source, char *reason)
{
    const struct sensor_name *known = find_sensor_name(parameters, sensor_id);
    struct sensor_name *name;
    const char *why = why_not_sensor_name(value);

    if (why) {
        snprintf(reason, PARAMETER_REASON_BYTES, "name '%.60s' %s", value, why);
        return false;
    }
    if (!known && parameters->num_names == RHO_MAX_SENSORS) {
        snprintf(reason, PARAMETER_REASON_BYTES, "more than %d sensors", RHO_MAX_SENSORS);
        return false;
    }
    name = &parameters->names[known ? (size_t)(known - parameters->names) : parameters->num_names];
    if (!known) {
        *name = (struct sensor_name){.sensor_id = sensor_id};
        parameters->num_names++;
    }
    if (source >= name->source) {
        snprintf(name->text, sizeof name->text, "%s", value);
        name->source = source;
    }
    return true;
}

/* Assigns a sensor's parameter; key: "N.name", with the sensor's number N. */
static bool assign_sensor_parameter(struct parameters *parameters, const char *key,
                                    const char *value, enum parameter_source source, char *reason)
{
    const char *dot = strchr(key, '.');
    char digits[16] = "";
    struct sensor_parameters *sensor;
    int32_t sensor_id;
    double number;
    int id;

    if (dot && (size_t)(dot - key) < sizeof digits) {
        memcpy(digits, key, (size_t)(dot - key));
    }
    if (!dot || parse_int32_or_give_reason(digits, &sensor_id)) {
        snprintf(reason, PARAMETER_REASON_BYTES,
                 "'sensor.%.60s' is not sensor.N.key with a whole number N", key);
        return false;
    }
    id = index_of_parameter_name(dot + 1, sensor_parameter_name_at, reason);
    if (id == NUM_SENSOR_PARAMETERS) {
        return assign_sensor_name(parameters, sensor_id, value, source, reason);
    }
    if (id < 0 || !parse_parameter_value(&sensor_texts[id], value, &number, reason) ||
        (id == SENSOR_RANGE_RATE_SPAN_MPS && !check_range_rate_span(number, reason))) {
        return false;
    }
    sensor = find_or_add_sensor(parameters, sensor_id);
    if (!sensor) {
        snprintf(reason, PARAMETER_REASON_BYTES, "more than %d sensors", RHO_MAX_SENSORS);
        return false;
    }
    store_by_precedence(&sensor->value[id], &sensor->source[id], number, source);
    return true;
}

/* Assigns sensors_allowed: sensors' numbers, separated by blanks or commas; empty: all sensors. */
static bool assign_allowed_sensors(struct parameters *parameters, const char *value,
                                   enum parameter_source source,
                                   char reason[PARAMETER_REASON_BYTES])
{
    static const char between[] = " \t,";
    int16_t allowed[RHO_MAX_SENSORS] = {0};
    uint16_t count = 0;
    int32_t sensor_id;

    for (value += strspn(value, between); *value; value += strspn(value, between)) {
        const int bytes = (int)strcspn(value, between);
        char digits[16];

        snprintf(digits, sizeof digits, "%.*s", bytes, value);
        if (bytes >= (int)sizeof digits || parse_int32_or_give_reason(digits, &sensor_id) ||
            sensor_id != (int16_t)sensor_id) {
            snprintf(reason, PARAMETER_REASON_BYTES,
                     "sensors_allowed '%.*s' is not a sensor's number", bytes < 60 ? bytes : 60,
                     value);
            return false;
        }
        if (count == RHO_MAX_SENSORS) {
            snprintf(reason, PARAMETER_REASON_BYTES, "sensors_allowed: more than %d sensors",
                     RHO_MAX_SENSORS);
            return false;
        }
        allowed[count++] = (int16_t)sensor_id;
        value += bytes;
    }
    if (source >= parameters->allowed_source) {
        memcpy(parameters->allowed, allowed, sizeof allowed);
        parameters->num_allowed = count;
        parameters->allowed_source = source;
    }
    return true;
}

static void store_common_value(struct parameters *parameters, enum parameter_id id, double value,
                               enum parameter_source source)
{
    store_by_precedence(&parameters->value[id], &parameters->source[id], value, source);
}

/* Fields that rho_settings_preset chooses; of the others a method may have its own. */
#define PRESET_FIELDS(FIELD)                                                                       \
    FIELD(V_MIN_MPS, v_min_mps)                                                                    \
    FIELD(V_MAX_MPS, v_max_mps)                                                                    \
    FIELD(ACCEL_MAX_MPS2, accel_max_mps2)                                                          \
    FIELD(PD, pd)                                                                                  \
    FIELD(SIGMA_RANGE_M, sigma_range_m)                                                            \
    FIELD(SIGMA_AZIMUTH_RAD, sigma_azimuth_rad)                                                    \
    FIELD(SIGMA_ELEVATION_RAD, sigma_elevation_rad)                                                \
    FIELD(SIGMA_RANGE_RATE_MPS, sigma_range_rate_mps)                                              \
    FIELD(RANGE_MIN_M, range_min_m)                                                                \
    FIELD(RANGE_MAX_M, range_max_m)                                                                \
    FIELD(FALSE_TRACKS_PER_HOUR, false_tracks_per_hour)                                            \
    FIELD(COAST_SCANS_MAX, coast_scans_max)                                                        \
    FIELD(STANDING, standing)

/* The decimal number that the float was written as, 0.009 and not 0.00899999961. */
static double shortest_decimal(float value)
{
    char text[32];

    snprintf(text, sizeof text, "%.7g", (double)value);
    return strtod(text, NULL);
}

bool parameters_assign_preset(struct parameters *parameters, const char *name,
                              char reason[PARAMETER_REASON_BYTES])
{
    static const char *const names[RHO_NUM_PRESETS] = {
        [RHO_PRESET_EN_ROUTE] = "en_route", [RHO_PRESET_APPROACH] = "approach",
        [RHO_PRESET_MARINE] = "marine",     [RHO_PRESET_COASTAL_HARBOUR] = "coastal_harbour",
        [RHO_PRESET_TRAFFIC] = "traffic",   [RHO_PRESET_DRONE_DEFENCE] = "drone_defence"};

    for (int i = 0; i < RHO_NUM_PRESETS; i++) {
        if (strcmp(name, names[i]) == 0) {
            struct rho_settings settings;

            rho_settings_preset(&settings, (enum rho_preset)i);
#define SUGGEST(id, field)                                                                         \
    store_common_value(parameters, PARAMETER_##id, shortest_decimal((float)settings.field),        \
                       SOURCE_PRESET);
            PRESET_FIELDS(SUGGEST)
#undef SUGGEST
            store_common_value(parameters, PARAMETER_LATE_MAX_S,
                               fmin(PARAMETER_LATE_SCANS * (double)settings.scan_interval_s,
                                    PARAMETER_LATE_LIMIT_S),
                               SOURCE_PRESET);
            return true;
        }
    }
    snprintf(
        reason, PARAMETER_REASON_BYTES,
        "'%.40s' is none of en_route, approach, marine, coastal_harbour, drone_defence, traffic",
        name);
    return false;
}

bool parameters_assign(struct parameters *parameters, const char *key, const char *value,
                       enum parameter_source source, char reason[PARAMETER_REASON_BYTES])
{
    static const char prefix[] = "sensor.";
    struct parameter_text text;
    double number;
    int id;

    if (!strcmp(key, "sensors_allowed")) {
        return assign_allowed_sensors(parameters, value, source, reason);
    }
    if (!strcmp(key, "preset")) {
        return parameters_assign_preset(parameters, value, reason);
    }
    if (!strcmp(key, "reflectors")) {
        return parameters_assign_reflectors(parameters, value, source, reason);
    }
    if (!strncmp(key, prefix, sizeof prefix - 1)) {
        return assign_sensor_parameter(parameters, key + sizeof prefix - 1, value, source, reason);
    }
    if (!strncmp(key, "zone.", strlen("zone."))) {
        return parameters_assign_zone(parameters, key + strlen("zone."), value, source, reason);
    }
    id = index_of_parameter_name(key, parameter_name_at, reason);
    if (id < 0) {
        return false;
    }
    text = parameters_text((enum parameter_id)id);
    if (!parse_parameter_value(&text, value, &number, reason) ||
        (id == PARAMETER_RANGE_RATE_SPAN_MPS && !check_range_rate_span(number, reason))) {
        return false;
    }
    store_common_value(parameters, (enum parameter_id)id, number, source);
    return true;
}

void parameters_set_defaults(struct parameters *parameters)
{
    memset(parameters, 0, sizeof *parameters);
    for (int i = 0; i < NUM_PARAMETERS; i++) {
        parameters->value[i] = texts[i].value;
        parameters->source[i] = texts[i].has_default ? SOURCE_DEFAULT : SOURCE_UNSET;
    }
}

void parameters_suggest(struct parameters *parameters, enum parameter_id id, double value)
{
    store_common_value(parameters, id, value, SOURCE_METHOD);
}

void parameters_set_assignment(struct parameters *parameters, const char *assignment)
{
    const char *equals = strchr(assignment, '=');
    char reason[PARAMETER_REASON_BYTES], key[80] = "";

    if (!equals) {
        fail(EXIT_USAGE, "--set %s: not of the form key=value", assignment);
    }
    snprintf(key, sizeof key, "%.*s", (int)(equals - assignment), assignment);
    if (!parameters_assign(parameters, key, equals + 1, SOURCE_SET, reason)) {
        fail(EXIT_USAGE, "--set %s: %s", assignment, reason);
    }
}

bool parameters_has_value(const struct parameters *parameters, enum parameter_id id)
{
    return parameters->source[id] != SOURCE_UNSET;
}

void parameters_set_gate(struct parameters *parameters, const char *gate)
{
    char reason[PARAMETER_REASON_BYTES];

    if (!parameters_assign(parameters, "gate", gate, SOURCE_SET, reason)) {
        fail(EXIT_USAGE, "--%s", reason);
    }
}

void parameters_set_method(struct parameters *parameters, const char *method)
{
    char reason[PARAMETER_REASON_BYTES];
    const bool is_of_bearings = strncmp(method, "passive", strlen("passive")) == 0;

    if (!parameters_assign(parameters, is_of_bearings ? "bearings_method" : "method", method,
                           SOURCE_SET, reason)) {
        fail(EXIT_USAGE, "--%s", reason);
    }
}

const char *parameters_sensor_name(const struct parameters *parameters, int32_t sensor_id)
{
    const struct sensor_name *name = find_sensor_name(parameters, sensor_id);

    return name ? name->text : NULL;
}

bool parameters_has_sensor(const struct parameters *parameters, int32_t sensor_id)
{
    return find_sensor(parameters, sensor_id) != NULL;
}

int32_t parameters_lone_sensor_id(const struct parameters *parameters)
{
    return parameters->num_sensors == 1 ? parameters->sensors[0].sensor_id : 0;
}

double parameters_value_of_sensor(const struct parameters *parameters, int32_t sensor_id,
                                  enum sensor_parameter_id id, double otherwise)
{
    const struct sensor_parameters *sensor = find_sensor(parameters, sensor_id);

    return sensor && sensor->source[id] != SOURCE_UNSET ? sensor->value[id] : otherwise;
}

static void check_parameter_below(const struct parameters *parameters, enum parameter_id low,
                                  enum parameter_id high)
{
    if (parameters->value[low] >= parameters->value[high]) {
        fail(EXIT_USAGE, "%s %.9g is not below %s %.9g", texts[low].name, parameters->value[low],
             texts[high].name, parameters->value[high]);
    }
}

static void check_min_scans(const struct parameters *parameters)
{
    double scans = parameters->value[PARAMETER_SCANS];
    double min_scans = parameters->value[PARAMETER_MIN_SCANS];

    if (min_scans > scans) {
        fail(EXIT_USAGE, "min_scans %.9g is more than scans %.9g", min_scans, scans);
    }
    if (min_scans > 0 && min_scans < 3) {
        fail(EXIT_USAGE, "min_scans %.9g is neither 0 nor 3 or more", min_scans);
    }
}

static void check_area_sides(const struct parameters *parameters)
{
    int num_set = 0;

    for (int i = PARAMETER_AREA_X_MIN_M; i <= PARAMETER_AREA_Y_MAX_M; i++) {
        num_set += parameters_has_value(parameters, (enum parameter_id)i);
    }
    if (!num_set) {
        return;
    }
    if (num_set < 4) {
        fail(EXIT_USAGE,
             "area_x_min_m, area_x_max_m, area_y_min_m and area_y_max_m go together: "
             "%d of 4 are set",
             num_set);
    }
    check_parameter_below(parameters, PARAMETER_AREA_X_MIN_M, PARAMETER_AREA_X_MAX_M);
    check_parameter_below(parameters, PARAMETER_AREA_Y_MIN_M, PARAMETER_AREA_Y_MAX_M);
}

/*
 * Exit 2 where the notches at multiples of the blind speed overlap, so that no target is visible.
 */
static void check_blind_speed(double notch_mps, double blind_mps, const char *of)
{
    if (blind_mps > 0.0 && blind_mps <= 2.0 * notch_mps) {
        fail(EXIT_USAGE, "%sblind_speed_mps %.9g is not more than twice notch_mps %.9g", of,
             blind_mps, notch_mps);
    }
}

void parameters_check_together(const struct parameters *parameters)
{
    double range_min_m = parameters->value[PARAMETER_RANGE_MIN_M];
    double range_max_m = parameters->value[PARAMETER_RANGE_MAX_M];

    check_parameter_below(parameters, PARAMETER_V_MIN_MPS, PARAMETER_V_MAX_MPS);
    check_parameter_below(parameters, PARAMETER_RANGE_MIN_M, PARAMETER_RANGE_MAX_M);
    check_min_scans(parameters);
    check_area_sides(parameters);
    check_blind_speed(parameters->value[PARAMETER_NOTCH_MPS],
                      parameters->value[PARAMETER_BLIND_SPEED_MPS], "");
    for (size_t i = 0; i < parameters->num_sensors; i++) {
        int32_t id = parameters->sensors[i].sensor_id;
        double low = parameters_value_of_sensor(parameters, id, SENSOR_RANGE_MIN_M, range_min_m);
        double high = parameters_value_of_sensor(parameters, id, SENSOR_RANGE_MAX_M, range_max_m);
        char of[32];

        if (low >= high) {
            fail(EXIT_USAGE, "sensor %d: range_min_m %.9g is not below range_max_m %.9g", (int)id,
                 low, high);
        }
        snprintf(of, sizeof of, "sensor %d: ", (int)id);
        check_blind_speed(parameters_value_of_sensor(parameters, id, SENSOR_NOTCH_MPS,
                                                     parameters->value[PARAMETER_NOTCH_MPS]),
                          parameters_value_of_sensor(parameters, id, SENSOR_BLIND_SPEED_MPS,
                                                     parameters->value[PARAMETER_BLIND_SPEED_MPS]),
                          of);
    }
}
