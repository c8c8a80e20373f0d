/* Decisions of the trust region and its sub-problem on functions with known minimisers. */
#include <string.h>

#include "common/base/memory.h"
#include "tests/tap.h"
#include "tools/trstep/subproblem.h"
#include "tools/trstep/trust.h"

static struct pm_err err;

/* A step that promised to raise T from 100 by 10 and costs nothing. */
static struct pm_step promise(void)
{
    struct pm_step s = {.value = 100, .gain = 10, .radius = 0.3, .rms_step = 0.3, .max_step = 0.5};
    s.trial.pcase.radius = 0.3;
    s.trial.pcase.radius_max = 1;
    return s;
}

static void check_judgements(void)
{
    struct pm_step s = promise();
    struct pm_work w = {.objective = 50};
    struct judgement j;

    trust_judge(NULL, &w, &j);
    ok(j.accepted, "the first design is accepted");
    w.objective = 109;
    trust_judge(&s, &w, &j);
    ok(j.accepted && fabs(j.ratio - 0.9) < 1e-12, "0.9 of the prediction: accepted");
    near_rel("and the radius grows", trust_radius(&s, &j), 0.45, 1e-12);
    s.rms_step = 0.2;
    s.max_step = 0.3;
    near_rel("but not if the step stayed inside", trust_radius(&s, &j), 0.3, 1e-12);
    s = promise();
    s.radius = s.rms_step = 0.9;
    near_rel("nor beyond its cap", trust_radius(&s, &j), 1, 1e-12);
    s = promise();
    w.objective = 102;
    trust_judge(&s, &w, &j);
    ok(j.accepted, "0.2 of the prediction: accepted");
    near_rel("and the radius shrinks", trust_radius(&s, &j), 0.2, 1e-12);
    w.objective = 100.5;
    trust_judge(&s, &w, &j);
    ok(!j.accepted && j.reason[0] != '\0', "0.05 of the prediction: rejected, %s", j.reason);
    near_rel("and the radius is a third", trust_radius(&s, &j), 0.1, 1e-12);
    /* the merit would rise by 30 for less curvature, but T falls */
    s.weight[0] = 1;
    s.penalty[0] = 30;
    w.objective = 99;
    trust_judge(&s, &w, &j);
    ok(!j.accepted, "T fell: rejected whatever the merit, %s", j.reason);
    w.objective = 101;
    trust_judge(&s, &w, &j);
    near_rel("ratio of merits", j.ratio, 31.0 / 40, 1e-12);
    s = promise();
    s.renew = 1;
    w.objective = 60;
    trust_judge(&s, &w, &j);
    ok(j.accepted && j.renewed, "a renewed design is accepted whatever it is worth");
    near_rel("and the radius stays", trust_radius(&s, &j), 0.3, 1e-12);
    s = promise();
    /* a step that gives up 2 of T for 30 less penalty */
    s.gain = -2;
    s.weight[1] = 1;
    s.penalty[1] = 30;
    w.objective = 98;
    trust_judge(&s, &w, &j);
    ok(j.accepted && fabs(j.ratio - 1) < 1e-12, "T falls as promised for a wall: accepted");
    memcpy(w.failure, "no equilibrium", 15);
    trust_judge(&s, &w, &j);
    ok(!j.accepted && strcmp(j.reason, "no equilibrium") == 0,
       "a failed design is rejected with its reason");
}

