/* Typed HDF5 access: files, provenance attributes, datasets. */
#include "common/files/h5.h"

#include <errno.h>
#include <hdf5.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/atomic.h"
#include "common/base/libraries.h"
#include "common/base/memory.h"
#include "common/files/provenance.h"
#include "common/files/schema.h"

enum { KIND_SIZE = 16, COMPACT_LIMIT = 16384, CHUNK_LIMIT = 1 << 22 };

struct pm_h5 {
    hid_t id;
    int writing;
    char kind[KIND_SIZE];
    char path[PM_PATH_MAX];
    struct pm_atomic out;
    struct pm_symbols symbols; /* sizes seen in this file */
};

void pm_h5_quiet(void)
{
    /* Its clean-up at exit crashes after a write that failed (disk full); every file is closed here
     * anyway. */
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

void pm_h5_version(char *text, size_t size)
{
    unsigned major = 0, minor = 0, release = 0;
    H5get_libversion(&major, &minor, &release);
    snprintf(text, size, "%u.%u.%u", major, minor, release);
}

const char *pm_h5_path(const struct pm_h5 *f)
{
    return f->path;
}

enum pm_status pm_h5_refuse(const struct pm_h5 *f, struct pm_err *err, const char *item,
                            const char *format, ...)
{
    char text[256];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return pm_fail(err, PM_INPUT, "cannot use '%s': item '%s' %s", f->path, item, text);
}

static enum pm_status write_failed(const struct pm_h5 *f, const char *item, struct pm_err *err)
{
    return pm_fail(err, PM_SYSTEM, "cannot write '%s': item '%s': HDF5 or disk failure", f->path,
                   item);
}

/* Attributes */

/* A copy of a fixed-length text attribute in new memory; NULL where there is none. */
static char *read_text_attribute(hid_t object, const char *name, struct pm_err *err)
{
    char *text = NULL;
    if (H5Aexists(object, name) <= 0)
        return NULL;
    hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
    hid_t type = H5Aget_type(attribute);
    if (H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0) {
        text = pm_calloc((ptrdiff_t)H5Tget_size(type) + 1, 1, err);
        if (text != NULL && H5Aread(attribute, type, text) < 0)
            text[0] = '\0';
    }
    H5Tclose(type);
    H5Aclose(attribute);
    return text;
}

static hid_t text_type(size_t length)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, length > 0 ? length : 1);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    return type;
}

static int put_text_attribute(hid_t object, const char *name, const char *text)
{
    hid_t type = text_type(strlen(text));
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    int ok = attribute >= 0 && H5Awrite(attribute, type, text) >= 0;
    ok = (attribute < 0 || H5Aclose(attribute) >= 0) && ok;
    H5Sclose(space);
    H5Tclose(type);
    return ok;
}

enum pm_status pm_h5_ancestry(const char *path, char **kind, char **history, char **command,
                              struct pm_err *err)
{
    *kind = *history = *command = NULL;
    if (H5Fis_hdf5(path) <= 0)
        return PM_OK;
    hid_t id = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (id < 0)
        return PM_OK;
    struct pm_err own = {.status = PM_OK};
    *kind = read_text_attribute(id, "kind", &own);
    *history = read_text_attribute(id, "history", &own);
    *command = read_text_attribute(id, "command", &own);
    H5Fclose(id);
    return own.status == PM_OK ? PM_OK : pm_fail(err, own.status, "%s", own.text);
}

/* Files */

static enum pm_status check_header(struct pm_h5 *f, const char *kinds, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_err memory = {.status = PM_OK};
    char *format = read_text_attribute(f->id, "format", &memory);
    char *kind = read_text_attribute(f->id, "kind", &memory);
    char *version = read_text_attribute(f->id, "format_version", &memory);
    if (memory.status != PM_OK)
        status = pm_fail(err, memory.status, "%s", memory.text);
    else if (format == NULL || strcmp(format, "pneumorph") != 0 || kind == NULL || version == NULL)
        status = pm_fail(err, PM_INPUT, "cannot use '%s': not a pneumorph file", f->path);
    else if (strtol(version, NULL, 10) != strtol(PM_FORMAT_VERSION, NULL, 10))
        status = pm_fail(err, PM_INPUT, "cannot use '%s': format version %s, expected %s", f->path,
                         version, PM_FORMAT_VERSION);
    else if (!pm_schema_word_in(kind, kinds))
        status = pm_fail(err, PM_INPUT, "cannot use '%s': it is of kind '%s', expected '%s'",
                         f->path, kind, kinds);
    else
        snprintf(f->kind, sizeof f->kind, "%s", kind);
    pm_free(format);
    pm_free(kind);
    pm_free(version);
    return status;
}

