#include "common/files/surfaces.h"

#include <stdio.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/record.h"

enum { NAME = 64 };

static const char *member(char name[NAME], const char *at, ptrdiff_t k, const char *what)
{
    snprintf(name, NAME, "%s/surface%td/%s", at, k, what);
    return name;
}

static const char *perm_name(char name[NAME], const char *at)
{
    snprintf(name, NAME, "%s/symmetry/perm", at);
    return name;
}

static enum pm_status check_surface(struct pm_h5 *f, const char *at, ptrdiff_t k,
                                    const struct pm_surface *s, struct pm_err *err)
{
    char name[NAME];
    if (s->type != PM_SURFACE_BSPLINE && s->type != PM_SURFACE_SPHERE)
        return pm_h5_refuse(f, err, member(name, at, k, "type"), "is %d, expected 0 or 1", s->type);
    if (s->n < 1)
        return pm_h5_refuse(f, err, member(name, at, k, "phi"), "has no control points");
    int tube = s->type == PM_SURFACE_BSPLINE;
    if (tube && (s->nu < 4 || s->nv < 4 || s->n % s->nu != 0 || s->n / s->nu != s->nv))
        return pm_h5_refuse(f, err, member(name, at, k, "nu"),
                            "and nv are %td and %td for %td control points", s->nu, s->nv, s->n);
    for (ptrdiff_t i = 0; i < s->n && !tube; i++)
        if (!(s->d0[i] > 0))
            return pm_h5_refuse(f, err, member(name, at, k, "d0"),
                                "is %g at entry %td, expected > 0", s->d0[i], i);
    for (ptrdiff_t i = 0; i < 3 * s->n; i++)
        if (s->free[i] > 1)
            return pm_h5_refuse(f, err, member(name, at, k, "free"),
                                "is %d at entry %td, expected 0 or 1", s->free[i], i);
    return pm_check_range(f, member(name, at, k, "tri"), s->tri, 3 * s->nt, 0, s->n, err);
}

static enum pm_status read_surface(struct pm_h5 *f, const char *at, ptrdiff_t k,
                                   struct pm_surface *s, struct pm_err *err)
{
    enum pm_status status;
    char name[NAME];
    ptrdiff_t d[PM_MAX_RANK];
    int64_t type, nu, nv;
    PM_TRY(pm_h5_get_int(f, member(name, at, k, "type"), &type, err));
    PM_TRY(pm_h5_get_int(f, member(name, at, k, "nu"), &nu, err));
    PM_TRY(pm_h5_get_int(f, member(name, at, k, "nv"), &nv, err));
    s->type = (int32_t)(type < 0 || type > 1 ? -1 : type);
    s->nu = (ptrdiff_t)nu;
    s->nv = (ptrdiff_t)nv;
    PM_TRY(pm_h5_get(f, member(name, at, k, "phi"), d, &s->phi, err));
    s->n = d[0];
    PM_TRY(pm_h5_get(f, member(name, at, k, "free"), d, &s->free, err));
    PM_TRY(pm_h5_get(f, member(name, at, k, "Phi"), d, &s->Phi, err));
    PM_TRY(pm_h5_get(f, member(name, at, k, "d0"), d, &s->d0, err));
    PM_TRY(pm_h5_get(f, member(name, at, k, "tri"), d, &s->tri, err));
    s->nt = d[0];
    PM_TRY(pm_h5_get_into(f, member(name, at, k, "spacing"), 2, s->spacing, err));
    PM_TRY(check_surface(f, at, k, s, err));
done:
    return status;
}

static enum pm_status fill_offsets(struct pm_surfaces *s, struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(PM_NEW(s->offset, s->ns + 1, err));
    for (ptrdiff_t k = 0; k < s->ns; k++)
        s->offset[k + 1] = s->offset[k] + s->s[k].n;
done:
    return status;
}

