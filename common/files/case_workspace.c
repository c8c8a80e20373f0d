/* Sections [actuation] and [workspace] of a case. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/files/case_complete.h"

/* 0 chambers, 0 DoFs: any number. */
static const struct {
    const char *name;
    int chambers, ndofs, dofs[6];
} measures[] = {
    {"2T", 2, 2, {0, 2}},    {"3T", 3, 3, {0, 1, 2}},   {"2R", 3, 3, {3, 4, 5}},
    {"3R", 3, 3, {3, 4, 5}}, {"1R2T", 3, 3, {0, 2, 4}}, {"3R3T", 6, 6, {0, 1, 2, 3, 4, 5}},
    {"manifold", 0, 0, {0}},
};

/* "1,3" to {0, 2}: distinct numbers 1..6, ascending. */
static int parse_dofs(const char *text, int *dofs)
{
    int n = 0, last = 0;
    for (const char *p = text;; p++) {
        p += strspn(p, " ");
        if (*p < '1' || *p > '6' || *p - '0' <= last)
            return 0;
        last = *p - '0';
        dofs[n++] = last - 1;
        p++;
        p += strspn(p, " ");
        if (*p == '\0')
            return n;
        if (*p != ',')
            return 0;
    }
}

/* The place of `word` in the list, which ends with NULL. */
static enum pm_status choose(const char *name, const char *key, const char *word,
                             const char *const *list, int *place, struct pm_err *err)
{
    char expected[128] = "";
    size_t at = 0;
    for (*place = 0; list[*place] != NULL; ++*place)
        if (strcmp(list[*place], word) == 0)
            return PM_OK;
    for (int i = 0; list[i] != NULL; i++)
        at += (size_t)snprintf(expected + at, sizeof expected - at, "%s%s",
                               i == 0                ? ""
                               : list[i + 1] == NULL ? " or "
                                                     : ", ",
                               list[i]);
    return pm_fail(err, PM_INPUT, "cannot use '%s': key '%s' is '%s', expected %s", name, key, word,
                   expected);
}

static enum pm_status complete_weight(struct pm_case_raw *raw, const char *name, struct pm_err *err)
{
    static const char *const kinds[] = {"none", "box", "gaussian", "half-space", NULL};
    static const char *const fields[] = {"position", "direction", NULL};
    enum pm_status status;
    struct pm_weight *k = &raw->c.weight;
    int kind;

    PM_TRY(choose(name, "weight", raw->weight, kinds, &kind, err));
    PM_TRY(choose(name, "weight_on", raw->weight_on, fields, &k->direction, err));
    k->kind = (enum pm_weight_kind)kind;
    const int sized = kind == PM_WEIGHT_BOX || kind == PM_WEIGHT_GAUSSIAN;
    const struct {
        const char *key;
        double *value;
        int n, wanted;
    } use[] = {
        {"weight_center", k->center, 3, kind != PM_WEIGHT_NONE},
        {"weight_size", k->size, 3, sized},
        {"weight_normal", k->normal, 3, kind == PM_WEIGHT_HALF_SPACE},
        {"weight_width", &k->width, 1, kind == PM_WEIGHT_BOX || kind == PM_WEIGHT_HALF_SPACE}};
    for (size_t i = 0; i < sizeof use / sizeof *use; i++) {
        if (use[i].wanted == isnan(use[i].value[0]))
            PM_TRY(pm_fail(err, PM_INPUT, "cannot use '%s': key '%s' %s weight = %s", name,
                           use[i].key, use[i].wanted ? "is missing for" : "does not go with",
                           raw->weight));
        for (int j = 0; j < use[i].n && !use[i].wanted; j++)
            use[i].value[j] = 0;
    }
    const double length = hypot(hypot(k->normal[0], k->normal[1]), k->normal[2]);
    if (kind == PM_WEIGHT_HALF_SPACE && !(length > 0))
        PM_TRY(pm_fail(err, PM_INPUT,
                       "cannot use '%s': key 'weight_normal' is 0, expected a direction", name));
    for (int j = 0; j < 3 && length > 0; j++)
        k->normal[j] /= length;
done:
    return status;
}

/* The measure against DoFs and chambers. */
static enum pm_status complete_measure(struct pm_case_raw *raw, const char *name,
                                       struct pm_err *err)
{
    struct pm_case *c = &raw->c;
    size_t m = 0, count = sizeof measures / sizeof measures[0];
    while (m < count && strcmp(measures[m].name, c->measure) != 0)
        m++;
    if (m == count)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': key 'measure' is '%s', expected 2T, 3T, 2R, 3R, 1R2T, "
                       "3R3T or manifold",
                       name, c->measure);
    c->ndofs = measures[m].ndofs;
    memcpy(c->dofs, measures[m].dofs, sizeof c->dofs);
    if (c->ndofs == 0) {
        c->ndofs = parse_dofs(raw->dofs, c->dofs);
        if (c->ndofs == 0)
            return pm_fail(err, PM_INPUT,
                           "cannot use '%s': key 'dofs' is '%s', measure manifold expects "
                           "ascending numbers out of 1..6",
                           name, raw->dofs);
        return PM_OK;
    }
    if (raw->dofs[0] != '\0' && parse_dofs(raw->dofs, c->dofs) != c->ndofs)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': key 'dofs' is '%s', expected %d ascending numbers "
                       "out of 1..6",
                       name, raw->dofs, c->ndofs);
    if (c->nchambers > 0 && c->nchambers != measures[m].chambers)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': measure %s with %td chambers, expected %d%s", name,
                       c->measure, c->nchambers, measures[m].chambers,
                       c->nchambers < measures[m].chambers
                           ? "; fewer chambers than DoFs have measure manifold"
                           : "; with more chambers than DoFs poses repeat, and no measure counts "
                             "them once");
    return PM_OK;
}

enum pm_status pm_case_workspace(struct pm_case_raw *raw, const char *name, struct pm_err *err)
{
    static const char *const forms[] = {"boundary", "volume", NULL};
    static const char *const answers[] = {"yes", "no", NULL};
    static const char *const fields[] = {"exact", "taylor", NULL};
    enum pm_status status;
    struct pm_case *c = &raw->c;
    int form;

    PM_TRY(choose(name, "form", raw->form, forms, &form, err));
    c->form = (enum pm_form)form;
    PM_TRY(choose(name, "reduce", raw->reduce, answers, &c->full_set, err));
    PM_TRY(choose(name, "field", raw->field, fields, &c->taylor, err));
    PM_TRY(complete_weight(raw, name, err));
    if (!(c->pmax > c->pmin))
        PM_TRY(pm_fail(err, PM_INPUT, "cannot use '%s': pmax is %g, expected more than pmin = %g",
                       name, c->pmax, c->pmin));
    if (isnan(c->lever))
        c->lever = 0;
    if (c->measure[0] != '\0') /* else no workspace: single equilibria only */
        PM_TRY(complete_measure(raw, name, err));
done:
    return status;
}
