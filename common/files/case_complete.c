#include "common/files/case_complete.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Slack of comparisons between numbers of the case file [mm]. */
static const double slack = 1e-9;
static const double PI = 3.14159265358979323846;

static enum pm_status missing(const char *name, const char *section, const char *key,
                              struct pm_err *err)
{
    return pm_fail(err, PM_INPUT, "cannot use '%s': key '%s' in section '[%s]' is missing", name,
                   key, section);
}

static enum pm_status bad_word(const char *name, const char *key, const char *found,
                               const char *expected, struct pm_err *err)
{
    return pm_fail(err, PM_INPUT, "cannot use '%s': key '%s' is '%s', expected %s", name, key,
                   found, expected);
}

static enum pm_status use_preset(struct pm_case_raw *raw, const char *name, struct pm_err *err)
{
    char names[256];
    struct pm_case *c = &raw->c;
    const struct pm_material_preset *p = pm_material_preset(raw->preset);
    if (p == NULL) {
        pm_material_preset_names(names, sizeof names);
        return bad_word(name, "preset", raw->preset, names, err);
    }
    if (c->law[0] != '\0')
        return pm_fail(err, PM_INPUT, "cannot use '%s': key 'law' does not go with 'preset'", name);
    snprintf(c->law, sizeof c->law, "%s", p->law);
    c->nlaw_parameter = p->n;
    memcpy(c->law_parameter, p->c, sizeof p->c);
    return PM_OK;
}

/* The parameters of a law given by keys: those of other laws (all laws with a preset) are refused.
 */
static enum pm_status use_keys(struct pm_case_raw *raw, const struct pm_material_law *law,
                               const char *name, struct pm_err *err)
{
    struct pm_case *c = &raw->c;
    ptrdiff_t laws, n = 0;
    const struct pm_material_law *all = pm_material_laws(&laws);
    for (ptrdiff_t l = 0; l < laws; l++)
        for (ptrdiff_t i = 0; i < all[l].most; i++) {
            if (isnan(raw->parameter[l][i]))
                continue;
            if (&all[l] != law)
                return pm_fail(err, PM_INPUT,
                               "cannot use '%s': key '%s' is not a parameter of %s '%s'", name,
                               all[l].key[i], law != NULL ? "law" : "preset",
                               law != NULL ? c->law : raw->preset);
            n = i + 1;
        }
    if (law == NULL)
        return PM_OK;
    n = n < law->least ? law->least : n;
    if (law->step > 1)
        n = (n + law->step - 1) / law->step * law->step;
    for (ptrdiff_t i = 0; i < n; i++) {
        const double value = raw->parameter[law - all][i];
        if (isnan(value) && (law->step > 0 || i < law->least))
            return missing(name, "material", law->key[i], err);
        c->law_parameter[i] = isnan(value) ? 0 : value;
    }
    c->nlaw_parameter = n;
    return PM_OK;
}

static enum pm_status complete_material(struct pm_case_raw *raw, const char *name,
                                        struct pm_err *err)
{
    enum pm_status status;
    struct pm_case *c = &raw->c;
    char names[256];
    if (raw->preset[0] != '\0') {
        PM_TRY(use_preset(raw, name, err));
        PM_TRY(use_keys(raw, NULL, name, err));
    } else {
        if (c->law[0] == '\0')
            snprintf(c->law, sizeof c->law, "neo-hookean");
        if (pm_material_law(c->law) == NULL) {
            pm_material_law_names(names, sizeof names);
            PM_TRY(bad_word(name, "law", c->law, names, err));
        }
        PM_TRY(use_keys(raw, pm_material_law(c->law), name, err));
    }
    for (ptrdiff_t i = 1; strcmp(c->law, "ogden") == 0 && i < c->nlaw_parameter; i += 2)
        if (c->law_parameter[i] == 0)
            PM_TRY(pm_fail(err, PM_INPUT, "cannot use '%s': key 'alpha%td' is 0, expected another",
                           name, i / 2 + 1));
    c->mu = pm_material_shear(pm_material_law(c->law), c->nlaw_parameter, c->law_parameter);
    if (!(c->mu > 0) || !isfinite(c->mu))
        PM_TRY(pm_fail(err, PM_INPUT,
                       "cannot use '%s': law '%s' has the small-strain shear modulus %g MPa, "
                       "expected > 0",
                       name, c->law, c->mu));
    if (isnan(c->kappa))
        c->kappa = 100 * c->mu;
done:
    return status;
}

