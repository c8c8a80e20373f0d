/* Rotation and its derivatives against tests/data/rotation.json (five angles from 0 to 2.8 rad). */
#include "common/mechanics/rotation.h"

#include "tests/reference.h"
#include "tests/tap.h"

int main(void)
{
    cJSON *root = reference_load("tests/data/rotation.json");
    if (root == NULL)
        return tap_bail("no reference");
    const cJSON *item;
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(root, "cases"))
    {
        double theta[3], want[243];
        struct pm_rotation r;
        reference_numbers(item, "theta", theta, 3);
        pm_rotation_at(theta, 1, &r);
        reference_numbers(item, "R", want, 9);
        near_array("R", r.R, want, 9, 2e-15);
        reference_numbers(item, "R_i", want, 27);
        near_array("dR", &r.Ri[0][0], want, 27, 2e-15);
        reference_numbers(item, "R_ij", want, 81);
        near_array("d2R", &r.Rij[0][0][0], want, 81, 4e-15);
        reference_numbers(item, "R_ijk", want, 243);
        near_array("d3R", &r.Rijk[0][0][0][0], want, 243, 2e-14);
    }
    cJSON_Delete(root);
    return tap_done();
}
