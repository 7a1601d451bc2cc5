/* SPDX-License-Identifier: MIT */
/*
 * status: the outcome of every call that can be refused.
 *
 * Zero is success. A call that returns anything else has left its object unchanged, byte for byte.
 */
#ifndef RHOTRACK_STATUS_H
#define RHOTRACK_STATUS_H

/* The compiler warns where the outcome of a call so marked is dropped. */
#if defined(__GNUC__)
#define RHO_MUST_CHECK __attribute__((warn_unused_result))
#else
#define RHO_MUST_CHECK
#endif

enum rho_status {
    RHO_OK = 0,
    RHO_ERROR_NULL, /* a pointer that must point somewhere is NULL */
    /* sizeof(object) differs: library and caller were built with other capacities */
    RHO_ERROR_SIZE,
    RHO_ERROR_CONFIG,   /* a parameter is outside its range */
    RHO_ERROR_VALUE,    /* a number is not finite or outside its range */
    RHO_ERROR_CAPACITY, /* more than a RHO_MAX_... allows */
    RHO_ERROR_SINGULAR, /* a matrix is not positive definite */
    RHO_ERROR_STATE,    /* the object was never initialised, or has nothing of what is asked for */
    /* of bytes that should be a message: */
    RHO_ERROR_SHORT,    /* they end too early */
    RHO_ERROR_TYPE,     /* another message, or another version of it: the fingerprint differs */
    RHO_ERROR_COUNT,    /* a list's count is negative, or more than the message may hold */
    RHO_ERROR_TRAILING, /* they go on behind its end */
    RHO_NUM_STATUS      /* count of the values above, not an outcome */
};

/*
 * Name of an outcome for logs: "ok", "null", "size", ... A constant string; "unknown" for any other value.
 * Cost: constant. Stack: 0 bytes.
 */
const char *rho_status_name(enum rho_status status);

#endif
