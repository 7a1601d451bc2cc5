/* SPDX-License-Identifier: MIT */
/*
 * status: the outcome of every call that can fail.
 *
 * Zero is success. A call that returns anything else has left its object unchanged, byte for byte.
 */
#ifndef RHOTRACK_STATUS_H
#define RHOTRACK_STATUS_H

/* Marks functions whose result must be used: the compiler warns where it is not. */
#if defined(__GNUC__)
#define RHO_MUST_CHECK __attribute__((warn_unused_result))
#else
#define RHO_MUST_CHECK
#endif

#ifdef __cplusplus
extern "C" {
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
    RHO_ERROR_STATE,    /* the object was never initialised, or does not have the thing asked for */
    /* decoding of a message: */
    RHO_ERROR_SHORT,    /* the bytes end too early */
    RHO_ERROR_TYPE,     /* the fingerprint differs: another message, or another version of it */
    RHO_ERROR_COUNT,    /* the count of a list is negative, or more than the message may hold */
    RHO_ERROR_TRAILING, /* bytes follow the end of the message */
    RHO_NUM_STATUS      /* count of the values above, not an outcome */
};

/*
 * Name of an outcome for logs: "ok", "null", "size", ... A constant string; "unknown" for any other
 * value. Cost: constant. Stack: 0 bytes.
 */
const char *rho_status_name(enum rho_status status);

#ifdef __cplusplus
}
#endif

#endif
