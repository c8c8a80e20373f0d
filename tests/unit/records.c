/* Every record written and read back; what the readers must refuse. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "tests/records.h"
#include "tests/tap.h"

#define SAME(a, b, n) (memcmp((a), (b), (size_t)(n) * sizeof *(a)) == 0)

static void test_surfaces(const char *path)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_surfaces a, b;
    ok(sample_surfaces(&a, &err) == PM_OK, "sample surfaces %s", err.text);
    ok(sample_write(path, "surface", &a, &err) == PM_OK, "write surfaces %s", err.text);
    if (!ok(pm_surfaces_load(path, &b, &err) == PM_OK, "load surfaces %s", err.text))
        return;
    ok(a.ns == b.ns && a.offset[a.ns] == b.offset[b.ns], "counts");
    for (ptrdiff_t k = 0; k < a.ns; k++) {
        const struct pm_surface *s = &a.s[k], *t = &b.s[k];
        ok(s->type == t->type && s->n == t->n && s->nu == t->nu && s->nv == t->nv &&
               s->nt == t->nt && SAME(s->phi, t->phi, 3 * s->n) &&
               SAME(s->free, t->free, 3 * s->n) && SAME(s->Phi, t->Phi, 3 * s->n) &&
               SAME(s->d0, t->d0, s->n) && SAME(s->tri, t->tri, 3 * s->nt),
           "surface %td comes back", k);
    }
    ok(SAME(a.perm, b.perm, a.pcase.symmetry.nops * a.offset[a.ns]), "orbits come back");
    ok(strcmp(a.pcase.text, b.pcase.text) == 0 && b.pcase.nchambers == 2, "the case comes back");
    double phi[3 * 64] = {0};
    pm_surfaces_gather(&a, phi);
    phi[0] += 1;
    pm_surfaces_scatter(&b, phi);
    ok(b.s[0].phi[0] == a.s[0].phi[0] + 1 && SAME(b.s[2].phi, a.s[2].phi, 3 * a.s[2].n),
       "gather and scatter");
    struct pm_surfaces c;
    ok(pm_surfaces_copy(&a, &c, &err) == PM_OK && SAME(c.s[1].Phi, a.s[1].Phi, 3 * a.s[1].n),
       "copy");
    pm_surfaces_release(&a);
    pm_surfaces_release(&b);
    pm_surfaces_release(&c);
}

static void test_mesh(const char *path)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_mesh a, b;
    ok(sample_mesh(&a, &err) == PM_OK, "sample mesh %s", err.text);
    ok(sample_write(path, "mesh", &a, &err) == PM_OK, "write mesh %s", err.text);
    if (!ok(pm_mesh_load(path, 0, &b, &err) == PM_OK, "load mesh %s", err.text))
        return;
    ok(a.nn == b.nn && a.ne == b.ne && a.nf == b.nf && a.nc == b.nc && a.nw == b.nw && a.N == b.N,
       "counts");
    ok(SAME(a.x, b.x, 3 * a.nn) && SAME(a.x_generated, b.x_generated, 3 * a.nn), "nodes come back");
    ok(SAME(a.tet, b.tet, 10 * a.ne) && SAME(a.tri, b.tri, 6 * a.nf) &&
           SAME(a.tri_tag, b.tri_tag, a.nf),
       "elements come back");
    ok(SAME(a.surface, b.surface, a.nn) && SAME(a.S, b.S, 3 * a.nn), "parameters come back");
    ok(SAME(a.wptr, b.wptr, a.nn + 1) && SAME(a.wcol, b.wcol, a.nw) && SAME(a.wval, b.wval, a.nw),
       "weights come back");
    ok(a.max_damping == b.max_damping && a.min_jacobian == b.min_jacobian && a.coarse == b.coarse &&
           SAME(a.reference_point, b.reference_point, 3) && b.tag == NULL && b.failure[0] == '\0',
       "scalars come back");
    pm_mesh_release(&b);
    struct pm_h5 *f = NULL;
    ptrdiff_t d[PM_MAX_RANK];
    int64_t *vtk = NULL;
    ok(pm_h5_open(path, "mesh", &f, &err) == PM_OK &&
           pm_h5_get(f, "/VTKHDF/Connectivity", d, &vtk, &err) == PM_OK && d[0] == 10 * a.ne &&
           vtk[7] == a.tet[7] && vtk[8] == a.tet[9] && vtk[9] == a.tet[8],
       "VTK numbers the last two nodes the other way round");
    pm_free(vtk);
    pm_h5_close(f);
    memcpy(a.failure, "no mesh today", 14);
    ok(sample_write(path, "mesh", &a, &err) == PM_OK, "write a failure %s", err.text);
    ok(pm_mesh_load(path, 0, &b, &err) == PM_INPUT && strstr(err.text, "no mesh today") != NULL,
       "a recorded failure is refused: %s", err.text);
    err.status = PM_OK;
    ok(pm_mesh_load(path, 1, &b, &err) == PM_OK && strcmp(b.failure, "no mesh today") == 0,
       "or read where that is allowed");
    pm_mesh_release(&a);
    pm_mesh_release(&b);
}

static void test_state(const char *path)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_state a, b;
    ok(sample_state(&a, &err) == PM_OK, "sample state %s", err.text);
    ok(sample_write(path, "state", &a, &err) == PM_OK, "write state %s", err.text);
    if (!ok(pm_state_load(path, 0, &b, &err) == PM_OK, "load state %s", err.text))
        return;
    ok(SAME(a.u, b.u, 3 * a.mesh.nn) && SAME(a.U, b.U, 6) && SAME(a.J, b.J, 6 * a.mesh.nc),
       "fields come back");
    ok(SAME(a.pressure, b.pressure, a.mesh.nc) && SAME(a.volume, b.volume, a.mesh.nc) &&
           SAME(a.volume0, b.volume0, a.mesh.nc) && SAME(a.reaction, b.reaction, 6),
       "chambers come back");
    ok(a.energy == b.energy && a.residual == b.residual && a.min_det_F == b.min_det_F &&
           a.load_steps == b.load_steps && a.newton_steps == b.newton_steps &&
           a.factorisations == b.factorisations && a.backoffs == b.backoffs &&
           a.stable == b.stable && a.warm == b.warm && a.form == b.form && a.load == b.load &&
           strcmp(a.element, b.element) == 0,
       "scalars come back");
    ok(a.contact.intersections == b.contact.intersections && a.contact.gap == b.contact.gap &&
           a.contact.closeness == b.contact.closeness && SAME(a.contact.at, b.contact.at, 3) &&
           SAME(a.contact.surface, b.contact.surface, 2),
       "self-contact comes back");
    pm_state_release(&b);
    struct pm_mesh m;
    ok(pm_mesh_load(path, 0, &m, &err) == PM_OK && SAME(m.x, a.mesh.x, 3 * m.nn),
       "a state is a mesh");
    pm_mesh_release(&m);
    memcpy(a.failure, "buckled", 8);
    ok(sample_write(path, "state", &a, &err) == PM_OK, "write a failure %s", err.text);
    ok(pm_state_load(path, 1, &b, &err) == PM_OK && strcmp(b.failure, "buckled") == 0 &&
           b.load == a.load && SAME(b.pressure, a.pressure, a.mesh.nc),
       "a failed state keeps its load");
    pm_state_release(&a);
    pm_state_release(&b);
}

static void test_sweep(const char *path)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_sweep a, b;
    ok(sample_sweep(&a, &err) == PM_OK, "sample path %s", err.text);
    ok(sample_write(path, "path", &a, &err) == PM_OK, "write path %s", err.text);
    if (!ok(pm_sweep_load(path, &b, &err) == PM_OK, "load path %s", err.text))
        return;
    ok(a.np == b.np && SAME(a.pressure, b.pressure, 6) && SAME(a.U, b.U, 18) &&
           SAME(a.J, b.J, 36) && SAME(a.volume, b.volume, 6) &&
           SAME(a.displacement, b.displacement, 90),
       "fields come back");
    ok(SAME(a.reached, b.reached, 3) && SAME(a.factorisations, b.factorisations, 3) &&
           SAME(a.intersections, b.intersections, 3) && SAME(a.gap, b.gap, 3) &&
           SAME(a.closeness, b.closeness, 3) && SAME(a.energy, b.energy, 3) &&
           SAME(a.residual, b.residual, 3) && SAME(a.min_det_F, b.min_det_F, 3) &&
           strcmp(a.reason, b.reason) == 0 && strcmp(a.element, b.element) == 0,
       "points come back");
    pm_sweep_release(&a);
    pm_sweep_release(&b);
}

static void test_work_and_sens(const char *path)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_work a, b;
    ok(sample_work(&a, &err) == PM_OK, "sample work %s", err.text);
    ok(sample_write(path, "work", &a, &err) == PM_OK, "write work %s", err.text);
    if (!ok(pm_work_load(path, 0, &b, &err) == PM_OK, "load work %s", err.text))
        return;
    ok(a.value == b.value && a.objective == b.objective && a.amplification == b.amplification &&
           a.form == b.form && a.orientation == b.orientation && a.value_other == b.value_other &&
           a.quadrature_error == b.quadrature_error && a.min_det == b.min_det &&
           a.max_det == b.max_det && a.sign_changes == b.sign_changes &&
           strcmp(a.name, b.name) == 0 && strcmp(a.unit, b.unit) == 0,
       "scalars come back");
    ok(a.ng == b.ng && a.nc == b.nc && SAME(a.load, b.load, a.ng) && SAME(a.U, b.U, 6 * a.ng) &&
           SAME(a.J, b.J, 6 * a.ng * a.nc) && SAME(a.w, b.w, a.ng) &&
           SAME(a.dw_dU, b.dw_dU, 6 * a.ng) && SAME(a.dw_dJ, b.dw_dJ, 6 * a.ng * a.nc) &&
           SAME(a.intersections, b.intersections, a.ng) && SAME(a.gap, b.gap, a.ng) &&
           SAME(a.closeness_at, b.closeness_at, a.ng) && SAME(a.dw_dG, b.dw_dG, a.ng) &&
           SAME(a.pressure, b.pressure, a.ng * a.nc),
       "points come back");
    pm_work_release(&a);
    pm_work_release(&b);
    struct pm_sens s, t;
    ok(sample_sens(&s, &err) == PM_OK, "sample sens %s", err.text);
    ok(sample_write(path, "sens", &s, &err) == PM_OK, "write sens %s", err.text);
    ok(pm_sens_load(path, &t, &err) == PM_OK && t.N == s.N &&
           SAME(s.gradient, t.gradient, 3 * s.N) && s.identity_scaling == t.identity_scaling &&
           s.load == t.load,
       "sens comes back %s", err.text);
    pm_sens_release(&s);
    pm_sens_release(&t);
}

static void test_step(const char *path)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_step a, b;
    ok(sample_step(&a, &err) == PM_OK, "sample step %s", err.text);
    a.trial.s[1].phi[0] += 1;
    ok(sample_write(path, "step", &a, &err) == PM_OK, "write step %s", err.text);
    if (!ok(pm_step_load(path, &b, &err) == PM_OK, "load step %s", err.text))
        return;
    ok(SAME(a.trial.s[1].phi, b.trial.s[1].phi, 3 * a.trial.s[1].n) &&
           SAME(a.accepted.s[1].phi, b.accepted.s[1].phi, 3 * a.accepted.s[1].n) &&
           b.trial.s[1].phi[0] == b.accepted.s[1].phi[0] + 1,
       "trial and accepted surfaces come back");
    ok(SAME(a.gradient, b.gradient, 84) && a.value == b.value && a.radius == b.radius &&
           a.gain == b.gain && SAME(a.weight, b.weight, 2) && SAME(a.penalty, b.penalty, 2) &&
           strcmp(a.verdict, b.verdict) == 0,
       "the accepted design comes back");
    ok(b.ntrials == 2 && b.trials[0].accepted == 1 && b.trials[0].measure == 12.5 &&
           b.trials[0].reason[0] == '\0' && b.trials[1].iteration == 1 &&
           b.trials[1].ratio == -0.5 && strcmp(b.trials[1].reason, "no gain") == 0,
       "the history comes back");
    pm_step_release(&b);
    struct pm_surfaces s;
    ok(pm_surfaces_load(path, &s, &err) == PM_OK && s.s[1].phi[0] == a.trial.s[1].phi[0],
       "a step is the surfaces of its trial");
    pm_surfaces_release(&s);
    pm_step_release(&a);
}

int main(void)
{
    char folder[] = "/tmp/pm-records-XXXXXX", path[64];
    if (mkdtemp(folder) == NULL)
        return tap_bail("no temporary folder");
    snprintf(path, sizeof path, "%s/r.h5", folder);
    test_surfaces(path);
    test_mesh(path);
    test_state(path);
    test_sweep(path);
    test_work_and_sens(path);
    test_step(path);
    unlink(path);
    ok(rmdir(folder) == 0, "no temporary is left");
    return tap_done();
}
