#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "tools/pmplot/pmplot.h"

enum { PIECES = 24 }; /* line segments between two states */

/* A state or its image by a symmetry operation, in the two DoFs of the case. */
struct place {
    double p[2]; /* [p/mu] */
    double U[2];
    double J[2][2]; /* dU_i/dp_r */
};

static double det(const double *Q)
{
    return Q[0] * (Q[4] * Q[8] - Q[5] * Q[7]) - Q[1] * (Q[3] * Q[8] - Q[5] * Q[6]) +
           Q[2] * (Q[3] * Q[7] - Q[4] * Q[6]);
}

/* U(Pi p) = Qh U(p), J(Pi p) = Qh J Pi^T, Qh = diag(Q, det(Q) Q). */
static struct place image(const struct pm_state *s, ptrdiff_t g)
{
    const struct pm_case *c = &s->mesh.pcase;
    const double *Q = c->symmetry.Q[g], axial = det(Q);
    const int *to = c->symmetry.chamber[g];
    struct place q = {{0}, {0}, {{0}}};

    for (int r = 0; r < 2; r++)
        q.p[to[r]] = s->pressure[r];
    for (int i = 0; i < 2; i++)
        for (int b = 0; b < 3; b++) {
            const int a = c->dofs[i], row = (a < 3 ? 0 : 3) + b;
            const double f = Q[3 * (a % 3) + b] * (a < 3 ? 1 : axial);
            q.U[i] += f * s->U[row];
            for (int r = 0; r < 2; r++)
                q.J[i][to[r]] += f * s->J[2 * row + r];
        }
    return q;
}

static int same(double a, double b)
{
    return fabs(a - b) < 1e-9;
}

/* The places on the edge p_fixed = level, sorted by the other pressure, each once. */
static ptrdiff_t edge_places(const struct place *all, ptrdiff_t n, int fixed, double level,
                             struct place *out)
{
    ptrdiff_t count = 0;
    for (ptrdiff_t i = 0; i < n; i++) {
        ptrdiff_t at = count;
        if (!same(all[i].p[fixed], level))
            continue;
        while (at > 0 && out[at - 1].p[!fixed] > all[i].p[!fixed] + 1e-9)
            at--;
        if (at > 0 && same(out[at - 1].p[!fixed], all[i].p[!fixed]))
            continue;
        memmove(out + at + 1, out + at, (size_t)(count - at) * sizeof *out);
        out[at] = all[i];
        count++;
    }
    return count;
}

static void print_curve(const struct place *a, const struct place *b, int along)
{
    const double h = b->p[along] - a->p[along];
    for (int k = 0; k < PIECES; k++) {
        const double t = (double)k / PIECES, s = 1 - t;
        for (int i = 0; i < 2; i++)
            printf("%.6f%c",
                   s * s * (1 + 2 * t) * a->U[i] + t * t * (1 + 2 * s) * b->U[i] +
                       s * t * h * (s * a->J[i][along] - t * b->J[i][along]),
                   i == 0 ? ' ' : '\n');
    }
}

/* Counterclockwise in the actuation square: (0,0) (M,0) (M,M) (0,M). */
static enum pm_status print_outline(const struct pm_case *c, const struct place *all, ptrdiff_t n,
                                    struct place *scratch, struct pm_err *err)
{
    static const struct {
        int fixed, high, falling;
    } edge[4] = {{1, 0, 0}, {0, 1, 0}, {1, 1, 1}, {0, 0, 1}};

    puts("# outline");
    for (int e = 0; e < 4; e++) {
        const int along = !edge[e].fixed;
        const ptrdiff_t m =
            edge_places(all, n, edge[e].fixed, edge[e].high ? c->pmax : c->pmin, scratch);
        if (m < 2 || !same(scratch[0].p[along], c->pmin) || !same(scratch[m - 1].p[along], c->pmax))
            return pm_fail(
                err, PM_INPUT,
                "the edge p%d = %g has no states at its corners, expected p%d = %g and %g",
                edge[e].fixed + 1, edge[e].high ? c->pmax : c->pmin, along + 1, c->pmin, c->pmax);
        for (ptrdiff_t k = 0; k + 1 < m; k++) {
            const ptrdiff_t i = edge[e].falling ? m - 1 - k : k,
                            j = edge[e].falling ? i - 1 : i + 1;
            print_curve(&scratch[i], &scratch[j], along);
        }
        if (e == 3)
            printf("%.6f %.6f\n", scratch[0].U[0], scratch[0].U[1]);
    }
    puts("\n");
    return PM_OK;
}

static void print_places(const char *title, const struct place *q, ptrdiff_t n)
{
    printf("# %s: U p\n", title);
    for (ptrdiff_t i = 0; i < n; i++)
        printf("%.6f %.6f %.6g %.6g\n", q[i].U[0], q[i].U[1], q[i].p[0], q[i].p[1]);
    puts("\n");
}

enum pm_status pmplot_workspace(const struct pm_state *states, ptrdiff_t n, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_case *c = &states[0].mesh.pcase;
    struct place *all = NULL, *scratch = NULL;
    ptrdiff_t count = 0;

    if (c->nchambers != 2 || c->ndofs != 2)
        PM_TRY(pm_fail(err, PM_INPUT, "case '%s' has %td chambers and %d DoFs, expected 2 and 2",
                       c->name, c->nchambers, c->ndofs));
    PM_TRY(PM_NEW(all, n * c->symmetry.nops, err));
    PM_TRY(PM_NEW(scratch, n * c->symmetry.nops, err));
    for (ptrdiff_t g = 0; g < c->symmetry.nops; g++)
        for (ptrdiff_t i = 0; i < n && same(c->symmetry.Q[g][8], 1); i++) { /* keeps the base */
            if (strcmp(states[i].mesh.pcase.text, c->text) != 0)
                PM_TRY(pm_fail(err, PM_INPUT, "the states belong to different cases"));
            all[count++] = image(&states[i], g);
        }
    PM_TRY(print_outline(c, all, count, scratch, err));
    print_places("states", all, n);
    print_places("images", all + n, count - n);
done:
    pm_free(all);
    pm_free(scratch);
    return status;
}
