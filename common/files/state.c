#include "common/files/state.h"

#include <stdio.h>

#include "common/base/memory.h"
#include "common/files/record.h"

/* The scalars in one table for reading and writing. */
struct scalar {
    const char *name;
    size_t offset;
    int real;
};

#define AT(member) offsetof(struct pm_state, member)

static const struct scalar scalars[] = {
    {"/solve/energy", AT(energy), 1},
    {"/solve/residual", AT(residual), 1},
    {"/solve/min_det_F", AT(min_det_F), 1},
    {"/solve/load_steps", AT(load_steps), 0},
    {"/solve/newton_steps", AT(newton_steps), 0},
    {"/solve/factorisations", AT(factorisations), 0},
    {"/solve/backoffs", AT(backoffs), 0},
    {"/solve/unknowns", AT(unknowns), 0},
    {"/solve/solves", AT(solves), 0},
    {"/solve/factor_entries", AT(factor_entries), 1},
    {"/solve/factor_flops", AT(factor_flops), 1},
    {"/solve/limit", AT(limit), 1},
    {"/solve/stable", AT(stable), 0},
    {"/solve/warm", AT(warm), 0},
    {"/contact/intersections", AT(contact.intersections), 0},
    {"/contact/gap", AT(contact.gap), 1},
    {"/contact/closeness", AT(contact.closeness), 1},
};

enum { NSCALARS = sizeof scalars / sizeof scalars[0] };

static enum pm_status read_load(struct pm_h5 *f, struct pm_state *s, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t d[PM_MAX_RANK] = {0};
    PM_TRY(pm_h5_get_int(f, "/load/form", &s->form, err));
    PM_TRY(pm_h5_get_int(f, "/load/index", &s->load, err));
    if (s->form < 0 || s->form > 1 || s->load < -1)
        PM_TRY(pm_h5_refuse(f, err, "/load/form", "and index are %lld and %lld", (long long)s->form,
                            (long long)s->load));
    if (s->failure[0] != '\0' && !pm_h5_has(f, "/load/pressure"))
        goto done;
    PM_TRY(pm_h5_get(f, "/load/pressure", d, &s->pressure, err));
    if (s->failure[0] == '\0' && d[0] != s->mesh.nc)
        PM_TRY(pm_h5_refuse(f, err, "/load/pressure", "has %td entries for %td chambers", d[0],
                            s->mesh.nc));
done:
    return status;
}

static enum pm_status read_solution(struct pm_h5 *f, struct pm_state *s, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t d[PM_MAX_RANK];
    PM_TRY(pm_h5_get(f, "/node/displacement", d, &s->u, err));
    if (pm_h5_has(f, "/node/bubble")) {
        PM_TRY(pm_h5_get(f, "/node/bubble", d, &s->bubble, err));
        s->nbubble = d[0];
    }
    PM_TRY(pm_h5_get_into(f, "/tip/U", 6, s->U, err));
    PM_TRY(pm_h5_get(f, "/tip/J", d, &s->J, err));
    PM_TRY(pm_h5_get(f, "/chamber/volume", d, &s->volume, err));
    PM_TRY(pm_h5_get(f, "/chamber/volume0", d, &s->volume0, err));
    PM_TRY(pm_h5_get_into(f, "/base/reaction", 6, s->reaction, err));
    PM_TRY(pm_record_get_short(f, "/solve/element", s->element, sizeof s->element, err));
    for (int i = 0; i < NSCALARS; i++)
        PM_TRY(pm_h5_get_into(f, scalars[i].name, 1, (char *)s + scalars[i].offset, err));
    PM_TRY(pm_h5_get_into(f, "/contact/at", 3, s->contact.at, err));
    PM_TRY(pm_h5_get_into(f, "/contact/surface", 2, s->contact.surface, err));
    PM_TRY(pm_check_range(f, "/contact/surface", s->contact.surface, 2, PM_FACE_SYM_Z,
                          s->mesh.nc + 1, err));
done:
    return status;
}

