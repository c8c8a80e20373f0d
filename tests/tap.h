/* TAP for C tests: checks count themselves, `return tap_done();` at the end of main prints the
 * plan, so a test that dies early has none and fails. Run one test by hand: make
 * build/tests/unit/NAME && build/tests/unit/NAME */
#ifndef TAP_H
#define TAP_H

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

static int tap_count, tap_failed;

/* One check; the name is a printf format. Returns what it was given. */
__attribute__((format(printf, 2, 3))) static inline int ok(int good, const char *name, ...)
{
    va_list args;
    printf("%s %d - ", good ? "ok" : "not ok", ++tap_count);
    va_start(args, name);
    vprintf(name, args);
    va_end(args);
    putchar('\n');
    tap_failed += !good;
    return good;
}

static inline int tap_compare(const char *name, double got, double want, double error,
                              double tolerance)
{
    int good = error <= tolerance; /* false for NaN */
    ok(good, "%s", name);
    if (!good)
        printf("# %s: got %.17g, want %.17g, error %.3g, tolerance %.3g\n", name, got, want, error,
               tolerance);
    return good;
}

/* |got - want| <= tolerance */
static inline int near_abs(const char *name, double got, double want, double tolerance)
{
    return tap_compare(name, got, want, fabs(got - want), tolerance);
}

/* |got - want| <= tolerance |want| */
static inline int near_rel(const char *name, double got, double want, double tolerance)
{
    return tap_compare(name, got, want, fabs(got - want) / fabs(want), tolerance);
}

/* max |got - want| <= tolerance max |want| over n entries; reports the worst one. */
static inline int near_array(const char *name, const double *got, const double *want, ptrdiff_t n,
                             double tolerance)
{
    double scale = 0, worst = 0;
    ptrdiff_t at = 0;
    for (ptrdiff_t i = 0; i < n; i++)
        scale = fmax(scale, fabs(want[i]));
    for (ptrdiff_t i = 0; i < n; i++) {
        double error = fabs(got[i] - want[i]);
        if (!(error <= worst)) {
            worst = error;
            at = i;
        }
    }
    if (n <= 0)
        return ok(0, "%s: nothing to compare", name);
    int good = tap_compare(name, got[at], want[at], scale > 0 ? worst / scale : worst, tolerance);
    if (!good)
        printf("# at entry %td of %td, scale %.3g\n", at, n, scale);
    return good;
}

static inline int tap_done(void)
{
    printf("1..%d\n", tap_count);
    return tap_failed > 0;
}

/* The rest of the test makes no sense: say why, no plan. */
__attribute__((format(printf, 1, 2))) static inline int tap_bail(const char *why, ...)
{
    va_list args;
    printf("Bail out! ");
    va_start(args, why);
    vprintf(why, args);
    va_end(args);
    putchar('\n');
    return 1;
}

#endif
