#include "common/actuation/lattice.h"

#include <math.h>
#include <string.h>

#include "common/actuation/loads.h"
#include "common/actuation/measure.h"
#include "common/base/memory.h"

enum { MAX_STEPS = 100 };

enum pm_status pm_lattice_make(const struct pm_case *c, double interval, struct pm_lattice *l,
                               struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(pm_measure_check(c, PM_FORM_BOUNDARY, err));
    if (c->nchambers != 2 && c->nchambers != 3)
        PM_TRY(pm_fail(err, PM_INPUT, "a dense workspace of %td chambers, expected 2 or 3",
                       c->nchambers));
    const double range = c->pmax - c->pmin;
    /* the slack forgives rounding of a range that is a multiple */
    const double pairs = ceil(range / interval / 2 * (1 - 1e-9));
    if (!(interval > 0) || !(2 * pairs <= MAX_STEPS))
        PM_TRY(pm_fail(err, PM_INPUT,
                       "an interval of %g in a range of pressures of %g, expected at least %g",
                       interval, range, range / MAX_STEPS));
    *l = (struct pm_lattice){.n = (int)c->nchambers,
                             .steps = 2 * (int)pairs,
                             .path = strcmp(c->measure, "2R") == 0,
                             .low = c->pmin,
                             .high = c->pmax,
                             .size = 1};
    for (int r = 0; r < l->n; r++)
        l->size *= l->steps + 1;
done:
    return status;
}

static void unpack(const struct pm_lattice *l, ptrdiff_t id, int *k)
{
    for (int r = l->n - 1; r >= 0; r--) {
        k[r] = (int)(id % (l->steps + 1));
        id /= l->steps + 1;
    }
}

static ptrdiff_t pack(const struct pm_lattice *l, const int *k)
{
    ptrdiff_t id = 0;
    for (int r = 0; r < l->n; r++)
        id = id * (l->steps + 1) + k[r];
    return id;
}

ptrdiff_t pm_lattice_center(const struct pm_lattice *l)
{
    return l->size / 2;
}

int pm_lattice_has(const struct pm_lattice *l, ptrdiff_t id)
{
    int k[PM_MAX_CHAMBERS], low = 0, high = 0;
    unpack(l, id, k);
    for (int r = 0; r < l->n; r++) {
        low += k[r] == 0;
        high += k[r] == l->steps;
    }
    if (l->path)
        return (low > 0 && high > 0 && low + high >= 2) || id == pm_lattice_center(l);
    return low + high > 0;
}

void pm_lattice_pressure(const struct pm_lattice *l, ptrdiff_t id, double *p)
{
    int k[PM_MAX_CHAMBERS];
    unpack(l, id, k);
    for (int r = 0; r < l->n; r++)
        p[r] = k[r] == l->steps ? l->high : l->low + k[r] * (l->high - l->low) / l->steps;
}

ptrdiff_t pm_lattice_find(const struct pm_lattice *l, const double *p)
{
    int k[PM_MAX_CHAMBERS];
    for (int r = 0; r < l->n; r++) {
        const double at = (p[r] - l->low) / (l->high - l->low) * l->steps;
        if (!(fabs(at - round(at)) < 1e-6) || at < -0.5 || at > l->steps + 0.5)
            return -1; /* pressures pass through text */
        k[r] = (int)round(at);
    }
    const ptrdiff_t id = pack(l, k);
    return pm_lattice_has(l, id) ? id : -1;
}

int pm_lattice_symmetry(const struct pm_case *c, ptrdiff_t g)
{
    return g == 0 || (!c->full_set && fabs(c->symmetry.Q[g][8] - 1) < 1e-9 &&
                      fabs(c->symmetry.t[g][2]) < 1e-9);
}

ptrdiff_t pm_lattice_image(const struct pm_case *c, const struct pm_lattice *l, ptrdiff_t g,
                           ptrdiff_t id)
{
    int k[PM_MAX_CHAMBERS], image[PM_MAX_CHAMBERS];
    unpack(l, id, k);
    for (int r = 0; r < l->n; r++)
        image[c->symmetry.chamber[g][r]] = k[r];
    return pack(l, image);
}

static int is_first(const struct pm_case *c, const struct pm_lattice *l, ptrdiff_t id)
{
    for (ptrdiff_t g = 1; g < c->symmetry.nops; g++)
        if (pm_lattice_symmetry(c, g) && pm_lattice_image(c, l, g, id) < id)
            return 0;
    return 1;
}

static double apart(const struct pm_lattice *l, ptrdiff_t a, const double *p)
{
    double q[PM_MAX_CHAMBERS], sum = 0;
    pm_lattice_pressure(l, a, q);
    for (int r = 0; r < l->n; r++)
        sum += (q[r] - p[r]) * (q[r] - p[r]);
    return sum;
}

enum pm_status pm_lattice_walk(const struct pm_case *c, const struct pm_lattice *l, ptrdiff_t **ids,
                               ptrdiff_t *n, struct pm_err *err)
{
    double p[PM_MAX_CHAMBERS] = {0};
    ptrdiff_t *list = pm_calloc(l->size, sizeof *list, err), count = 0;

    if (list == NULL)
        return PM_SYSTEM;
    for (ptrdiff_t id = 0; id < l->size; id++)
        if (pm_lattice_has(l, id) && is_first(c, l, id))
            list[count++] = id;
    for (ptrdiff_t i = 0; i < count; i++) {
        ptrdiff_t best = i;
        for (ptrdiff_t j = i + 1; j < count; j++)
            if (apart(l, list[j], p) < apart(l, list[best], p) * (1 - 1e-9))
                best = j;
        const ptrdiff_t next = list[best];
        memmove(list + i + 1, list + i, (size_t)(best - i) * sizeof *list);
        list[i] = next;
        pm_lattice_pressure(l, next, p);
    }
    *ids = list;
    *n = count;
    return PM_OK;
}

int pm_lattice_sides(const struct pm_lattice *l)
{
    return l->path ? 6 : 2 * l->n;
}

struct pm_lattice_side pm_lattice_side(const struct pm_lattice *l, int s)
{
    const int n = l->n, r = s / 2, sign = s % 2 ? 1 : -1;
    ptrdiff_t unit[PM_MAX_CHAMBERS];
    struct pm_lattice_side side = {.face = r, .sign = sign, .axes = n - 1};

    unit[n - 1] = 1;
    for (int k = n - 1; k > 0; k--)
        unit[k - 1] = unit[k] * (l->steps + 1);
    if (l->path) {
        const struct pm_edge e = pm_load_edge(s);
        side = (struct pm_lattice_side){.face = e.varying, .sign = e.sign, .axes = 1};
        side.origin = l->steps * (unit[e.high] + (e.sign < 0 ? unit[e.varying] : 0));
        side.stride[0] = e.sign * unit[e.varying];
        return side;
    }
    side.origin = sign > 0 ? l->steps * unit[r] : 0;
    if (n == 2) { /* p_1 = pmax and p_2 = pmin rise */
        const int rises = (r == 0) == (sign > 0);
        side.stride[0] = rises ? unit[1 - r] : -unit[1 - r];
        side.origin += rises ? 0 : l->steps * unit[1 - r];
        return side;
    }
    side.stride[0] = unit[(r + (sign > 0 ? 1 : 2)) % 3];
    side.stride[1] = unit[(r + (sign > 0 ? 2 : 1)) % 3];
    return side;
}
