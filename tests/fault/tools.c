/* The n-th allocation of a tool fails: status, message, no file, under the sanitizers no leak. n
 * grows by a quarter from one attempt to the next until the tool succeeds. (tetmesh does its work
 * in a child process and needs gmsh: not here.) */
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/base/atomic.h"
#include "common/base/libraries.h"
#include "common/base/log.h"
#include "common/base/memory.h"
#include "tests/tap.h"
#include "tools/adjsens/adjsens.h"
#include "tools/fesolve/fesolve.h"
#include "tools/invkin/invkin.h"
#include "tools/meshexport/meshexport.h"
#include "tools/surfexport/surfexport.h"
#include "tools/surfgen/surfgen.h"
#include "tools/surfremesh/surfremesh.h"
#include "tools/trstep/trstep.h"
#include "tools/wsint/wsint.h"

enum { MAX_OPERANDS = 8 };

struct attempt {
    const char *tool;
    enum pm_status (*run)(const struct pm_common *c, struct pm_err *err);
    const char *operands[MAX_OPERANDS]; /* in the working folder, NULL terminated */
};

static enum pm_status surfgen(const struct pm_common *c, struct pm_err *err)
{
    return surfgen_run(&(const struct surfgen_files){0}, c, err);
}

static enum pm_status surfremesh(const struct pm_common *c, struct pm_err *err)
{
    struct surfremesh_opts opts = {.alpha = 0.1, .iterations = 20};
    return surfremesh_run(&opts, c, err);
}

static enum pm_status fesolve(const struct pm_common *c, struct pm_err *err)
{
    const struct fesolve_opts opts = {.have_load = 1, .element = "tet10-blend", .tolerance = 1e-8};
    return fesolve_run(&opts, c, err);
}

static enum pm_status invkin(const struct pm_common *c, struct pm_err *err)
{
    const struct invkin_opts opts = {.target = {0.05, 0.2},
                                     .ntarget = 2,
                                     .length = 57.3,
                                     .tolerance = 0.1,
                                     .most = 9,
                                     .residual = 1e-8};
    return invkin_run(&opts, c, err);
}

static enum pm_status wsint(const struct pm_common *c, struct pm_err *err)
{
    return wsint_run(&(struct wsint_opts){.points = 0}, c, err);
}

static enum pm_status adjsens(const struct pm_common *c, struct pm_err *err)
{
    return adjsens_run(&(struct adjsens_opts){.seed = 1, .radius = 0.02}, c, err);
}

static enum pm_status trstep(const struct pm_common *c, struct pm_err *err)
{
    return trstep_run(&(struct trstep_opts){.judge = 0}, c, err);
}

static enum pm_status meshexport(const struct pm_common *c, struct pm_err *err)
{
    const struct meshexport_opts opts = {.npressure = 2, .pressure = {0.1, 0.05}, .steps = 1};
    return meshexport_run(&opts, c, err);
}

static enum pm_status export_part(const char *what, const struct pm_common *c, struct pm_err *err)
{
    const struct surfexport_opts opts = {
        .what = what,
        .size = 8,
        .tolerance = 1,
        .mould = {.pull = 1, .wall = 8, .print = 4, .clearance = 0.2}};
    return surfexport_run(&opts, c, err);
}

static enum pm_status surfexport_mould(const struct pm_common *c, struct pm_err *err)
{
    return export_part("mould2", c, err);
}

static enum pm_status surfexport_plate(const struct pm_common *c, struct pm_err *err)
{
    return export_part("plate", c, err);
}

static void test_tool(const struct attempt *a)
{
    char *operands[MAX_OPERANDS];
    int noperands = 0, bad = 0, attempts = 0;
    enum pm_status status = PM_SYSTEM;
    long n = 1;
    struct pm_err err = {.status = PM_OK};
    for (; a->operands[noperands] != NULL; noperands++) {
        operands[noperands] = malloc(64);
        snprintf(operands[noperands], 64, "%s", a->operands[noperands]);
    }
    const struct pm_common common = {.output = "out.h5",
                                     .tool = a->tool,
                                     .command = a->tool,
                                     .noperands = noperands,
                                     .operands = operands};
    for (; status != PM_OK && n < 1000000 && bad == 0; n += 1 + n / 4, attempts++) {
        err = (struct pm_err){.status = PM_OK};
        pm_memory_fail_at(n);
        status = a->run(&common, &err);
        pm_memory_fail_at(0);
        if (status != PM_OK)
            bad += status != PM_SYSTEM || err.status != PM_SYSTEM || err.text[0] == '\0' ||
                   access("out.h5", F_OK) == 0;
    }
    ok(bad == 0 && status == PM_OK && attempts > 5 && access("out.h5", F_OK) == 0,
       "%s after %d failures", a->tool, attempts - 1);
    if (bad != 0 || status != PM_OK)
        printf("# request %ld of %s: status %d, '%s'\n", n, a->tool, (int)status, err.text);
    unlink("out.h5");
    for (int i = 0; i < noperands; i++)
        free(operands[i]);
}

/* The files of one iteration by the tools themselves. */
static int prepare(const char *folder, const char *build)
{
    static const char script[] =
        "set -e; root=$PWD; case $BUILD in /*) b=$BUILD/bin ;; *) b=$root/$BUILD/bin ;; esac; cd "
        "%s;"
        "cp $root/tests/data/tiny.ini .; $b/surfgen tiny.ini -o surf.h5; $b/tetmesh surf.h5 -o "
        "mesh.h5;"
        "for g in 0 1 2 3; do $b/fesolve -l $g mesh.h5 -o state-$g.h5; done; $b/wsint state-?.h5 "
        "-o work.h5;"
        "for g in 0 1 2 3; do $b/adjsens state-$g.h5 work.h5 -o sens-$g.h5; done";
    char command[sizeof script + 128];
    setenv("BUILD", build, 0);
    snprintf(command, sizeof command, script, folder);
    int status = system(command);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 && chdir(folder) == 0;
}

int main(void)
{
    static const struct attempt attempts[] = {
        {"surfgen", surfgen, {"tiny.ini"}},
        {"surfremesh", surfremesh, {"surf.h5"}},
        {"fesolve", fesolve, {"mesh.h5"}},
        {"invkin", invkin, {"mesh.h5"}},
        {"wsint", wsint, {"state-0.h5", "state-1.h5", "state-2.h5", "state-3.h5"}},
        {"adjsens", adjsens, {"state-0.h5", "work.h5"}},
        {"meshexport", meshexport, {"mesh.h5"}},
        {"surfexport", surfexport_mould, {"surf.h5"}},
        {"surfexport", surfexport_plate, {"surf.h5"}},
        {"trstep",
         trstep,
         {"surf.h5", "work.h5", "sens-0.h5", "sens-1.h5", "sens-2.h5", "sens-3.h5"}},
    };
    char folder[] = "/tmp/pm-fault-XXXXXX", command[64];
    if (mkdtemp(folder) == NULL || !prepare(folder, "build"))
        return tap_bail("the tools do not make the inputs");
    pm_gsl_quiet();
    pm_h5_quiet();
    pm_log_set("fault", -1);
    for (size_t i = 0; i < sizeof attempts / sizeof attempts[0]; i++)
        test_tool(&attempts[i]);
    snprintf(command, sizeof command, "ls -A | grep -c '^[.]' >/dev/null");
    ok(system(command) != 0, "no temporary is left");
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command) == 0 ? tap_done() : 1;
}
