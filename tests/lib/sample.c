/* sample KIND FILE: a small valid file of that kind (tests/records.h). */
#include <stdio.h>

#include "tests/records.h"

int main(int argc, char **argv)
{
    struct pm_err err = {.status = PM_OK};
    union {
        struct pm_surfaces surfaces;
        struct pm_mesh mesh;
        struct pm_state state;
        struct pm_work work;
        struct pm_sens sens;
    } r;
    if (argc != 3)
        return PM_USAGE;
    const char *kind = argv[1];
    enum pm_status status = PM_USAGE;
    if (strcmp(kind, "surface") == 0)
        status = sample_surfaces(&r.surfaces, &err);
    else if (strcmp(kind, "mesh") == 0)
        status = sample_mesh(&r.mesh, &err);
    else if (strcmp(kind, "state") == 0)
        status = sample_state(&r.state, &err);
    else if (strcmp(kind, "work") == 0)
        status = sample_work(&r.work, &err);
    else if (strcmp(kind, "sens") == 0)
        status = sample_sens(&r.sens, &err);
    if (status == PM_OK)
        status = sample_write(argv[2], kind, &r, &err);
    if (status == PM_OK && strcmp(kind, "surface") == 0)
        pm_surfaces_release(&r.surfaces);
    else if (status == PM_OK && strcmp(kind, "mesh") == 0)
        pm_mesh_release(&r.mesh);
    else if (status == PM_OK && strcmp(kind, "state") == 0)
        pm_state_release(&r.state);
    else if (status == PM_OK && strcmp(kind, "work") == 0)
        pm_work_release(&r.work);
    else if (status == PM_OK)
        pm_sens_release(&r.sens);
    if (status != PM_OK)
        fprintf(stderr, "sample: %s\n", err.text);
    return (int)status;
}