static enum pm_status complete_body(struct pm_case_raw *raw, const char *name, struct pm_err *err)
{
    static const char *const shapes[] = {"cylinder", "envelope", "file", "rounded-box"};
    struct pm_case *c = &raw->c;
    int shape = raw->body[0] == '\0' ? PM_BODY_ENVELOPE : 0;
    while (shape < 4 && raw->body[0] != '\0' && strcmp(shapes[shape], raw->body) != 0)
        shape++;
    if (shape == 4)
        return bad_word(name, "shape", raw->body, "envelope, cylinder, rounded-box or file", err);
    c->body = (enum pm_body)shape;
    struct {
        const char *key;
        double *value;
        int of, wanted;
    } use[] = {{"height", &c->height, -1, 1},
               {"wall", &c->wall, PM_BODY_ENVELOPE, 1},
               {"web", &c->web, PM_BODY_ENVELOPE, 0},
               {"radius", &c->body_radius, PM_BODY_CYLINDER, 1},
               {"width", &c->body_width, PM_BODY_BOX, 1},
               {"depth", &c->body_depth, PM_BODY_BOX, 1},
               {"rounding", &c->body_rounding, PM_BODY_BOX, 1}};
    for (size_t i = 0; i < sizeof use / sizeof use[0]; i++) {
        int mine = use[i].of < 0 || use[i].of == shape;
        if (mine && use[i].wanted && isnan(*use[i].value))
            return missing(name, "body", use[i].key, err);
        if (!mine && !isnan(*use[i].value))
            return pm_fail(err, PM_INPUT,
                           "cannot use '%s': key '%s' in section '[body]' belongs to shape = %s",
                           name, use[i].key, shapes[use[i].of]);
        if (!mine)
            *use[i].value = 0;
    }
    if (isnan(c->web))
        c->web = 2 * c->wall;
    if (c->body == PM_BODY_BOX && 2 * c->body_rounding >= fmin(c->body_width, c->body_depth))
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': rounding is %g, expected less than half of width %g and "
                       "depth %g",
                       name, c->body_rounding, c->body_width, c->body_depth);
    if (c->around < 8 || c->rows < 8)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': keys 'around' and 'rows' are %ld and %ld, expected "
                       "at least 8",
                       name, c->around, c->rows);
    return PM_OK;
}

/* Radius of the bounding cylinder. */
static double outer_radius(const struct pm_chamber *k)
{
    return (k->radius + k->amplitude) * fmax(k->section[0], k->section[1]);
}

/* Angles in degrees become radians; an ellipse turned by pi is itself. */
static enum pm_status complete_section(struct pm_chamber *c, int r, const char *name,
                                       struct pm_err *err)
{
    if (isnan(c->section[0])) {
        if (!isnan(c->turn) || !isnan(c->twist))
            return pm_fail(err, PM_INPUT,
                           "cannot use '%s': chamber %d has '%s' without 'section', expected both",
                           name, r + 1, isnan(c->turn) ? "twist" : "turn");
        c->section[0] = c->section[1] = 1;
    }
    c->turn = isnan(c->turn) ? 0 : c->turn * PI / 180;
    c->turn -= PI * ceil(c->turn / PI - 0.5);
    c->twist = isnan(c->twist) ? 0 : c->twist * PI / 180;
    return PM_OK;
}

static enum pm_status complete_cells(struct pm_chamber *c, int r, const char *name,
                                     struct pm_err *err)
{
    if (!isnan(c->section[0]) || !isnan(c->turn) || !isnan(c->twist))
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': chamber %d has 'section', 'turn' or 'twist', which shape "
                       "= pneunet does not take",
                       name, r + 1);
    if (c->channel >= c->depth || c->channel >= c->width || c->thickness >= c->pitch)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': chamber %d: expected a channel narrower than the cells "
                       "and cells thinner than the pitch",
                       name, r + 1);
    c->length = (double)(c->cells - 1) * c->pitch + c->thickness;
    c->radius = c->channel / 2;
    c->amplitude = 0;
    if (isnan(c->spacing))
        c->spacing = c->thickness / 4;
    return complete_section(c, r, name, err);
}