/* Each operation is a bijection, the first one the identity. */
static enum pm_status check_perm(struct pm_h5 *f, const char *item, const struct pm_surfaces *s,
                                 ptrdiff_t nops, ptrdiff_t N, struct pm_err *err)
{
    enum pm_status status;
    uint8_t *hit = NULL;
    if (nops != s->pcase.symmetry.nops || N != s->offset[s->ns])
        return pm_h5_refuse(f, err, item, "is %td x %td, expected %td x %td", nops, N,
                            s->pcase.symmetry.nops, s->offset[s->ns]);
    PM_TRY(pm_check_range(f, item, s->perm, nops * N, 0, N, err));
    PM_TRY(PM_NEW(hit, nops * N, err));
    for (ptrdiff_t i = 0; i < nops * N; i++) {
        ptrdiff_t target = i / N * N + s->perm[i];
        if (hit[target] || (i < N && s->perm[i] != i))
            PM_TRY(pm_h5_refuse(f, err, item,
                                "is no permutation at entry %td (the first one "
                                "must be the identity)",
                                i));
        hit[target] = 1;
    }
done:
    pm_free(hit);
    return status;
}

enum pm_status pm_surfaces_read_at(struct pm_h5 *f, const char *at, struct pm_surfaces *s,
                                   struct pm_err *err)
{
    enum pm_status status;
    char name[NAME];
    ptrdiff_t d[PM_MAX_RANK];
    *s = (struct pm_surfaces){.ns = 0};
    PM_TRY(pm_record_get_case(f, &s->pcase, err));
    PM_TRY(PM_NEW(s->s, s->pcase.nchambers + 1, err));
    s->ns = s->pcase.nchambers + 1;
    for (ptrdiff_t k = 0; k < s->ns; k++)
        PM_TRY(read_surface(f, at, k, &s->s[k], err));
    PM_TRY(fill_offsets(s, err));
    PM_TRY(pm_h5_get(f, perm_name(name, at), d, &s->perm, err));
    PM_TRY(check_perm(f, name, s, d[0], d[1], err));
    PM_TRY(pm_h5_get_into(f, "/tip/reference_point", 3, s->reference_point, err));
done:
    if (status != PM_OK)
        pm_surfaces_release(s);
    return status;
}

enum pm_status pm_surfaces_read(struct pm_h5 *f, struct pm_surfaces *s, struct pm_err *err)
{
    return pm_surfaces_read_at(f, "", s, err);
}

enum pm_status pm_surfaces_load(const char *path, struct pm_surfaces *s, struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *f = NULL;
    *s = (struct pm_surfaces){.ns = 0};
    PM_TRY(pm_h5_open(path, "surface step", &f, err));
    PM_TRY(pm_surfaces_read(f, s, err));
done:
    pm_h5_close(f);
    return status;
}

static enum pm_status write_surface(struct pm_h5 *f, const char *at, ptrdiff_t k,
                                    const struct pm_surface *s, struct pm_err *err)
{
    enum pm_status status;
    char name[NAME];
    PM_TRY(pm_h5_put_int(f, member(name, at, k, "type"), s->type, err));
    PM_TRY(pm_h5_put_int(f, member(name, at, k, "nu"), s->nu, err));
    PM_TRY(pm_h5_put_int(f, member(name, at, k, "nv"), s->nv, err));
    const ptrdiff_t points[] = {s->n, 3}, triangles[] = {s->nt, 3}, two = 2;
    PM_TRY(pm_h5_put(f, member(name, at, k, "phi"), points, s->phi, err));
    PM_TRY(pm_h5_put(f, member(name, at, k, "free"), points, s->free, err));
    PM_TRY(pm_h5_put(f, member(name, at, k, "Phi"), points, s->Phi, err));
    PM_TRY(pm_h5_put(f, member(name, at, k, "d0"), points, s->d0, err));
    PM_TRY(pm_h5_put(f, member(name, at, k, "tri"), triangles, s->tri, err));
    PM_TRY(pm_h5_put(f, member(name, at, k, "spacing"), &two, s->spacing, err));
done:
    return status;
}

enum pm_status pm_surfaces_write_at(struct pm_h5 *f, const char *at, const struct pm_surfaces *s,
                                    struct pm_err *err)
{
    enum pm_status status;
    char name[NAME];
    for (ptrdiff_t k = 0; k < s->ns; k++)
        PM_TRY(write_surface(f, at, k, &s->s[k], err));
    const ptrdiff_t d[] = {s->pcase.symmetry.nops, s->offset[s->ns]};
    PM_TRY(pm_h5_put(f, perm_name(name, at), d, s->perm, err));
done:
    return status;
}

