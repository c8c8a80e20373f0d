/* The case file: one table of keys drives parsing, defaults and checks of single values. */
#include "common/files/case.h"

#include <errno.h>
#include <ini.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/files/case_complete.h"

enum { MAX_TEXT = 1 << 20, MAX_LINE = 198 };

enum value_type { NUMBER, INTEGER, WORD, NUMBERS };
enum range { ANY, POSITIVE, NOT_NEGATIVE };

struct key {
    const char *section, *name;
    enum value_type type;
    enum range range;
    size_t offset; /* in struct pm_case_raw */
    size_t size;   /* WORD: bytes; NUMBERS: how many */
};

#define AT(member)      offsetof(struct pm_case_raw, member)
#define WORD_AT(member) WORD, ANY, AT(member), sizeof(((struct pm_case_raw *)0)->member)
#define CHAMBER(member) offsetof(struct pm_chamber_raw, member)

static const struct key keys[] = {
    {"case", "name", WORD_AT(c.name)},
    {"material", "law", WORD_AT(c.law)},
    {"material", "preset", WORD_AT(preset)},
    {"material", "kappa", NUMBER, POSITIVE, AT(c.kappa), 0},
    {"body", "shape", WORD_AT(body)},
    {"body", "height", NUMBER, POSITIVE, AT(c.height), 0},
    {"body", "wall", NUMBER, POSITIVE, AT(c.wall), 0},
    {"body", "web", NUMBER, POSITIVE, AT(c.web), 0},
    {"body", "radius", NUMBER, POSITIVE, AT(c.body_radius), 0},
    {"body", "width", NUMBER, POSITIVE, AT(c.body_width), 0},
    {"body", "depth", NUMBER, POSITIVE, AT(c.body_depth), 0},
    {"body", "rounding", NUMBER, POSITIVE, AT(c.body_rounding), 0},
    {"body", "around", INTEGER, POSITIVE, AT(c.around), 0},
    {"body", "rows", INTEGER, POSITIVE, AT(c.rows), 0},
    {"symmetry", "group", WORD_AT(group)},
    {"actuation", "pmin", NUMBER, ANY, AT(c.pmin), 0},
    {"actuation", "pmax", NUMBER, ANY, AT(c.pmax), 0},
    {"actuation", "points", INTEGER, POSITIVE, AT(c.points), 0},
    {"actuation", "reduce", WORD_AT(reduce)},
    {"workspace", "measure", WORD_AT(c.measure)},
    {"workspace", "form", WORD_AT(form)},
    {"workspace", "dofs", WORD_AT(dofs)},
    {"workspace", "lever", NUMBER, POSITIVE, AT(c.lever), 0},
    {"workspace", "field", WORD_AT(field)},
    {"workspace", "weight", WORD_AT(weight)},
    {"workspace", "weight_on", WORD_AT(weight_on)},
    {"workspace", "weight_center", NUMBERS, ANY, AT(c.weight.center), 3},
    {"workspace", "weight_size", NUMBERS, POSITIVE, AT(c.weight.size), 3},
    {"workspace", "weight_normal", NUMBERS, ANY, AT(c.weight.normal), 3},
    {"workspace", "weight_width", NUMBER, POSITIVE, AT(c.weight.width), 0},
    {"mesh", "size", NUMBER, POSITIVE, AT(c.mesh_size), 0},
    {"mesh", "crest", NUMBER, POSITIVE, AT(c.mesh_crest), 0},
    {"mesh", "layers", INTEGER, NOT_NEGATIVE, AT(c.mesh_layers), 0},
    {"mesh", "extension", WORD_AT(extension)},
    {"constraints", "wall_min", NUMBER, POSITIVE, AT(c.wall_min), 0},
    {"constraints", "void_min", NUMBER, POSITIVE, AT(c.void_min), 0},
    {"constraints", "curvature_max", NUMBER, POSITIVE, AT(c.curvature_max), 0},
    {"constraints", "gap_min", NUMBER, NOT_NEGATIVE, AT(c.gap_min), 0},
    {"constraints", "amplification_max", NUMBER, NOT_NEGATIVE, AT(c.amplification_max), 0},
    {"constraints", "cap_min", NUMBER, NOT_NEGATIVE, AT(c.cap_min), 0},
    {"constraints", "contact", WORD_AT(contact)},
    {"constraints", "domain", WORD_AT(domain)},
    {"constraints", "domain_radius", NUMBER, POSITIVE, AT(c.domain_radius), 0},
    {"constraints", "domain_x", NUMBER, POSITIVE, AT(c.domain_half[0]), 0},
    {"constraints", "domain_y", NUMBER, POSITIVE, AT(c.domain_half[1]), 0},
    {"optimisation", "radius", NUMBER, POSITIVE, AT(c.radius), 0},
    {"optimisation", "radius_max", NUMBER, POSITIVE, AT(c.radius_max), 0},
    {"optimisation", "remesh_every", INTEGER, NOT_NEGATIVE, AT(c.remesh_every), 0},
    {"optimisation", "secants", INTEGER, NOT_NEGATIVE, AT(c.secants), 0},
    {"optimisation", "max_iterations", INTEGER, POSITIVE, AT(c.max_iterations), 0},
    {"optimisation", "tolerance", NUMBER, POSITIVE, AT(c.tolerance), 0},
};

