/* results_hdf5.c: writes the frames of a run so that no crash can take back a frame that was finished.
 *
 * Why a file per frame while the run lasts. An HDF5 file that is open for writing is a moving target: the library updates headers and
 * trees in place, in an order of its own, so a process killed in the middle leaves a file that does not open; in the single-writer mode of
 * the newer format it leaves a mark that has to be cleared by a tool. And a write that fails (a full disk) leaves the library itself in a
 * state that ends in a crash at exit. So each frame is built in memory, as a whole HDF5 file, and put on the disk by ordinary writes under
 * another name, then renamed: frames/frame_000012.h5. results.h5 is a small file of links to them, replaced in the same way. At the end of
 * the run all frames are gathered into one self-contained results.h5 and the folder disappears; paths inside are the same in both forms.
 * Whoever has the file open meanwhile (ParaView on a run that goes on) keeps what he opened. */
#define _GNU_SOURCE /* fallocate */
#include "core/frames.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/files.h"

enum { MOST_FIELDS = 24, MOST_COMPONENTS = 9 };

typedef struct column {              /* a dataset of each frame and body */
    const char *name, *unit, *names; /* names of the components */
    int given, written;              /* components as the body has them, as the file has them */
    bool integer, of_body[1];        /* of_body has body_count entries: a body of another method may lack a field */
} column;

typedef struct frame_record {
    size_t *points; /* per body */
    size_t total;
    size_t *topology; /* per body, and of the cloud last: the frame that holds `vertices` for this number of points */
    double time;
    long step;
    off_t bytes;
} frame_record;

struct ab_frames {
    const ab_scene *scene;
    ab_domain *const *domains;
    size_t bodies;
    column *columns[MOST_FIELDS];
    size_t column_count;
    char *folder, *frame_folder, *path; /* DIR, DIR/frames, DIR/results.h5 */
    frame_record *records;
    size_t count, capacity;
    double *values, *rows; /* as a body gives them; as the file has them */
    size_t value_capacity, row_capacity;
    ab_xdmf *cloud, **of_body; /* of_body: NULL where there is one body */
};

/* ---- what will be written ---- */

static const ab_field *field_of(const ab_domain *domain, const char *name) {
    size_t count = 0;
    const ab_field *fields = domain->ops->fields(domain, &count);
    for (size_t f = 0; f < count; f++)
        if (strcmp(fields[f].name, name) == 0) return &fields[f];
    return NULL;
}

static ab_status column_add(ab_frames *frames, const char *name, ab_report *report) {
    for (size_t c = 0; c < frames->column_count; c++)
        if (strcmp(frames->columns[c]->name, name) == 0) return AB_OK;
    if (frames->column_count == MOST_FIELDS) return ab_report_error(report, AB_NOWHERE, "output.fields: more than %d fields", MOST_FIELDS);
    column *new = calloc(1, sizeof *new + frames->bodies * sizeof(bool));
    if (new == NULL) return ab_report_failure(report, "no memory for the output field '%s'", name);
    frames->columns[frames->column_count++] = new;
    if (strcmp(name, "body") == 0 || strcmp(name, "id") == 0) { /* numbers, not quantities: each body has them */
        new->name = name;
        new->unit = "1";
        new->names = "number";
        new->given = new->written = 1;
        new->integer = true;
        for (size_t b = 0; b < frames->bodies; b++) new->of_body[b] = true;
        return AB_OK;
    }
    for (size_t b = 0; b < frames->bodies; b++) {
        const ab_field *field = field_of(frames->domains[b], name);
        if (field == NULL) continue;
        new->of_body[b] = true;
        if (new->name != NULL &&new->given != field->components)
            return ab_report_error(report, AB_NOWHERE, "output.fields: '%s' has %d components in one body and %d in body '%s'", name,
                                   new->given, field->components, frames->scene->bodies[b].name);
        new->name = field->name;
        new->unit = field->unit;
        new->given = field->components;
        const bool vector = field->components == 2 || field->components == 3;
        const bool stress = field->component_names != NULL && strncmp(field->component_names, "xx yy zz", 8) == 0;
        new->written = vector ? 3 : stress ? 6 : field->components;
        new->names = vector ? "x y z" : stress ? "xx xy xz yy yz zz" : field->component_names != NULL ? field->component_names : "value";
    }
    if (new->name != NULL &&new->given > MOST_COMPONENTS)
        return ab_report_error(report, AB_NOWHERE, "output.fields: '%s' has %d components, more than %d", name, new->given,
                               MOST_COMPONENTS);
    if (new->name != NULL) return AB_OK;
    char known[512] = "";
    size_t count = 0, used = 0;
    const ab_field *fields = frames->bodies > 0 ? frames->domains[0]->ops->fields(frames->domains[0], &count) : NULL;
    for (size_t f = 0; f < count && used < sizeof known; f++)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", f > 0 ? ", " : "", fields[f].name);
    return ab_report_error(report, AB_NOWHERE, "output.fields: no body has a field '%s'; there are: %s", name, known);
}

