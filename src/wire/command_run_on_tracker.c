/* SPDX-License-Identifier: MIT */
/* command_run_on_tracker: runs an operator's command message on a tracker, and fills the answer. */
#include "rhotrack/command.h"

#include "rhotrack/operator.h"

static enum rho_status start_track_by_command(const struct rho_message_command *command,
                                              struct rho_tracker *tracker,
                                              struct rho_report *report)
{
    const struct rho_operator_start at = {.x_m = command->x_m,
                                          .y_m = command->y_m,
                                          .sigma_m = command->sigma_m,
                                          .vx_mps = command->vx_mps,
                                          .vy_mps = command->vy_mps,
                                          .sigma_mps = command->sigma_mps};
    return rho_tracker_start_at(tracker, &at, report);
}

static enum rho_status add_excluded_area_by_command(const struct rho_message_command *command,
                                                    struct rho_tracker *tracker)
{
    const struct rho_extent area = {.x_min_m = command->x_m,
                                    .x_max_m = command->x_max_m,
                                    .y_min_m = command->y_m,
                                    .y_max_m = command->y_max_m};
    return rho_tracker_exclude_area(tracker, &area);
}

static enum rho_status run_command_action(const struct rho_message_command *command,
                                          struct rho_tracker *tracker, struct rho_report *report)
{
    const uint32_t track_id = (uint32_t)command->track_id;
    switch (command->action) {
    case RHO_MESSAGE_COMMAND_START:
        return start_track_by_command(command, tracker, report);
    case RHO_MESSAGE_COMMAND_DROP:
        return rho_tracker_drop_track(tracker, track_id, report);
    case RHO_MESSAGE_COMMAND_RENUMBER:
        return rho_tracker_renumber_track(tracker, track_id, (uint32_t)command->new_id, report);
    case RHO_MESSAGE_COMMAND_FREEZE:
    case RHO_MESSAGE_COMMAND_THAW:
        return rho_tracker_freeze_track(tracker, track_id,
                                        command->action == RHO_MESSAGE_COMMAND_FREEZE, report);
    case RHO_MESSAGE_COMMAND_EXCLUDE:
        return add_excluded_area_by_command(command, tracker);
    case RHO_MESSAGE_COMMAND_INCLUDE:
        return rho_tracker_include_place(tracker, command->x_m, command->y_m);
    default:
        return RHO_ERROR_VALUE;
    }
}

/* Identity of the track that a successful command was about, as it is now; 0: of no track. */
static uint32_t track_id_after_command(const struct rho_message_command *command,
                                       const struct rho_tracker *tracker)
{
    switch (command->action) {
    case RHO_MESSAGE_COMMAND_START:
        return tracker->tracks[tracker->num_tracks - 1u].track_id;
    case RHO_MESSAGE_COMMAND_RENUMBER:
        return (uint32_t)command->new_id;
    case RHO_MESSAGE_COMMAND_EXCLUDE:
    case RHO_MESSAGE_COMMAND_INCLUDE:
        return 0;
    default:
        return (uint32_t)command->track_id;
    }
}

enum rho_status rho_command_run(const struct rho_message_command *command,
                                struct rho_tracker *tracker, struct rho_report *report,
                                struct rho_message_command_answer *answer)
{
    if (!command || !tracker || !report || !answer) {
        return RHO_ERROR_NULL;
    }
    const enum rho_status status = run_command_action(command, tracker, report);
    *answer = (struct rho_message_command_answer){
        .utime = report->time_us,
        .number = command->number,
        .action = command->action,
        .status = (int8_t)status,
    };
    if (status == RHO_OK) {
        answer->track_id = (int32_t)track_id_after_command(command, tracker);
    }
    return status;
}