static const struct key chamber_keys[] = {
    {"chamber", "shape", WORD, ANY, CHAMBER(shape), sizeof(((struct pm_chamber_raw *)0)->shape)},
    {"chamber", "center", NUMBERS, ANY, CHAMBER(c.center), 3},
    {"chamber", "radius", NUMBER, POSITIVE, CHAMBER(c.radius), 0},
    {"chamber", "length", NUMBER, POSITIVE, CHAMBER(c.length), 0},
    {"chamber", "amplitude", NUMBER, NOT_NEGATIVE, CHAMBER(c.amplitude), 0},
    {"chamber", "pitch", NUMBER, POSITIVE, CHAMBER(c.pitch), 0},
    {"chamber", "spacing", NUMBER, POSITIVE, CHAMBER(c.spacing), 0},
    {"chamber", "section", NUMBERS, POSITIVE, CHAMBER(c.section), 2},
    {"chamber", "turn", NUMBER, ANY, CHAMBER(c.turn), 0},
    {"chamber", "cells", INTEGER, POSITIVE, CHAMBER(c.cells), 0},
    {"chamber", "thickness", NUMBER, POSITIVE, CHAMBER(c.thickness), 0},
    {"chamber", "width", NUMBER, POSITIVE, CHAMBER(c.width), 0},
    {"chamber", "depth", NUMBER, POSITIVE, CHAMBER(c.depth), 0},
    {"chamber", "channel", NUMBER, POSITIVE, CHAMBER(c.channel), 0},
    {"chamber", "twist", NUMBER, ANY, CHAMBER(c.twist), 0},
};

enum {
    NKEYS = sizeof keys / sizeof keys[0],
    NCHAMBER = sizeof chamber_keys / sizeof chamber_keys[0]
};

struct parser {
    const char *file, *rest; /* name for messages; text still to be read */
    int line, too_long;
    unsigned char seen[NKEYS], seen_chamber[PM_MAX_CHAMBERS][NCHAMBER];
    unsigned char seen_parameter[PM_MAX_LAWS][PM_MAX_LAW_PARAMETERS];
    struct pm_case_raw *raw;
    struct pm_err *err;
};

/* fgets for libinih that counts the lines. */
static char *next_line(char *buffer, int size, void *user)
{
    struct parser *p = user;
    if (*p->rest == '\0' || p->too_long)
        return NULL;
    size_t n = strcspn(p->rest, "\n");
    p->line++;
    if (n > MAX_LINE || n + 2 > (size_t)size) {
        p->too_long = 1;
        return NULL;
    }
    memcpy(buffer, p->rest, n);
    buffer[n] = '\0';
    p->rest += n + (p->rest[n] == '\n');
    return buffer;
}

static int refuse(struct parser *p, const struct key *k, const char *value, const char *expected)
{
    pm_fail(p->err, PM_INPUT, "cannot use '%s': line %d: key '%s' is '%s', expected %s", p->file,
            p->line, k->name, value, expected);
    return 0;
}

static const char *range_text(enum range range)
{
    return range == POSITIVE       ? "a number > 0"
           : range == NOT_NEGATIVE ? "a number >= 0"
                                   : "a number";
}

