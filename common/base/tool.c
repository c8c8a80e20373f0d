/* The frame of a command line tool. */
#include "common/base/tool.h"

#include <assert.h>
#include <errno.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/atomic.h"
#include "common/base/libraries.h"
#include "common/base/log.h"
#include "common/base/memory.h"

enum { MAX_OPTIONS = 64, COMMON_OPTIONS = 5, LONG_ONLY = 1000 };

static const struct pm_option common_options[COMMON_OPTIONS] = {
    {"output", 'o', "FILE", "write the result to FILE"},
    {"verbose", 'v', NULL, "say more (repeatable)"},
    {"quiet", 'q', NULL, "no warnings, no progress"},
    {"help", 'h', NULL, "print this text"},
    {"version", 'V', NULL, "print the version and those of the libraries"},
};

/* The options of a tool followed by the common ones, in the forms getopt wants. */
struct option_list {
    int n;
    const struct pm_option *item[MAX_OPTIONS];
    struct option longs[MAX_OPTIONS + 1];
    char shorts[2 * MAX_OPTIONS + 2];
};

static void list_options(const struct pm_tool *tool, struct option_list *l)
{
    memset(l, 0, sizeof *l);
    for (const struct pm_option *o = tool->options; o != NULL && o->name != NULL; o++) {
        assert(l->n < MAX_OPTIONS - COMMON_OPTIONS);
        l->item[l->n++] = o;
    }
    for (int i = 0; i < COMMON_OPTIONS; i++)
        l->item[l->n++] = &common_options[i];
    char *s = l->shorts;
    *s++ = ':';
    for (int i = 0; i < l->n; i++) {
        const struct pm_option *o = l->item[i];
        l->longs[i] = (struct option){.name = o->name,
                                      .has_arg = o->arg != NULL ? required_argument : no_argument,
                                      .val = LONG_ONLY + i};
        if (o->letter != 0) {
            *s++ = (char)o->letter;
            if (o->arg != NULL)
                *s++ = ':';
        }
    }
}

static const struct pm_option *find_option(const struct option_list *l, int value)
{
    if (value >= LONG_ONLY)
        return l->item[value - LONG_ONLY];
    for (int i = 0; i < l->n; i++)
        if (l->item[i]->letter == value)
            return l->item[i];
    return NULL;
}

static void print_help(const struct pm_tool *tool, const struct option_list *l)
{
    printf("usage: %s [options] %s%s%s\n\n%s\n\noptions:\n", tool->name, tool->operands,
           tool->operands[0] != '\0' ? " " : "", tool->output_optional ? "[-o FILE]" : "-o FILE",
           tool->summary);
    for (int i = 0; i < l->n; i++) {
        const struct pm_option *o = l->item[i];
        char left[64];
        snprintf(left, sizeof left, "%s%s%s", o->name, o->arg != NULL ? " " : "",
                 o->arg != NULL ? o->arg : "");
        if (o->letter != 0)
            printf("  -%c, --%-24s %s\n", o->letter, left, o->help);
        else
            printf("      --%-24s %s\n", left, o->help);
    }
    printf("\nexit status: 0 done, 1 system or library, 2 usage, 3 invalid input, 4 numerical "
           "failure\n");
}

static void print_version(const struct pm_tool *tool)
{
    char hdf5[32], suitesparse[32];
    pm_h5_version(hdf5, sizeof hdf5);
    pm_suitesparse_version(suitesparse, sizeof suitesparse);
    printf("%s (pneumorph) %s\nHDF5 %s, SuiteSparse %s, GSL %s, zlib %s\n", tool->name, PM_VERSION,
           hdf5, suitesparse, pm_gsl_version(), pm_zlib_version());
}

/* Appends one word, its folders left out, quoted for a shell where it needs it. */
static enum pm_status append_word(char **text, const char *word, struct pm_err *err)
{
    const char *value = strncmp(word, "--", 2) == 0 ? strchr(word, '=') : NULL;
    value = value != NULL ? value + 1 : word;
    if (value[0] >= '1' && value[0] <= '9' && value[1] == '=')
        value += 2; /* N=FILE */
    const char *slash = strrchr(value, '/');
    const char *rest = slash != NULL ? slash + 1 : value;
    static const char *const plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
        "-_.,:=+@%";
    const char *quote = rest[0] != '\0' && strspn(rest, plain) == strlen(rest) ? "" : "'";
    size_t old = *text != NULL ? strlen(*text) : 0;
    size_t size = old + strlen(word) + 4;
    char *longer = pm_realloc(*text, (ptrdiff_t)size, 1, err);
    if (longer == NULL)
        return PM_SYSTEM;
    snprintf(longer + old, size - old, "%s%.*s%s%s%s", old > 0 ? " " : "", (int)(value - word),
             word, quote, rest, quote);
    *text = longer;
    return PM_OK;
}

/* The command line without what cannot change the result: folders, -v, -q. */
static enum pm_status describe(const struct pm_tool *tool, int argc, char **argv, char **text,
                               struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(append_word(text, tool->name, err));
    for (int i = 1; i < argc; i++) {
        const char *w = argv[i];
        int silent = strcmp(w, "--verbose") == 0 || strcmp(w, "--quiet") == 0 ||
                     (w[0] == '-' && w[1] != '\0' && strspn(w + 1, "vq") == strlen(w + 1));
        if (!silent)
            PM_TRY(append_word(text, w, err));
    }
done:
    return status;
}

