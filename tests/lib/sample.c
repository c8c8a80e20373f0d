/* sample KIND FILE: a small valid file of that kind (tests/records.h). */
#include <stdio.h>

#include "tests/records.h"

int main(int argc, char **argv)
{
    struct pm_err err = {.status = PM_OK};
    union sample r;
    if (argc != 3)
        return PM_USAGE;
    enum pm_status status = sample_make(argv[1], &r, &err);
    if (status == PM_OK) {
        status = sample_write(argv[2], argv[1], &r, &err);
        sample_release(argv[1], &r);
    }
    if (status != PM_OK)
        fprintf(stderr, "sample: %s\n", err.text);
    return (int)status;
}
