#include "common/files/material.h"

#include <stdio.h>
#include <string.h>

#include "common/base/tool.h"

static const struct pm_material_law laws[] = {
    {"neo-hookean", 1, 1, 1, {"mu"}},
    {"mooney-rivlin", 2, 2, 2, {"c10", "c01"}},
    {"yeoh", 1, 3, 0, {"c1", "c2", "c3"}},
    {"ogden",
     2,
     12,
     2,
     {"mu1", "alpha1", "mu2", "alpha2", "mu3", "alpha3", "mu4", "alpha4", "mu5", "alpha5", "mu6",
      "alpha6"}},
};

/* Constants of a preset never change, since files name it: better ones get another name. Fits: one
 * Ogden term, least squares of nominal stress over 9 to 200 % nominal strain of the published mean
 * curve (first loading, 450 mm/min), rms residual below 1 % of the largest stress. */
#define MARECHAL                                                                                   \
    "fitted to tensile tests of Marechal et al. 2021, Soft Robotics 8:284, "                       \
    "doi 10.1089/soro.2019.0115"
#define PAPER                                                                                      \
    "Continuum Jacobian based computational morphogenesis for soft robotic workspace optimization"
static const struct pm_material_preset presets[] = {
    {"ecoflex-00-30", "ogden", MARECHAL, 2, {0.01327, 2.270}},
    {"ecoflex-00-50", "ogden", MARECHAL, 2, {0.01628, 2.452}},
    {"dragon-skin-10", "ogden", MARECHAL " (Medium)", 2, {0.02729, 3.120}},
    {"dragon-skin-20", "ogden", MARECHAL, 2, {0.08429, 2.972}},
    {"dragon-skin-30", "ogden", MARECHAL, 2, {0.1255, 2.870}},
    {"elastosil-m4601",
     "yeoh",
     "Soft Robotics Toolkit (Holland et al. 2014, Soft Robotics 1:224, doi 10.1089/soro.2014.0010)",
     2,
     {0.11, 0.02}},
    {"smooth-sil-950",
     "neo-hookean",
     "100 % modulus of 272 psi, technical bulletin of Smooth-On",
     1,
     {1.0716}},
    {"sylgard-184",
     "neo-hookean",
     "E = 1.32 MPa cured at 25 C, Johnston et al. 2014, J. Micromech. Microeng. 24:035017, "
     "doi 10.1088/0960-1317/24/3/035017",
     1,
     {0.44}},
    {"shore-40a", "neo-hookean", PAPER ", cured unheated", 1, {0.465}},
    {"shore-40a-heated", "neo-hookean", PAPER ", cured heated", 1, {0.471}},
};

_Static_assert(sizeof laws / sizeof laws[0] == PM_MAX_LAWS, "as many laws as declared");
enum { LAWS = PM_MAX_LAWS, PRESETS = sizeof presets / sizeof presets[0] };

const struct pm_material_law *pm_material_laws(ptrdiff_t *count)
{
    *count = LAWS;
    return laws;
}

const struct pm_material_preset *pm_material_presets(ptrdiff_t *count)
{
    *count = PRESETS;
    return presets;
}

const struct pm_material_law *pm_material_law(const char *name)
{
    for (int i = 0; i < LAWS; i++)
        if (strcmp(laws[i].name, name) == 0)
            return &laws[i];
    return NULL;
}

const struct pm_material_preset *pm_material_preset(const char *name)
{
    for (int i = 0; i < PRESETS; i++)
        if (strcmp(presets[i].name, name) == 0)
            return &presets[i];
    return NULL;
}

/* Appends name i of n. */
static void list(char *out, size_t size, const char *name, int i, int n)
{
    const size_t used = strlen(out);
    snprintf(out + used, size - used, "%s%s", i == 0 ? "" : i + 1 < n ? ", " : " or ", name);
}

void pm_material_law_names(char *out, size_t size)
{
    out[0] = '\0';
    for (int i = 0; i < LAWS; i++)
        list(out, size, laws[i].name, i, LAWS);
}

void pm_material_preset_names(char *out, size_t size)
{
    out[0] = '\0';
    for (int i = 0; i < PRESETS; i++)
        list(out, size, presets[i].name, i, PRESETS);
}