ab_status ab_frames_create(const ab_scene *scene, ab_domain *const *domains, ab_frames **result, ab_report *report) {
    ab_frames *frames = calloc(1, sizeof *frames);
    if (frames == NULL) return ab_report_failure(report, "no memory for the output");
    *result = frames;
    frames->scene = scene;
    frames->domains = domains;
    frames->bodies = scene->body_count;
    for (size_t b = 0; b < frames->bodies; b++)
        if (strcmp(scene->bodies[b].name, "all") == 0)
            return ab_report_error(report, scene->bodies[b].mark,
                                   "a body cannot be named 'all' where there is output: results.h5 has a group of that name");
    static const char *const always[] = {"position", "id", "body"};
    ab_status status = AB_OK;
    for (size_t f = 0; f < 3 && status == AB_OK; f++) status = column_add(frames, always[f], report);
    for (size_t f = 0; f < scene->output_field_count; f++) {
        const ab_status one = column_add(frames, scene->output_fields[f], report);
        if (one != AB_OK) status = one;
    }
    return status;
}

/* ---- the folder ---- */

static char *numbered(const ab_frames *frames, size_t number, const char *pattern) {
    char name[64];
    snprintf(name, sizeof name, pattern, number);
    return ab_path_join(frames->frame_folder, name);
}

/* Frames of an earlier run, complete or not. Files of other names stay. */
static void clear_frame_folder(const char *path) {
    DIR *folder = opendir(path);
    if (folder == NULL) return;
    for (const struct dirent *entry; (entry = readdir(folder)) != NULL;)
        if (strncmp(entry->d_name, "frame_", 6) == 0) unlinkat(dirfd(folder), entry->d_name, 0);
    closedir(folder);
}

static ab_status xdmf_open(ab_frames *frames, ab_report *report) {
    const ab_scene *scene = frames->scene;
    const char *title = scene->title != NULL ? scene->title : "abut";
    char *path = ab_path_join(frames->folder, "results.xdmf");
    if (path == NULL) return ab_report_failure(report, "no memory for the output");
    ab_status status = ab_xdmf_create(path, title, &frames->cloud, report);
    free(path);
    if (status != AB_OK || frames->bodies < 2) return status;
    frames->of_body = calloc(frames->bodies, sizeof *frames->of_body);
    if (frames->of_body == NULL) return ab_report_failure(report, "no memory for the output");
    for (size_t b = 0; b < frames->bodies && status == AB_OK; b++) {
        char name[300];
        snprintf(name, sizeof name, "results_%.250s.xdmf", scene->bodies[b].name);
        for (char *c = name; *c != '\0'; c++)
            if (*c == '/') *c = '_';
        if ((path = ab_path_join(frames->folder, name)) == NULL) return ab_report_failure(report, "no memory for the output");
        status = ab_xdmf_create(path, scene->bodies[b].name, &frames->of_body[b], report);
        free(path);
    }
    return status;
}

ab_status ab_frames_begin(ab_frames *frames, const char *folder, ab_report *report) {
    frames->folder = ab_path_join(folder, "");
    frames->frame_folder = ab_path_join(folder, "frames");
    frames->path = ab_path_join(folder, "results.h5");
    if (frames->folder == NULL || frames->frame_folder == NULL || frames->path == NULL)
        return ab_report_failure(report, "no memory for the output");
    AB_TRY(ab_folder_make(frames->frame_folder, report));
    clear_frame_folder(frames->frame_folder);
    return xdmf_open(frames, report);
}

/* ---- one file in memory ---- */

static herr_t innermost(unsigned depth, const H5E_error2_t *error, void *text) {
    (void)depth;
    if (error->desc != NULL) snprintf(text, 256, "%.255s", error->desc);
    return 0;
}

static ab_status trouble(const char *what, ab_report *report) {
    char text[256] = "no reason given";
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, innermost, text);
    /* upward starts at the cause and ends at the call: the last one visited is the call; walk down to end at the cause */
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, innermost, text);
    return ab_report_failure(report, "results.h5: cannot %s: %s", what, text);
}

