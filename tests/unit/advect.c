/* A homogeneous deformation is carried to any neighbouring shape exactly. */
#include "common/mechanics/advect.h"
#include "tests/records.h"
#include "tests/tap.h"

int main(void)
{
    static const double A[9] = {0.3,  -0.9, 0.1, 0.8, 0.4,
                                -0.2, 0.05, 0.3, 1.1}; /* F: turned and stretched */
    struct pm_err err = {0};
    struct pm_mesh from = {0}, to = {0};
    double u[30], got[30], want[30];

    if (sample_mesh(&from, &err) != PM_OK || sample_mesh(&to, &err) != PM_OK) {
        ok(0, "%s", err.text);
        return tap_done();
    }
    for (int i = 0; i < 30; i++)
        to.x[i] += 0.05 * sin(1 + 3 * i);
    for (int a = 0; a < 10; a++)
        for (int i = 0; i < 3; i++) {
            u[3 * a + i] = 0.7 - from.x[3 * a + i];
            want[3 * a + i] = 0.7 - to.x[3 * a + i];
            for (int j = 0; j < 3; j++) {
                u[3 * a + i] += A[3 * i + j] * from.x[3 * a + j];
                want[3 * a + i] += A[3 * i + j] * to.x[3 * a + j];
            }
        }
    ok(pm_advect(&from, u, &to, got, &err) == PM_OK, "carried");
    near_array("homogeneous deformation", got, want, 30, 1e-14); /* rounding */
    ok(pm_advect(&from, u, &from, got, &err) == PM_OK, "carried to the same shape");
    ok(memcmp(got, u, sizeof u) == 0, "the same shape keeps its displacements bit for bit");
    pm_mesh_release(&from);
    pm_mesh_release(&to);
    return tap_done();
}
