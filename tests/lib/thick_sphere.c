/* An octant of a thick sphere, 1 <= r <= OUTER, as a gmsh 2.2 file, and the radial displacement of
 * its surfaces in a state file.
 *   thick_sphere write N M ORDER FILE.msh [OUTER [GROUP]]   N parts a side, M layers; ORDER
 * quadratic (curved) or linear; OUTER 2 where not given; GROUP of the outer side: exterior, or
 * chamber2 for its volume thick_sphere read STATE.h5                      the mean radial
 * displacements inside, outside
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/files/state.h"
#include "common/mechanics/tet10.h"

enum { MAX_SIDE = 16, MAX_NODES = 100000 };

/* Group numbers are entity numbers too. */
enum { BODY = 1, CHAMBER, EXTERIOR, SYM_X, SYM_Y, SYM_Z, GROUPS = 6 };
static const char *const group_name[GROUPS + 1] = {
    "", "body", "chamber1", "exterior", "symmetry-x", "symmetry-y", "symmetry-z"};

struct octant {
    int n, m, nv, nn, ne, nt, corners;  /* parts, layers, vertices, nodes ... */
    int id[MAX_SIDE + 1][MAX_SIDE + 1]; /* direction (i, j, n - i - j) */
    int nd;
    double outer;
    const char *group; /* of the outer side */
    double dir[MAX_SIDE * MAX_SIDE][3];
    double (*x)[3]; /* nodes */
    int (*ends)[2]; /* of the middle nodes */
    int (*tet)[10];
    int (*tri)[7]; /* nodes, group */
};

static int vertex(const struct octant *o, int d, int layer)
{
    return layer * o->nd + d;
}

static int middle(struct octant *o, int a, int b)
{
    const int low = a < b ? a : b, high = a < b ? b : a;
    for (int k = o->nv; k < o->nn; k++)
        if (o->ends[k][0] == low && o->ends[k][1] == high)
            return k;
    const int p = low % o->nd, q = high % o->nd;
    const int layers = low / o->nd + high / o->nd;
    const double r = 1 + (o->outer - 1) * 0.5 * layers / o->m;
    double v[3], l = 0;
    for (int i = 0; i < 3; i++) {
        v[i] = o->dir[p][i] + o->dir[q][i];
        l += v[i] * v[i];
    }
    for (int i = 0; i < 3; i++)
        o->x[o->nn][i] = r * v[i] / sqrt(l);
    o->ends[o->nn][0] = low;
    o->ends[o->nn][1] = high;
    return o->nn++;
}

static void add_tet(struct octant *o, int a, int b, int c, int d)
{
    int *v = o->tet[o->ne++];
    double u[3][3];
    const int order[4] = {a, b, c, d};
    memcpy(v, order, sizeof order);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            u[k][i] = o->x[order[k + 1]][i] - o->x[a][i];
    const double det = u[0][0] * (u[1][1] * u[2][2] - u[1][2] * u[2][1]) +
                       u[0][1] * (u[1][2] * u[2][0] - u[1][0] * u[2][2]) +
                       u[0][2] * (u[1][0] * u[2][1] - u[1][1] * u[2][0]);
    if (det < 0) {
        v[1] = c;
        v[2] = b;
    }
    for (int k = 0; k < 6; k++)
        v[4 + k] = middle(o, v[pm_tet10_edge[k][0]], v[pm_tet10_edge[k][1]]);
}

static void add_tri(struct octant *o, int group, int a, int b, int c)
{
    const int v[7] = {a, b, c, middle(o, a, b), middle(o, b, c), middle(o, c, a), group};
    memcpy(o->tri[o->nt++], v, sizeof v);
}

/* The prism over (a, b, c) between two layers, cut by ascending directions: neighbours agree. */
static void add_prism(struct octant *o, int layer, int a, int b, int c)
{
    int d[3] = {a, b, c}, low[3], high[3];
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2 - i; j++)
            if (d[j] > d[j + 1]) {
                const int swap = d[j];
                d[j] = d[j + 1];
                d[j + 1] = swap;
            }
    for (int k = 0; k < 3; k++) {
        low[k] = vertex(o, d[k], layer);
        high[k] = vertex(o, d[k], layer + 1);
    }
    add_tet(o, low[0], low[1], low[2], high[2]);
    add_tet(o, low[0], low[1], high[1], high[2]);
    add_tet(o, low[0], high[0], high[1], high[2]);
    if (layer == 0)
        add_tri(o, CHAMBER, low[0], low[1], low[2]);
    if (layer == o->m - 1)
        add_tri(o, EXTERIOR, high[0], high[1], high[2]);
    for (int j = 0; j < 3; j++) /* sides on the planes */
        for (int p = 0; p < 3; p++) {
            const int q = (p + 1) % 3, first = d[p] < d[q] ? p : q, second = d[p] < d[q] ? q : p;
            if (o->dir[d[p]][j] != 0 || o->dir[d[q]][j] != 0)
                continue;
            add_tri(o, SYM_X + j, low[first], low[second], high[second]);
            add_tri(o, SYM_X + j, low[first], high[first], high[second]);
        }
}

