#include "tools/trstep/secants.h"

#include <string.h>

#include "common/base/memory.h"

static double dot(ptrdiff_t n, const double *a, const double *b)
{
    double sum = 0;
    for (ptrdiff_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

double secants_at(const struct secants *m, const double *d, double factor, double *slope)
{
    double value = 0;
    for (ptrdiff_t k = 0; k < m->count; k++) {
        const double *r = m->r + m->n * k, *z = m->z + m->n * k;
        const double rd = dot(m->n, r, d) / m->zs[k], zd = dot(m->n, z, d) / m->zs[k];
        value += rd * zd * m->zs[k] - m->rs[k] * zd * zd / 2;
        for (ptrdiff_t i = 0; i < m->n && slope != NULL; i++)
            slope[i] += factor * (zd * r[i] + (rd - m->rs[k] * zd / m->zs[k]) * z[i]);
    }
    return value;
}

double secants_value(const struct secants *m, const double *d)
{
    return secants_at(m, d, 0, NULL);
}

enum pm_status secants_new(const struct pm_step *s, const double *mass, struct secants *m,
                           struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const ptrdiff_t n = 3 * s->accepted.offset[s->accepted.ns];

    *m = (struct secants){.n = n};
    PM_TRY(PM_NEW(m->r, s->npairs * n, err));
    PM_TRY(PM_NEW(m->z, s->npairs * n, err));
    PM_TRY(PM_NEW(m->zs, s->npairs, err));
    PM_TRY(PM_NEW(m->rs, s->npairs, err));
    for (ptrdiff_t k = 0; k < s->npairs; k++) {
        const double *step = s->pair_step + n * k;
        double *r = m->r + n * k, *z = m->z + n * k;
        memcpy(r, s->pair_gradient + n * k, (size_t)n * sizeof *r);
        secants_at(m, step, -1, r);
        for (ptrdiff_t i = 0; i < n; i++)
            z[i] = mass[i / 3] * step[i];
        m->zs[k] = dot(n, z, step);
        m->rs[k] = dot(n, r, step);
        m->count++;
    }
done:
    return status;
}

void secants_release(struct secants *m)
{
    pm_free(m->r);
    pm_free(m->z);
    pm_free(m->zs);
    pm_free(m->rs);
    *m = (struct secants){0};
}

enum pm_status secants_collect(const struct pm_step *before, ptrdiff_t most, struct pm_step *s,
                               struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const ptrdiff_t n = 3 * s->accepted.offset[s->accepted.ns];
    double *old = NULL, *now = NULL;
    int moved = 0;

    s->npairs = 0;
    if (before == NULL || most == 0 || 3 * before->accepted.offset[before->accepted.ns] != n)
        return PM_OK;
    PM_TRY(PM_NEW(old, n, err));
    PM_TRY(PM_NEW(now, n, err));
    pm_surfaces_gather(&before->accepted, old);
    pm_surfaces_gather(&s->accepted, now);
    for (ptrdiff_t i = 0; i < n; i++)
        moved |= now[i] != old[i];
    const ptrdiff_t kept = before->npairs < most - moved ? before->npairs : most - moved;
    const ptrdiff_t from = (before->npairs - kept) * n;
    s->npairs = kept + moved;
    PM_TRY(PM_NEW(s->pair_step, s->npairs * n, err));
    PM_TRY(PM_NEW(s->pair_gradient, s->npairs * n, err));
    for (ptrdiff_t i = 0; i < kept * n; i++) {
        s->pair_step[i] = before->pair_step[from + i];
        s->pair_gradient[i] = before->pair_gradient[from + i];
    }
    for (ptrdiff_t i = 0; i < n && moved; i++) {
        s->pair_step[kept * n + i] = now[i] - old[i];
        s->pair_gradient[kept * n + i] = s->gradient[i] - before->gradient[i];
    }
done:
    pm_free(old);
    pm_free(now);
    return status;
}
