/* Surfaces from files: what reads and what is refused, how close the fitted surfaces lie. */
#include "tools/surfgen/given.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "common/geometry/collide.h"
#include "common/geometry/trimesh_read.h"
#include "tests/tap.h"
#include "tests/tube_mesh.h"
#include "tools/surfgen/surfgen.h"

enum form { TEXT, BINARY, OBJ };

/* Both ends of an open straight tube closed by flat fans in z = 0 and z = its length. */
static void close_flat(struct pm_trimesh *m, int around, double length)
{
    for (int end = 0; end < 2; end++) {
        const int32_t middle = (int32_t)m->nn, first = end ? (int32_t)m->nn - 1 - around : 0;
        memset(&m->x[3 * m->nn], 0, 3 * sizeof *m->x);
        m->x[3 * m->nn++ + 2] = end ? length / 2 : -length / 2;
        for (int a = 0; a < around; a++) {
            const int32_t i = first + a, j = first + (a + 1) % around;
            int32_t *t = &m->tri[3 * m->nt++];
            t[0] = end ? i : j;
            t[1] = end ? j : i;
            t[2] = middle;
        }
    }
    for (ptrdiff_t a = 0; a < m->nn; a++)
        m->x[3 * a + 2] += length / 2;
}

static void write_mesh(const char *path, const struct pm_trimesh *m, enum form form)
{
    FILE *f = fopen(path, "wb");

    if (f == NULL)
        return;
    if (form == BINARY)
        fprintf(f, "%-80s%c%c%c%c", "solid that is none", (int)(m->nt & 255),
                (int)(m->nt >> 8 & 255), (int)(m->nt >> 16 & 255), 0);
    for (ptrdiff_t a = 0; form == OBJ && a < m->nn; a++)
        fprintf(f, "v %.17g %.17g %.17g\n", m->x[3 * a], m->x[3 * a + 1], m->x[3 * a + 2]);
    for (ptrdiff_t t = 0; t < m->nt; t++) {
        const int32_t *v = &m->tri[3 * t];
        float block[12] = {0};
        if (form == OBJ)
            fprintf(f, "f %d//1 %d//1 %d//1\n", v[0] + 1, v[1] + 1, v[2] + 1);
        if (form == TEXT)
            fprintf(f, "facet normal 0 0 0\n outer loop\n");
        for (int k = 0; k < 9; k++) {
            const double x = m->x[3 * (ptrdiff_t)v[k / 3] + k % 3];
            block[3 + k] = (float)x;
            if (form == TEXT)
                fprintf(f, k % 3 == 0 ? "  vertex %.17g" : k % 3 == 2 ? " %.17g\r\n" : " %.17g", x);
        }
        if (form == TEXT)
            fprintf(f, " endloop\nendfacet\n");
        if (form == BINARY) {
            fwrite(block, 1, sizeof block, f);
            fwrite("\0", 1, 2, f);
        }
    }
    fclose(f);
}

/* A mesh comes back from all three forms; turned inside out it is turned back. */
static void forms(void)
{
    static const char *const name[] = {"given.stl", "given.stl", "given.obj"};
    const struct tube_shape shape = {5, 30, 1, 2, 1, 1, 0, 1};
    struct pm_err err = {0};
    struct pm_trimesh m = {0}, back = {0};

    if (tube_mesh(&shape, 16, 20, &m, &err) != PM_OK)
        return;
    const double volume = pm_collide_volume(m.x, m.nt, m.tri);
    for (enum form form = TEXT; form <= OBJ; form++) {
        for (ptrdiff_t t = 0; t < m.nt; t++) {
            int32_t a = m.tri[3 * t];
            m.tri[3 * t] = m.tri[3 * t + 1];
            m.tri[3 * t + 1] = a;
        }
        write_mesh(name[form], &m, form);
        int good = pm_trimesh_read(name[form], &back, &err) == PM_OK;
        ok(good && back.nn == m.nn && back.nt == m.nt, "%s, form %d: %td nodes, %td triangles %s",
           name[form], (int)form, back.nn, back.nt, err.text);
        /* binary coordinates have single precision */
        near_rel("its volume", pm_collide_volume(back.x, back.nt, back.tri), volume, 1e-6);
        pm_trimesh_release(&back);
    }
    pm_trimesh_release(&m);
}

static void refused(const char *why, const char *path, const char *text, const char *word)
{
    struct pm_err err = {0};
    struct pm_trimesh m = {0};
    FILE *f = fopen(path, "wb");

    if (f == NULL)
        return;
    fputs(text, f);
    fclose(f);
    enum pm_status status = pm_trimesh_read(path, &m, &err);
    ok(status == PM_INPUT && strstr(err.text, word) != NULL && strstr(err.text, path) != NULL,
       "%s: %s", why, err.text);
    pm_trimesh_release(&m);
}

static void refusals(void)
{
    refused("an empty file", "bad.stl", "", "no triangle");
    refused("not a number", "bad.stl", "facet\nvertex 1 2 x\n", "line 2");
    refused("infinite", "bad.stl", "facet\nvertex 1 2 inf\n", "finite");
    refused("two vertices", "bad.stl", "vertex 1 2 3\nvertex 1 2 4\nendfacet\n", "three vertices");
    refused("something else", "bad.stl", "hello\n", "line 1");
    refused("one triangle", "bad.stl", "vertex 1 2 3\nvertex 1 2 4\nvertex 2 2 4\nendfacet\n",
            "one triangle");
    refused("a face of unknown vertices", "bad.obj", "v 0 0 0\nf 1 2 3\n", "line 2");
    refused("two tetrahedra", "bad.obj",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
            "v 3 0 0\nv 4 0 0\nv 3 1 0\nv 3 0 1\nf -4 -2 -3\nf -4 -3 -1\nf -3 -2 -1\nf -4 -1 -2\n",
            "several parts");
}

