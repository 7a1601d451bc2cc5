/* SPDX-License-Identifier: MIT */
#include "rhotrack/types.h"

/* Names as characters, no pointers: without relocations the table is read-only everywhere. */
static const char status_names[RHO_NUM_STATUS][9] = {
    [RHO_OK] = "ok",
    [RHO_ERROR_NULL] = "null",
    [RHO_ERROR_SIZE] = "size",
    [RHO_ERROR_CONFIG] = "config",
    [RHO_ERROR_VALUE] = "value",
    [RHO_ERROR_CAPACITY] = "capacity",
    [RHO_ERROR_SINGULAR] = "singular",
    [RHO_ERROR_STATE] = "state",
    [RHO_ERROR_SHORT] = "short",
    [RHO_ERROR_TYPE] = "type",
    [RHO_ERROR_COUNT] = "count",
    [RHO_ERROR_TRAILING] = "trailing",
};

const char *rho_status_name(enum rho_status status)
{
    const unsigned value = (unsigned)status;
    return value < RHO_NUM_STATUS ? status_names[value] : "unknown";
}