enum pm_status pm_surfaces_write(struct pm_h5 *f, const struct pm_surfaces *s, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t three = 3;
    PM_TRY(pm_h5_put_text(f, "/case/text", s->pcase.text, err));
    PM_TRY(pm_h5_put(f, "/tip/reference_point", &three, s->reference_point, err));
    PM_TRY(pm_surfaces_write_at(f, "", s, err));
done:
    return status;
}

enum pm_status pm_surface_new(int32_t type, ptrdiff_t n, ptrdiff_t nt, struct pm_surface *s,
                              struct pm_err *err)
{
    enum pm_status status;
    *s = (struct pm_surface){.type = type, .n = n, .nt = nt};
    PM_TRY(PM_NEW(s->phi, 3 * n, err));
    PM_TRY(PM_NEW(s->free, 3 * n, err));
    PM_TRY(PM_NEW(s->Phi, 3 * n, err));
    PM_TRY(PM_NEW(s->d0, n, err));
    PM_TRY(PM_NEW(s->tri, 3 * nt, err));
    memset(s->free, 1, 3 * (size_t)n);
done:
    return status;
}

enum pm_status pm_surface_copy(const struct pm_surface *a, struct pm_surface *b, struct pm_err *err)
{
    enum pm_status status;
    *b = (struct pm_surface){.type = a->type, .n = a->n, .nu = a->nu, .nv = a->nv, .nt = a->nt};
    memcpy(b->spacing, a->spacing, sizeof b->spacing);
    PM_TRY(pm_copy_array(&b->phi, a->phi, 3 * a->n, sizeof *a->phi, err));
    PM_TRY(pm_copy_array(&b->free, a->free, 3 * a->n, sizeof *a->free, err));
    PM_TRY(pm_copy_array(&b->Phi, a->Phi, 3 * a->n, sizeof *a->Phi, err));
    PM_TRY(pm_copy_array(&b->d0, a->d0, a->n, sizeof *a->d0, err));
    PM_TRY(pm_copy_array(&b->tri, a->tri, 3 * a->nt, sizeof *a->tri, err));
done:
    return status;
}

enum pm_status pm_surfaces_copy(const struct pm_surfaces *from, struct pm_surfaces *to,
                                struct pm_err *err)
{
    enum pm_status status;
    *to = (struct pm_surfaces){.ns = 0};
    ptrdiff_t count = from->pcase.symmetry.nops * from->offset[from->ns];
    PM_TRY(pm_case_copy(&from->pcase, &to->pcase, err));
    PM_TRY(PM_NEW(to->s, from->ns, err));
    to->ns = from->ns;
    for (ptrdiff_t k = 0; k < from->ns; k++)
        PM_TRY(pm_surface_copy(&from->s[k], &to->s[k], err));
    PM_TRY(fill_offsets(to, err));
    PM_TRY(pm_copy_array(&to->perm, from->perm, count, sizeof *from->perm, err));
    memcpy(to->reference_point, from->reference_point, sizeof to->reference_point);
done:
    if (status != PM_OK)
        pm_surfaces_release(to);
    return status;
}

void pm_surfaces_gather(const struct pm_surfaces *s, double *phi)
{
    for (ptrdiff_t k = 0; k < s->ns; k++)
        memcpy(phi + 3 * s->offset[k], s->s[k].phi, (size_t)(3 * s->s[k].n) * sizeof *phi);
}

void pm_surfaces_scatter(struct pm_surfaces *s, const double *phi)
{
    for (ptrdiff_t k = 0; k < s->ns; k++)
        memcpy(s->s[k].phi, phi + 3 * s->offset[k], (size_t)(3 * s->s[k].n) * sizeof *phi);
}

void pm_surface_release(struct pm_surface *s)
{
    pm_free(s->phi);
    pm_free(s->free);
    pm_free(s->Phi);
    pm_free(s->d0);
    pm_free(s->tri);
    *s = (struct pm_surface){.n = 0};
}

void pm_surfaces_release(struct pm_surfaces *s)
{
    for (ptrdiff_t k = 0; s->s != NULL && k < s->ns; k++)
        pm_surface_release(&s->s[k]);
    pm_free(s->s);
    pm_free(s->offset);
    pm_free(s->perm);
    pm_case_release(&s->pcase);
    *s = (struct pm_surfaces){.ns = 0};
}
