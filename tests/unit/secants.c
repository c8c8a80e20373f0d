/* The curvature of the model: exact along the last step, symmetric, equal to its own gradient; what
 * is remembered. */
#include <string.h>

#include "common/base/memory.h"
#include "tests/robot.h"
#include "tests/tap.h"
#include "tools/trstep/secants.h"

static struct pm_err err;

static double dot(ptrdiff_t n, const double *a, const double *b)
{
    double sum = 0;
    for (ptrdiff_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Three pairs of the quadratic function of the matrix diag + u u'. */
static void fill(struct pm_step *s, ptrdiff_t n, const double *diag, const double *u)
{
    for (ptrdiff_t k = 0; k < s->npairs; k++) {
        double *step = s->pair_step + n * k, *y = s->pair_gradient + n * k;
        for (ptrdiff_t i = 0; i < n; i++)
            step[i] = sin(0.7 * (double)i + 2 * (double)k);
        for (ptrdiff_t i = 0; i < n; i++)
            y[i] = diag[i] * step[i] + u[i] * dot(n, u, step);
    }
}

static void check_model(const struct pm_surfaces *r)
{
    const ptrdiff_t n = 3 * r->offset[r->ns];
    struct pm_step s = {.accepted = *r, .npairs = 3};
    struct secants m = {.n = 0};
    double *mass, *diag, *u, *a, *b, *Ba, *Bb;
    if (PM_NEW(s.pair_step, 3 * n, &err) != PM_OK ||
        PM_NEW(s.pair_gradient, 3 * n, &err) != PM_OK || PM_NEW(mass, n / 3, &err) != PM_OK ||
        PM_NEW(diag, 6 * n, &err) != PM_OK)
        return;
    u = diag + n;
    a = u + n;
    b = a + n;
    Ba = b + n;
    Bb = Ba + n;
    for (ptrdiff_t i = 0; i < n; i++) {
        const ptrdiff_t point = i / 3;
        mass[point] = 1 + 0.5 * sin((double)point);
        diag[i] = cos((double)i);
        u[i] = sin(3 * (double)i);
        a[i] = cos(5 * (double)i);
        b[i] = s.pair_step[i];
    }
    fill(&s, n, diag, u);
    ok(secants_new(&s, mass, &m, &err) == PM_OK && m.count == 3, "three pairs %s", err.text);
    const double *last = s.pair_step + 2 * n, *y = s.pair_gradient + 2 * n;
    secants_at(&m, last, 1, Bb);
    near_array("B s = y for the last pair", Bb, y, n, 1e-12);
    near_rel("and s.y/2", secants_value(&m, last), dot(n, last, y) / 2, 1e-12);
    const double value = secants_at(&m, a, 1, Ba);
    near_rel("value = a.B a/2", value, dot(n, a, Ba) / 2, 1e-12);
    near_rel("symmetric", dot(n, a, Bb), dot(n, last, Ba), 1e-11);
    secants_release(&m);
    s.npairs = 0;
    ok(secants_new(&s, mass, &m, &err) == PM_OK && secants_value(&m, a) == 0, "none without pairs");
    secants_release(&m);
    pm_free(mass);
    pm_free(diag);
    pm_free(s.pair_step);
    pm_free(s.pair_gradient);
}

/* Seven accepted steps, each by 1 in all coordinates of the chamber, at most three remembered. */
static void check_memory(const struct pm_surfaces *r)
{
    const ptrdiff_t n = 3 * r->offset[r->ns];
    struct pm_step before = {.ntrials = 0}, s = {.ntrials = 0};
    for (int k = 0; k < 7; k++) {
        s = (struct pm_step){.ntrials = 0};
        if (pm_surfaces_copy(r, &s.accepted, &err) != PM_OK || PM_NEW(s.gradient, n, &err) != PM_OK)
            return;
        for (ptrdiff_t i = 0; i < 3 * s.accepted.s[1].n; i++)
            s.accepted.s[1].phi[i] += k;
        for (ptrdiff_t i = 0; i < n; i++)
            s.gradient[i] = k * k;
        if (secants_collect(k > 0 ? &before : NULL, 3, &s, &err) != PM_OK)
            ok(0, "%s", err.text);
        ok(s.npairs == (k < 3 ? k : 3), "%d steps: %td pairs", k, s.npairs);
        pm_step_release(&before);
        before = s;
    }
    const ptrdiff_t c = 3 * r->offset[1];
    near_abs("the step", s.pair_step[2 * n + c], 1, 1e-12);
    near_abs("of the chamber alone", s.pair_step[2 * n], 0, 0);
    near_abs("change of the gradient, the last", s.pair_gradient[2 * n], 36 - 25, 0);
    near_abs("and the first", s.pair_gradient[0], 16 - 9, 0);
    struct pm_step same = {.ntrials = 0};
    ok(pm_surfaces_copy(&s.accepted, &same.accepted, &err) == PM_OK &&
           secants_collect(&s, 3, &same, &err) == PM_OK && same.npairs == 3,
       "a rejected trial keeps them");
    pm_step_release(&same);
    pm_step_release(&s);
}

int main(void)
{
    struct pm_surfaces r = {0};
    const struct robot_chamber chamber = {{5, 0, 50}, {8, 11, 40}, 0.3};
    if (robot_init(&r, 20, 100, 1, &chamber, &err) != PM_OK ||
        pm_case_parse("[case]\nname = robot\n[material]\nmu = 0.5\n", "robot", &r.pcase, &err) !=
            PM_OK)
        return tap_bail("%s", err.text);
    if (PM_NEW(r.perm, r.offset[r.ns], &err) != PM_OK)
        return tap_bail("%s", err.text);
    for (ptrdiff_t i = 0; i < r.offset[r.ns]; i++)
        r.perm[i] = (int32_t)i;
    check_model(&r);
    check_memory(&r);
    pm_surfaces_release(&r);
    return tap_done();
}
