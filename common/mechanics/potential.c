#include <math.h>
#include <string.h>

#include "common/mechanics/model.h"
#include "common/mechanics/tensor.h"

enum { VALUES = 3 * PM_MOST_NODES, FACE_VALUES = 3 * PM_MOST_FACE_NODES };

void pm_gather(const int32_t *nodes, ptrdiff_t n, const double *nodal, double *local)
{
    for (ptrdiff_t a = 0; a < n; a++)
        memcpy(local + 3 * a, nodal + 3 * (ptrdiff_t)nodes[a], 3 * sizeof *local);
}

static void scatter_face(const struct pm_model *m, ptrdiff_t f, double s, const double *local,
                         double *nodal)
{
    const int32_t *t = m->space.tri + m->cavity.n * f;
    for (int a = 0; a < m->cavity.n; a++)
        for (int i = 0; i < 3; i++)
            nodal[3 * (ptrdiff_t)t[a] + i] += s * local[3 * a + i];
}

static void gather_face(const struct pm_model *m, ptrdiff_t f, const double *nodal, double *local)
{
    pm_gather(m->space.tri + m->cavity.n * f, m->cavity.n, nodal, local);
}

void pm_model_face(const struct pm_model *m, const struct pm_config *c, ptrdiff_t f, double *x)
{
    const int32_t *t = m->space.tri + m->cavity.n * f;
    for (int a = 0; a < m->cavity.n; a++)
        for (int i = 0; i < 3; i++) {
            ptrdiff_t k = 3 * (ptrdiff_t)t[a] + i;
            x[3 * a + i] = m->space.x[k] + c->u[k] - (a < 6 ? m->origin[i] : 0.0);
        }
}

/* ---- batches ---- */

struct pm_element pm_model_batch(const struct pm_model *m, ptrdiff_t b)
{
    const struct pm_element_type *t = m->space.type;
    return (struct pm_element){.type = t,
                               .law = &m->law,
                               .blend = m->blend,
                               .dN = m->dN + 3 * t->nq * t->npe * b,
                               .w = m->w + t->nq * b,
                               .phi = m->phi + t->modes * t->nq * b};
}

int pm_model_lanes(const struct pm_model *m, ptrdiff_t b)
{
    ptrdiff_t left = m->space.ne - PM_LANES * b;
    return left < PM_LANES ? (int)left : PM_LANES;
}

void pm_model_gather(const struct pm_model *m, ptrdiff_t b, const double *nodal, pm_lanes *local)
{
    ptrdiff_t npe = m->space.type->npe;
    for (int l = 0; l < PM_LANES; l++) {
        ptrdiff_t e = PM_LANES * b + l < m->space.ne ? PM_LANES * b + l : m->space.ne - 1;
        for (ptrdiff_t a = 0; a < npe; a++)
            for (int i = 0; i < 3; i++)
                local[3 * a + i][l] = nodal[3 * (ptrdiff_t)m->space.tet[npe * e + a] + i];
    }
}

static void scatter(const struct pm_model *m, ptrdiff_t b, const pm_lanes *local, double *nodal)
{
    ptrdiff_t npe = m->space.type->npe;
    for (int l = 0; l < pm_model_lanes(m, b); l++) {
        const int32_t *t = m->space.tet + npe * (PM_LANES * b + l);
        for (ptrdiff_t a = 0; a < npe; a++)
            for (int i = 0; i < 3; i++)
                nodal[3 * (ptrdiff_t)t[a] + i] += local[3 * a + i][l];
    }
}

ptrdiff_t pm_model_chamber(const struct pm_model *m, ptrdiff_t f)
{
    int32_t tag = m->mesh->tri_tag[f];
    return tag >= 1 ? tag - 1 : -1;
}

/* ---- potential, forces ---- */

static double strain_energy(const struct pm_model *m, const struct pm_config *c, double *f,
                            double *min_det)
{
    double sum = 0.0;
    *min_det = INFINITY;
    for (ptrdiff_t b = 0; b < m->nb; b++) {
        struct pm_element el = pm_model_batch(m, b);
        pm_lanes u[VALUES], fe[VALUES], E, low;
        pm_model_gather(m, b, c->u, u);
        pm_element_energy(&el, u, f != NULL ? fe : NULL, &E, &low);
        for (int l = 0; l < pm_model_lanes(m, b); l++) {
            sum += E[l];
            *min_det = fmin(*min_det, low[l]);
        }
        if (!(*min_det > 0.0))
            return INFINITY;
        if (f != NULL)
            scatter(m, b, fe, f);
    }
    return sum;
}

double pm_model_potential(const struct pm_model *m, const struct pm_config *c, const double *p,
                          double *f, double *volume, double *min_det)
{
    const struct pm_mesh *mesh = m->mesh;
    if (f != NULL)
        memset(f, 0, 3 * (size_t)m->nn * sizeof *f);
    if (volume != NULL)
        memset(volume, 0, (size_t)mesh->nc * sizeof *volume);
    double Pi = strain_energy(m, c, f, min_det);
    for (ptrdiff_t k = 0; k < mesh->nf; k++) {
        ptrdiff_t r = pm_model_chamber(m, k);
        double x[FACE_VALUES], g[FACE_VALUES], V = 0.0;
        if (r < 0)
            continue;
        pm_model_face(m, c, k, x);
        pm_cavity_vec(&m->cavity, x, x, g);
        for (int i = 0; i < 3 * m->cavity.n; i++)
            V -= x[i] * g[i] / 6.0;
        Pi -= p[r] * V;
        if (volume != NULL)
            volume[r] += V;
        if (f != NULL)
            scatter_face(m, k, 0.5 * p[r], g, f);
    }
    return Pi;
}