/* The keys that the shape of chamber r takes are there, no others. */
static enum pm_status check_keys(const struct pm_chamber_raw *raw, const char *section,
                                 const char *name, struct pm_err *err)
{
    const struct pm_chamber *c = &raw->c;
    int wave = c->shape == PM_SHAPE_BELLOWS, sphere = c->shape == PM_SHAPE_SPHERE;
    int file = c->shape == PM_SHAPE_FILE;
    int cells = c->shape == PM_SHAPE_PNEUNET;
    const struct {
        const char *key;
        double value;
        int wanted;
    } use[] = {{"center", c->center[0], 1},
               {"radius", c->radius, !file && !cells},
               {"length", c->length, !sphere && !file && !cells},
               {"amplitude", c->amplitude, wave},
               {"pitch", c->pitch, wave || cells},
               {"cells", c->cells > 0 ? (double)c->cells : nan(""), cells},
               {"thickness", c->thickness, cells},
               {"width", c->width, cells},
               {"depth", c->depth, cells},
               {"channel", c->channel, cells}};
    for (size_t i = 0; i < sizeof use / sizeof use[0]; i++) {
        if (use[i].wanted && isnan(use[i].value))
            return missing(name, section, use[i].key, err);
        if (!use[i].wanted && !isnan(use[i].value))
            return pm_fail(err, PM_INPUT,
                           "cannot use '%s': key '%s' in section '[%s]' is not one of shape "
                           "= %s",
                           name, use[i].key, section, raw->shape);
    }
    if (file && !(isnan(c->section[0]) && isnan(c->turn) && isnan(c->twist)))
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': keys 'section', 'turn' and 'twist' in section '[%s]' are "
                       "none of shape = file",
                       name, section);
    return PM_OK;
}

static enum pm_status complete_chamber(struct pm_chamber_raw *raw, int r, const char *name,
                                       struct pm_err *err)
{
    static const char *const shapes[] = {"sphere",  "ellipsoid", "capsule",
                                         "bellows", "file",      "pneunet"};
    struct pm_chamber *c = &raw->c;
    char section[16] = {'c', 'h', 'a', 'm', 'b', 'e', 'r', (char)('1' + r), '\0'};
    int shape = 0;
    while (shape < 6 && strcmp(shapes[shape], raw->shape) != 0)
        shape++;
    if (raw->shape[0] == '\0')
        return missing(name, section, "shape", err);
    if (shape == 6)
        return bad_word(name, "shape", raw->shape,
                        "sphere, ellipsoid, capsule, bellows, pneunet or file", err);
    c->shape = (enum pm_shape)shape;
    enum pm_status status = check_keys(raw, section, name, err);
    if (status != PM_OK)
        return status;
    int wave = c->shape == PM_SHAPE_BELLOWS, sphere = c->shape == PM_SHAPE_SPHERE;
    int file = c->shape == PM_SHAPE_FILE;
    if (c->shape == PM_SHAPE_PNEUNET)
        return complete_cells(c, r, name, err);
    c->thickness = c->width = c->depth = c->channel = 0;
    if (sphere)
        c->length = 2 * c->radius;
    if (!wave)
        c->amplitude = c->pitch = 0;
    if (file)
        c->radius = c->length = 0;
    if (!file && c->amplitude >= c->radius)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': amplitude of chamber %d is %g, expected less than "
                       "its radius %g",
                       name, r + 1, c->amplitude, c->radius);
    if ((c->shape == PM_SHAPE_CAPSULE || wave) && c->length < 2 * c->radius)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': length of chamber %d is %g, expected at least twice "
                       "its radius %g",
                       name, r + 1, c->length, c->radius);
    /* At least 14 control points around and 6 along a wave resolve the surface to a few hundredths
       of a millimetre. */
    if (isnan(c->spacing))
        c->spacing = file ? 2.5 : fmin(2.5, 2 * PI * c->radius / 14);
    if (wave && isnan(raw->c.spacing))
        c->spacing = fmin(c->spacing, c->pitch / 6);
    return complete_section(c, r, name, err);
}

