/* sample KIND FILE [linear]: a small valid file of that kind (tests/records.h), a mesh or state
 * with one linear tetrahedron. */
#include <stdio.h>

#include "tests/linear.h"
#include "tests/records.h"

int main(int argc, char **argv)
{
    struct pm_err err = {.status = PM_OK};
    union sample r;
    const int linear = argc == 4 && strcmp(argv[3], "linear") == 0;
    if (argc != 3 && !linear)
        return PM_USAGE;
    enum pm_status status = sample_make(argv[1], &r, &err);
    if (status == PM_OK) {
        if (linear)
            sample_linear(strcmp(argv[1], "state") == 0 ? &r.state.mesh : &r.mesh);
        status = sample_write(argv[2], argv[1], &r, &err);
        sample_release(argv[1], &r);
    }
    if (status != PM_OK)
        fprintf(stderr, "sample: %s\n", err.text);
    return (int)status;
}
