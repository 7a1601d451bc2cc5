/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/parse.h"
#include "rhotrack/reflectors.h"
#include "settings/parameters.h"

#define NUMBERS 4

/*
 * Parses one coordinate of a wall; returns the text behind it and its blanks, or NULL with the
 * reason.
 */
static const char *parse_wall_coordinate(const char *value, double *number,
                                         char reason[PARAMETER_REASON_BYTES])
{
    const char *behind = value;
    const int bytes = (int)strcspn(value, " \t,");

    if (parse_next_number(&behind, number)) {
        snprintf(reason, PARAMETER_REASON_BYTES, "reflectors '%.*s' is not a number",
                 bytes < 60 ? bytes : 60, value);
        return NULL;
    }
    if (fabs(*number) > (double)RHO_LIMIT_POSITION_M) {
        snprintf(reason, PARAMETER_REASON_BYTES, "reflectors %.*s is outside -%g .. %g m", bytes,
                 value, (double)RHO_LIMIT_POSITION_M, (double)RHO_LIMIT_POSITION_M);
        return NULL;
    }
    return behind + strspn(behind, " \t");
}

bool parameters_assign_reflectors(struct parameters *parameters, const char *value,
                                  enum parameter_source source, char reason[PARAMETER_REASON_BYTES])
{
    struct rho_reflector reflectors[RHO_MAX_REFLECTORS];
    uint16_t count = 0;

    for (value += strspn(value, " \t"); *value; count++) {
        double at[NUMBERS];

        for (int i = 0; i < NUMBERS; i++) {
            value = parse_wall_coordinate(value, &at[i], reason);
            if (!value) {
                return false;
            }
        }
        if (*value && *value != ',') {
            snprintf(reason, PARAMETER_REASON_BYTES,
                     "reflectors: x y x y of a wall, with commas between walls, not '%.60s'",
                     value);
            return false;
        }
        if (hypot(at[2] - at[0], at[3] - at[1]) < (double)RHO_REFLECTOR_LEAST_M) {
            snprintf(reason, PARAMETER_REASON_BYTES, "reflectors: wall %d is shorter than %g m",
                     count + 1, (double)RHO_REFLECTOR_LEAST_M);
            return false;
        }
        if (count == RHO_MAX_REFLECTORS) {
            snprintf(reason, PARAMETER_REASON_BYTES, "reflectors: more than %d walls",
                     RHO_MAX_REFLECTORS);
            return false;
        }
        reflectors[count] =
            (struct rho_reflector){(float)at[0], (float)at[1], (float)at[2], (float)at[3]};
        value += strspn(value, " \t,");
    }
    if (source >= parameters->reflectors_source) {
        memcpy(parameters->reflectors, reflectors, count * sizeof reflectors[0]);
        parameters->num_reflectors = count;
        parameters->reflectors_source = source;
    }
    return true;
}

void parameters_reflectors_text(const struct parameters *parameters,
                                char text[PARAMETER_REFLECTORS_BYTES])
{
    size_t length = 0;

    snprintf(text, PARAMETER_REFLECTORS_BYTES, "-");
    for (size_t i = 0; i < parameters->num_reflectors; i++) {
        const struct rho_reflector *at = &parameters->reflectors[i];

        length += (size_t)snprintf(text + length, PARAMETER_REFLECTORS_BYTES - length,
                                   "%s%.9g %.9g %.9g %.9g", i ? ", " : "", (double)at->from_x_m,
                                   (double)at->from_y_m, (double)at->to_x_m, (double)at->to_y_m);
    }
}
