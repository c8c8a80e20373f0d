/* synthetic KIND SURF.h5 WORK.h5 SENS.h5: a measure of the surfaces alone with its gradient, in
 * place of equilibria, to drive trstep into its constraints.
 *
 *   volume  volume of the chambers over that of the body: thins every wall
 *   area    area of the chambers [mm2]: folds them
 *
 * Prints on one line: measure, least wall over wall_min, least cap over cap_min, largest curvature
 * over curvature_max, defect of the symmetry [mm], control points, fault or "-". */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/sens.h"
#include "common/files/work.h"
#include "common/geometry/check.h"
#include "common/geometry/curvature.h"
#include "common/geometry/symmetry.h"

static double triple(const double *a, const double *b, const double *c)
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/* Adds factor d(volume or area of surface k)/dphi to g (N x 3); returns the volume or area. */
static double derive(const struct pm_samples *m, const double *phi, ptrdiff_t k, int area,
                     double factor, double *g)
{
    double sum = 0;
    for (ptrdiff_t i = m->first[k]; i < m->first[k + 1]; i++) {
        double r[3], r_a[6], d[3] = {0}, d_a[6], e[3];
        pm_samples_at(m, i, phi, r, r_a, NULL);
        r[2] = 0; /* V = sum w (x, y, 0).(r_1 x r_2)/2 */
        sum += m->w[i] * (area ? pm_area_gradient(r_a, d_a) : triple(r, r_a, r_a + 3) / 2);
        for (int j = 0; j < 3 && !area; j++) {
            memset(e, 0, sizeof e);
            e[j] = 0.5;
            d[j] = j < 2 ? triple(e, r_a, r_a + 3) : 0;
            d_a[j] = triple(r, e, r_a + 3);
            d_a[3 + j] = triple(r, r_a, e);
        }
        for (ptrdiff_t w = m->ptr[i]; w < m->ptr[i + 1]; w++)
            for (int j = 0; j < 3; j++)
                g[3 * m->col[w] + j] +=
                    factor * m->w[i] *
                    (m->c[w] * d[j] + m->c_a[2 * w] * d_a[j] + m->c_a[2 * w + 1] * d_a[3 + j]);
    }
    return sum;
}

static enum pm_status evaluate(const struct pm_surfaces *s, int area, struct pm_sens *to,
                               double *value, struct pm_err *err)
{
    enum pm_status status;
    struct pm_samples m = {0};
    double *phi = NULL;

    PM_TRY(pm_samples_new(s, HUGE_VAL, 2, &m, err));
    PM_TRY(PM_NEW(phi, 3 * s->offset[s->ns], err));
    PM_TRY(PM_NEW(to->gradient, 3 * s->offset[s->ns], err));
    to->N = s->offset[s->ns];
    pm_surfaces_gather(s, phi);
    const double body = area ? 1 : pm_samples_volume(&m, phi, 0);
    *value = 0;
    for (ptrdiff_t k = 1; k < s->ns; k++)
        *value += derive(&m, phi, k, area, 1 / body, to->gradient) / body;
    if (!area)
        derive(&m, phi, 0, 0, -*value / body, to->gradient);
done:
    pm_samples_release(&m);
    pm_free(phi);
    return status;
}

static enum pm_status print(const struct pm_surfaces *s, double value, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_case *c = &s->pcase;
    struct pm_check check;
    double *phi = NULL;

    PM_TRY(pm_surfaces_measure(s, &check, err));
    PM_TRY(PM_NEW(phi, 3 * s->offset[s->ns], err));
    pm_surfaces_gather(s, phi);
    printf("%.9g\t%.4f\t%.4f\t%.4f\t%.2e\t%td\t%s\n", value, check.wall.distance / c->wall_min,
           check.cap / c->cap_min, check.curvature / c->curvature_max, pm_symmetry_defect(s, phi),
           s->offset[s->ns], check.fault[0] != '\0' ? check.fault : "-");
done:
    pm_free(phi);
    return status;
}

static enum pm_status save(const struct pm_surfaces *s, double value, struct pm_sens *sens,
                           char *const paths[2], struct pm_err *err)
{
    enum pm_status status;
    const struct pm_common common = {.tool = "synthetic", .command = "synthetic"};
    struct pm_h5 *f = NULL;
    int64_t zero = 0;
    double point[36] = {0}, wide = -1;
    struct pm_work w = {.pcase = s->pcase,
                        .value = value,
                        .objective = value,
                        .amplification = 1,
                        .name = "2T",
                        .unit = "mm2",
                        .orientation = 1,
                        .quadrature_error = -1,
                        .ng = 1,
                        .nc = 1,
                        .load = &zero,
                        .pressure = point,
                        .U = point,
                        .J = point,
                        .w = &value,
                        .dw_dU = point,
                        .dw_dJ = point,
                        .intersections = &zero,
                        .gap = &wide,
                        .closeness_at = (double[]){0},
                        .dw_dG = (double[]){0}};

    PM_TRY(pm_h5_create(paths[0], "work", &common, NULL, &f, err));
    PM_TRY(pm_work_write(f, &w, err));
    status = pm_h5_commit(f, err);
    f = NULL;
    PM_TRY(status);
    sens->pcase = s->pcase;
    PM_TRY(pm_h5_create(paths[1], "sens", &common, NULL, &f, err));
    PM_TRY(pm_sens_write(f, sens, err));
    status = pm_h5_commit(f, err);
    f = NULL;
done:
    sens->pcase = (struct pm_case){.text = NULL};
    pm_h5_close(f);
    return status;
}

int main(int argc, char **argv)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_surfaces s = {.ns = 0};
    struct pm_sens sens = {.N = 0};
    enum pm_status status = PM_OK;
    double value = 0;

    if (argc != 5 || (strcmp(argv[1], "volume") != 0 && strcmp(argv[1], "area") != 0))
        return PM_USAGE;
    PM_TRY(pm_surfaces_load(argv[2], &s, &err));
    PM_TRY(evaluate(&s, strcmp(argv[1], "area") == 0, &sens, &value, &err));
    PM_TRY(save(&s, value, &sens, argv + 3, &err));
    PM_TRY(print(&s, value, &err));
done:
    if (status != PM_OK)
        fprintf(stderr, "synthetic: %s\n", err.text);
    pm_sens_release(&sens);
    pm_surfaces_release(&s);
    return (int)status;
}
