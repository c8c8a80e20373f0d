/* Dense workspaces of synthetic robots against Gauss sums, and what is refused [model 7.6]. */
#include <stdlib.h>
#include <unistd.h>

#include "common/actuation/lattice.h"
#include "common/actuation/loads.h"
#include "common/base/log.h"
#include "common/files/workspace.h"
#include "tests/actuated.h"
#include "tests/records.h"
#include "tests/tap.h"
#include "tools/wsint/wsint.h"

static struct pm_err err;
static const char path[] = "path.h5", dense[] = "dense.h5";

static double gauss(const struct pm_case *c)
{
    struct pm_case fine = *c;
    struct pm_load *loads = NULL;
    ptrdiff_t n = 0;
    double sum = 0;

    fine.points = 12;
    if (pm_load_set(&fine, PM_FORM_BOUNDARY, &loads, &n, &err) != PM_OK)
        return NAN;
    for (ptrdiff_t g = 0; g < n; g++) {
        double U[6], J[6 * PM_MAX_CHAMBERS], w = NAN, a[6], b[6 * PM_MAX_CHAMBERS];
        actuated_robot(&c->symmetry, (int)c->nchambers, c->pmax, loads[g].p, U, J);
        pm_measure_point(&fine, PM_FORM_BOUNDARY, &loads[g], U, J, &w, a, b, &err);
        sum += loads[g].weight * w;
    }
    pm_free(loads);
    return fabs(sum);
}

/* A path of the robot over its boundary, the last `without` points left out; `spoil`
 * changes it before it is written. */
static enum pm_status write_path(const struct pm_case *c, double interval, ptrdiff_t without,
                                 void (*spoil)(struct pm_sweep *))
{
    enum pm_status status;
    struct pm_sweep s = {.element = "tet10"};
    struct pm_lattice l;
    ptrdiff_t *ids = NULL, n = 0;

    PM_TRY(pm_lattice_make(c, interval, &l, &err));
    PM_TRY(pm_lattice_walk(c, &l, &ids, &n, &err));
    PM_TRY(sample_mesh(&s.mesh, &err));
    pm_case_release(&s.mesh.pcase);
    PM_TRY(pm_case_copy(c, &s.mesh.pcase, &err));
    s.mesh.nc = c->nchambers;
    PM_TRY(pm_sweep_allocate(&s, n - without, &err));
    PM_TRY(PM_NEW(s.reason, 1, &err));
    for (ptrdiff_t i = 0; i < s.np; i++) {
        double *p = s.pressure + l.n * i;
        s.reached[i] = 1;
        pm_lattice_pressure(&l, ids[i], p);
        actuated_robot(&c->symmetry, l.n, c->pmax, p, s.U + 6 * i, s.J + 6 * l.n * i);
    }
    if (spoil != NULL)
        spoil(&s);
    PM_TRY(sample_write(path, "path", &s, &err));
done:
    pm_free(ids);
    pm_sweep_release(&s);
    return status;
}

static enum pm_status run_dense(struct pm_workspace *w)
{
    char name[] = "path.h5", *operands[] = {name, NULL};
    const struct pm_common common = {
        .tool = "wsint", .command = "wsint", .operands = operands, .noperands = 1, .output = dense};
    enum pm_status status = wsint_run(&(struct wsint_opts){.dense = 1}, &common, &err);
    return status == PM_OK && w != NULL ? pm_workspace_load(dense, w, &err) : status;
}

