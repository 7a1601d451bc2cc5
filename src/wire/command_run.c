/* SPDX-License-Identifier: MIT */
/* command_run: runs an operator's command message on a tracker, and fills the answer. */
#include "rhotrack/command.h"

#include "rhotrack/operator.h"

enum rho_status rho_command_run(const struct rho_message_command *command,
                                struct rho_tracker *tracker, struct rho_report *report,
                                struct rho_message_command_answer *answer)
{
    if (!command || !tracker || !report || !answer) {
        return RHO_ERROR_NULL;
    }
    const struct rho_operator_start at = {.x_m = command->x_m,
                                          .y_m = command->y_m,
                                          .sigma_m = command->sigma_m,
                                          .vx_mps = command->vx_mps,
                                          .vy_mps = command->vy_mps,
                                          .sigma_mps = command->sigma_mps};
    const struct rho_extent area = {.x_min_m = command->x_m,
                                    .x_max_m = command->x_max_m,
                                    .y_min_m = command->y_m,
                                    .y_max_m = command->y_max_m};
    const uint32_t track_id = (uint32_t)command->track_id, new_id = (uint32_t)command->new_id;
    uint32_t about = track_id; /* the track that the command is about, as it is now; 0: none */
    enum rho_status status = RHO_ERROR_VALUE;
    switch (command->action) {
    case RHO_MESSAGE_COMMAND_START:
        status = rho_tracker_start_at(tracker, &at, report);
        about = status == RHO_OK ? tracker->tracks[tracker->num_tracks - 1u].track_id : 0;
        break;
    case RHO_MESSAGE_COMMAND_DROP:
        status = rho_tracker_drop_track(tracker, track_id, report);
        break;
    case RHO_MESSAGE_COMMAND_RENUMBER:
        status = rho_tracker_renumber_track(tracker, track_id, new_id, report);
        about = new_id;
        break;
    case RHO_MESSAGE_COMMAND_FREEZE:
    case RHO_MESSAGE_COMMAND_THAW:
        status = rho_tracker_freeze_track(tracker, track_id,
                                          command->action == RHO_MESSAGE_COMMAND_FREEZE, report);
        break;
    case RHO_MESSAGE_COMMAND_EXCLUDE:
        status = rho_tracker_exclude_area(tracker, &area);
        about = 0;
        break;
    case RHO_MESSAGE_COMMAND_INCLUDE:
        status = rho_tracker_include_place(tracker, command->x_m, command->y_m);
        about = 0;
        break;
    default:
        break;
    }
    *answer = (struct rho_message_command_answer){
        .utime = report->time_us,
        .number = command->number,
        .action = command->action,
        .status = (int8_t)status,
        .track_id = status == RHO_OK ? (int32_t)about : 0,
    };
    return status;
}