static enum pm_status complete_chambers(struct pm_case_raw *raw, const char *name,
                                        struct pm_err *err)
{
    struct pm_case *c = &raw->c;
    while (c->nchambers < PM_MAX_CHAMBERS && (raw->listed >> c->nchambers & 1u) != 0) {
        int r = (int)c->nchambers++;
        enum pm_status status = complete_chamber(&raw->chamber[r], r, name, err);
        if (status != PM_OK)
            return status;
        c->chamber[r] = raw->chamber[r].c;
    }
    if (raw->listed >> c->nchambers != 0)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': section '[chamber%td]' is missing, later ones are "
                       "given",
                       name, c->nchambers + 1);
    return pm_case_images(c, name, err);
}

/* The body that follows cells is made for limbs that are images of each other around the axis, the
 * first one on +x. */
static enum pm_status check_limbs(const struct pm_case *c, const char *name, struct pm_err *err)
{
    const struct pm_chamber *a = &c->chamber[0];
    int good = c->nchambers <= 3 && c->body == PM_BODY_ENVELOPE && fabs(a->center[1]) < slack &&
               a->center[0] > slack && fabs(a->center[2] - c->height / 2) < slack;
    for (ptrdiff_t r = 0; r < c->nchambers; r++) {
        const struct pm_chamber *b = &c->chamber[r];
        double angle = 2 * PI * (double)r / (double)c->nchambers;
        int there = 0;
        for (ptrdiff_t s = 0; s < c->nchambers; s++)
            there |= hypot(c->chamber[s].center[0] - a->center[0] * cos(angle),
                           c->chamber[s].center[1] - a->center[0] * sin(angle)) < 1e-9 * c->height;
        good = good && there && b->shape == a->shape && b->cells == a->cells &&
               b->pitch == a->pitch && b->thickness == a->thickness && b->width == a->width &&
               b->depth == a->depth && b->channel == a->channel;
    }
    return good ? PM_OK
                : pm_fail(err, PM_INPUT,
                          "cannot use '%s': shape = pneunet with %td chambers, expected 1 to 3 "
                          "equal limbs around the z axis in an envelope, half-way up, the first "
                          "one at y = 0, x > 0",
                          name, c->nchambers);
}

/* The chambers lie in the body and do not touch each other. */
static enum pm_status check_chambers(const struct pm_case *c, const char *name, struct pm_err *err)
{
    int limbs = 0;
    for (ptrdiff_t r = 0; r < c->nchambers; r++)
        limbs |= c->chamber[r].shape == PM_SHAPE_PNEUNET;
    if (limbs && check_limbs(c, name, err) != PM_OK)
        return PM_INPUT;
    for (ptrdiff_t r = 0; r < c->nchambers; r++) {
        const struct pm_chamber *k = &c->chamber[r];
        double low = k->center[2] - k->length / 2, high = k->center[2] + k->length / 2;
        double reach = hypot(k->center[0], k->center[1]) + outer_radius(k);
        if (k->shape == PM_SHAPE_FILE && c->body == PM_BODY_ENVELOPE)
            return pm_fail(err, PM_INPUT,
                           "cannot use '%s': chamber %td comes from a file, expected a body that "
                           "is no envelope",
                           name, r + 1);
        if (k->shape == PM_SHAPE_FILE) /* its surface says where it is */
            continue;
        if (low < c->cap_min - slack || high > c->height - c->cap_min + slack)
            return pm_fail(err, PM_INPUT,
                           "cannot use '%s': chamber %td reaches from z = %g to %g, expected "
                           "within cap_min = %g and height - cap_min = %g",
                           name, r + 1, low, high, c->cap_min, c->height - c->cap_min);
        if (c->body == PM_BODY_CYLINDER && reach > c->body_radius - c->wall_min + slack)
            return pm_fail(err, PM_INPUT,
                           "cannot use '%s': chamber %td reaches to radius %g, expected at "
                           "most body radius - wall_min = %g",
                           name, r + 1, reach, c->body_radius - c->wall_min);
        for (ptrdiff_t s = 0; !limbs && s < r; s++) {
            const struct pm_chamber *o = &c->chamber[s];
            double gap = hypot(k->center[0] - o->center[0], k->center[1] - o->center[1]) -
                         outer_radius(k) - outer_radius(o);
            if (o->shape == PM_SHAPE_FILE)
                continue;
            double gap_z = fabs(k->center[2] - o->center[2]) - (k->length + o->length) / 2;
            if (gap <= 0 && gap_z <= 0)
                return pm_fail(err, PM_INPUT,
                               "cannot use '%s': chambers %td and %td overlap by %g mm, "
                               "expected bounding cylinders apart",
                               name, s + 1, r + 1, -gap);
        }
    }
    return PM_OK;
}