static void check_renewal(void)
{
    const struct pm_case c = {.remesh_every = 3};
    struct pm_trial t[4] = {{.accepted = 1}, {.accepted = 1}, {.accepted = 0}, {.accepted = 1}};
    struct pm_step s = promise();
    struct pm_work w = {.objective = 0};
    struct judgement j = {.accepted = 1};
    ok(!trust_renew(&c, t, 1, &j) && !trust_renew(&c, t, 2, &j) && trust_renew(&c, t, 3, &j),
       "every third trial renews the design");
    t[2].renewed = 1;
    ok(!trust_renew(&c, t, 3, &j) && !trust_renew(&c, t, 4, &j), "counted from the last time");
    snprintf(w.failure, sizeof w.failure, "tetmesh: worn mesh: cannot morph");
    trust_judge(&s, &w, &j);
    ok(!j.accepted && j.worn, "a worn mesh");
    t[2].renewed = 0;
    ok(trust_renew(&c, t, 2, &j) == 0 && trust_renew(&c, t, 4, &j), "is renewed unless it was new");
    s.trials = t;
    s.ntrials = 3;
    near_rel("and the radius stays", trust_radius(&s, &j), 0.3, 1e-12);
    s.ntrials = 1;
    near_rel("on a new mesh it shrinks", trust_radius(&s, &j), 0.1, 1e-12);
}

static void check_contact(void)
{
    struct pm_step s = promise();
    int64_t pairs[2] = {0, 3};
    struct pm_work w = {.objective = 109, .ng = 2, .intersections = pairs};
    struct judgement j;

    trust_judge(&s, &w, &j);
    ok(j.accepted, "piercing is ignored");
    s.trial.pcase.contact_rejects = 1;
    trust_judge(&s, &w, &j);
    ok(!j.accepted && strstr(j.reason, "1 of 2 states") != NULL, "rejected: %s", j.reason);
    struct pm_trial before = {.accepted = 1, .gap = -1};
    s.trials = &before;
    s.ntrials = 1;
    trust_judge(&s, &w, &j);
    ok(!j.accepted, "rejected: the last design was wide open");
    before.gap = 0;
    trust_judge(&s, &w, &j);
    ok(j.accepted, "a step from a design that pierced itself");
    s.ntrials = 0;
    pairs[1] = 0;
    trust_judge(&s, &w, &j);
    ok(j.accepted, "accepted without piercing");
}

static void check_verdicts(void)
{
    const struct pm_case c = {.radius = 0.3, .tolerance = 0.01};
    struct pm_trial t[7] = {{0}};
    for (int i = 0; i < 7; i++)
        t[i] = (struct pm_trial){.accepted = 1, .measure = 100 + 0.1 * i, .rms_step = 0.07};
    ok(strcmp(trust_verdict(&c, t, 7, 0.3), "converged") == 0,
       "half a per cent over five accepted trials");
    ok(strcmp(trust_verdict(&c, t, 5, 0.3), "continue") == 0, "five trials are four changes");
    for (int i = 0; i < 7; i++)
        t[i].rms_step = 0.05;
    ok(strcmp(trust_verdict(&c, t, 7, 0.3), "continue") == 0, "steps too short to tell");
    t[6].rms_step = 0.1;
    ok(strcmp(trust_verdict(&c, t, 7, 0.3), "converged") == 0, "just long enough");
    t[3].renewed = 1;
    ok(strcmp(trust_verdict(&c, t, 6, 0.3), "continue") == 0, "a renewal is no trial");
    t[3].renewed = 0;
    t[1].measure = 90;
    ok(strcmp(trust_verdict(&c, t, 7, 0.3), "continue") == 0, "ten per cent");
    t[6].accepted = 0;
    ok(strcmp(trust_verdict(&c, t, 7, 0.002), "stalled") == 0, "a tiny radius");
}

/* 1/2 k |step - to|^2 mass per point as penalty. */
struct bowl {
    ptrdiff_t N;
    const double *mass, *to;
    double k;
};

static double bowl(void *context, const double *step, double *gradient)
{
    const struct bowl *b = context;
    double f = 0;
    for (ptrdiff_t i = 0; i < 3 * b->N; i++) {
        const double d = step[i] - b->to[i], m = b->k * b->mass[i / 3];
        f += m * d * d / 2;
        if (gradient != NULL)
            gradient[i] += m * d;
    }
    return f;
}