static int in_range(double v, enum range range)
{
    return isfinite(v) && !(range == POSITIVE && v <= 0) && !(range == NOT_NEGATIVE && v < 0);
}

static int take_number(struct parser *p, const struct key *k, const char *value, void *target)
{
    char *end;
    double v = strtod(value, &end);
    if (end == value || *end != '\0' || !in_range(v, k->range))
        return refuse(p, k, value, range_text(k->range));
    memcpy(target, &v, sizeof v);
    return 1;
}

static int take_integer(struct parser *p, const struct key *k, const char *value, void *target)
{
    char *end;
    errno = 0;
    long v = strtol(value, &end, 10);
    if (end == value || *end != '\0' || errno != 0 || !in_range((double)v, k->range) || v > INT_MAX)
        return refuse(p, k, value, k->range == POSITIVE ? "an integer > 0" : "an integer >= 0");
    memcpy(target, &v, sizeof v);
    return 1;
}

static int take_numbers(struct parser *p, const struct key *k, const char *value, void *target)
{
    double v[3] = {0};
    const char *at = value;
    for (size_t i = 0; i < k->size; i++) {
        char *end;
        v[i] = strtod(at, &end);
        end += strspn(end, " \t");
        if (end == at || !in_range(v[i], k->range) || *end != (i + 1 < k->size ? ',' : '\0'))
            return refuse(p, k, value,
                          k->size == 2           ? "two numbers > 0 'a, b'"
                          : k->range == POSITIVE ? "three numbers > 0 'x, y, z'"
                                                 : "three numbers 'x, y, z'");
        at = end + 1;
    }
    memcpy(target, v, k->size * sizeof v[0]);
    return 1;
}

static int take_word(struct parser *p, const struct key *k, const char *value, void *target)
{
    size_t length = strlen(value);
    if (length == 0 || length >= k->size)
        return refuse(p, k, value, "a shorter word");
    memcpy(target, value, length + 1);
    return 1;
}

static int take(struct parser *p, const struct key *k, const char *value, unsigned char *seen,
                void *base)
{
    void *target = (char *)base + k->offset;
    if (*seen)
        return refuse(p, k, value, "each key once");
    *seen = 1;
    switch (k->type) {
    case NUMBER:
        return take_number(p, k, value, target);
    case INTEGER:
        return take_integer(p, k, value, target);
    case NUMBERS:
        return take_numbers(p, k, value, target);
    default:
        return take_word(p, k, value, target);
    }
}

/* 0-based chamber of a section "chamber1" .., -1 for another section. */
static int chamber_number(const char *section)
{
    static const char head[] = "chamber";
    const char *digit = section + sizeof head - 1;
    if (strncmp(section, head, sizeof head - 1) != 0 || digit[0] < '1' ||
        digit[0] > '0' + PM_MAX_CHAMBERS || digit[1] != '\0')
        return -1;
    return digit[0] - '1';
}

static int take_chamber(struct parser *p, int r, const char *name, const char *value)
{
    for (int i = 0; i < NCHAMBER; i++) {
        if (strcmp(chamber_keys[i].name, name) == 0) {
            p->raw->listed |= 1u << r;
            return take(p, &chamber_keys[i], value, &p->seen_chamber[r][i], &p->raw->chamber[r]);
        }
    }
    pm_fail(p->err, PM_INPUT, "cannot use '%s': line %d: unknown key '%s' in section '[chamber%d]'",
            p->file, p->line, name, r + 1);
    return 0;
}

/* A parameter of a law; -1: there is no such key. */
static int take_parameter(struct parser *p, const char *name, const char *value)
{
    ptrdiff_t laws;
    const struct pm_material_law *law = pm_material_laws(&laws);
    for (ptrdiff_t l = 0; l < laws; l++)
        for (ptrdiff_t i = 0; i < law[l].most; i++)
            if (strcmp(law[l].key[i], name) == 0) {
                const struct key k = {"material", law[l].key[i], NUMBER, ANY, 0, 0};
                return take(p, &k, value, &p->seen_parameter[l][i], &p->raw->parameter[l][i]);
            }
    return -1;
}

