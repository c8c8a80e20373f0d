/* Damages an HDF5 file for tests of the readers:
 *   mangle set FILE DATASET INDEX VALUE   one entry (numbers; nan and inf allowed)
 *   mangle drop FILE DATASET              the dataset is gone
 *   mangle shorten FILE DATASET           the first axis loses its last row
 *   mangle narrow FILE DATASET            numbers become 16 bit integers
 *   mangle attribute FILE NAME TEXT       another text in a root attribute */
#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int set_entry(hid_t file, const char *name, const char *index, const char *value)
{
    hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
    hid_t space = H5Dget_space(set);
    hssize_t n = H5Sget_simple_extent_npoints(space), i = strtol(index, NULL, 10);
    double *v = n > i ? calloc((size_t)n, sizeof *v) : NULL;
    int ok = v != NULL && H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, v) >= 0;
    if (ok) {
        v[i] = strtod(value, NULL);
        ok = H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, v) >= 0;
    }
    free(v);
    H5Sclose(space);
    H5Dclose(set);
    return ok;
}

/* Writes zeros of another type or shape in place of a dataset. */
static int replace(hid_t file, const char *name, int narrow)
{
    hsize_t d[H5S_MAX_RANK] = {0};
    hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
    hid_t space = H5Dget_space(set), type = narrow ? H5Tcopy(H5T_STD_I16LE) : H5Dget_type(set);
    int rank = H5Sget_simple_extent_dims(space, d, NULL);
    H5Sclose(space);
    H5Dclose(set);
    if (rank < 0 || (!narrow && (rank == 0 || d[0] == 0)) || H5Ldelete(file, name, H5P_DEFAULT) < 0)
        return 0;
    if (!narrow)
        d[0]--;
    space = rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, d, NULL);
    set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Tclose(type);
    H5Sclose(space);
    return set >= 0 && H5Dclose(set) >= 0;
}

static int set_attribute(hid_t file, const char *name, const char *text)
{
    hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, strlen(text) + 1);
    H5Adelete(file, name);
    hid_t attribute = H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    int ok = H5Awrite(attribute, type, text) >= 0;
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
    return ok;
}

int main(int argc, char **argv)
{
    if (argc < 4)
        return 2;
    const char *what = argv[1], *name = argv[3];
    hid_t file = H5Fopen(argv[2], H5F_ACC_RDWR, H5P_DEFAULT);
    int ok = 0;
    if (file < 0)
        return 1;
    if (strcmp(what, "set") == 0 && argc == 6)
        ok = set_entry(file, name, argv[4], argv[5]);
    else if (strcmp(what, "drop") == 0 && argc == 4)
        ok = H5Ldelete(file, name, H5P_DEFAULT) >= 0;
    else if ((strcmp(what, "shorten") == 0 || strcmp(what, "narrow") == 0) && argc == 4)
        ok = replace(file, name, what[0] == 'n');
    else if (strcmp(what, "attribute") == 0 && argc == 5)
        ok = set_attribute(file, name, argv[4]);
    return H5Fclose(file) >= 0 && ok ? 0 : 1;
}
