/* Materials by name: every preset against what its source measured, the laws' tables, the text that
 * says a material. */
#include "common/files/material.h"

#include <stdio.h>
#include <string.h>

#include "common/files/case.h"
#include "common/mechanics/law.h"
#include "tests/lanes.h"
#include "tests/tap.h"

/* Nominal uniaxial stress of the incompressible solid at stretch l, by the law itself. */
static double uniaxial(const struct pm_law *law, double l)
{
    const double t = 1 / sqrt(l), F[9] = {l, 0, 0, 0, t, 0, 0, 0, t};
    double P[9];
    lanes_law_stress(law, F, P);
    return P[0] - P[8] * t / l;
}

/* What the sources state: nominal stress at 100 % and 200 % strain (mean curves of the tensile
 * tests; data sheet) with the residual of the fit, or Young's modulus (3 mu at rest). */
static const struct {
    const char *name;
    double stress100, stress200, E; /* [MPa], 0: not stated */
    double tolerance;
} stated[] = {
    {"ecoflex-00-30", 0.02972, 0.05239, 0, 0.03},
    {"ecoflex-00-50", 0.04095, 0.079005, 0, 0.005},
    {"dragon-skin-10", 0.112963, 0.27279, 0, 0.025},
    {"dragon-skin-20", 0.31836, 0.722257, 0, 0.015},
    {"dragon-skin-30", 0.437123, 0.95947, 0, 0.015},
    {"smooth-sil-950", 272 * 6.894757e-3, 0, 0, 1e-3}, /* psi */
    {"sylgard-184", 0, 0, 1.32, 1e-12},
    {"shore-40a", 0, 0, 3 * 0.465, 1e-12},
    {"shore-40a-heated", 0, 0, 3 * 0.471, 1e-12},
    {"elastosil-m4601", 0, 0, 6 * 0.11, 1e-12},
};

static void check_source(const struct pm_law *law, const char *name)
{
    for (size_t i = 0; i < sizeof stated / sizeof stated[0]; i++) {
        if (strcmp(stated[i].name, name) != 0)
            continue;
        if (stated[i].stress100 > 0)
            near_rel("stress at 100 %", uniaxial(law, 2), stated[i].stress100, stated[i].tolerance);
        if (stated[i].stress200 > 0)
            near_rel("stress at 200 %", uniaxial(law, 3), stated[i].stress200, stated[i].tolerance);
        if (stated[i].E > 0)
            near_rel("Young's modulus", 3 * law->mu, stated[i].E, stated[i].tolerance);
        return;
    }
    ok(0, "'%s' has something to be compared with", name);
}

/* Slope of the stress at rest is 3 mu (to h^2), and the stress grows up to 300 % strain in tension,
 * 50 % in compression: beyond what a fit to 200 % has seen, within what chambers do. */
static void check_behaviour(const struct pm_law *law)
{
    const double h = 1e-4;
    near_rel("E = 3 mu", (uniaxial(law, 1 + h) - uniaxial(law, 1 - h)) / (2 * h), 3 * law->mu,
             1e-6);
    int grows = 1;
    for (int k = 10; k < 80; k++)
        grows = grows && uniaxial(law, 0.05 * (k + 1)) > uniaxial(law, 0.05 * k);
    ok(grows, "stress grows with stretch");
}

/* A line ".It Cm NAME Pq LAW C1, C2.." of the page. */
static int on_page(const struct pm_material_preset *p)
{
    char want[256], line[512];
    int found = 0, used = snprintf(want, sizeof want, ".It Cm %s Pq %s", p->name, p->law);
    for (ptrdiff_t i = 0; i < p->n; i++)
        used +=
            snprintf(want + used, sizeof want - (size_t)used, "%s %.6g", i > 0 ? "," : "", p->c[i]);
    FILE *page = fopen("man/pneumorph-case.5", "r");
    while (page != NULL && fgets(line, sizeof line, page) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        found = found || strcmp(line, want) == 0;
    }
    if (page != NULL)
        fclose(page);
    return found;
}

static void check_preset(const struct pm_material_preset *p)
{
    struct pm_err err = {0};
    struct pm_case c;
    struct pm_law law;
    char text[512], lines[256];
    const struct pm_material m = {.preset = p->name};
    printf("# %s\n", p->name);
    ok(pm_material_text(&m, lines, sizeof lines, &err) == PM_OK, "text %s", err.text);
    snprintf(text, sizeof text, "[case]\nname = t\n[material]\n%s", lines);
    if (!ok(pm_case_parse(text, "t.ini", &c, &err) == PM_OK, "case %s", err.text))
        return;
    ok(strcmp(c.law, p->law) == 0 && c.nlaw_parameter == p->n &&
           memcmp(c.law_parameter, p->c, sizeof p->c) == 0,
       "the case has its constants");
    ok(c.mu > 0 && c.kappa == 100 * c.mu, "mu %g, kappa 100 mu", c.mu);
    ok(pm_law_set(&law, c.law, c.nlaw_parameter, c.law_parameter, c.kappa, &err) == PM_OK &&
           law.mu == c.mu,
       "law %s", err.text);
    ok(strlen(p->source) > 20, "it states its source");
    ok(on_page(p), "it stands in pneumorph-case(5) with its constants");
    check_source(&law, p->name);
    check_behaviour(&law);
    pm_case_release(&c);
}

/* Law, keys and parameters survive their own text, to the last digit. */
static void check_law(const struct pm_material_law *law)
{
    struct pm_err err = {0};
    struct pm_case c;
    char text[1024], lines[960];
    struct pm_material m = {.law = law->name, .n = law->most, .kappa = 7.3};
    for (ptrdiff_t i = 0; i < m.n; i++)
        m.c[i] = 1 / (3.0 + (double)i);
    ok(pm_material_text(&m, lines, sizeof lines, &err) == PM_OK, "text %s", err.text);
    snprintf(text, sizeof text, "[case]\nname = t\n[material]\n%s", lines);
    ok(pm_case_parse(text, "t.ini", &c, &err) == PM_OK && strcmp(c.law, law->name) == 0 &&
           c.nlaw_parameter == m.n && memcmp(c.law_parameter, m.c, sizeof m.c) == 0 &&
           c.kappa == 7.3,
       "%s: %td parameters %s", law->name, m.n, err.text);
    pm_case_release(&c);
    ok(pm_material_text(&m, lines, 20, &err) == PM_SYSTEM, "%s", err.text);
}

static void refused(const struct pm_material *m, const char *says)
{
    struct pm_err err = {0};
    char lines[256];
    if (!ok(pm_material_text(m, lines, sizeof lines, &err) == PM_USAGE &&
                strstr(err.text, says) != NULL,
            "refused: %s", says))
        printf("# got: %s\n", err.text);
}

int main(void)
{
    ptrdiff_t n;
    const struct pm_material_preset *preset = pm_material_presets(&n);
    for (ptrdiff_t i = 0; i < n; i++)
        check_preset(&preset[i]);
    const struct pm_material_law *law = pm_material_laws(&n);
    for (ptrdiff_t i = 0; i < n; i++)
        check_law(&law[i]);
    refused(&(struct pm_material){.law = "ogden", .n = 3},
            "found 3 parameters, expected 2 to 12 in pairs");
    refused(&(struct pm_material){.law = "yeoh", .n = 4}, "found 4 parameters, expected 1 to 3");
    refused(&(struct pm_material){.law = "gent", .n = 2},
            "unknown law 'gent', expected neo-hookean, mooney-rivlin, yeoh or ogden");
    refused(&(struct pm_material){.preset = "butter"}, "shore-40a or shore-40a-heated");
    return tap_done();
}
