/* SPDX-License-Identifier: MIT */
/*
 * command: does the commands and settings of an operator that come as messages: command_t on
 * RHO_COMMANDS, answered by command_answer_t on RHO_COMMAND_ANSWERS; setting_t on RHO_SETTINGS,
 * answered by setting_answer_t on RHO_SETTING_ANSWERS.
 *
 *     if (rho_message_command_decode(data, size, &command) == RHO_OK &&
 *         rho_message_command_validate(&command, NULL) == RHO_OK) {
 *         ... keep it until after the next step
 *         rho_command_run(&command, &tracker, &report, &answer);
 *         answer.scan = node.step;
 *         answer.epoch = node.epoch;
 *     }
 *
 * The command is run before the step's messages are made, which then show the change. Nothing
 * proves who sent a command: a node is to take commands only on a private network, and when told
 * to.
 */
#ifndef RHOTRACK_COMMAND_H
#define RHOTRACK_COMMAND_H

#include "rhotrack/message.h"
#include "rhotrack/settings.h"
#include "rhotrack/tracker.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

/*
 * Runs a command, and fills the answer but for scan and epoch, which are 0.
 *   report  report of the last step
 * Errors: NULL, VALUE (an unknown action), and those of the functions of operator.h, which are
 * the answer's status, too; the tracker is unchanged. Stack: 3.3 KB.
 */
RHO_MUST_CHECK enum rho_status rho_command_run(const struct rho_message_command *command,
                                               struct rho_tracker *tracker,
                                               struct rho_report *report,
                                               struct rho_message_command_answer *answer);

/*
 * Changes one of the settings that the caller keeps, and fills the answer but for utime, scan and
 * epoch, which are 0. Where it is changed the caller applies the settings to tracker, initiators
 * and descriptions of sensors (settings.h); the answer says when that takes effect. Errors: NULL,
 * VALUE (no such field, no number, or a fraction where a whole number is wanted), CONFIG (this or
 * another field would be outside its range: the answer's fault_field, value, min and max), which
 * are the answer's status, too; the settings are unchanged. Constant cost. Stack: 440 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_command_set(const struct rho_message_setting *setting,
                                               struct rho_settings *settings,
                                               struct rho_message_setting_answer *answer);

/*
 * Name of the parameter in struct rho_settings that a message's field number stands for; NULL:
 * there is none. Constant cost. Stack: 8 bytes.
 */
const char *rho_command_setting_name(int field);

RHO_END_C

#endif
