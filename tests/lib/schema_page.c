/* The items of the schema as an mdoc list: the generated part of pneumorph-format(5). */
#include <stdio.h>

#include "common/files/schema.h"

int main(void)
{
    ptrdiff_t n;
    const struct pm_item *item = pm_schema_items(&n);
    for (ptrdiff_t i = 0; i < n; i++) {
        printf(".It Pa %s\n%s", item[i].name, pm_schema_type_name(item[i].type));
        for (const char *p = item[i].shape; *p != '\0'; p++)
            printf("%s%c", p == item[i].shape ? " (" : "", *p == ' ' ? ',' : *p);
        printf("%s, unit %s, in: %s%s.\n%s.\n", item[i].shape[0] != '\0' ? ")" : "", item[i].unit,
               item[i].kinds, item[i].required ? "" : "; optional", item[i].text);
    }
    return 0;
}
