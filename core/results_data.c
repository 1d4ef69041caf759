/* results_data.c: the pieces an HDF5 file of results is made of, and the way it gets to the disk. */
#include <stdlib.h>
#include <string.h>

#include "core/files.h"
#include "core/frames_inner.h"

static herr_t innermost(unsigned depth, const H5E_error2_t *error, void *text) {
    (void)depth;
    if (error->desc != NULL) snprintf(text, 256, "%.255s", error->desc);
    return 0;
}

ab_status ab_hdf5_trouble(const char *what, ab_report *report) {
    char text[256] = "no memory";                              /* the one trouble that HDF5 cannot always note */
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, innermost, text); /* ends at the cause */
    return ab_report_failure(report, "results.h5: cannot %s: %s", what, text);
}

hid_t ab_hdf5_create(void) {
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access, (size_t)1 << 20, 0);
    const hid_t file = H5Fcreate("frame", H5F_ACC_TRUNC, H5P_DEFAULT, access);
    H5Pclose(access);
    return file;
}

/* Puts the file in memory on the disk as a whole. */
ab_status ab_hdf5_save(hid_t file, const char *path, off_t *bytes, ab_report *report) {
    if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0) return ab_hdf5_trouble("build a frame", report);
    const ssize_t size = H5Fget_file_image(file, NULL, 0);
    if (size <= 0) return ab_hdf5_trouble("build a frame", report);
    void *image = malloc((size_t)size);
    if (image == NULL) return ab_report_failure(report, "no memory for a frame of %zd bytes; write fewer fields or frames", size);
    ab_status status = AB_OK;
    if (H5Fget_file_image(file, image, (size_t)size) != size)
        status = ab_hdf5_trouble("build a frame", report);
    else
        status = ab_file_replace(path, image, (size_t)size, report);
    free(image);
    if (bytes != NULL) *bytes = (off_t)size;
    return status;
}

int ab_hdf5_text(hid_t object, const char *name, const char *text) {
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    int result = -1;
    if (H5Tset_size(type, strlen(text) + 1) >= 0) {
        const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
        if (attribute >= 0) {
            result = H5Awrite(attribute, type, text);
            H5Aclose(attribute);
        }
    }
    H5Sclose(space);
    H5Tclose(type);
    return result;
}

int ab_hdf5_value(hid_t object, const char *name, hid_t stored, hid_t given, const void *value) {
    const hid_t space = H5Screate(H5S_SCALAR), attribute = H5Acreate2(object, name, stored, space, H5P_DEFAULT, H5P_DEFAULT);
    const int result = attribute < 0 ? -1 : H5Awrite(attribute, given, value);
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    return result;
}

hid_t ab_hdf5_space(size_t points, int components) {
    const hsize_t size[2] = {points, (hsize_t)components};
    return H5Screate_simple(components > 1 ? 2 : 1, size, NULL);
}

int ab_hdf5_dataset(hid_t group, const char *name, const char *unit, const char *names, hid_t stored, hid_t given, hid_t space,
                    hid_t creation, const void *values) {
    const hid_t set = H5Dcreate2(group, name, stored, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    if (set < 0) return -1;
    int result = values != NULL ? H5Dwrite(set, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) : 0;
    if (result >= 0) result = ab_hdf5_text(set, "unit", unit);
    if (result >= 0) result = ab_hdf5_text(set, "components", names);
    return H5Dclose(set) < 0 ? -1 : result;
}

/* 0 .. points-1: what a reader of unstructured grids wants to hear about a cloud of points. One component per row. */
int ab_hdf5_vertices(hid_t group, size_t points, void *scratch) {
    int32_t *vertex = scratch;
    for (size_t p = 0; p < points; p++) vertex[p] = (int32_t)p;
    const hsize_t size[2] = {points, 1};
    const hid_t space = H5Screate_simple(2, size, NULL);
    const int result = ab_hdf5_dataset(group, "vertices", "1", "point", H5T_STD_I32LE, H5T_NATIVE_INT32, space, H5P_DEFAULT, vertex);
    H5Sclose(space);
    return result;
}

/* The nodes of each element, as rows of the group's other datasets. */
int ab_hdf5_connectivity(hid_t group, const ab_cells *cells) {
    static const char *const names[] = {"corner0 corner1 corner2 corner3",
                                        "corner0 corner1 corner2 corner3 middle01 middle12 middle23 middle30"};
    const hsize_t size[2] = {cells->count, (hsize_t)cells->nodes};
    const hid_t space = H5Screate_simple(2, size, NULL);
    const int result = ab_hdf5_dataset(group, "connectivity", "1", names[cells->nodes > 4], H5T_STD_I32LE, H5T_NATIVE_UINT32, space,
                                       H5P_DEFAULT, cells->connectivity);
    H5Sclose(space);
    return result;
}