static int handle(void *user, const char *section, const char *name, const char *value)
{
    struct parser *p = user;
    int known = 0;
    if (p->err->status != PM_OK)
        return 0;
    int r = chamber_number(section);
    if (r >= 0)
        return take_chamber(p, r, name, value);
    if (strcmp(section, "material") == 0) {
        const int taken = take_parameter(p, name, value);
        if (taken >= 0)
            return taken;
    }
    for (int i = 0; i < NKEYS; i++) {
        if (strcmp(keys[i].section, section) != 0)
            continue;
        known = 1;
        if (strcmp(keys[i].name, name) == 0)
            return take(p, &keys[i], value, &p->seen[i], p->raw);
    }
    if (known)
        pm_fail(p->err, PM_INPUT, "cannot use '%s': line %d: unknown key '%s' in section '[%s]'",
                p->file, p->line, name, section);
    else
        pm_fail(p->err, PM_INPUT, "cannot use '%s': line %d: unknown section '[%s]'", p->file,
                p->line, section);
    return 0;
}

/* What a case leaves out; NAN or "" where completion decides or refuses. */
static void set_defaults(struct pm_case_raw *raw)
{
    *raw = (struct pm_case_raw){.c = {.kappa = NAN,
                                      .height = NAN,
                                      .wall = NAN,
                                      .web = NAN,
                                      .body_radius = NAN,
                                      .body_width = NAN,
                                      .body_depth = NAN,
                                      .body_rounding = NAN,
                                      .around = 24,
                                      .rows = 48,
                                      .pmax = 0.12,
                                      .points = 2,
                                      .lever = NAN,
                                      .void_min = NAN,
                                      .gap_min = NAN,
                                      .weight = {.center = {NAN, NAN, NAN},
                                                 .size = {NAN, NAN, NAN},
                                                 .normal = {NAN, NAN, NAN},
                                                 .width = NAN},
                                      .mesh_size = 3,
                                      .mesh_crest = 1.2,
                                      .wall_min = 2.5,
                                      .curvature_max = 1,
                                      .amplification_max = 1.5,
                                      .cap_min = 3,
                                      .domain_radius = NAN,
                                      .domain_half = {NAN, NAN},
                                      .radius = 0.3,
                                      .radius_max = 1,
                                      .remesh_every = 5,
                                      .secants = 5,
                                      .max_iterations = 140,
                                      .tolerance = 1e-2},
                                .group = "none",
                                .domain = "none",
                                .form = "boundary",
                                .reduce = "yes",
                                .extension = "laplace",
                                .contact = "ignore",
                                .field = "exact",
                                .weight = "none",
                                .weight_on = "position"};
    for (int l = 0; l < PM_MAX_LAWS; l++)
        for (int i = 0; i < PM_MAX_LAW_PARAMETERS; i++)
            raw->parameter[l][i] = NAN;
    for (int r = 0; r < PM_MAX_CHAMBERS; r++)
        raw->chamber[r].c = (struct pm_chamber){.center = {NAN, NAN, NAN},
                                                .radius = NAN,
                                                .length = NAN,
                                                .amplitude = NAN,
                                                .pitch = NAN,
                                                .spacing = NAN,
                                                .section = {NAN, NAN},
                                                .turn = NAN,
                                                .twist = NAN,
                                                .thickness = NAN,
                                                .width = NAN,
                                                .depth = NAN,
                                                .channel = NAN};
}

enum pm_status pm_case_parse(const char *text, const char *name, struct pm_case *c,
                             struct pm_err *err)
{
    struct pm_case_raw raw;
    struct pm_err local = {.status = PM_OK};
    struct parser p = {.file = name, .rest = text, .raw = &raw, .err = &local};
    *c = (struct pm_case){.text = NULL};
    set_defaults(&raw);
    int result = ini_parse_stream(next_line, &p, handle, &p);
    enum pm_status status;
    if (local.status != PM_OK)
        PM_TRY(pm_fail(err, local.status, "%s", local.text));
    if (p.too_long)
        PM_TRY(pm_fail(err, PM_INPUT, "cannot use '%s': line %d has more than %d characters", name,
                       p.line, (int)MAX_LINE));
    if (result != 0)
        PM_TRY(pm_fail(err, PM_INPUT,
                       "cannot use '%s': line %d: expected '[section]' or 'key = value'", name,
                       result));
    PM_TRY(pm_case_complete(&raw, name, err));
    PM_TRY(PM_NEW(raw.c.text, (ptrdiff_t)strlen(text) + 1, err));
    memcpy(raw.c.text, text, strlen(text) + 1);
    *c = raw.c;
done:
    return status;
}