static hid_t memory_file(void) {
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access, (size_t)1 << 20, 0);
    const hid_t file = H5Fcreate("frame", H5F_ACC_TRUNC, H5P_DEFAULT, access);
    H5Pclose(access);
    return file;
}

/* Puts the file in memory on the disk as a whole. */
static ab_status memory_file_save(hid_t file, const char *path, off_t *bytes, ab_report *report) {
    if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0) return trouble("build a frame", report);
    const ssize_t size = H5Fget_file_image(file, NULL, 0);
    if (size <= 0) return trouble("build a frame", report);
    void *image = malloc((size_t)size);
    if (image == NULL) return ab_report_failure(report, "no memory for a frame of %zd bytes; write fewer fields or frames", size);
    ab_status status = AB_OK;
    if (H5Fget_file_image(file, image, (size_t)size) != size)
        status = trouble("build a frame", report);
    else
        status = ab_file_replace(path, image, (size_t)size, report);
    free(image);
    if (bytes != NULL) *bytes = (off_t)size;
    return status;
}

static int attribute_text(hid_t object, const char *name, const char *text) {
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

static int attribute_value(hid_t object, const char *name, hid_t stored, hid_t given, const void *value) {
    const hid_t space = H5Screate(H5S_SCALAR), attribute = H5Acreate2(object, name, stored, space, H5P_DEFAULT, H5P_DEFAULT);
    const int result = attribute < 0 ? -1 : H5Awrite(attribute, given, value);
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    return result;
}

static hid_t stored_type(const column *c) { return c->integer ? H5T_STD_I64LE : H5T_IEEE_F64LE; }

static hid_t space_of(size_t points, int components) {
    const hsize_t size[2] = {points, (hsize_t)components};
    return H5Screate_simple(components > 1 ? 2 : 1, size, NULL);
}

static int dataset_write(hid_t group, const char *name, const char *unit, const char *names, hid_t stored, hid_t given, hid_t space,
                         hid_t creation, const void *values) {
    const hid_t set = H5Dcreate2(group, name, stored, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    if (set < 0) return -1;
    int result = values != NULL ? H5Dwrite(set, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) : 0;
    if (result >= 0) result = attribute_text(set, "unit", unit);
    if (result >= 0) result = attribute_text(set, "components", names);
    return H5Dclose(set) < 0 ? -1 : result;
}

/* 0 .. points-1: what a reader of unstructured grids wants to hear about a cloud of points. One component per row. */
static int vertices_write(hid_t group, size_t points, void *scratch) {
    int32_t *vertex = scratch;
    for (size_t p = 0; p < points; p++) vertex[p] = (int32_t)p;
    const hsize_t size[2] = {points, 1};
    const hid_t space = H5Screate_simple(2, size, NULL);
    const int result = dataset_write(group, "vertices", "1", "point", H5T_STD_I32LE, H5T_NATIVE_INT32, space, H5P_DEFAULT, vertex);
    H5Sclose(space);
    return result;
}

/* ---- a frame ---- */

static bool grow(double **array, size_t *capacity, size_t wanted) {
    if (wanted <= *capacity) return true;
    free(*array);
    *array = malloc(wanted * sizeof **array);
    *capacity = *array != NULL ? wanted : 0;
    return *array != NULL;
}

/* A body's values as rows of the file: vectors and tensors completed with zeros, in the file's order. */
static void spread(const column *c, const double *in, size_t points, double *out) {
    if (c->given == c->written) {
        memcpy(out, in, points * (size_t)c->given * sizeof *out);
    } else if (c->written == 3) {
        for (size_t p = 0; p < points; p++) {
            out[3 * p] = in[2 * p];
            out[3 * p + 1] = in[2 * p + 1];
            out[3 * p + 2] = 0;
        }
    } else { /* xx yy zz xy -> xx xy xz yy yz zz */
        for (size_t p = 0; p < points; p++) {
            const double full[6] = {in[4 * p], in[4 * p + 3], 0, in[4 * p + 1], 0, in[4 * p + 2]};
            memcpy(out + 6 * p, full, sizeof full);
        }
    }
    if (c->given == 6 && c->written == 6) { /* xx yy zz xy yz zx */
        for (size_t p = 0; p < points; p++) {
            const double *s = in + 6 * p, full[6] = {s[0], s[3], s[5], s[1], s[4], s[2]};
            memcpy(out + 6 * p, full, sizeof full);
        }
    }
}

static ab_status column_write(ab_frames *frames, const column *c, size_t body, size_t points, hid_t group, ab_report *report) {
    const size_t given = points * (size_t)c->given + 1, written = points * (size_t)c->written + 1;
    if (!grow(&frames->values, &frames->value_capacity, given) || !grow(&frames->rows, &frames->row_capacity, written))
        return ab_report_failure(report, "no memory for a frame of %zu points", points);
    void *rows = frames->rows;
    if (c->integer) {
        int64_t *number = rows;
        const bool id = strcmp(c->name, "id") == 0;
        if (id) AB_TRY(frames->domains[body]->ops->read(frames->domains[body], "id", frames->values, report));
        for (size_t p = 0; p < points; p++) number[p] = id ? (int64_t)frames->values[p] : (int64_t)body;
    } else {
        AB_TRY(frames->domains[body]->ops->read(frames->domains[body], c->name, frames->values, report));
        spread(c, frames->values, points, rows);
    }
    const hid_t space = space_of(points, c->written);
    const int result = dataset_write(group, c->name, c->unit, c->names, stored_type(c), c->integer ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE,
                                     space, H5P_DEFAULT, rows);
    H5Sclose(space);
    return result < 0 ? trouble("build a frame", report) : AB_OK;
}

/* The rows of every body one after the other, as a view of the bodies' own datasets; NaN where a body lacks the field. */
static int cloud_column_write(const ab_frames *frames, const column *c, const frame_record *record, const char *frame, hid_t group) {
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE), space = space_of(record->total, c->written);
    const double none = (double)NAN;
    int result = c->integer ? 0 : H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, &none);
    hsize_t first[2] = {0, 0};
    for (size_t b = 0; b < frames->bodies && result >= 0; b++) {
        const hsize_t size[2] = {record->points[b], (hsize_t)c->written};
        if (c->of_body[b] && record->points[b] > 0) {
            char source[400];
            snprintf(source, sizeof source, "/%s/%.300s/%s", frame, frames->scene->bodies[b].name, c->name);
            const hid_t part = space_of(record->points[b], c->written);
            result = H5Sselect_hyperslab(space, H5S_SELECT_SET, first, NULL, size, NULL);
            if (result >= 0) result = H5Pset_virtual(creation, space, ".", source, part);
            H5Sclose(part);
        }
        first[0] += record->points[b];
    }
    H5Sselect_all(space);
    if (result >= 0) result = dataset_write(group, c->name, c->unit, c->names, stored_type(c), H5I_INVALID_HID, space, creation, NULL);
    H5Sclose(space);
    H5Pclose(creation);
    return result;
}