enum action { ACTION_RUN, ACTION_DONE };

static enum pm_status take_option(const struct pm_tool *tool, const struct pm_option *o,
                                  struct pm_common *common, void *opts, struct pm_err *err)
{
    switch (o >= common_options && o < common_options + COMMON_OPTIONS ? o->letter : 0) {
    case 'o':
        common->output = optarg;
        return PM_OK;
    case 'v':
        common->verbosity++;
        return PM_OK;
    case 'q':
        common->verbosity = -1;
        return PM_OK;
    default:
        return tool->option(opts, o->name, o->arg != NULL ? optarg : NULL, err);
    }
}

static enum pm_status check_operands(const struct pm_tool *tool, const struct pm_common *common,
                                     struct pm_err *err)
{
    if (common->noperands < tool->min_operands)
        return pm_fail(err, PM_USAGE, "found %d operands, expected %s", common->noperands,
                       tool->operands);
    if (tool->max_operands >= 0 && common->noperands > tool->max_operands)
        return pm_fail(err, PM_USAGE, "operand '%s' is one too many, expected %s",
                       common->operands[tool->max_operands], tool->operands);
    if (common->output == NULL && !tool->output_optional)
        return pm_fail(err, PM_USAGE, "no output file, expected -o FILE");
    return PM_OK;
}

static enum pm_status parse(const struct pm_tool *tool, int argc, char **argv,
                            struct pm_common *common, void *opts, enum action *action,
                            struct pm_err *err)
{
    struct option_list l;
    list_options(tool, &l);
    *action = ACTION_RUN;
    opterr = 0;
    for (;;) {
        int at = optind;
        int value = getopt_long(argc, argv, l.shorts, l.longs, NULL);
        if (value == -1)
            break;
        if (value == '?')
            return pm_fail(err, PM_USAGE, "unknown option '%s'",
                           argv[optind > at ? optind - 1 : at]);
        if (value == ':')
            return pm_fail(err, PM_USAGE, "option '%s' needs a value", argv[optind - 1]);
        const struct pm_option *o = find_option(&l, value);
        if (o == &common_options[3] || o == &common_options[4]) {
            if (o->letter == 'h')
                print_help(tool, &l);
            else
                print_version(tool);
            *action = ACTION_DONE;
            return PM_OK;
        }
        enum pm_status status = take_option(tool, o, common, opts, err);
        if (status != PM_OK)
            return status;
    }
    common->noperands = argc - optind;
    common->operands = argv + optind;
    return check_operands(tool, common, err);
}

/* OpenBLAS 0.3.21 does not know the newest processors and takes its slowest kernel (Prescott)
 * there, four times slower: name the kernel that the instruction set allows. */
static const char *blas_kernel(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
        return "SkylakeX";
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        return "Haswell";
#endif
    return NULL;
}

/* The thread pools of OpenMP and OpenBLAS and the BLAS kernel are chosen at process start only. */
static void restart_tuned(char **argv)
{
    static const char *const names[] = {"OMP_THREAD_LIMIT", "OPENBLAS_NUM_THREADS",
                                        "OMP_NUM_THREADS"};
    int changed = 0;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (getenv(names[i]) == NULL)
            changed |= setenv(names[i], "1", 0) == 0;
    }
    if (blas_kernel() != NULL && getenv("OPENBLAS_CORETYPE") == NULL)
        changed |= setenv("OPENBLAS_CORETYPE", blas_kernel(), 0) == 0;
    /* By its own path, so that the process keeps its name; where that fails, the run is merely
     * slower. */
    char path[4096];
    ssize_t n = changed ? readlink("/proc/self/exe", path, sizeof path - 1) : -1;
    if (n > 0) {
        path[n] = '\0';
        execv(path, argv);
    }
}

int pm_tool_main(const struct pm_tool *tool, int argc, char **argv, void *opts)
{
    restart_tuned(argv);
    pm_gsl_quiet();
    pm_h5_quiet();
    pm_atomic_guard();
    struct pm_err err = {.status = PM_OK};
    struct pm_common common = {.tool = tool->name};
    enum action action;
    char *command = NULL;
    enum pm_status status;
    PM_TRY(parse(tool, argc, argv, &common, opts, &action, &err));
    if (action == ACTION_RUN) {
        pm_log_set(tool->name, common.verbosity);
        PM_TRY(describe(tool, argc, argv, &command, &err));
        common.command = command;
        PM_TRY(tool->run(opts, &common, &err));
    }
    if (fflush(stdout) != 0)
        status = pm_fail(&err, PM_SYSTEM, "cannot write standard output: %s", strerror(errno));
done:
    pm_progress("%s", "");
    pm_free(command);
    if (status != PM_OK)
        fprintf(stderr, "%s: %s\n", tool->name, err.text);
    if (status == PM_USAGE)
        fprintf(stderr, "Try '%s --help'.\n", tool->name);
    return (int)status;
}
