/* Materials by name: the laws with the keys of their parameters, the presets with their source, and
 * the [material] section of a case that says one of them. */
#ifndef PM_MATERIAL_H
#define PM_MATERIAL_H

#include <stddef.h>

#include "common/base/status.h"

enum { PM_MAX_LAWS = 4, PM_MAX_LAW_PARAMETERS = 12 };

struct pm_material_law {
    const char *name;
    ptrdiff_t least, most; /* parameters it takes */
    ptrdiff_t step;        /* 0: those left out are 0; else they come in groups of `step` */
    /* Keys of the case file in the order of the parameters; alpha [1], all others [MPa]. */
    const char *key[PM_MAX_LAW_PARAMETERS];
};

struct pm_material_preset {
    const char *name, *law, *source;
    ptrdiff_t n;
    double c[PM_MAX_LAW_PARAMETERS]; /* parameters of the law (n) */
};

/* As --law with --parameters, or --material, and --kappa say it. */
struct pm_material {
    const char *law, *preset; /* NULL: not given; borrowed */
    ptrdiff_t n;
    double c[PM_MAX_LAW_PARAMETERS]; /* (n) */
    double kappa;                    /* bulk modulus [MPa], 0: not given */
};

/* The tables; a name that is not in them: NULL. */
const struct pm_material_law *pm_material_laws(ptrdiff_t *count);
const struct pm_material_law *pm_material_law(const char *name);
const struct pm_material_preset *pm_material_presets(ptrdiff_t *count);
const struct pm_material_preset *pm_material_preset(const char *name);

/* "a, b or c" of the names of all laws or presets, cut to size. */
void pm_material_law_names(char *out, size_t size);
void pm_material_preset_names(char *out, size_t size);

/* Small-strain shear modulus [MPa] of parameters c (n): mu; 2 (c10 + c01); 2 c1; 1/2 sum mu_k
 * alpha_k. */
double pm_material_shear(const struct pm_material_law *law, ptrdiff_t n, const double *c);

/* Whether the law takes n parameters. */
int pm_material_takes(const struct pm_material_law *law, ptrdiff_t n);
/* Takes option material, law, parameters or kappa: *taken tells whether it was one of them. */
enum pm_status pm_material_option(struct pm_material *m, const char *name, const char *value,
                                  int *taken, struct pm_err *err);
/* Refuses (PM_USAGE) a law without parameters, parameters without a law, a law beside a preset. */
enum pm_status pm_material_check(const struct pm_material *m, struct pm_err *err);
/* "law = ..", "key = value" lines that say m, digits kept. PM_USAGE for an unknown law or preset
 * and for a wrong number of parameters, PM_SYSTEM if size is not enough. */
enum pm_status pm_material_text(const struct pm_material *m, char *out, size_t size,
                                struct pm_err *err);

#endif