/* Points 0 and 1 are mirror images in x, the others have no symmetry; z of point 2 is fixed. */
static void project(void *context, double *v)
{
    (void)context;
    const double x = (v[0] - v[3]) / 2, y = (v[1] + v[4]) / 2, z = (v[2] + v[5]) / 2;
    v[0] = x;
    v[3] = -x;
    v[1] = v[4] = y;
    v[2] = v[5] = z;
    v[8] = 0;
}

static void check_subproblem(void)
{
    enum { N = 6 };
    double mass[N] = {0.1, 0.1, 0.3, 0.2, 0.2, 0.1}, to[3 * (N + 1)] = {0}, G[3 * N],
           step[3 * N] = {0}, want[3 * N];
    struct bowl b = {.N = N, .mass = mass, .to = to, .k = 0};
    struct subproblem s = {.N = N,
                           .gradient = G,
                           .mass = mass,
                           .radius = 0.3,
                           .penalty = bowl,
                           .project = project,
                           .context = &b};

    for (int i = 0; i < 3 * N; i++)
        G[i] = mass[i / 3] * sin(1 + 2.3 * i);
    project(NULL, G);
    ok(subproblem_solve(&s, step, &err) == PM_OK, "linear: solved");
    /* the step is radius M^-1 G/|G|; L-BFGS ends at 1e-3 of the gradient */
    for (int i = 0; i < 3 * N; i++)
        want[i] = s.radius * G[i] / mass[i / 3] / subproblem_dual_norm(&s, G);
    near_array("linear: the step is along M^-1 G", step, want, 3 * N, 5e-3);
    near_rel("linear: on the bound", subproblem_norm(&s, step), s.radius, 1e-9);
    /* a point cut in two, each with half the surface and so half the gradient: all move as before
     */
    double mass2[N + 1], G2[3 * (N + 1)], step2[3 * (N + 1)] = {0};
    struct subproblem two = s;
    memcpy(mass2, mass, sizeof mass);
    memcpy(G2, G, sizeof G);
    mass2[5] = mass2[6] = mass[5] / 2;
    for (int i = 15; i < 21; i++)
        G2[i] = G[15 + i % 3] / 2;
    two.N = N + 1;
    two.mass = mass2;
    two.gradient = G2;
    b.mass = mass2;
    b.N = N + 1;
    ok(subproblem_solve(&two, step2, &err) == PM_OK, "more control points: solved");
    near_array("more control points: the same step", step2, step, 3 * N, 5e-3);
    near_array("more control points: of the new one too", &step2[18], &step[15], 3, 5e-3);
    b.mass = mass;
    b.N = N;
    /* inside the bounds: k M (step - to) = G */
    b.k = 30;
    for (int i = 0; i < 3 * N; i++) {
        to[i] = i == 0 ? 0.1 : i == 3 ? -0.1 : 0;
        want[i] = to[i] + G[i] / mass[i / 3] / b.k;
    }
    memset(step, 0, sizeof step);
    ok(subproblem_solve(&s, step, &err) == PM_OK, "quadratic: solved");
    near_array("quadratic: the minimiser inside the ball", step, want, 3 * N, 5e-3);
    /* one point wants it all: no point moves more than twice the radius */
    b.k = 0;
    memset(G, 0, sizeof G);
    G[15] = 1;
    memset(step, 0, sizeof step);
    mass[5] = 0.01;
    ok(subproblem_solve(&s, step, &err) == PM_OK && fabs(step[15] - 2 * s.radius) < 0.02 * s.radius,
       "a single point moves by twice the radius, %g", step[15]);
    memset(G, 0, sizeof G);
    ok(subproblem_solve(&s, step, &err) == PM_NUMERIC, "no gradient: %s", err.text);
}

int main(void)
{
    check_judgements();
    check_renewal();
    check_contact();
    check_verdicts();
    check_subproblem();
    return tap_done();
}
