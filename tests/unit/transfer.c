/* A displacement carried to other nodes: homogeneous ones exactly everywhere, quadratic ones
 * exactly within straight elements, base and symmetry planes held. */
#include "common/mechanics/transfer.h"
#include "tests/records.h"
#include "tests/tap.h"

static void homogeneous(const double *x, double u[3])
{
    static const double A[9] = {0.3, -0.9, 0.1, 0.8, 0.4, -0.2, 0.05, 0.3, 1.1};
    for (int i = 0; i < 3; i++)
        u[i] = 0.7 - x[i] + A[3 * i] * x[0] + A[3 * i + 1] * x[1] + A[3 * i + 2] * x[2];
}

static void quadratic(const double *x, double u[3])
{
    u[0] = x[0] * x[1] + 0.3 * x[2];
    u[1] = x[2] * x[2] - x[0];
    u[2] = 0.5 * x[1] * x[0] + x[1] * x[1];
}

/* Of the nodes of `to` the difference from the field. */
static void compare(const char *name, const struct pm_mesh *from, const struct pm_mesh *to,
                    void (*field)(const double *x, double u[3]))
{
    struct pm_err err = {0};
    double u[30], got[30], want[30];
    for (int a = 0; a < 10; a++) {
        field(from->x + 3 * a, u + 3 * a);
        field(to->x + 3 * a, want + 3 * a);
    }
    ok(pm_transfer(from, u, to, got, &err) == PM_OK, "carried");
    near_array(name, got, want, 30, 1e-12); /* Newton's method to rounding */
}

int main(void)
{
    struct pm_err err = {0};
    struct pm_mesh from = {0}, to = {0};
    double u[30], got[30];
    if (sample_mesh(&from, &err) != PM_OK || sample_mesh(&to, &err) != PM_OK)
        return tap_bail("%s", err.text);
    for (int f = 0; f < 4; f++)
        to.tri_tag[f] = PM_FACE_EXTERIOR;
    /* the sample is curved; straighten one of them */
    static const int edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};
    struct pm_mesh straight = from;
    double x[30];
    memcpy(x, from.x, sizeof x);
    straight.x = x;
    for (int k = 0; k < 6; k++)
        for (int i = 0; i < 3; i++)
            x[12 + 3 * k + i] = 0.5 * (x[3 * edge[k][0] + i] + x[3 * edge[k][1] + i]);
    compare("homogeneous, the same nodes", &from, &to, homogeneous);
    for (int i = 0; i < 30; i++)
        to.x[i] = 0.2 + 0.04 * sin(1 + 3 * i);
    compare("homogeneous, inside", &from, &to, homogeneous);
    compare("quadratic, inside a straight element", &straight, &to, quadratic);
    for (int i = 0; i < 30; i++)
        to.x[i] = 0.4 + 0.8 * sin(1 + 3 * i);
    compare("homogeneous, outside too", &from, &to, homogeneous);
    compare("homogeneous, of a straight element", &straight, &to, homogeneous);
    to.tri_tag[0] = PM_FACE_BASE;
    to.tri_tag[1] = PM_FACE_SYM_Y;
    for (int a = 0; a < 10; a++)
        homogeneous(from.x + 3 * a, u + 3 * a);
    ok(pm_transfer(&from, u, &to, got, &err) == PM_OK, "carried to a mesh with planes");
    double base = 0, plane = 0;
    for (int k = 0; k < 6; k++) {
        for (int i = 0; i < 3; i++)
            base += fabs(got[3 * to.tri[k] + i]);
        plane += fabs(got[3 * to.tri[6 + k] + 1]);
    }
    ok(base <= 0 && plane <= 0, "base and plane hold their nodes");
    pm_mesh_release(&from);
    pm_mesh_release(&to);
    return tap_done();
}