enum pm_status pm_state_read(struct pm_h5 *f, struct pm_state *s, struct pm_err *err)
{
    enum pm_status status;
    *s = (struct pm_state){.form = 0};
    PM_TRY(pm_mesh_read(f, &s->mesh, err));
    memcpy(s->failure, s->mesh.failure, sizeof s->failure);
    PM_TRY(read_load(f, s, err));
    if (s->failure[0] == '\0')
        PM_TRY(read_solution(f, s, err));
done:
    if (status != PM_OK)
        pm_state_release(s);
    return status;
}

enum pm_status pm_state_load(const char *path, int allow_failure, struct pm_state *s,
                             struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *f = NULL;
    *s = (struct pm_state){.form = 0};
    PM_TRY(pm_h5_open(path, "state", &f, err));
    PM_TRY(pm_state_read(f, s, err));
    if (s->failure[0] != '\0' && !allow_failure)
        PM_TRY(pm_record_fail(path, s->failure, err));
done:
    pm_h5_close(f);
    if (status != PM_OK)
        pm_state_release(s);
    return status;
}

static enum pm_status write_solution(struct pm_h5 *f, const struct pm_state *s, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t points[] = {s->mesh.nn, 3}, jacobian[] = {6, s->mesh.nc},
                    bubbles[] = {s->nbubble, 3};
    PM_TRY(pm_h5_put(f, "/node/displacement", points, s->u, err));
    if (s->nbubble > 0)
        PM_TRY(pm_h5_put(f, "/node/bubble", bubbles, s->bubble, err));
    PM_TRY(pm_h5_put(f, "/tip/U", jacobian, s->U, err));
    PM_TRY(pm_h5_put(f, "/tip/J", jacobian, s->J, err));
    PM_TRY(pm_h5_put(f, "/chamber/volume", &s->mesh.nc, s->volume, err));
    PM_TRY(pm_h5_put(f, "/chamber/volume0", &s->mesh.nc, s->volume0, err));
    PM_TRY(pm_h5_put(f, "/base/reaction", jacobian, s->reaction, err));
    PM_TRY(pm_h5_put_text(f, "/solve/element", s->element, err));
    for (int i = 0; i < NSCALARS; i++)
        PM_TRY(pm_h5_put(f, scalars[i].name, NULL, (const char *)s + scalars[i].offset, err));
    PM_TRY(pm_h5_put(f, "/contact/at", (const ptrdiff_t[]){3}, s->contact.at, err));
    PM_TRY(pm_h5_put(f, "/contact/surface", (const ptrdiff_t[]){2}, s->contact.surface, err));
    PM_TRY(pm_h5_vtk_point_field(f, "/node/displacement", "displacement", err));
done:
    return status;
}

/* A failed state keeps its case, its load and the reason. */
static enum pm_status write_failure(struct pm_h5 *f, const struct pm_state *s, struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(pm_h5_put_text(f, "/case/text", s->mesh.pcase.text, err));
    PM_TRY(pm_h5_put_text(f, "/failure", s->failure, err));
done:
    return status;
}

enum pm_status pm_state_write(struct pm_h5 *f, const struct pm_state *s, struct pm_err *err)
{
    enum pm_status status;
    int failed = s->failure[0] != '\0';
    ptrdiff_t nc = failed ? s->mesh.pcase.nchambers : s->mesh.nc;
    PM_TRY(failed ? write_failure(f, s, err) : pm_mesh_write(f, &s->mesh, err));
    PM_TRY(pm_h5_put_int(f, "/load/form", s->form, err));
    PM_TRY(pm_h5_put_int(f, "/load/index", s->load, err));
    if (s->pressure != NULL && nc > 0)
        PM_TRY(pm_h5_put(f, "/load/pressure", &nc, s->pressure, err));
    if (!failed)
        PM_TRY(write_solution(f, s, err));
done:
    return status;
}

void pm_state_release(struct pm_state *s)
{
    pm_free(s->pressure);
    pm_free(s->u);
    pm_free(s->bubble);
    pm_free(s->J);
    pm_free(s->volume);
    pm_free(s->volume0);
    pm_mesh_release(&s->mesh);
    *s = (struct pm_state){.form = 0};
}
