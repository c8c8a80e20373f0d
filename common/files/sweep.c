#include "common/files/sweep.h"

#include "common/base/memory.h"
#include "common/files/record.h"

/* The arrays in one table for memory, reading and writing. */
struct array {
    const char *name;
    size_t offset; /* of the pointer in struct pm_sweep */
    int rank, integer;
};

#define AT(member) offsetof(struct pm_sweep, member)

static const struct array arrays[] = {
    {"/path/pressure", AT(pressure), 2, 0},
    {"/path/reached", AT(reached), 1, 1},
    {"/path/U", AT(U), 2, 0},
    {"/path/J", AT(J), 3, 0},
    {"/path/volume", AT(volume), 2, 0},
    {"/path/energy", AT(energy), 1, 0},
    {"/path/residual", AT(residual), 1, 0},
    {"/path/min_det_F", AT(min_det_F), 1, 0},
    {"/path/factorisations", AT(factorisations), 1, 1},
    {"/path/intersections", AT(intersections), 1, 1},
    {"/path/gap", AT(gap), 1, 0},
    {"/path/closeness", AT(closeness), 1, 0},
    {"/path/displacement", AT(displacement), 3, 0},
};

enum { NARRAYS = sizeof arrays / sizeof arrays[0] };

static void **member(struct pm_sweep *s, int k)
{
    return (void **)(void *)((char *)s + arrays[k].offset);
}

/* Shape of array k. */
static void shape(const struct pm_sweep *s, int k, ptrdiff_t d[3])
{
    const size_t at = arrays[k].offset;
    d[0] = s->np;
    d[1] = at == AT(U) || at == AT(J) ? 6 : at == AT(displacement) ? s->mesh.nn : s->mesh.nc;
    d[2] = at == AT(displacement) ? 3 : s->mesh.nc;
}

enum pm_status pm_sweep_allocate(struct pm_sweep *s, ptrdiff_t np, struct pm_err *err)
{
    s->np = np;
    for (int k = 0; k < NARRAYS; k++) {
        ptrdiff_t d[3], n = np;
        shape(s, k, d);
        for (int r = 1; r < arrays[k].rank; r++)
            n *= d[r];
        *member(s, k) = pm_calloc(n, arrays[k].integer ? sizeof(int64_t) : sizeof(double), err);
        if (*member(s, k) == NULL)
            return PM_SYSTEM;
    }
    return PM_OK;
}

static enum pm_status read_sweep(struct pm_h5 *f, struct pm_sweep *s, struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(pm_mesh_read(f, &s->mesh, err));
    PM_TRY(pm_record_get_short(f, "/solve/element", s->element, sizeof s->element, err));
    PM_TRY(pm_h5_get_text(f, "/path/reason", &s->reason, err));
    for (int k = 0; k < NARRAYS; k++) {
        ptrdiff_t d[PM_MAX_RANK];
        PM_TRY(pm_h5_get(f, arrays[k].name, d, (void *)member(s, k), err));
        if (k == 0 && d[1] != s->mesh.nc)
            PM_TRY(pm_h5_refuse(f, err, "/path/pressure",
                                "has %td entries a point for %td chambers", d[1], s->mesh.nc));
        s->np = d[0];
    }
done:
    return status;
}

enum pm_status pm_sweep_load(const char *path, struct pm_sweep *s, struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *f = NULL;
    *s = (struct pm_sweep){.np = 0};
    PM_TRY(pm_h5_open(path, "path", &f, err));
    PM_TRY(read_sweep(f, s, err));
done:
    pm_h5_close(f);
    if (status != PM_OK)
        pm_sweep_release(s);
    return status;
}

enum pm_status pm_sweep_write(struct pm_h5 *f, const struct pm_sweep *s, struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(pm_mesh_write(f, &s->mesh, err));
    PM_TRY(pm_h5_put_text(f, "/solve/element", s->element, err));
    PM_TRY(pm_h5_put_text(f, "/path/reason", s->reason, err));
    for (int k = 0; k < NARRAYS; k++) {
        ptrdiff_t d[3];
        shape(s, k, d);
        const char *at = (const char *)s + arrays[k].offset;
        PM_TRY(pm_h5_put(f, arrays[k].name, d, *(void *const *)(const void *)at, err));
    }
done:
    return status;
}

void pm_sweep_release(struct pm_sweep *s)
{
    for (int k = 0; k < NARRAYS; k++)
        pm_free(*member(s, k));
    pm_free(s->reason);
    pm_mesh_release(&s->mesh);
    *s = (struct pm_sweep){.np = 0};
}