/* Keys of another domain are refused; those not used become 0. */
static enum pm_status complete_domain(struct pm_case_raw *raw, const char *name, struct pm_err *err)
{
    struct pm_case *c = &raw->c;
    static const char *const words[] = {"none", "cylinder", "box"};
    int k = 0;
    while (k < 3 && strcmp(words[k], raw->domain) != 0)
        k++;
    if (k == 3)
        return bad_word(name, "domain", raw->domain, "none, cylinder or box", err);
    c->domain = (enum pm_domain)k;
    const struct {
        const char *key;
        double *value;
        enum pm_domain of;
    } use[] = {{"domain_radius", &c->domain_radius, PM_DOMAIN_CYLINDER},
               {"domain_x", &c->domain_half[0], PM_DOMAIN_BOX},
               {"domain_y", &c->domain_half[1], PM_DOMAIN_BOX}};
    for (size_t i = 0; i < sizeof use / sizeof use[0]; i++) {
        if (use[i].of == c->domain && isnan(*use[i].value))
            return missing(name, "constraints", use[i].key, err);
        if (use[i].of != c->domain && !isnan(*use[i].value))
            return pm_fail(err, PM_INPUT,
                           "cannot use '%s': key '%s' in section '[constraints]' is not one of "
                           "domain = %s",
                           name, use[i].key, raw->domain);
        if (use[i].of != c->domain)
            *use[i].value = 0;
    }
    return PM_OK;
}

enum pm_status pm_case_complete(struct pm_case_raw *raw, const char *name, struct pm_err *err)
{
    enum pm_status status;
    struct pm_case *c = &raw->c;
    if (c->name[0] == '\0')
        PM_TRY(missing(name, "case", "name", err));
    PM_TRY(complete_material(raw, name, err));
    int has_body = raw->body[0] != '\0' || !isnan(c->height) || !isnan(c->wall) || !isnan(c->web) ||
                   !isnan(c->body_radius) || !isnan(c->body_width) || !isnan(c->body_depth) ||
                   !isnan(c->body_rounding);
    if (raw->listed != 0 || has_body)
        PM_TRY(complete_body(raw, name, err));
    else
        c->height = c->wall = c->web = c->body_radius = c->body_width = c->body_depth =
            c->body_rounding = 0;
    PM_TRY(pm_case_group(raw->group, c->height, &c->symmetry, name, err));
    PM_TRY(complete_chambers(raw, name, err));
    PM_TRY(check_chambers(c, name, err));
    PM_TRY(complete_domain(raw, name, err));
    PM_TRY(pm_case_workspace(raw, name, err));
    c->extension = PM_EXTENSION_LAPLACE;
    if (strcmp(raw->extension, "elasticity") == 0)
        c->extension = PM_EXTENSION_ELASTICITY;
    else if (strcmp(raw->extension, "laplace") != 0)
        PM_TRY(bad_word(name, "extension", raw->extension, "laplace or elasticity", err));
    if (isnan(c->void_min)) /* casting cores and grooves may be thinner than walls */
        c->void_min = 0.4 * c->wall_min;
    c->contact_rejects = strcmp(raw->contact, "reject") == 0;
    if (!c->contact_rejects && strcmp(raw->contact, "ignore") != 0)
        PM_TRY(bad_word(name, "contact", raw->contact, "ignore or reject", err));
    if (isnan(c->gap_min))
        c->gap_min = c->contact_rejects ? 0.6 * c->wall_min : 0;
    else if (c->gap_min > 0 && !c->contact_rejects)
        PM_TRY(
            pm_fail(err, PM_INPUT,
                    "cannot use '%s': gap_min in section '[constraints]' is %g, expected 0 where "
                    "contact is not reject",
                    name, c->gap_min));
    if (c->radius > c->radius_max)
        PM_TRY(pm_fail(err, PM_INPUT,
                       "cannot use '%s': radius in section '[optimisation]' is %g, expected "
                       "at most radius_max = %g",
                       name, c->radius, c->radius_max));
done:
    return status;
}
