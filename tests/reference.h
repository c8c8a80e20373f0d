/* Numeric reference cases: JSON files under tests/data, read with cJSON. Tests run from the source
 * root. */
#ifndef REFERENCE_H
#define REFERENCE_H

#include <cjson/cJSON.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The parsed file, NULL (with a TAP diagnostic) if it cannot be used; cJSON_Delete. */
static inline cJSON *reference_load(const char *path)
{
    FILE *stream = fopen(path, "rb");
    char *text = NULL;
    cJSON *json = NULL;
    if (stream != NULL && fseek(stream, 0, SEEK_END) == 0) {
        long size = ftell(stream);
        rewind(stream);
        text = size > 0 ? calloc((size_t)size + 1, 1) : NULL;
        if (text != NULL && fread(text, 1, (size_t)size, stream) == (size_t)size)
            json = cJSON_Parse(text);
    }
    if (stream != NULL)
        fclose(stream);
    free(text);
    if (json == NULL)
        printf("# cannot use '%s'\n", path);
    return json;
}

static inline ptrdiff_t reference_flatten(const cJSON *item, double *out, ptrdiff_t at,
                                          ptrdiff_t max)
{
    if (cJSON_IsNumber(item)) {
        if (at < max)
            out[at] = item->valuedouble;
        return at + 1;
    }
    const cJSON *child;
    cJSON_ArrayForEach(child, item) at = reference_flatten(child, out, at, max);
    return at;
}

/* Numbers of the member `name` (nested arrays in C order) into out; how many there are, 0 if it is
 * missing. */
static inline ptrdiff_t reference_numbers(const cJSON *object, const char *name, double *out,
                                          ptrdiff_t max)
{
    const cJSON *item = name != NULL ? cJSON_GetObjectItemCaseSensitive(object, name) : object;
    return item != NULL ? reference_flatten(item, out, 0, max) : 0;
}

#endif