void pm_case_warn(const struct pm_case *c, const char *name)
{
    if (strcmp(c->law, "ogden") != 0)
        return;
    for (ptrdiff_t i = 0; i + 1 < c->nlaw_parameter; i += 2)
        if (c->law_parameter[i] * c->law_parameter[i + 1] < 0)
            pm_warn("'%s': mu%td alpha%td = %g MPa < 0: the law may be unstable at large strain",
                    name, i / 2 + 1, i / 2 + 1, c->law_parameter[i] * c->law_parameter[i + 1]);
}

enum pm_status pm_case_load(const char *path, struct pm_case *c, struct pm_err *err)
{
    enum pm_status status;
    char *text = NULL;
    *c = (struct pm_case){.text = NULL};
    FILE *stream = fopen(path, "rb");
    if (stream == NULL)
        PM_TRY(pm_fail(err, PM_INPUT, "cannot open '%s': %s", path, strerror(errno)));
    PM_TRY(PM_NEW(text, MAX_TEXT + 1, err));
    size_t n = fread(text, 1, MAX_TEXT, stream);
    if (ferror(stream))
        PM_TRY(pm_fail(err, PM_SYSTEM, "cannot read '%s': %s", path, strerror(errno)));
    if (n == MAX_TEXT || memchr(text, '\0', n) != NULL)
        PM_TRY(pm_fail(err, PM_INPUT, "cannot use '%s': not a case file", path));
    PM_TRY(pm_case_parse(text, path, c, err));
    pm_case_warn(c, path);
done:
    if (stream != NULL)
        fclose(stream);
    pm_free(text);
    return status;
}

enum pm_status pm_case_copy(const struct pm_case *from, struct pm_case *to, struct pm_err *err)
{
    enum pm_status status;
    char *text = NULL;
    size_t size = strlen(from->text) + 1;
    *to = (struct pm_case){.text = NULL};
    PM_TRY(PM_NEW(text, (ptrdiff_t)size, err));
    memcpy(text, from->text, size);
    *to = *from;
    to->text = text;
done:
    return status;
}

/* Appends text to `out` but its sections [material]. */
static void copy_others(const char *text, char *out)
{
    static const char material[] = "[material]";
    int skip = 0;
    for (size_t n; *text != '\0'; text += n) {
        n = strcspn(text, "\n");
        n += text[n] == '\n';
        const char *word = text + strspn(text, " \t");
        if (*word == '[')
            skip = strncmp(word, material, sizeof material - 1) == 0;
        if (!skip) {
            memcpy(out, text, n);
            out += n;
        }
    }
    *out = '\0';
}

enum pm_status pm_case_set_material(struct pm_case *c, const struct pm_material *m,
                                    struct pm_err *err)
{
    enum pm_status status;
    char *text = NULL, lines[960];
    struct pm_case changed = {.text = NULL};
    struct pm_material wanted = *m;
    if (m->law == NULL && m->preset == NULL) {
        wanted.law = c->law;
        wanted.n = c->nlaw_parameter;
        memcpy(wanted.c, c->law_parameter, sizeof wanted.c);
    }
    PM_TRY(pm_material_text(&wanted, lines, sizeof lines, err));
    const size_t size = strlen(c->text) + sizeof lines + 16;
    PM_TRY(PM_NEW(text, (ptrdiff_t)size, err));
    copy_others(c->text, text);
    const size_t used = strlen(text);
    snprintf(text + used, size - used, "%s[material]\n%s",
             used > 0 && text[used - 1] != '\n' ? "\n" : "", lines);
    PM_TRY(pm_case_parse(text, "the case with another material", &changed, err));
    pm_case_warn(&changed, "--parameters");
    pm_case_release(c);
    *c = changed;
done:
    pm_free(text);
    return status;
}

void pm_case_release(struct pm_case *c)
{
    pm_free(c->text);
    *c = (struct pm_case){.text = NULL};
}
