/* Scalar items: arrays of rank 0. */
#include "common/files/h5.h"

enum pm_status pm_h5_put_double(struct pm_h5 *f, const char *name, double v, struct pm_err *err)
{
    return pm_h5_put(f, name, NULL, &v, err);
}

enum pm_status pm_h5_put_int(struct pm_h5 *f, const char *name, int64_t v, struct pm_err *err)
{
    return pm_h5_put(f, name, NULL, &v, err);
}

enum pm_status pm_h5_get_double(struct pm_h5 *f, const char *name, double *v, struct pm_err *err)
{
    return pm_h5_get_into(f, name, 1, v, err);
}

enum pm_status pm_h5_get_int(struct pm_h5 *f, const char *name, int64_t *v, struct pm_err *err)
{
    return pm_h5_get_into(f, name, 1, v, err);
}