/* The group `all`, in the file of the frame and again in the gathered one (a virtual dataset names the file it stands in). */
static int cloud_write(ab_frames *frames, size_t number, const char *frame, hid_t parent) {
    const frame_record *record = &frames->records[number];
    const hid_t group = H5Gcreate2(parent, "all", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (group < 0) return -1;
    int result = 0;
    for (size_t c = 0; c < frames->column_count && result >= 0; c++)
        result = cloud_column_write(frames, frames->columns[c], record, frame, group);
    if (result >= 0 && record->topology[frames->bodies] == number) {
        result = grow(&frames->rows, &frames->row_capacity, record->total + 1) ? vertices_write(group, record->total, frames->rows) : -1;
    }
    return H5Gclose(group) < 0 ? -1 : result;
}

static ab_status frame_fill(ab_frames *frames, size_t number, hid_t file, const char *name, ab_report *report) {
    const frame_record *record = &frames->records[number];
    const hid_t frame = H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (frame < 0) return trouble("build a frame", report);
    const int64_t step = record->step;
    ab_status status = AB_OK;
    if (attribute_value(frame, "time", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &record->time) < 0 ||
        attribute_text(frame, "time_unit", "s") < 0 || attribute_value(frame, "step", H5T_STD_I64LE, H5T_NATIVE_INT64, &step) < 0)
        status = trouble("build a frame", report);
    for (size_t b = 0; b < frames->bodies && status == AB_OK; b++) {
        const hid_t group = H5Gcreate2(frame, frames->scene->bodies[b].name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        if (group < 0) status = trouble("build a frame", report);
        for (size_t c = 0; c < frames->column_count && status == AB_OK; c++)
            if (frames->columns[c]->of_body[b]) status = column_write(frames, frames->columns[c], b, record->points[b], group, report);
        if (status == AB_OK && record->topology[b] == number && vertices_write(group, record->points[b], frames->rows) < 0)
            status = trouble("build a frame", report);
        if (group >= 0) H5Gclose(group);
    }
    if (status == AB_OK && cloud_write(frames, number, name, frame) < 0) status = trouble("build a frame", report);
    H5Gclose(frame);
    return status;
}

/* results.h5 while the run lasts: a link to each frame. */
static ab_status links_write(const ab_frames *frames, ab_report *report) {
    const hid_t file = memory_file();
    if (file < 0) return trouble("build the list of frames", report);
    ab_status status = AB_OK;
    for (size_t k = 0; k < frames->count && status == AB_OK; k++) {
        char name[32], target[48];
        snprintf(name, sizeof name, "frame_%06zu", k);
        snprintf(target, sizeof target, "frames/%s.h5", name);
        if (H5Lcreate_external(target, name, file, name, H5P_DEFAULT, H5P_DEFAULT) < 0) status = trouble("link a frame", report);
    }
    if (status == AB_OK) status = memory_file_save(file, frames->path, NULL, report);
    H5Fclose(file);
    return status;
}

static frame_record *record_new(ab_frames *frames) {
    if (frames->count == frames->capacity) {
        const size_t capacity = frames->capacity == 0 ? 64 : 2 * frames->capacity;
        frame_record *records = realloc(frames->records, capacity * sizeof *records);
        if (records == NULL) return NULL;
        frames->records = records;
        frames->capacity = capacity;
    }
    frame_record *record = &frames->records[frames->count];
    *record = (frame_record){0};
    record->points = calloc(2 * frames->bodies + 1, sizeof *record->points);
    if (record->points == NULL) return NULL;
    record->topology = record->points + frames->bodies;
    return record;
}

static ab_status xdmf_add(ab_frames *frames, size_t number, ab_report *report) {
    const frame_record *record = &frames->records[number];
    ab_xdmf_field fields[MOST_FIELDS];
    for (size_t b = 0; b <= frames->bodies; b++) {
        const bool cloud = b == frames->bodies;
        if (!cloud && frames->of_body == NULL) continue;
        size_t count = 0;
        for (size_t c = 0; c < frames->column_count; c++)
            if (cloud || frames->columns[c]->of_body[b])
                fields[count++] = (ab_xdmf_field){frames->columns[c]->name, frames->columns[c]->written, frames->columns[c]->integer};
        AB_TRY(ab_xdmf_add(cloud ? frames->cloud : frames->of_body[b], number, record->topology[b],
                           cloud ? "all" : frames->scene->bodies[b].name, record->time, cloud ? record->total : record->points[b], fields,
                           count, report));
    }
    return AB_OK;
}

ab_status ab_frames_write(ab_frames *frames, double time, long step, ab_report *report) {
    const size_t number = frames->count;
    frame_record *record = record_new(frames);
    if (record == NULL) return ab_report_failure(report, "no memory for frame %zu", number);
    record->time = time;
    record->step = step;
    for (size_t b = 0; b < frames->bodies; b++) record->total += record->points[b] = frames->domains[b]->ops->count(frames->domains[b]);
    const frame_record *before = number > 0 ? &frames->records[number - 1] : NULL;
    for (size_t b = 0; b < frames->bodies; b++)
        record->topology[b] = before && before->points[b] == record->points[b] ? before->topology[b] : number;
    record->topology[frames->bodies] = before && before->total == record->total ? before->topology[frames->bodies] : number;
    if (record->total > INT32_MAX)
        return ab_report_failure(report, "a frame of %zu points is more than the result files can number", record->total);

    char name[32];
    snprintf(name, sizeof name, "frame_%06zu", number);
    char *path = numbered(frames, number, "frame_%06zu.h5");
    ab_status status = path == NULL ? ab_report_failure(report, "no memory for frame %zu", number) : AB_OK;
    H5E_BEGIN_TRY {
        const hid_t file = status == AB_OK ? memory_file() : H5I_INVALID_HID;
        if (status == AB_OK && file < 0) status = trouble("build a frame", report);
        if (status == AB_OK) status = frame_fill(frames, number, file, name, report);
        if (status == AB_OK) status = memory_file_save(file, path, &record->bytes, report);
        if (file >= 0) H5Fclose(file);
        if (status == AB_OK) {
            frames->count++;
            status = links_write(frames, report);
        }
    }
    H5E_END_TRY
    free(path);
    if (status != AB_OK && frames->count == number) free(record->points);
    return status == AB_OK ? xdmf_add(frames, number, report) : status;
}

/* ---- the end ---- */

/* Room for the gathered file: blocks are set aside before the library writes into them, because it does not survive a write that fails. */
static bool reserve(const char *path, off_t bytes) {
    struct rlimit limit;
    if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && (rlim_t)bytes > limit.rlim_cur) return false;
    const int file = open(path, O_RDWR | O_CLOEXEC);
    if (file < 0) return false;
    const bool done = fallocate(file, FALLOC_FL_KEEP_SIZE, 0, bytes) == 0;
    close(file);
    return done;
}

static int gather_frame(ab_frames *frames, size_t number, hid_t into) {
    char name[32];
    snprintf(name, sizeof name, "frame_%06zu", number);
    char *path = numbered(frames, number, "frame_%06zu.h5");
    if (path == NULL) return -1;
    const hid_t from = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    free(path);
    if (from < 0) return -1;
    const hid_t source = H5Gopen2(from, name, H5P_DEFAULT), target = H5Gcreate2(into, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const int64_t step = frames->records[number].step;
    int result = source < 0 || target < 0 ? -1 : 0;
    if (result == 0 &&
        (attribute_value(target, "time", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &frames->records[number].time) < 0 ||
         attribute_text(target, "time_unit", "s") < 0 || attribute_value(target, "step", H5T_STD_I64LE, H5T_NATIVE_INT64, &step) < 0))
        result = -1;
    for (size_t b = 0; b < frames->bodies && result >= 0; b++) {
        const char *body = frames->scene->bodies[b].name;
        result = H5Ocopy(source, body, target, body, H5P_DEFAULT, H5P_DEFAULT);
    }
    if (result >= 0) result = cloud_write(frames, number, name, target);
    if (source >= 0) H5Gclose(source);
    if (target >= 0) H5Gclose(target);
    H5Fclose(from);
    return result;
}

ab_status ab_frames_finish(ab_frames *frames, ab_report *report) {
    if (frames->cloud != NULL) AB_TRY(ab_xdmf_finish(frames->cloud, report));
    for (size_t b = 0; frames->of_body != NULL && b < frames->bodies; b++) AB_TRY(ab_xdmf_finish(frames->of_body[b], report));
    if (frames->count == 0) {
        if (frames->frame_folder != NULL) rmdir(frames->frame_folder);
        return AB_OK;
    }
    off_t bytes = 1 << 20;
    for (size_t k = 0; k < frames->count; k++) bytes += frames->records[k].bytes + 65536;
    char *beside = malloc(strlen(frames->path) + 6);
    if (beside == NULL) return ab_report_failure(report, "no memory to gather the frames");
    sprintf(beside, "%s.part", frames->path);
    int result = -1;
    H5E_BEGIN_TRY {
        hid_t file = H5Fcreate(beside, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
        if (file >= 0) H5Fclose(file);
        if (file >= 0 && reserve(beside, bytes) && (file = H5Fopen(beside, H5F_ACC_RDWR, H5P_DEFAULT)) >= 0) {
            result = 0;
            for (size_t k = 0; k < frames->count && result >= 0; k++) result = gather_frame(frames, k, file);
            if (H5Fclose(file) < 0) result = -1;
        }
    }
    H5E_END_TRY
    if (result >= 0 && rename(beside, frames->path) == 0) {
        clear_frame_folder(frames->frame_folder);
        rmdir(frames->frame_folder);
    } else {
        unlink(beside);
        ab_report_warning(report, AB_NOWHERE,
                          "no room to gather %zu frames into '%s' (%lld bytes): it stays a list of links into '%s', which readers follow",
                          frames->count, frames->path, (long long)bytes, frames->frame_folder);
    }
    free(beside);
    return AB_OK;
}

size_t ab_frames_count(const ab_frames *frames) { return frames == NULL ? 0 : frames->count; }

void ab_frames_destroy(ab_frames *frames) {
    if (frames == NULL) return;
    for (size_t k = 0; k < frames->count; k++) free(frames->records[k].points);
    for (size_t c = 0; c < frames->column_count; c++) free(frames->columns[c]);
    ab_xdmf_destroy(frames->cloud);
    for (size_t b = 0; frames->of_body != NULL && b < frames->bodies; b++) ab_xdmf_destroy(frames->of_body[b]);
    free(frames->of_body);
    free(frames->records);
    free(frames->values);
    free(frames->rows);
    free(frames->folder);
    free(frames->frame_folder);
    free(frames->path);
    free(frames);
}