enum pm_status pm_h5_open(const char *path, const char *kinds, struct pm_h5 **out,
                          struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *f = NULL;
    *out = NULL;
    pm_h5_quiet();
    if (access(path, R_OK) != 0)
        return pm_fail(err, PM_INPUT, "cannot open '%s': %s", path, strerror(errno));
    PM_TRY(PM_NEW(f, 1, err));
    snprintf(f->path, sizeof f->path, "%s", path);
    f->out.slot = -1;
    f->id = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (f->id < 0) {
        const char *why = H5Fis_hdf5(path) > 0 ? "truncated or damaged" : "not an HDF5 file";
        status = pm_fail(err, PM_INPUT, "cannot use '%s': %s", path, why);
        goto done;
    }
    PM_TRY(check_header(f, kinds, err));
    *out = f;
    f = NULL;
done:
    pm_h5_close(f);
    return status;
}

static enum pm_status put_provenance(struct pm_h5 *f, const char *kind,
                                     const struct pm_common *common,
                                     const char *const *extra_inputs, struct pm_err *err)
{
    struct pm_provenance p = {.inputs = NULL};
    enum pm_status status;
    PM_TRY(pm_provenance_collect(&p, common, extra_inputs, err));
    const char *const attribute[][2] = {
        {"format", "pneumorph"},
        {"kind", kind},
        {"format_version", PM_FORMAT_VERSION},
        {"tool", common->tool},
        {"tool_version", PM_VERSION},
        {"command", common->command},
        {"inputs", p.inputs},
        {"history", p.history},
    };
    for (size_t i = 0; i < sizeof attribute / sizeof attribute[0]; i++)
        if (!put_text_attribute(f->id, attribute[i][0], attribute[i][1]))
            PM_TRY(write_failed(f, attribute[i][0], err));
done:
    pm_provenance_release(&p);
    return status;
}

/* The 1.8 file format: checksummed metadata, attributes of any size, no times. */
static hid_t create_file(const char *path)
{
    hid_t access_list = H5Pcreate(H5P_FILE_ACCESS);
    hid_t create_list = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_libver_bounds(access_list, H5F_LIBVER_V18, H5F_LIBVER_V18);
    H5Pset_obj_track_times(create_list, 0);
    hid_t id = H5Fcreate(path, H5F_ACC_TRUNC, create_list, access_list);
    H5Pclose(create_list);
    H5Pclose(access_list);
    return id;
}

enum pm_status pm_h5_create(const char *path, const char *kind, const struct pm_common *common,
                            const char *const *extra_inputs, struct pm_h5 **out, struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *f = NULL;
    *out = NULL;
    pm_h5_quiet();
    PM_TRY(PM_NEW(f, 1, err));
    f->id = -1;
    f->writing = 1;
    snprintf(f->kind, sizeof f->kind, "%s", kind);
    snprintf(f->path, sizeof f->path, "%s", path);
    PM_TRY(pm_atomic_begin(&f->out, path, err));
    f->id = create_file(f->out.temporary);
    if (f->id < 0)
        PM_TRY(pm_fail(err, PM_SYSTEM, "cannot write '%s': the file cannot be created", path));
    PM_TRY(put_provenance(f, kind, common, extra_inputs, err));
    *out = f;
    f = NULL;
done:
    pm_h5_close(f);
    return status;
}

static enum pm_status check_complete(struct pm_h5 *f, struct pm_err *err)
{
    ptrdiff_t n;
    const struct pm_item *item = pm_schema_items(&n);
    if (pm_h5_has(f, "/failure"))
        return PM_OK;
    for (ptrdiff_t i = 0; i < n; i++)
        if (item[i].required && pm_schema_word_in(f->kind, item[i].kinds) &&
            strstr(item[i].name, "%d") == NULL && !pm_h5_has(f, item[i].name))
            return pm_fail(err, PM_SYSTEM, "cannot write '%s': item '%s' was not given", f->path,
                           item[i].name);
    return PM_OK;
}

