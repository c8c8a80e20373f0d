#include <string.h>

#include "tools/trstep/trstep.h"

static const struct pm_option OPTIONS[] = {
    {"previous", 0, "STEP.h5", "the step that proposed these surfaces; none for the first design"},
    {"judge", 0, NULL, "print accept or reject, write nothing"},
    {"history", 0, "STEP.h5", "print the history of a step file as a table, tab separated"},
    {"verdict", 0, "STEP.h5", "print the verdict of a step file: continue, converged or stalled"},
    {"next", 0, "STEP.h5",
     "print what a step file proposes: trial, leap (any mesh may judge it) or renew"},
    {0},
};

static enum pm_status take(void *opts, const char *name, const char *value, struct pm_err *err)
{
    struct trstep_opts *o = opts;
    (void)err;
    if (strcmp(name, "previous") == 0)
        o->previous = value;
    else if (strcmp(name, "history") == 0)
        o->history = value;
    else if (strcmp(name, "verdict") == 0)
        o->verdict = value;
    else if (strcmp(name, "next") == 0)
        o->next = value;
    else
        o->judge = 1;
    return PM_OK;
}

static enum pm_status run(void *opts, const struct pm_common *common, struct pm_err *err)
{
    return trstep_run(opts, common, err);
}

int main(int argc, char **argv)
{
    struct trstep_opts opts = {0};
    const struct pm_tool tool = {
        .name = "trstep",
        .operands = "SURF.h5 WORK.h5 [SENS.h5..]",
        .summary = "judge a trial design and propose the next one",
        .options = OPTIONS,
        .min_operands = 0,
        .max_operands = -1,
        .output_optional = 1,
        .option = take,
        .run = run,
    };
    return pm_tool_main(&tool, argc, argv, &opts);
}