double pm_material_shear(const struct pm_material_law *law, ptrdiff_t n, const double *c)
{
    double mu = 0.0;
    if (strcmp(law->name, "neo-hookean") == 0)
        return c[0];
    if (strcmp(law->name, "mooney-rivlin") == 0)
        return 2 * (c[0] + c[1]);
    if (strcmp(law->name, "yeoh") == 0)
        return 2 * c[0];
    for (ptrdiff_t k = 0; k + 1 < n; k += 2)
        mu += 0.5 * c[k] * c[k + 1];
    return mu;
}

int pm_material_takes(const struct pm_material_law *law, ptrdiff_t n)
{
    return n >= law->least && n <= law->most && (law->step == 0 || n % law->step == 0);
}

enum pm_status pm_material_option(struct pm_material *m, const char *name, const char *value,
                                  int *taken, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int n = 0;
    *taken = 1;
    if (strcmp(name, "material") == 0) {
        m->preset = value;
    } else if (strcmp(name, "law") == 0) {
        m->law = value;
    } else if (strcmp(name, "parameters") == 0) {
        status = pm_parse_doubles(name, value, PM_MAX_LAW_PARAMETERS, m->c, &n, err);
        m->n = n;
    } else if (strcmp(name, "kappa") == 0) {
        status = pm_parse_double(name, value, &m->kappa, err);
        if (status == PM_OK && !(m->kappa > 0))
            status =
                pm_fail(err, PM_USAGE, "option --kappa: found %s, expected a number > 0", value);
    } else {
        *taken = 0;
    }
    return status;
}

enum pm_status pm_material_check(const struct pm_material *m, struct pm_err *err)
{
    if ((m->law != NULL) != (m->n > 0))
        return pm_fail(err, PM_USAGE, "--law and --parameters need each other");
    if (m->law != NULL && m->preset != NULL)
        return pm_fail(err, PM_USAGE, "--law does not go with --material");
    return PM_OK;
}

/* How many parameters this law takes. */
static void counts(const struct pm_material_law *law, char *out, size_t size)
{
    if (law->least == law->most)
        snprintf(out, size, "%td", law->least);
    else
        snprintf(out, size, "%td to %td%s", law->least, law->most,
                 law->step > 1 ? " in pairs" : "");
}

static enum pm_status check(const struct pm_material *m, struct pm_err *err)
{
    char names[256];
    if (m->preset != NULL && pm_material_preset(m->preset) == NULL) {
        pm_material_preset_names(names, sizeof names);
        return pm_fail(err, PM_USAGE, "unknown material '%s', expected %s", m->preset, names);
    }
    if (m->preset != NULL)
        return PM_OK;
    const struct pm_material_law *law = pm_material_law(m->law);
    if (law == NULL) {
        pm_material_law_names(names, sizeof names);
        return pm_fail(err, PM_USAGE, "unknown law '%s', expected %s", m->law, names);
    }
    if (pm_material_takes(law, m->n))
        return PM_OK;
    counts(law, names, sizeof names);
    return pm_fail(err, PM_USAGE, "law '%s': found %td parameters, expected %s", m->law, m->n,
                   names);
}

enum pm_status pm_material_text(const struct pm_material *m, char *out, size_t size,
                                struct pm_err *err)
{
    const enum pm_status status = check(m, err);
    if (status != PM_OK)
        return status;
    int used = snprintf(out, size, m->preset != NULL ? "preset = %s\n" : "law = %s\n",
                        m->preset != NULL ? m->preset : m->law);
    for (ptrdiff_t i = 0; m->preset == NULL && i < m->n && (size_t)used < size; i++)
        used += snprintf(out + used, size - (size_t)used, "%s = %.17g\n",
                         pm_material_law(m->law)->key[i], m->c[i]);
    if (m->kappa > 0 && (size_t)used < size)
        used += snprintf(out + used, size - (size_t)used, "kappa = %.17g\n", m->kappa);
    if ((size_t)used >= size)
        return pm_fail(err, PM_SYSTEM, "the text of a material has more than %zu characters", size);
    return PM_OK;
}