enum pm_status pm_h5_commit(struct pm_h5 *f, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    if (f->writing) {
        PM_TRY(check_complete(f, err));
        int flushed = H5Fflush(f->id, H5F_SCOPE_GLOBAL) >= 0;
        int closed = H5Fclose(f->id) >= 0;
        f->id = -1;
        if (!flushed || !closed)
            PM_TRY(write_failed(f, "/", err));
        PM_TRY(pm_atomic_commit(&f->out, err));
    }
    pm_h5_close(f);
done:
    return status;
}

void pm_h5_close(struct pm_h5 *f)
{
    if (f == NULL)
        return;
    if (f->id >= 0)
        H5Fclose(f->id);
    if (f->writing)
        pm_atomic_abort(&f->out);
    pm_free(f);
}

/* 1: the groups above `name` exist; `make` creates the missing ones. (H5Lexists wants them all, and
 * HDF5's own way of creating them notes the time.) */
static int has_groups(struct pm_h5 *f, const char *name, int make)
{
    char part[256];
    int ok = 1;
    snprintf(part, sizeof part, "%s", name);
    hid_t list = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_obj_track_times(list, 0);
    for (char *p = strchr(part + 1, '/'); p != NULL && ok; p = strchr(p + 1, '/')) {
        *p = '\0';
        ok = H5Lexists(f->id, part, H5P_DEFAULT) > 0;
        if (!ok && make) {
            hid_t group = H5Gcreate2(f->id, part, H5P_DEFAULT, list, H5P_DEFAULT);
            ok = group >= 0 && H5Gclose(group) >= 0;
        }
        *p = '/';
    }
    H5Pclose(list);
    return ok;
}

int pm_h5_has(struct pm_h5 *f, const char *name)
{
    return has_groups(f, name, 0) && H5Lexists(f->id, name, H5P_DEFAULT) > 0;
}

/* Datasets */

static hid_t memory_type(enum pm_type type)
{
    const hid_t types[] = {H5T_NATIVE_DOUBLE, H5T_NATIVE_INT32, H5T_NATIVE_INT64, H5T_NATIVE_UINT8,
                           H5T_C_S1};
    return types[type];
}

static hid_t file_type(enum pm_type type)
{
    const hid_t types[] = {H5T_IEEE_F64LE, H5T_STD_I32LE, H5T_STD_I64LE, H5T_STD_U8LE, H5T_C_S1};
    return types[type];
}

static enum pm_status find_item(const struct pm_h5 *f, const char *name,
                                const struct pm_item **item, int *index, struct pm_err *err)
{
    *item = pm_schema_find(f->kind, name, index);
    if (*item == NULL)
        return pm_fail(err, PM_SYSTEM, "'%s': no item '%s' in the schema of kind '%s'", f->path,
                       name, f->kind);
    return PM_OK;
}

/* Arrays beyond a few kilobytes are one checksummed chunk; integers are compressed. */
static hid_t storage(const struct pm_item *item, int rank, const hsize_t *dims, size_t bytes)
{
    hid_t list = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(list, 0);
    if (bytes < COMPACT_LIMIT)
        return list;
    hsize_t chunk[PM_MAX_RANK];
    size_t row = bytes / (size_t)dims[0];
    memcpy(chunk, dims, (size_t)rank * sizeof chunk[0]);
    if (bytes > CHUNK_LIMIT && row < CHUNK_LIMIT)
        chunk[0] = CHUNK_LIMIT / row;
    H5Pset_chunk(list, rank, chunk);
    if (item->type != PM_TYPE_DOUBLE) {
        H5Pset_shuffle(list);
        H5Pset_deflate(list, 1);
    }
    H5Pset_fletcher32(list);
    return list;
}

static int create_dataset(struct pm_h5 *f, const char *name, const struct pm_item *item, hid_t type,
                          hid_t space, hid_t list, hid_t memory, const void *data)
{
    if (!has_groups(f, name, 1))
        return 0;
    hid_t set = H5Dcreate2(f->id, name, type, space, H5P_DEFAULT, list, H5P_DEFAULT);
    if (set < 0)
        return 0;
    int ok = H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
    ok = ok && put_text_attribute(set, "units", item->unit);
    ok = ok && put_text_attribute(set, "description", item->text);
    return H5Dclose(set) >= 0 && ok;
}

