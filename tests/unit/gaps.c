/* The model of closeness: exact at the design, its slope, no gain beyond open gaps. */
#include "tools/trstep/gaps.h"

#include <math.h>
#include <string.h>

#include "tests/tap.h"

enum { N = 4, UNKNOWNS = 3 * N };
static struct pm_err err;

int main(void)
{
    ptrdiff_t offset[2] = {0, N};
    struct pm_step s = {.accepted = {.ns = 1, .offset = offset}};
    struct pm_step copy = {.accepted = {.ns = 1, .offset = offset}};
    double g[2][UNKNOWNS], d[UNKNOWNS], slope[UNKNOWNS] = {0}, opening[UNKNOWNS];
    double norm = 0, along = 0;

    for (int i = 0; i < UNKNOWNS; i++) {
        g[0][i] = sin(i + 1.0);
        g[1][i] = cos(2.0 * i);
        d[i] = 0.1 * cos(3.0 * i + 1);
        norm += g[0][i] * g[0][i];
    }
    near_abs("nothing is close", gaps_at(&s, d, 1, slope), 0, 0);
    ok(gaps_add(&s, 2, 0.5, g[0], &err) == PM_OK && gaps_add(&s, 3, 0.7, g[1], &err) == PM_OK &&
           s.nclose == 2,
       "two states %s", err.text);
    gaps_at(&s, (double[UNKNOWNS]){0}, 1, slope);
    for (int i = 0; i < UNKNOWNS; i++)
        slope[i] -= 2 * g[0][i] + 3 * g[1][i];
    near_array("at the design the slope is a dG", slope, (double[UNKNOWNS]){0}, UNKNOWNS, 1e-15);

    memset(slope, 0, sizeof slope);
    gaps_at(&s, d, -1, slope);
    for (int i = 0; i < UNKNOWNS; i++) {
        double ends[2], moved[UNKNOWNS];
        for (int k = 0; k < 2; k++) {
            memcpy(moved, d, sizeof moved);
            moved[i] += k == 0 ? 1e-4 : -1e-4;
            ends[k] = gaps_at(&s, moved, 0, NULL);
        }
        slope[i] += (ends[0] - ends[1]) / 2e-4;
    }
    near_array("its slope against differences", slope, (double[UNKNOWNS]){0}, UNKNOWNS, 1e-10);

    /* one gap linear in the design: G = (1 - x)^2, so what is wanted is x = 1 and no more */
    for (int i = 0; i < UNKNOWNS; i++) {
        opening[i] = -2 * 0.5 / norm * g[0][i];
        along += opening[i] * g[1][i];
    }
    const double other = fmax(sqrt(0.7) + along / (2 * sqrt(0.7)), 0);
    near_rel("opened, it gives its own closeness", gaps_at(&s, opening, 0, NULL),
             -2 * 0.5 + 3 * (other * other - 0.7), 1e-12);

    ok(gaps_copy(&s, &copy, &err) == PM_OK, "a copy");
    near_rel("is alike", gaps_at(&copy, d, 0, NULL), gaps_at(&s, d, 0, NULL), 0);
    pm_step_release(&(struct pm_step){.nclose = 2,
                                      .close_weight = s.close_weight,
                                      .close_value = s.close_value,
                                      .close_gradient = s.close_gradient});
    pm_step_release(&(struct pm_step){.nclose = 2,
                                      .close_weight = copy.close_weight,
                                      .close_value = copy.close_value,
                                      .close_gradient = copy.close_gradient});
    return tap_done();
}
