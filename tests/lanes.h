/* Batched kernels at one point or element: every lane holds it, lane 5 is read. */
#ifndef TESTS_LANES_H
#define TESTS_LANES_H

#include "common/mechanics/element.h"

enum { LANE = 5, LANES_MOST = 9 * PM_MOST_NODES * (PM_MOST_NODES + 1) / 2 };

static inline const pm_lanes *lanes_of(int n, const double *v, pm_lanes *out)
{
    for (int k = 0; k < n; k++)
        out[k] = pm_lanes_all(v[k]);
    return out;
}

static inline void lanes_pick(int n, const pm_lanes *from, double *to)
{
    for (int k = 0; k < n; k++)
        to[k] = from[k][LANE];
}

static inline double lanes_law_stress(const struct pm_law *law, const double *F, double *P)
{
    pm_lanes f[9], p[9], W;
    pm_law_stress(law, lanes_of(9, F, f), &W, p);
    lanes_pick(9, p, P);
    return W[LANE];
}

static inline void lanes_law_tangent(const struct pm_law *law, const double *F, double *A)
{
    pm_lanes f[9], a[81];
    pm_law_tangent(law, lanes_of(9, F, f), a);
    lanes_pick(81, a, A);
}

static inline void lanes_law_apply(const struct pm_law *law, const double *F, const double *G,
                                   double *AG)
{
    pm_lanes f[9], g[9], a[9];
    pm_law_apply(law, lanes_of(9, F, f), lanes_of(9, G, g), a);
    lanes_pick(9, a, AG);
}

static inline void lanes_law_third(const struct pm_law *law, const double *F, const double *G,
                                   const double *H, double *T)
{
    pm_lanes f[9], g[9], h[9], t[9];
    pm_law_third(law, lanes_of(9, F, f), lanes_of(9, G, g), lanes_of(9, H, h), t);
    lanes_pick(9, t, T);
}

/* One element in all lanes. */
struct lanes_element {
    struct pm_element el;
    int n; /* values of a nodal array */
    pm_lanes dN[3 * PM_MOST_NODES * PM_MOST_POINTS], w[PM_MOST_POINTS],
        phi[PM_MOST_MODES * PM_MOST_POINTS];
};

static inline double lanes_element_set(struct lanes_element *e, const struct pm_element_type *type,
                                       const struct pm_law *law, const double *X)
{
    double low = 0.0;
    for (int l = 0; l < PM_LANES; l++)
        low = pm_element_geometry(type, X, l, e->dN, e->w, e->phi);
    e->el = (struct pm_element){type, law, pm_element_blend(type, law), e->dN, e->w, e->phi};
    e->n = 3 * type->npe;
    return low;
}

static inline double lanes_element_energy(const struct lanes_element *e, const double *u, double *f)
{
    pm_lanes U[3 * PM_MOST_NODES], out[3 * PM_MOST_NODES], E, low;
    pm_element_energy(&e->el, lanes_of(e->n, u, U), f != NULL ? out : NULL, &E, &low);
    if (f != NULL)
        lanes_pick(e->n, out, f);
    return E[LANE];
}

/* K (n x n); mixed or NULL */
static inline void lanes_element_tangent(const struct lanes_element *e, const double *u,
                                         const double *mixed, double *K)
{
    pm_lanes M[PM_MIXED * PM_MOST_POINTS];
    pm_lanes U[3 * PM_MOST_NODES], out[LANES_MOST];
    pm_element_tangent(&e->el, lanes_of(e->n, u, U),
                       mixed != NULL ? lanes_of(PM_MIXED * e->el.type->nq, mixed, M) : NULL, out);
    for (int b = 0, at = 0; b < e->n / 3; b++)
        for (int a = 0; a <= b; a++, at++)
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++)
                    K[e->n * (3 * a + i) + 3 * b + j] = K[e->n * (3 * b + j) + 3 * a + i] =
                        out[9 * at + 3 * i + j][LANE];
}

/* mixed (nq x PM_MIXED) */
static inline void lanes_element_mixed(const struct lanes_element *e, const double *u,
                                       const double *du, double *mixed)
{
    pm_lanes U[3 * PM_MOST_NODES], d[3 * PM_MOST_NODES], out[PM_MIXED * PM_MOST_POINTS];
    pm_element_mixed(&e->el, lanes_of(e->n, u, U), lanes_of(e->n, du, d), out);
    lanes_pick(PM_MIXED * e->el.type->nq, out, mixed);
}

static inline void lanes_element_apply(const struct lanes_element *e, const double *u,
                                       const double *v, double *f)
{
    pm_lanes U[3 * PM_MOST_NODES], d[3 * PM_MOST_NODES], out[3 * PM_MOST_NODES];
    pm_element_apply(&e->el, lanes_of(e->n, u, U), lanes_of(e->n, v, d), out);
    lanes_pick(e->n, out, f);
}

static inline void lanes_element_third(const struct lanes_element *e, const double *u,
                                       const double *v, const double *w, double *f)
{
    pm_lanes U[3 * PM_MOST_NODES], d[3 * PM_MOST_NODES], g[3 * PM_MOST_NODES],
        out[3 * PM_MOST_NODES];
    pm_element_third(&e->el, lanes_of(e->n, u, U), lanes_of(e->n, v, d), lanes_of(e->n, w, g), out);
    lanes_pick(e->n, out, f);
}

/* n = 0 or 1 pair (v, h) */
static inline void lanes_element_shape(const struct lanes_element *e, const double *u,
                                       const double *g, int n, const double *v, const double *h,
                                       double *D)
{
    pm_lanes U[3 * PM_MOST_NODES], G[3 * PM_MOST_NODES],
        V[3 * PM_MOST_NODES] = {{0}}, H[3 * PM_MOST_NODES] = {{0}}, out[3 * PM_MOST_NODES];
    if (n > 0) {
        lanes_of(e->n, v, V);
        lanes_of(e->n, h, H);
    }
    pm_element_shape(&e->el, lanes_of(e->n, u, U), lanes_of(e->n, g, G), n, V, H, out);
    lanes_pick(e->n, out, D);
}

#endif