enum pm_status pm_h5_put(struct pm_h5 *f, const char *name, const ptrdiff_t *dims, const void *data,
                         struct pm_err *err)
{
    const struct pm_item *item;
    int index;
    enum pm_status status = find_item(f, name, &item, &index, err);
    if (status != PM_OK)
        return status;
    struct pm_size size[PM_MAX_RANK];
    hsize_t d[PM_MAX_RANK] = {1};
    int rank = pm_schema_sizes(item, index, PM_MAX_RANK, size);
    size_t bytes = H5Tget_size(memory_type(item->type));
    for (int k = 0; k < rank; k++) {
        ptrdiff_t expected;
        if (!pm_schema_agree(&f->symbols, &size[k], dims[k], &expected))
            return pm_fail(err, PM_SYSTEM,
                           "cannot write '%s': item '%s' axis %d has %td, expected %td", f->path,
                           name, k, dims[k], expected);
        d[k] = (hsize_t)dims[k];
        bytes *= (size_t)dims[k];
    }
    hid_t space = rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, d, NULL);
    hid_t list = storage(item, rank, d, bytes);
    int ok = create_dataset(f, name, item, file_type(item->type), space, list,
                            memory_type(item->type), data);
    H5Pclose(list);
    H5Sclose(space);
    return ok ? PM_OK : write_failed(f, name, err);
}

enum pm_status pm_h5_put_text(struct pm_h5 *f, const char *name, const char *v, struct pm_err *err)
{
    const struct pm_item *item;
    int index;
    enum pm_status status = find_item(f, name, &item, &index, err);
    if (status != PM_OK)
        return status;
    hid_t type = text_type(strlen(v));
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t list = storage(item, 0, NULL, 0);
    int ok = create_dataset(f, name, item, type, space, list, type, v);
    H5Pclose(list);
    H5Sclose(space);
    H5Tclose(type);
    return ok ? PM_OK : write_failed(f, name, err);
}

/* An open dataset with what the schema and the file say of it. */
struct entry {
    const struct pm_item *item;
    int index;
    hid_t set, type;
};

static void close_entry(struct entry *e)
{
    if (e->type >= 0)
        H5Tclose(e->type);
    if (e->set >= 0)
        H5Dclose(e->set);
}

static int type_fits(hid_t found, enum pm_type type)
{
    if (type == PM_TYPE_TEXT)
        return H5Tget_class(found) == H5T_STRING && H5Tis_variable_str(found) == 0;
    hid_t want = memory_type(type);
    return H5Tget_class(found) == H5Tget_class(want) && H5Tget_size(found) == H5Tget_size(want) &&
           (type == PM_TYPE_DOUBLE || H5Tget_sign(found) == H5Tget_sign(want));
}

static enum pm_status open_entry(struct pm_h5 *f, const char *name, struct entry *e,
                                 struct pm_err *err)
{
    e->set = e->type = -1;
    enum pm_status status = find_item(f, name, &e->item, &e->index, err);
    if (status != PM_OK)
        return status;
    if (!pm_h5_has(f, name))
        return pm_h5_refuse(f, err, name, "is missing");
    e->set = H5Dopen2(f->id, name, H5P_DEFAULT);
    if (e->set < 0)
        return pm_h5_refuse(f, err, name, "is not a readable dataset");
    e->type = H5Dget_type(e->set);
    if (!type_fits(e->type, e->item->type))
        return pm_h5_refuse(f, err, name, "has another type, expected %s",
                            pm_schema_type_name(e->item->type));
    return PM_OK;
}

/* Checks the shape against the schema; *count is the number of items. */
static enum pm_status entry_shape(struct pm_h5 *f, const char *name, const struct entry *e,
                                  ptrdiff_t *dims, ptrdiff_t *count, struct pm_err *err)
{
    struct pm_size size[PM_MAX_RANK];
    hsize_t d[PM_MAX_RANK] = {0};
    int rank = pm_schema_sizes(e->item, e->index, PM_MAX_RANK, size);
    hid_t space = H5Dget_space(e->set);
    int found = H5Sget_simple_extent_ndims(space);
    if (found == rank)
        H5Sget_simple_extent_dims(space, d, NULL);
    H5S_class_t class = H5Sget_simple_extent_type(space);
    H5Sclose(space);
    if (found != rank || class == H5S_NULL)
        return pm_h5_refuse(f, err, name, "has %d axes, expected %d", found, rank);
    *count = 1;
    for (int k = 0; k < rank; k++) {
        ptrdiff_t expected = 0;
        if (d[k] > (hsize_t)PTRDIFF_MAX ||
            !pm_schema_agree(&f->symbols, &size[k], (ptrdiff_t)d[k], &expected))
            return pm_h5_refuse(f, err, name, "has %llu along axis %d, expected %td",
                                (unsigned long long)d[k], k, expected);
        if (d[k] > 0 && *count > PTRDIFF_MAX / (ptrdiff_t)d[k])
            return pm_h5_refuse(f, err, name, "is too large");
        *count *= (ptrdiff_t)d[k];
        if (dims != NULL)
            dims[k] = (ptrdiff_t)d[k];
    }
    return PM_OK;
}