static void check(const char *measure, const char *chambers, const char *group)
{
    struct pm_case c = {0};
    double error[2], polygon[2], value[2];
    char name[96];

    if (actuated_case(&c, chambers, group, measure, 2, &err) != PM_OK)
        ok(0, "%s", err.text);
    const double want = gauss(&c);
    for (int k = 0; k < 2; k++) {
        struct pm_workspace w = {.nn = 0};
        ok(write_path(&c, k == 0 ? 0.012 : 0.006, 0, NULL) == PM_OK && run_dense(&w) == PM_OK,
           "%s, %s: %s", measure, group, err.text);
        value[k] = w.value;
        error[k] = fabs(w.value / want - 1);
        polygon[k] = fabs(w.value_polygon / want - 1);
        if (k == 0)
            ok(isnan(w.value_coarse), "ten intervals do not come in fours");
        if (k == 1) {
            printf("# %s, %s: Gauss %.9g, dense %.9g (%.1e, %.1e), polygon %.9g (%.1e, %.1e)\n",
                   measure, group, want, w.value, error[0], error[1], w.value_polygon, polygon[0],
                   polygon[1]);
            ok(w.branch_jumps == 0, "no branch is left");
            snprintf(name, sizeof name, "%s, %s: by every other sample", measure, group);
            near_rel(name, w.value_coarse, value[0], 1e-12); /* the same samples, summed alike */
            const double estimate = fabs(w.value_coarse - w.value) / 15 / want;
            ok(error[k] < 1e-11 || fabs(estimate / error[k] - 1) < 0.3, "%s: error %.2g, told %.2g",
               measure, error[k], estimate);
            if (strcmp(measure, "2R") == 0)
                ok(llabs((long long)w.interior) == 1, "the centre lies inside the path");
            ok(w.tilt[0] >= w.tilt[1] && w.tilt[1] >= w.tilt[2] && w.tilt[2] >= 0, "angles");
        }
        pm_workspace_release(&w);
    }
    snprintf(name, sizeof name, "%s, %s: dense value, 20 intervals", measure, group);
    near_abs(name, error[1], 0, 1e-6); /* h^4 of a map that bends by a fifth */
    ok(error[1] < 1e-11 || error[0] / error[1] > 12, "%s: order 4", name);
    if (!isnan(polygon[1]))
        ok(polygon[1] < 1e-2 && polygon[0] / polygon[1] > 3.5, "%s: its polygon, order 2", name);
    pm_case_release(&c);
}

/* Another vector of the same rotation. */
static void turn(struct pm_sweep *s)
{
    double *t = s->U + 6 * 4 + 3;
    const double length = sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
    for (int i = 0; i < 3; i++)
        t[i] -= 2 * acos(-1) * t[i] / length;
}

static void stuck(struct pm_sweep *s)
{
    s->reached[1] = 0;
}

static void check_refusals(void)
{
    struct pm_case c = {0};
    struct pm_workspace w = {.nn = 0};

    if (actuated_case(&c, actuated_two, "mirror-x mirror-y", "2T", 2, &err) != PM_OK)
        ok(0, "%s", err.text);
    unlink(dense);
    ok(write_path(&c, 0.012, 1, NULL) == PM_OK && run_dense(NULL) == PM_INPUT &&
           strstr(err.text, "no sample at p/mu = 0.12,0.12") != NULL,
       "a missing sample: %s", err.text);
    err = (struct pm_err){0};
    ok(write_path(&c, 0.012, 0, stuck) == PM_OK && run_dense(NULL) == PM_INPUT &&
           strstr(err.text, "no equilibrium") != NULL && access(dense, F_OK) != 0,
       "a sample without equilibrium: %s", err.text);
    err = (struct pm_err){0};
    ok(write_path(&c, 0.012, 0, turn) == PM_OK && run_dense(&w) == PM_OK && w.branch_jumps > 0,
       "a branch that is left: %lld", (long long)w.branch_jumps);
    pm_workspace_release(&w);
    pm_case_release(&c);
}

int main(void)
{
    char folder[] = "/tmp/pneumorph-dense-XXXXXX";
    if (mkdtemp(folder) == NULL || chdir(folder) != 0)
        return tap_bail("no folder");
    pm_log_set("dense", -1);
    check("2T", actuated_two, "mirror-x mirror-y");
    check("3T", actuated_three, "c3 mirror-y");
    check("3R", actuated_three, "c3");
    check("1R2T", actuated_listed, "none");
    check("2R", actuated_three, "c3 mirror-y");
    check_refusals();
    unlink(path);
    unlink(dense);
    if (chdir("/") != 0 || rmdir(folder) != 0)
        printf("# %s stays\n", folder);
    return tap_done();
}
