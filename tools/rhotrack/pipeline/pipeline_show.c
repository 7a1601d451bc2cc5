/* SPDX-License-Identifier: MIT */
#include "pipeline/pipeline_show.h"

#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "rhotrack/publish.h"
#include "settings/initiation_methods.h"

struct pipeline_show {
    struct rho_show show;
    uint32_t picture[RHO_SHOW_PICTURE];
};

static const char *const names[RHO_NUM_SHOW_KINDS] = {"ghosts", "votes", "hypotheses"};

static bool uses_passive_paper(const struct parameters *parameters)
{
    return method_of_bearings(parameters) == METHOD_PASSIVE_PAPER;
}

static bool uses_paper_starts(const struct parameters *parameters)
{
    return track_start_method(parameters) != METHOD_KERNEL;
}

static unsigned must_find_show_kind(const char *word, size_t length)
{
    unsigned kind = 0;

    while (kind < RHO_NUM_SHOW_KINDS &&
           (strlen(names[kind]) != length || strncmp(names[kind], word, length) != 0)) {
        kind++;
    }
    if (kind == RHO_NUM_SHOW_KINDS) {
        fail(EXIT_USAGE, "--show: '%.*s' is not ghosts, votes or hypotheses", (int)length, word);
    }
    return kind;
}

static void check_show_kind(unsigned kind, const struct parameters *parameters)
{
    if (kind == RHO_SHOW_GHOSTS && !uses_passive_paper(parameters)) {
        fail(EXIT_USAGE, "--show ghosts: of the methods only passive-paper has a ghost matrix "
                         "(--method passive-paper or --pipeline paper)");
    }
    if (kind == RHO_SHOW_VOTES && !uses_passive_paper(parameters) &&
        !uses_paper_starts(parameters)) {
        fail(EXIT_USAGE, "--show votes: the methods kernel and passive have no accumulator; ht, "
                         "mht, iht, nht and passive-paper have one (--method)");
    }
}

struct pipeline_show *pipeline_show_open(const char *kinds, const struct parameters *parameters)
{
    struct rho_show_config config;
    struct pipeline_show *show;

    if (!kinds) {
        return NULL;
    }
    rho_show_config_default(&config);
    config.kinds = 0;
    for (const char *word = kinds;; word++) {
        const size_t length = strcspn(word, ",");
        const unsigned kind = must_find_show_kind(word, length);

        check_show_kind(kind, parameters);
        config.kinds = (uint16_t)(config.kinds | 1u << kind);
        word += length;
        if (*word == '\0') {
            break;
        }
    }
    show = must_calloc(1, sizeof *show);
    config.picture = show->picture;
    must_succeed(rho_show_init(&show->show, sizeof show->show, &config), "show");
    return show;
}

void pipeline_show_step(struct pipeline_show *show, struct pipeline *pipeline, bool is_frame,
                        int32_t step, int32_t epoch, int64_t now_us,
                        const struct pipeline_show_output *output)
{
    const struct rho_show_source source = {
        .tracker = &pipeline->node->tracker,
        .report = &pipeline->node->report,
        .starts = is_frame ? NULL : pipeline_paper_starts(pipeline),
        .paper = is_frame ? pipeline_passive_paper(pipeline) : NULL,
        .step = step,
        .epoch = epoch,
    };
    uint8_t buffer[RHO_SHOW_MAX_SIZE];
    const char *channel;
    size_t size;

    if (!show) {
        return;
    }
    rho_show_begin(&show->show, &source, now_us);
    while ((channel = rho_show_next(&show->show, &source, buffer, sizeof buffer, &size))) {
        output->send(output->context, channel, buffer, size);
    }
}

uint64_t pipeline_show_num_not_sent(const struct pipeline_show *show)
{
    uint64_t not_sent = 0;

    for (unsigned kind = 0; show && kind < RHO_NUM_SHOW_KINDS; kind++) {
        not_sent += rho_show_not_sent(&show->show, (enum rho_show_kind)kind);
    }
    return not_sent;
}

void pipeline_show_close(struct pipeline_show *show)
{
    free(show);
}