static void build(struct octant *o)
{
    for (int i = 0; i <= o->n; i++)
        for (int j = 0; i + j <= o->n; j++) {
            const double v[3] = {i, j, o->n - i - j},
                         l = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
            for (int k = 0; k < 3; k++)
                o->dir[o->nd][k] = v[k] / l;
            o->id[i][j] = o->nd++;
        }
    o->nv = o->nn = o->nd * (o->m + 1);
    for (int layer = 0; layer <= o->m; layer++)
        for (int d = 0; d < o->nd; d++)
            for (int k = 0; k < 3; k++)
                o->x[vertex(o, d, layer)][k] = (1 + (o->outer - 1) * layer / o->m) * o->dir[d][k];
    for (int layer = 0; layer < o->m; layer++)
        for (int i = 0; i < o->n; i++)
            for (int j = 0; i + j < o->n; j++) {
                add_prism(o, layer, o->id[i][j], o->id[i + 1][j], o->id[i][j + 1]);
                if (i + j + 1 < o->n)
                    add_prism(o, layer, o->id[i + 1][j], o->id[i + 1][j + 1], o->id[i][j + 1]);
            }
}

static void put_element(const struct octant *o, FILE *f, int number, int group, const int *node)
{
    const int volume = group == BODY, n = volume ? o->corners : o->corners == 10 ? 6 : 3;
    const int type = volume ? (n == 10 ? 11 : 4) : n == 6 ? 9 : 2;
    fprintf(f, "%d %d 2 %d %d", number, type, group, group);
    for (int k = 0; k < n; k++)
        fprintf(f, " %d", node[k] + 1);
    fprintf(f, "\n");
}

static void write_22(const struct octant *o, FILE *f)
{
    const int nn = o->corners == 10 ? o->nn : o->nv;
    fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n", GROUPS);
    for (int g = 1; g <= GROUPS; g++)
        fprintf(f, "%d %d \"%s\"\n", g == BODY ? 3 : 2, g,
                g == EXTERIOR ? o->group : group_name[g]);
    fprintf(f, "$EndPhysicalNames\n$Nodes\n%d\n", nn);
    for (int a = 0; a < nn; a++)
        fprintf(f, "%d %.17g %.17g %.17g\n", a + 1, o->x[a][0], o->x[a][1], o->x[a][2]);
    fprintf(f, "$EndNodes\n$Elements\n%d\n", o->nt + o->ne);
    for (int t = 0; t < o->nt; t++)
        put_element(o, f, t + 1, o->tri[t][6], o->tri[t]);
    for (int e = 0; e < o->ne; e++)
        put_element(o, f, o->nt + e + 1, BODY, o->tet[e]);
    fprintf(f, "$EndElements\n");
}

static int write_octant(int n, int m, const char *order, const char *path, double outer,
                        const char *group)
{
    static struct octant o;
    const size_t side = (size_t)n, layers = (size_t)m;
    o.n = n;
    o.m = m;
    o.outer = outer;
    o.group = group;
    o.corners = strcmp(order, "linear") == 0 ? 4 : 10;
    o.x = calloc(MAX_NODES, sizeof *o.x);
    o.ends = calloc(MAX_NODES, sizeof *o.ends);
    o.tet = calloc(3 * side * side * layers, sizeof *o.tet);
    o.tri = calloc(2 * side * side + 6 * side * layers, sizeof *o.tri);
    FILE *f = fopen(path, "wb");
    if (n < 1 || n > MAX_SIDE || m < 1 || !(outer > 1) || o.x == NULL || o.ends == NULL ||
        o.tet == NULL || o.tri == NULL || f == NULL)
        return 1;
    build(&o);
    write_22(&o, f);
    free(o.x);
    free(o.ends);
    free(o.tet);
    free(o.tri);
    return fclose(f) != 0;
}

static double radius(const double x[3])
{
    return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}

static int read_state(const char *path)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_state s;
    double sum[2] = {0}, outer = 0;
    int count[2] = {0};
    if (pm_state_load(path, 0, &s, &err) != PM_OK) {
        fprintf(stderr, "%s\n", err.text);
        return 1;
    }
    for (ptrdiff_t a = 0; a < s.mesh.nn; a++)
        outer = fmax(outer, radius(s.mesh.x + 3 * a));
    for (ptrdiff_t a = 0; a < s.mesh.nn; a++) {
        const double *x = s.mesh.x + 3 * a, *u = s.u + 3 * a;
        const double r = radius(x);
        const int k = fabs(r - 1) < 1e-9 ? 0 : fabs(r - outer) < 1e-9 ? 1 : -1;
        if (k < 0)
            continue;
        sum[k] += (x[0] * u[0] + x[1] * u[1] + x[2] * u[2]) / r;
        count[k]++;
    }
    printf("%.9f %.9f\n", sum[0] / count[0], sum[1] / count[1]);
    pm_state_release(&s);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc >= 6 && argc <= 8 && strcmp(argv[1], "write") == 0)
        return write_octant((int)strtol(argv[2], NULL, 10), (int)strtol(argv[3], NULL, 10), argv[4],
                            argv[5], argc >= 7 ? strtod(argv[6], NULL) : 2,
                            argc == 8 ? argv[7] : "exterior");
    if (argc == 3 && strcmp(argv[1], "read") == 0)
        return read_state(argv[2]);
    fprintf(stderr, "usage: thick_sphere write N M ORDER FILE [OUTER [GROUP]] | read STATE\n");
    return 2;
}