static enum pm_status entry_read(struct pm_h5 *f, const char *name, const struct entry *e,
                                 ptrdiff_t count, void *data, struct pm_err *err)
{
    if (H5Dread(e->set, memory_type(e->item->type), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0)
        return pm_h5_refuse(f, err, name, "cannot be read: damaged");
    if (e->item->type == PM_TYPE_DOUBLE) {
        const double *v = data;
        for (ptrdiff_t i = 0; i < count; i++)
            if (!isfinite(v[i]))
                return pm_h5_refuse(f, err, name, "holds %g at entry %td, expected finite numbers",
                                    v[i], i);
    }
    return PM_OK;
}

enum pm_status pm_h5_get(struct pm_h5 *f, const char *name, ptrdiff_t *dims, void *data_out,
                         struct pm_err *err)
{
    struct entry e;
    ptrdiff_t count;
    char *data = NULL;
    enum pm_status status;
    PM_TRY(open_entry(f, name, &e, err));
    PM_TRY(entry_shape(f, name, &e, dims, &count, err));
    data = pm_calloc(count, H5Tget_size(memory_type(e.item->type)), err);
    PM_TRY(data != NULL ? PM_OK : PM_SYSTEM);
    PM_TRY(entry_read(f, name, &e, count, data, err));
    memcpy(data_out, &data, sizeof data);
    data = NULL;
done:
    pm_free(data);
    close_entry(&e);
    return status;
}

enum pm_status pm_h5_get_into(struct pm_h5 *f, const char *name, ptrdiff_t count, void *data,
                              struct pm_err *err)
{
    struct entry e;
    ptrdiff_t found;
    enum pm_status status;
    PM_TRY(open_entry(f, name, &e, err));
    PM_TRY(entry_shape(f, name, &e, NULL, &found, err));
    if (found != count)
        PM_TRY(pm_h5_refuse(f, err, name, "has %td entries, expected %td", found, count));
    PM_TRY(entry_read(f, name, &e, count, data, err));
done:
    close_entry(&e);
    return status;
}

enum pm_status pm_h5_get_text(struct pm_h5 *f, const char *name, char **v, struct pm_err *err)
{
    struct entry e;
    ptrdiff_t count;
    char *text = NULL;
    enum pm_status status;
    PM_TRY(open_entry(f, name, &e, err));
    PM_TRY(entry_shape(f, name, &e, NULL, &count, err));
    PM_TRY(PM_NEW(text, (ptrdiff_t)H5Tget_size(e.type) + 1, err));
    if (H5Dread(e.set, e.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) < 0)
        PM_TRY(pm_h5_refuse(f, err, name, "cannot be read: damaged"));
    *v = text;
    text = NULL;
done:
    pm_free(text);
    close_entry(&e);
    return status;
}

enum pm_status pm_h5_get_attribute(struct pm_h5 *f, const char *name, char **text,
                                   struct pm_err *err)
{
    *text = read_text_attribute(f->id, name, err);
    if (*text == NULL && err->status == PM_OK)
        pm_fail(err, PM_INPUT, "cannot use '%s': no attribute '%s'", f->path, name);
    return *text != NULL ? PM_OK : err->status;
}

/* VTKHDF */

enum pm_status pm_h5_link(struct pm_h5 *f, const char *target, const char *name, struct pm_err *err)
{
    int ok = has_groups(f, name, 1) &&
             H5Lcreate_soft(target, f->id, name, H5P_DEFAULT, H5P_DEFAULT) >= 0;
    return ok ? PM_OK : write_failed(f, name, err);
}

enum pm_status pm_h5_mark_vtk(struct pm_h5 *f, const char *type, struct pm_err *err)
{
    const int version[2] = {1, 0};
    const hsize_t two = 2;
    hid_t group = H5Gopen2(f->id, "/VTKHDF", H5P_DEFAULT);
    hid_t space = H5Screate_simple(1, &two, NULL);
    hid_t attribute = H5Acreate2(group, "Version", H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT);
    int ok = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_INT, version) >= 0;
    ok = ok && put_text_attribute(group, "Type", type);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Gclose(group);
    return ok ? PM_OK : write_failed(f, "/VTKHDF", err);
}
