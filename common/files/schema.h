/* The one table of everything a file can hold: it drives writing, reading and checking of every
 * dataset, and the format page is checked against it. */
#ifndef PM_SCHEMA_H
#define PM_SCHEMA_H

#include <stddef.h>

/* A format change bumps it; readers refuse another major number. */
#define PM_FORMAT_VERSION "1.0"

enum pm_type { PM_TYPE_DOUBLE, PM_TYPE_INT32, PM_TYPE_INT64, PM_TYPE_UINT8, PM_TYPE_TEXT };

struct pm_item {
    const char *kinds; /* file kinds that hold it, space separated */
    const char *name;  /* path; %d stands for a surface number */
    enum pm_type type;
    const char
        *shape; /* sizes, space separated: a number, a symbol (nn), a symbol plus a number (nn+1);
                   "" is one value. A symbol is one number per file; %d in it as in the name */
    const char *unit;
    const char *text;
    int required; /* 1: in every file of its kinds, unless that records a failure (/failure) */
};

enum { PM_SIZE_NAME = 24, PM_MAX_SYMBOLS = 64 };

/* One size of an item: value = (value of the symbol, 0 where it is "") + add. */
struct pm_size {
    char symbol[PM_SIZE_NAME];
    ptrdiff_t add;
};

/* The numbers that the symbols of one file stand for. */
struct pm_symbols {
    int n;
    struct {
        char name[PM_SIZE_NAME];
        ptrdiff_t value;
    } symbol[PM_MAX_SYMBOLS];
};

const struct pm_item *pm_schema_items(ptrdiff_t *n);
/* The item of a kind with this full path, NULL if there is none; *index is the number at %d, else
 * 0. */
const struct pm_item *pm_schema_find(const char *kind, const char *name, int *index);
/* Fills size (at most max of them) for the index and returns the rank. */
int pm_schema_sizes(const struct pm_item *item, int index, int max, struct pm_size *size);
/* 1: found is the size; a symbol seen for the first time takes its number from it. *expected as
 * known. */
int pm_schema_agree(struct pm_symbols *symbols, const struct pm_size *size, ptrdiff_t found,
                    ptrdiff_t *expected);
/* 1: word is one of the space separated words of list. */
int pm_schema_word_in(const char *word, const char *list);
const char *pm_schema_type_name(enum pm_type type);

#endif
