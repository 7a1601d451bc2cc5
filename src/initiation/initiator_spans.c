/* SPDX-License-Identifier: MIT */
/*
 * initiator_spans: ambiguous range rates in what is expected of chance. A set's count where its places tell which of them
 * is meant (measurement.h): three sd of the places' speed and of the range rate itself are within half the span.
 */
#include "initiator_chance.h"

#if RHO_AMBIGUOUS_RANGE_RATES
#include "rhotrack/approx.h"

/* No window is so long. */
#define CLEAR_NEVER_S2 1.0e30f

/* From this spread of the times on, (t - mean)^2 summed. */
static float clear_from_s2(const struct chance *chance, float span_mps)
{
    float clear_s2 = 0.0f;
    for (unsigned i = 0; i < chance->num_classes; i++) {
        const struct place_class *place = &chance->classes[i];
        float range_m2 = rho_exp(2.0f * place->log_range) + chance->search->fit_process_m2;
        float room = span_mps * span_mps / 36.0f - rho_exp(2.0f * place->log_range_rate);
        float s2 = room > 0.0f ? range_m2 / room : CLEAR_NEVER_S2;
        clear_s2 = s2 > clear_s2 ? s2 : clear_s2;
    }
    return clear_s2 < CLEAR_NEVER_S2 ? clear_s2 : CLEAR_NEVER_S2;
}

void rho_initiator_lay_spans(struct chance *chance)
{
    const struct search *search = chance->search;
    float least_mps = 0.0f;
    chance->log_aliases = 0.0f;
    for (unsigned m = 0; m < search->num_scans && chance->has_range_rate; m++) {
        const struct rho_sensor *sensor = &rho_window_scan_at(&search->initiator->window, m)->sensor;
        chance->log_aliases +=
            rho_measurement_log_aliases(sensor, search->initiator->config.v_max_mps) /
            (float)search->num_scans;
        if (rho_measurement_has_span(sensor) &&
            (!(least_mps > 0.0f) || sensor->range_rate_span_mps < least_mps)) {
            least_mps = sensor->range_rate_span_mps;
        }
    }
    chance->clear_s2 = least_mps > 0.0f ? clear_from_s2(chance, least_mps) : 0.0f;
}
#endif