void pm_model_volume_gradient(const struct pm_model *m, const struct pm_config *c, ptrdiff_t r,
                              double *nodal)
{
    memset(nodal, 0, 3 * (size_t)m->nn * sizeof *nodal);
    for (ptrdiff_t k = 0; k < m->space.nf; k++) {
        double x[FACE_VALUES], g[FACE_VALUES];
        if (pm_model_chamber(m, k) != r)
            continue;
        pm_model_face(m, c, k, x);
        pm_cavity_vec(&m->cavity, x, x, g);
        scatter_face(m, k, -0.5, g, nodal);
    }
}

void pm_model_volume_apply(const struct pm_model *m, const struct pm_config *c, ptrdiff_t r,
                           double s, const double *v, double *out)
{
    for (ptrdiff_t k = 0; k < m->space.nf; k++) {
        double x[FACE_VALUES], d[FACE_VALUES], g[FACE_VALUES];
        if (pm_model_chamber(m, k) != r)
            continue;
        pm_model_face(m, c, k, x);
        gather_face(m, k, v, d);
        pm_cavity_vec(&m->cavity, x, d, g);
        scatter_face(m, k, -s, g, out);
    }
}

void pm_model_apply(const struct pm_model *m, const struct pm_config *c, const double *p,
                    const double *v, double *out)
{
    memset(out, 0, 3 * (size_t)m->nn * sizeof *out);
    for (ptrdiff_t b = 0; b < m->nb; b++) {
        struct pm_element el = pm_model_batch(m, b);
        pm_lanes u[VALUES], d[VALUES], f[VALUES];
        pm_model_gather(m, b, c->u, u);
        pm_model_gather(m, b, v, d);
        pm_element_apply(&el, u, d, f);
        scatter(m, b, f, out);
    }
    for (ptrdiff_t r = 0; r < m->mesh->nc; r++)
        pm_model_volume_apply(m, c, r, -p[r], v, out);
}

void pm_model_third(const struct pm_model *m, const struct pm_config *c, const double *p,
                    const double *v, const double *w, double *out)
{
    memset(out, 0, 3 * (size_t)m->nn * sizeof *out);
    for (ptrdiff_t b = 0; b < m->nb; b++) {
        struct pm_element el = pm_model_batch(m, b);
        pm_lanes u[VALUES], d[VALUES], g[VALUES], f[VALUES];
        pm_model_gather(m, b, c->u, u);
        pm_model_gather(m, b, v, d);
        pm_model_gather(m, b, w, g);
        pm_element_third(&el, u, d, g, f);
        scatter(m, b, f, out);
    }
    for (ptrdiff_t k = 0; k < m->space.nf; k++) {
        ptrdiff_t r = pm_model_chamber(m, k);
        double d[FACE_VALUES], g[FACE_VALUES], f[FACE_VALUES];
        if (r < 0 || p[r] == 0.0)
            continue;
        gather_face(m, k, v, d);
        gather_face(m, k, w, g);
        pm_cavity_vec(&m->cavity, d, g, f);
        scatter_face(m, k, p[r], f, out);
    }
}

void pm_model_shape(const struct pm_model *m, const struct pm_config *c, const double *g,
                    ptrdiff_t n, const double *v, const double *h, double *D)
{
    enum { MOST = 8 };
    ptrdiff_t size = 3 * m->space.type->npe;
    memset(D, 0, 3 * (size_t)m->nn * sizeof *D);
    for (ptrdiff_t b = 0; b < m->nb; b++) {
        struct pm_element el = pm_model_batch(m, b);
        pm_lanes u[VALUES], ge[VALUES], ve[VALUES * MOST], he[VALUES * MOST], De[VALUES];
        pm_model_gather(m, b, c->u, u);
        pm_model_gather(m, b, g, ge);
        for (ptrdiff_t k = 0; k < n && k < MOST; k++) {
            pm_model_gather(m, b, v + 3 * k * m->nn, ve + size * k);
            pm_model_gather(m, b, h + 3 * k * m->nn, he + size * k);
        }
        pm_element_shape(&el, u, ge, (int)n, ve, he, De);
        scatter(m, b, De, D);
    }
}

enum pm_status pm_model_mixed_new(const struct pm_model *m, pm_lanes **mixed, struct pm_err *err)
{
    return PM_NEW_LANES(*mixed, PM_MIXED * m->nb * m->space.type->nq, err);
}

void pm_model_mixed(const struct pm_model *m, const struct pm_config *c, const double *du,
                    pm_lanes *mixed)
{
    for (ptrdiff_t b = 0; b < m->nb; b++) {
        struct pm_element el = pm_model_batch(m, b);
        pm_lanes u[VALUES], d[VALUES];
        pm_model_gather(m, b, c->u, u);
        pm_model_gather(m, b, du, d);
        pm_element_mixed(&el, u, d, mixed + PM_MIXED * m->space.type->nq * b);
    }
}
