/* A block with two chambers (258 tet10) solved by independent code in double precision: U, J and
 * the nodal gradient of an objective of U and J, tests/data/hollow_block.json. Plain tet10, the
 * reference's element. */
#include "common/mechanics/adjoint.h"
#include "common/mechanics/equilibrium.h"
#include "tests/reference.h"
#include "tests/tap.h"

enum { NN = 537, NE = 258, NC = 12, NF = 400 };

struct block {
    double X[3 * NN], tets[10 * NE], face[6 * NC], set[2][77];
    int32_t tet[10 * NE], tri[6 * NF], tag[NF];
    uint8_t mark[NN];
    struct pm_mesh mesh;
};

static void add_face(struct pm_mesh *m, const int32_t *nodes, const int *order, int32_t tag)
{
    for (int a = 0; a < 6; a++)
        m->tri[6 * m->nf + a] = nodes[order[a]];
    m->tri_tag[m->nf++] = tag;
}

/* Faces of elements whose six nodes are all in the given set. */
static void add_plane(struct block *b, const double *set, int32_t tag)
{
    static const int face[4][6] = {
        {0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 9, 7}, {1, 2, 3, 5, 8, 9}, {0, 3, 2, 7, 8, 6}};
    memset(b->mark, 0, sizeof b->mark);
    for (int k = 0; k < 77; k++)
        b->mark[(int)set[k]] = 1;
    for (int e = 0; e < NE; e++)
        for (int k = 0; k < 4; k++) {
            int all = 1;
            for (int a = 0; a < 6; a++)
                all &= b->mark[b->tet[10 * e + face[k][a]]];
            if (all)
                add_face(&b->mesh, b->tet + 10 * e, face[k], tag);
        }
}

static void read_block(const cJSON *root, struct block *b)
{
    static const int flip[6] = {0, 2, 1,
                                5, 4, 3}; /* the file's chamber normals point into the solid */
    static const char *const chamber[] = {"cav0", "cav1"};
    struct pm_mesh *m = &b->mesh;
    reference_numbers(root, "X", b->X, 3 * NN);
    reference_numbers(root, "tets", b->tets, 10 * NE);
    for (int k = 0; k < 10 * NE; k++)
        b->tet[k] = (int32_t)b->tets[k];
    *m = (struct pm_mesh){.nn = NN,
                          .ne = NE,
                          .nc = 2,
                          .npe = 10,
                          .npf = 6,
                          .x = b->X,
                          .x_generated = b->X,
                          .tet = b->tet,
                          .tri = b->tri,
                          .tri_tag = b->tag};
    for (int c = 0; c < 2; c++) {
        reference_numbers(root, chamber[c], b->face, 6 * NC);
        for (int t = 0; t < NC; t++) {
            int32_t nodes[6];
            for (int a = 0; a < 6; a++)
                nodes[a] = (int32_t)b->face[6 * t + a];
            add_face(m, nodes, flip, c + 1);
        }
    }
    reference_numbers(root, "clamped", b->set[0], 77);
    reference_numbers(root, "tip", b->set[1], 77);
    add_plane(b, b->set[0], PM_FACE_BASE);
    add_plane(b, b->set[1], PM_FACE_TIP);
    reference_numbers(root, "Xref", m->reference_point, 3);
    snprintf(m->pcase.law, sizeof m->pcase.law, "neo-hookean");
    m->pcase.nlaw_parameter = reference_numbers(root, "mu", m->pcase.law_parameter, 1);
    reference_numbers(root, "kappa", &m->pcase.kappa, 1);
}

static enum pm_status solve_and_compare(const cJSON *root, const struct block *b,
                                        struct pm_err *err)
{
    static double f[3 * NN], Jq[2 * 3 * NN], D[3 * NN], want[3 * NN];
    enum pm_status status;
    struct pm_model *m = NULL;
    struct pm_config c = {0};
    struct pm_solve_report r;
    struct pm_solve_options o = pm_solve_default;
    struct pm_objective goal = {.V = {0}};
    double p[2], V[2], J[12], w[12], D_ref[3], sum = 0.0;
    o.tolerance = 1e-11;
    reference_numbers(root, "p", p, 2);
    PM_TRY(pm_model_new(&b->mesh, "tet10", &m, err));
    PM_TRY(pm_config_new(m, &c, err));
    PM_TRY(pm_equilibrium(m, p, &o, NULL, &c, V, f, &r, err));
    PM_TRY(pm_jacobian(m, &c, 1.0, Jq, J, err));
    reference_numbers(root, "U", want, 6);
    near_array("U", c.U, want, 6, 1e-10);
    reference_numbers(root, "J", want, 12);
    near_array("J", J, want, 12, 1e-10);
    reference_numbers(root, "obj_a", goal.U, 6);
    reference_numbers(root, "obj_b", w, 12);
    for (int k = 0; k < 12; k++)
        goal.J[k / 2][k % 2] = w[k];
    const struct pm_adjoint_at at = {m, &c, p, f, Jq, 1.0};
    PM_TRY(pm_adjoint(&at, 1, &goal, PM_SHAPE_DOMAIN, D, D_ref, err));
    reference_numbers(root, "dT_dX", want, 3 * NN);
    /* its systems are solved to residuals of 1e-10; seen 1.2e-9 */
    near_array("nodal gradient by the adjoint", D, want, 3 * NN, 1e-8);
    for (int k = 0; k < 3 * NN; k += 3)
        sum += D[k];
    near_abs("translation identity", (sum + D_ref[0]) / fabs(D_ref[0]), 0.0, 1e-8);
    ok(r.factorisations <= 10, "%ld factorisations", r.factorisations);
done:
    pm_config_release(&c);
    pm_model_free(m);
    return status;
}

int main(void)
{
    static struct block b;
    struct pm_err err = {0};
    cJSON *root = reference_load("tests/data/hollow_block.json");
    if (root == NULL)
        return tap_bail("no reference");
    read_block(root, &b);
    if (solve_and_compare(root, &b, &err) != PM_OK)
        return tap_bail("%s", err.text);
    cJSON_Delete(root);
    return tap_done();
}