/* Bounds 30 % above what was measured. */
static void chamber(const char *name, const struct tube_shape *shape, int around, int rings,
                    double spacing, double mean, double max)
{
    struct pm_err err = {0};
    struct pm_trimesh m = {0};
    struct pm_surface s = {0};
    struct pm_misfit misfit = {0};

    int good = tube_mesh(shape, around, rings, &m, &err) == PM_OK &&
               pm_given_chamber(&m, spacing, NULL, &s, &misfit, &err) == PM_OK;
    ok(good, "%s: %td control points %s", name, s.n, err.text);
    ok(good && misfit.mean < mean && misfit.max < max, "%s: distance mean %.4f, max %.4f mm", name,
       misfit.mean, misfit.max);
    pm_trimesh_release(&m);
    pm_free(s.phi);
    pm_free(s.free);
    pm_free(s.Phi);
    pm_free(s.d0);
    pm_free(s.tri);
}

static const char *const CASE =
    "[case]\nname = given\n[material]\nlaw = neo-hookean\nmu = 1\n"
    "[body]\nshape = file\nheight = 50\naround = 24\nrows = 40\n"
    "[chamber1]\nshape = file\ncenter = 0, 0, 25\nspacing = 2\n[actuation]\npmax = 0.1\n"
    "[constraints]\nwall_min = 1.5\ncurvature_max = 3\ncap_min = 3\n";

/* A body with overhanging folds and a bellows in it, from two files. */
static void robot(void)
{
    const struct tube_shape outside = {14, 50, 2, 3, 1, 0, 3, 0},
                            inside = {6, 42, 1.5, 3, 1, 0, 0, 1};
    const struct surfgen_files files = {.body = "body.stl", .chamber = {"chamber.obj"}};
    const struct surfgen_files missing = {.body = "body.stl"};
    struct pm_err err = {0}, none = {0}, off = {0};
    struct pm_trimesh m = {0};
    struct pm_case c = {0};
    struct pm_surfaces s = {0};
    struct pm_surface body = {0};
    struct pm_misfit misfit = {0};
    struct pm_surfgen_report report;

    if (tube_mesh(&inside, 24, 60, &m, &err) != PM_OK)
        return;
    for (ptrdiff_t a = 0; a < m.nn; a++)
        m.x[3 * a + 2] += 25;
    write_mesh("chamber.obj", &m, OBJ);
    pm_trimesh_release(&m);
    if (tube_mesh(&outside, 48, 81, &m, &err) != PM_OK)
        return;
    close_flat(&m, 48, 50);
    write_mesh("body.stl", &m, TEXT);
    ok(pm_case_parse(CASE, "given", &c, &err) == PM_OK, "case with files %s", err.text);
    int good = pm_given_body(&m, &c, &body, &misfit, &err) == PM_OK;
    ok(good && misfit.mean < 0.043 && misfit.max < 0.24,
       "folded exterior: distance mean %.4f, max %.4f mm %s", misfit.mean, misfit.max, err.text);
    int flat = 1;
    for (ptrdiff_t i = 0; i < body.nu; i++)
        flat &= body.phi[3 * i + 2] == 0 && body.phi[3 * (body.n - 1 - i) + 2] == 50;
    ok(flat, "its rims lie in z = 0 and z = 50 exactly");
    ok(pm_surfgen_from(&c, &files, &s, &report, &err) == PM_OK, "robot from two files %s",
       err.text);
    pm_surfaces_release(&s);
    good = pm_surfgen_from(&c, &missing, &s, &report, &none) == PM_USAGE;
    ok(good && strstr(none.text, "--chamber 1") != NULL, "a missing file: %s", none.text);
    c.height = 60;
    good = pm_surfgen_from(&c, &files, &s, &report, &off) == PM_INPUT;
    ok(good && strstr(off.text, "0 to 60") != NULL, "another height: %s", off.text);
    pm_trimesh_release(&m);
    pm_case_release(&c);
    pm_free(body.phi);
    pm_free(body.free);
    pm_free(body.Phi);
    pm_free(body.d0);
    pm_free(body.tri);
}

int main(void)
{
    static const struct tube_shape bellows = {7, 36, 2.5, 3, 1, 0, 0, 1},
                                   bent = {5, 40, 0, 0, 1, 3, 0, 1},
                                   flat = {3, 30, 0, 0, 3, 0, 0, 1};
    char folder[] = "/tmp/pm-given-XXXXXX";

    if (mkdtemp(folder) == NULL || chdir(folder) != 0)
        return tap_bail("cannot make a folder for files");
    forms();
    refusals();
    chamber("bellows", &bellows, 32, 60, 2, 0.046, 0.56);
    chamber("C-bent tube", &bent, 24, 40, 2, 0.02, 0.12);
    chamber("flat chamber", &flat, 64, 40, 1.5, 0.034, 0.6);
    robot();
    if (remove("given.stl") != 0 || remove("given.obj") != 0 || remove("bad.stl") != 0 ||
        remove("bad.obj") != 0 || remove("body.stl") != 0 || remove("chamber.obj") != 0 ||
        remove(folder) != 0)
        return tap_bail("cannot remove the files");
    return tap_done();
}
