/* The case file: what it means, what is refused. */
#include <string.h>

#include "common/files/case.h"
#include "tests/tap.h"

#define HEAD                                                                                       \
    "[case]\nname = t\n[material]\nmu = 0.5\n[body]\nheight = 100\nwall = "                        \
    "3\n[workspace]\nmeasure = 2T\n"
#define CHAMBER                                                                                    \
    "[chamber1]\nshape = bellows\ncenter = 16.4, 0, 50\nradius = 10\nlength = 90\n"                \
    "amplitude = 2\npitch = 18\n"

#define CELLS                                                                                      \
    "[chamber1]\nshape = pneunet\ncenter = 6, 4, 50\ncells = 5\npitch = 13\nwidth = 12\n"          \
    "depth = 12\nchannel = 4\n"

static void test_reference(void)
{
    struct pm_case c;
    struct pm_err err = {.status = PM_OK};
    const char *text = HEAD CHAMBER "[symmetry]\ngroup = mirror-x mirror-y\n";
    if (!ok(pm_case_parse(text, "t.ini", &c, &err) == PM_OK, "two bellows parse %s", err.text))
        return;
    ok(strcmp(c.text, text) == 0 && strcmp(c.name, "t") == 0, "text and name are kept");
    ok(c.mu == 0.5 && c.kappa == 50 && c.law_parameter[0] == 0.5, "kappa is 100 mu by default");
    ok(c.pmin == 0 && c.pmax == 0.12 && c.points == 2 && c.form == PM_FORM_BOUNDARY,
       "actuation defaults");
    ok(c.ndofs == 2 && c.dofs[0] == 0 && c.dofs[1] == 2, "2T moves along x and z");
    ok(c.symmetry.nops == 4 && c.nchambers == 2, "group of 4, image appended");
    ok(c.chamber[1].center[0] == -16.4 && c.chamber[1].center[1] == 0 &&
           c.chamber[1].amplitude == 2,
       "the image is exact");
    static const int swap[4][2] = {{0, 1}, {1, 0}, {0, 1}, {1, 0}};
    static const double diagonal[4][2] = {{1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    for (int g = 0; g < 4; g++) {
        ok(c.symmetry.chamber[g][0] == swap[g][0] && c.symmetry.chamber[g][1] == swap[g][1],
           "operation %d permutes the chambers", g);
        ok(c.symmetry.Q[g][0] == diagonal[g][0] && c.symmetry.Q[g][4] == diagonal[g][1] &&
               c.symmetry.Q[g][8] == 1 && c.symmetry.Q[g][1] == 0,
           "operation %d is exact", g);
    }
    ok(c.chamber[0].spacing == 2.5, "spacing default");
    struct pm_case d;
    ok(pm_case_copy(&c, &d, &err) == PM_OK && strcmp(d.text, c.text) == 0 && d.text != c.text,
       "copy");
    pm_case_release(&c);
    ok(c.text == NULL, "release accepts and clears");
    pm_case_release(&c);
    pm_case_release(&d);
}

static void test_groups(void)
{
    struct pm_case c;
    struct pm_err err = {.status = PM_OK};
    static const char c3v[] =
        "[case]\nname=t\n[material]\nmu=1\n[body]\nheight=100\nwall=3\n[workspace]\n"
        "measure=3T\n[chamber1]\nshape=capsule\ncenter=15,0,50\nradius=6\nlength=80\n"
        "[symmetry]\ngroup = c3 mirror-y\n";
    ok(pm_case_parse(c3v, "t", &c, &err) == PM_OK && c.symmetry.nops == 6 && c.nchambers == 3,
       "C3 with mirrors has 6 operations %s", err.text);
    /* The rotation by 120 degrees takes 0 to 1 to 2 to 0. */
    const int *perm = c.symmetry.chamber[1];
    ok(perm[0] == 1 && perm[1] == 2 && perm[2] == 0, "the rotation is a cycle");
    double worst = 0;
    for (ptrdiff_t g = 0; g < c.symmetry.nops; g++) {
        const double *Q = c.symmetry.Q[g];
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                worst = fmax(worst, fabs(Q[3 * i] * Q[3 * j] + Q[3 * i + 1] * Q[3 * j + 1] +
                                         Q[3 * i + 2] * Q[3 * j + 2] - (i == j)));
    }
    near_abs("operations are orthogonal", worst, 0, 4e-16); /* rounding of sin 60 */
    pm_case_release(&c);
    static const char c2[] =
        "[case]\nname=t\n[material]\nmu=1\n[body]\nheight=100\nwall=3\n[workspace]\n"
        "measure=1R2T\n[chamber1]\nshape=capsule\ncenter=-12,0,50\nradius=7\nlength=90\n"
        "[chamber2]\nshape=capsule\ncenter=12,0,28\nradius=7\nlength=42\n"
        "[symmetry]\ngroup = c2-x mirror-y\n";
    ok(pm_case_parse(c2, "t", &c, &err) == PM_OK && c.symmetry.nops == 4 && c.nchambers == 3,
       "turn about y = 0, z = H/2 %s", err.text);
    ok(c.symmetry.Q[1][4] == -1 && c.symmetry.Q[1][8] == -1 && c.symmetry.t[1][2] == 100 &&
           c.chamber[2].center[2] == 72 && c.symmetry.chamber[1][0] == 0 &&
           c.symmetry.chamber[1][1] == 2,
       "it takes the low chamber to the high one");
    ok(c.ndofs == 3 && c.dofs[2] == 4, "1R2T: U1, U3, U5");
    pm_case_release(&c);
    ok(pm_case_parse("[case]\nname=m\n[material]\nlaw = mooney-rivlin\nc10 = 0.2\nc01 = 0.05\n",
                     "t", &c, &err) == PM_OK &&
           c.nchambers == 0 && fabs(c.mu - 0.5) < 1e-15 && c.symmetry.nops == 1,
       "a material alone is a case %s", err.text);
    pm_case_release(&c);
    ok(pm_case_parse("[case]\nname=m\n[material]\nlaw = yeoh\nc1 = 0.2\nc2 = -0.01\n", "t", &c,
                     &err) == PM_OK &&
           c.law_parameter[1] == -0.01 && c.mu == 0.4,
       "Yeoh %s", err.text);
    pm_case_release(&c);
}

#define MATERIAL "[case]\nname = m\n[material]\n"

static void test_materials(void)
{
    struct pm_case c;
    struct pm_err err = {.status = PM_OK};
    ok(pm_case_parse(MATERIAL "law = ogden\nmu1 = 0.4\nalpha1 = 1.3\nalpha2 = 5\nmu2 = 0.01\n", "t",
                     &c, &err) == PM_OK &&
           c.nlaw_parameter == 4 && c.law_parameter[1] == 1.3 && c.law_parameter[2] == 0.01 &&
           fabs(c.mu - 0.5 * (0.4 * 1.3 + 0.01 * 5)) < 1e-16,
       "Ogden: two terms, mu is half the sum of mu_k alpha_k %s", err.text);
    pm_case_release(&c);
    ok(pm_case_parse(MATERIAL "law = yeoh\nc1 = 0.2\nc3 = 0.01\n", "t", &c, &err) == PM_OK &&
           c.nlaw_parameter == 3 && c.law_parameter[1] == 0 && c.law_parameter[2] == 0.01,
       "Yeoh: a constant left out is 0 %s", err.text);
    pm_case_release(&c);
    const char *text = "[case]\nname = m\n[material] ; rubber\nmu = 2\n[workspace]\nmeasure = 2T";
    const struct pm_material yeoh = {.law = "yeoh", .n = 2, .c = {0.1, 0.2}}, stiff = {.kappa = 77};
    ok(pm_case_parse(text, "t", &c, &err) == PM_OK &&
           pm_case_set_material(&c, &yeoh, &err) == PM_OK && c.mu == 0.2 && c.kappa == 20 &&
           strcmp(c.text, "[case]\nname = m\n[workspace]\nmeasure = 2T\n[material]\nlaw = yeoh\n"
                          "c1 = 0.10000000000000001\nc2 = 0.20000000000000001\n") == 0,
       "another material takes the place of the section %s", err.text);
    ok(pm_case_set_material(&c, &stiff, &err) == PM_OK && c.mu == 0.2 && c.kappa == 77 &&
           c.law_parameter[1] == 0.2 && c.ndofs == 2,
       "another kappa keeps the law %s", err.text);
    ok(pm_case_set_material(&c, &(struct pm_material){.preset = "butter"}, &err) == PM_USAGE &&
           c.kappa == 77,
       "a wrong one changes nothing");
    err = (struct pm_err){.status = PM_OK};
    pm_case_release(&c);
    ok(pm_case_parse(MATERIAL "preset = elastosil-m4601\nkappa = 30\n", "t", &c, &err) == PM_OK &&
           strcmp(c.law, "yeoh") == 0 && c.law_parameter[1] == 0.02 && c.kappa == 30,
       "a preset with its own kappa %s", err.text);
    pm_case_release(&c);
}

static void refused(const char *text, const char *says)
{
    struct pm_case c;
    struct pm_err err = {.status = PM_OK};
    int good = pm_case_parse(text, "t.ini", &c, &err) == PM_INPUT &&
               strstr(err.text, says) != NULL && strstr(err.text, "'t.ini'") != NULL &&
               c.text == NULL;
    ok(good, "refused: %s", says);
    if (!good)
        printf("# got: %s\n", err.text);
    pm_case_release(&c);
}

static void test_bad_materials(void)
{
    static const struct {
        const char *text, *says;
    } bad[] = {
        {MATERIAL "mu = -1\n", "small-strain shear modulus -1 MPa, expected > 0"},
        {MATERIAL "law = mooney-rivlin\nc10 = 0.1\n",
         "key 'c01' in section '[material]' is missing"},
        {MATERIAL "law = ogden\nmu1 = 1\n", "key 'alpha1' in section '[material]' is missing"},
        {MATERIAL "law = ogden\nmu1 = 1\nalpha1 = 2\nmu3 = 1\nalpha3 = 4\n",
         "key 'mu2' in section '[material]' is missing"},
        {MATERIAL "law = ogden\nmu1 = 1\nalpha1 = 2\nmu2 = 1\nalpha2 = 0\n", "key 'alpha2' is 0"},
        {MATERIAL "law = ogden\nmu1 = 1\nalpha1 = -2\n", "small-strain shear modulus -1 MPa"},
        {MATERIAL "law = ogden\nmu1 = 1\nmu1 = 2\n",
         "line 6: key 'mu1' is '2', expected each key once"},
        {MATERIAL "law = ogden\nmu7 = 1\n", "line 5: unknown key 'mu7' in section '[material]'"},
        {MATERIAL "preset = butter\n", "key 'preset' is 'butter', expected ecoflex-00-30"},
        {MATERIAL "preset = sylgard-184\nlaw = yeoh\n", "key 'law' does not go with 'preset'"},
        {MATERIAL "preset = sylgard-184\nmu = 1\n",
         "'mu' is not a parameter of preset 'sylgard-184'"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        refused(bad[i].text, bad[i].says);
}

static void test_constraints(void)
{
    static const struct {
        const char *text, *says;
    } bad[] = {
        {HEAD CHAMBER "[constraints]\ndomain = ball\n",
         "key 'domain' is 'ball', expected none, cylinder or box"},
        {HEAD CHAMBER "[constraints]\ndomain = box\ndomain_x = 30\n",
         "key 'domain_y' in section '[constraints]' is missing"},
        {HEAD CHAMBER "[constraints]\ndomain_radius = 30\n",
         "key 'domain_radius' in section '[constraints]' is not one of domain = none"},
        {HEAD CHAMBER "[symmetry]\ngroup = mirror-x\n[constraints]\ncontact = maybe\n",
         "expected ignore or reject"},
        {HEAD CHAMBER "[symmetry]\ngroup = mirror-x\n[constraints]\ngap_min = 1\n",
         "gap_min in section '[constraints]' is 1, expected 0 where contact is not reject"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        refused(bad[i].text, bad[i].says);
}

static void test_refusals(void)
{
    static const struct {
        const char *text, *says;
    } bad[] = {
        {"", "key 'name' in section '[case]' is missing"},
        {"[case]\nname = t\n", "key 'mu' in section '[material]' is missing"},
        {HEAD CHAMBER "[mesh]\nsise = 3\n", "line 18: unknown key 'sise' in section '[mesh]'"},
        {HEAD CHAMBER "[meshes]\nsize = 3\n", "line 18: unknown section '[meshes]'"},
        {HEAD CHAMBER "[mesh]\nsize = 3mm\n",
         "line 18: key 'size' is '3mm', expected a number > 0"},
        {HEAD CHAMBER "[mesh]\nsize = -3\n", "expected a number > 0"},
        {HEAD CHAMBER "[mesh]\nsize = nan\n", "expected a number > 0"},
        {HEAD CHAMBER "[mesh]\nsize = 1e999\n", "expected a number > 0"},
        {HEAD CHAMBER "[mesh]\nsize = 3\nsize = 4\n",
         "line 19: key 'size' is '4', expected each key once"},
        {HEAD CHAMBER "[body]\nrows = 12.5\n", "key 'rows' is '12.5', expected an integer > 0"},
        {HEAD CHAMBER "[symmetry]\ngroup = c4\n", "key 'group' has 'c4'"},
        {HEAD CHAMBER, "measure 2T with 1 chambers, expected 2"},
        {HEAD CHAMBER "cells = 3\n", "key 'cells' in section '[chamber1]' is not one of shape"},
        {HEAD CELLS, "key 'thickness' in section '[chamber1]' is missing"},
        {HEAD CELLS "thickness = 14\n", "cells thinner than the pitch"},
        {HEAD CELLS "thickness = 5\nturn = 3\n", "which shape = pneunet does not take"},
        {HEAD CELLS "thickness = 5\n[symmetry]\ngroup = mirror-y\n",
         "shape = pneunet with 2 chambers, expected 1 to 3 equal limbs"},
        {HEAD CHAMBER "[body]\nwidth = 3\n",
         "'width' in section '[body]' belongs to shape = rounded"},
        {HEAD CHAMBER "[symmetry]\ngroup = mirror-x\n[actuation]\npmax = -1\n",
         "pmax is -1, expected more than pmin = 0"},
        {HEAD "[chamber1]\nshape = sphere\ncenter = 5, 0, 50\nradius = 10\n[symmetry]\ngroup = "
              "mirror-x\n",
         "chambers 1 and 2 overlap by 10 mm"},
        {HEAD "[chamber1]\nshape = sphere\ncenter = 15, 0, 99\nradius = 10\n[symmetry]\ngroup = "
              "mirror-x\n",
         "chamber 1 reaches from z = 89 to 109"},
        {HEAD "[chamber1]\nshape = sphere\ncenter = 15, 0\nradius = 10\n",
         "three numbers 'x, y, z'"},
        {HEAD "[chamber1]\nshape = cube\ncenter = 15, 0, 50\nradius = 10\n",
         "'cube', expected sphere"},
        {HEAD "[chamber1]\nshape = sphere\nradius = 10\n",
         "key 'center' in section '[chamber1]' is missing"},
        {HEAD "[chamber2]\nshape = sphere\ncenter = 15, 0, 50\nradius = 10\n",
         "section '[chamber1]' is missing"},
        {HEAD CHAMBER "[chamber9]\nshape = sphere\n", "unknown section '[chamber9]'"},
        {HEAD CHAMBER "[workspace]\nmeasure = 3T\n", "expected each key once"},
        {"[case]\nname = t\n[material]\nmu = 1\n[workspace]\nmeasure = 4T\n",
         "key 'measure' is '4T'"},
        {"[case]\nname = t\n[material]\nmu = 1\n[workspace]\nmeasure = 2T\ndofs = 3,1\n",
         "key 'dofs' is '3,1'"},
        {"[case]\nname = t\n[material]\nlaw = rubber\nmu = 1\n", "key 'law' is 'rubber'"},
        {"[case]\nname = t\n[material]\nlaw = yeoh\nc1 = 1\nmu = 1\n",
         "'mu' is not a parameter of law 'yeoh'"},
        {"[case]\nname = t\nthis is no line\n", "line 3: expected '[section]' or 'key = value'"},
        {"[case]\nname = t\n[material]\nmu = 1\n[optimisation]\nradius = 2\nradius_max = 1\n",
         "at most radius_max"},
        {"[case]\nname = t\n[material]\nmu = 1\n[body]\nwall = 3\n",
         "key 'height' in section '[body]' is missing"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        refused(bad[i].text, bad[i].says);
}

#define FREE "[case]\nname = t\n[material]\nmu = 1\n[workspace]\n"

static void test_workspaces(void)
{
    static const struct {
        const char *text, *says;
    } bad[] = {
        {FREE "field = best\n", "key 'field' is 'best', expected exact or taylor"},
        {FREE "[actuation]\nreduce = 1\n", "key 'reduce' is '1', expected yes or no"},
        {FREE "weight = cone\n", "expected none, box, gaussian or half-space"},
        {FREE "weight = box\nweight_center = 0,0,1\nweight_size = 1,1,1\n",
         "key 'weight_width' is missing for weight = box"},
        {FREE "weight = gaussian\nweight_center = 0,0,1\nweight_size = 1,1,0\n",
         "expected three numbers > 0"},
        {FREE "weight_center = 0,0,1\n", "key 'weight_center' does not go with weight = none"},
        {FREE "weight = half-space\nweight_center = 0,0,1\nweight_width = 1\nweight_normal = "
              "0,0,0\n",
         "key 'weight_normal' is 0"},
        {FREE "measure = manifold\n", "measure manifold expects"},
        {HEAD CHAMBER "[symmetry]\ngroup = c3\n", "with more chambers than DoFs poses repeat"},
        {HEAD CHAMBER, "fewer chambers than DoFs have measure manifold"},
    };
    struct pm_case c;
    struct pm_err err = {.status = PM_OK};
    ok(pm_case_parse(FREE "measure = manifold\ndofs = 1,3,5\nlever = 20\nform = volume\nweight = "
                          "half-space\nweight_on = direction\nweight_center = 0,0,0\n"
                          "weight_normal = 0,3,4\nweight_width = 0.2\n[actuation]\nreduce = no\n",
                     "t", &c, &err) == PM_OK,
       "a weighted manifold %s", err.text);
    ok(c.ndofs == 3 && c.lever == 20 && c.full_set && c.weight.kind == PM_WEIGHT_HALF_SPACE &&
           c.weight.direction && c.weight.normal[2] == 0.8 && c.weight.size[0] == 0,
       "its values");
    pm_case_release(&c);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        refused(bad[i].text, bad[i].says);
}

int main(void)
{
    test_workspaces();
    test_reference();
    test_groups();
    test_materials();
    test_bad_materials();
    test_constraints();
    test_refusals();
    struct pm_case c;
    struct pm_err err = {.status = PM_OK};
    ok(pm_case_load("no/such.ini", &c, &err) == PM_INPUT && strstr(err.text, "no/such.ini") != NULL,
       "missing file");
    return tap_done();
}
