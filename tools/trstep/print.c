#include <stdio.h>

#include "tools/trstep/trstep.h"

/* Several times the difference that a new mesh makes. */
static const double LEAP = 0.1;

/* `-` where a failed design has no value and where there is no reason. */
static void print_row(const struct pm_trial *t)
{
    const int failed = t->measure == 0;
    char measure[32] = "-", merit[32] = "-", ratio[32] = "-";

    if (!failed) {
        snprintf(measure, sizeof measure, "%.9g", t->measure);
        snprintf(merit, sizeof merit, "%.9g", t->merit);
        snprintf(ratio, sizeof ratio, "%.4g", t->ratio);
    }
    printf("%lld\t%lld\t%s\t%s\t%.6g\t%s\t%.4g\t%.3g\t%.3g\t%.4g\t%lld\t%.3g\t%.3g\t%.3g\t%s\n",
           (long long)t->iteration, (long long)t->accepted, measure, merit, t->predicted, ratio,
           t->radius, t->worst_curvature, t->worst_wall, t->rms_step, (long long)t->renewed,
           t->jump, t->amplification, t->gap, t->reason[0] != '\0' ? t->reason : "-");
}

enum pm_status trstep_print(const struct trstep_opts *opts, struct pm_err *err)
{
    enum pm_status status;
    struct pm_step s = {0};

    PM_TRY(pm_step_load(opts->verdict != NULL ? opts->verdict
                        : opts->next != NULL  ? opts->next
                                              : opts->history,
                        &s, err));
    if (opts->next != NULL) {
        puts(s.renew ? "renew" : s.gain > LEAP * s.value ? "leap" : "trial");
        goto done;
    }
    if (opts->verdict != NULL) {
        puts(s.verdict);
        goto done;
    }
    puts("iteration\taccepted\tmeasure\tmerit\tpredicted\tratio\tradius\tworst_curvature\tworst_"
         "wall\trms_step\trenewed\tjump\tamplification\tgap\treason");
    for (ptrdiff_t i = 0; i < s.ntrials; i++)
        print_row(&s.trials[i]);
done:
    pm_step_release(&s);
    return status;
}
