#include "tools/surfgen/files.h"

#include "common/geometry/collide.h"
#include "common/geometry/symmetry.h"
#include "common/geometry/trimesh_read.h"

enum pm_status pm_files_check(const struct pm_case *c, const struct surfgen_files *files,
                              struct pm_err *err)
{
    ptrdiff_t g;

    if (files->design != NULL) {
        for (ptrdiff_t k = 0; k < PM_MAX_CHAMBERS; k++)
            if (files->chamber[k] != NULL || files->body != NULL)
                return pm_fail(err, PM_USAGE, "--design does not go with --body and --chamber");
        return PM_OK;
    }
    if ((c->body == PM_BODY_FILE) != (files->body != NULL))
        return pm_fail(err, PM_USAGE, "the body of case '%s' is %s", c->name,
                       files->body != NULL ? "not from a file, but there is --body"
                                           : "from a file, expected --body FILE");
    for (ptrdiff_t k = 0; k < PM_MAX_CHAMBERS; k++) {
        int wanted = k < c->nchambers && c->chamber[k].shape == PM_SHAPE_FILE &&
                     pm_symmetry_source(&c->symmetry, k, &g) == k;
        if (wanted && files->chamber[k] == NULL)
            return pm_fail(err, PM_USAGE,
                           "chamber %td of case '%s' is from a file, expected --chamber %td=FILE",
                           k + 1, c->name, k + 1);
        if (!wanted && files->chamber[k] != NULL)
            return pm_fail(err, PM_USAGE,
                           "chamber %td of case '%s' is not from a file, or the image of another "
                           "one, but there is --chamber %td=",
                           k + 1, c->name, k + 1);
    }
    return PM_OK;
}

int pm_files_has(const struct pm_case *c, ptrdiff_t surface)
{
    return surface == 0 ? c->body == PM_BODY_FILE : c->chamber[surface - 1].shape == PM_SHAPE_FILE;
}

/* Chamber k, from 0: is it where the case says, and moved by the symmetry? */
static enum pm_status check_place(const struct pm_case *c, ptrdiff_t k, const char *path,
                                  const struct pm_trimesh *m, struct pm_err *err)
{
    const double *center = c->chamber[k].center;

    for (ptrdiff_t g = 1; g < c->symmetry.nops; g++)
        if (c->symmetry.chamber[g][k] == k)
            return pm_fail(err, PM_INPUT,
                           "chamber %td comes from a file and is its own image in the symmetry, "
                           "expected a group that moves it",
                           k + 1);
    if (!(pm_collide_winding(center, m->x, m->nt, m->tri) > 0.5))
        return pm_fail(err, PM_INPUT, "center (%g, %g, %g) of chamber %td does not lie inside '%s'",
                       center[0], center[1], center[2], k + 1, path);
    return PM_OK;
}

enum pm_status pm_files_surface(const struct pm_case *c, const struct surfgen_files *files,
                                ptrdiff_t k, struct pm_surface *s, struct pm_misfit *misfit,
                                struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const char *path = k == 0 ? files->body : files->chamber[k - 1];
    struct pm_trimesh m = {0};
    struct pm_err why = {0};

    PM_TRY(pm_trimesh_read(path, &m, err));
    if (k > 0) {
        PM_TRY(check_place(c, k - 1, path, &m, err));
        status = pm_given_chamber(&m, c->chamber[k - 1].spacing, NULL, s, misfit, &why);
    } else {
        status = pm_given_body(&m, c, s, misfit, &why);
    }
    if (status != PM_OK)
        pm_fail(err, status, "cannot use '%s': %s", path, why.text);
done:
    pm_trimesh_release(&m);
    return status;
}
