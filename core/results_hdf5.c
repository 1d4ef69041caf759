/* results_hdf5.c: writes the frames of a run so that no crash can take back a frame that was finished.
 *
 * Why a file per frame while the run lasts. An HDF5 file that is open for writing is a moving target: the library updates headers and
 * trees in place, in an order of its own, so a process killed in the middle leaves a file that does not open; in the single-writer mode of
 * the newer format it leaves a mark that has to be cleared by a tool. And a write that fails (a full disk) leaves the library itself in a
 * state that ends in a crash at exit. So each frame is built in memory, as a whole HDF5 file, and put on the disk by ordinary writes under
 * another name, then renamed: frames/frame_000012.h5. results.h5 is a small file of links to them, replaced in the same way. At the end of
 * the run all frames are gathered into one self-contained results.h5 and the folder disappears; paths inside are the same in both forms.
 * Whoever has the file open meanwhile (ParaView on a run that goes on) keeps what he opened. */
#include "core/frames_inner.h"

#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/files.h"
#include "core/vocabulary.h"

/* ---- what will be written ---- */

static const ab_field *field_of(const ab_domain *domain, const char *name) {
    size_t count = 0;
    const ab_field *fields = domain->ops->fields(domain, &count);
    for (size_t f = 0; f < count; f++)
        if (strcmp(fields[f].name, name) == 0) return &fields[f];
    return NULL;
}

static ab_cells cells_of(const ab_domain *domain) {
    ab_cells cells = {0};
    if (domain->ops->cells != NULL) domain->ops->cells(domain, &cells);
    return cells;
}

static ab_status column_add(ab_frames *frames, const char *name, ab_report *report) {
    for (size_t c = 0; c < frames->column_count; c++)
        if (frames->columns[c]->name != NULL && strcmp(frames->columns[c]->name, name) == 0) return AB_OK;
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
        const char *names = ab_component_names(field->component_names, field->components);
        const bool stress = strncmp(names, "xx yy zz", 8) == 0;
        new->written = vector ? 3 : stress ? 6 : field->components;
        new->names = vector ? "x y z" : stress ? "xx yy zz xy yz xz" : names;
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
    AB_TRY(ab_frames_contacts_check(frames, report));
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

char *ab_frames_path(const ab_frames *frames, size_t number) {
    char name[64];
    snprintf(name, sizeof name, "frame_%06zu.h5", number);
    return ab_path_join(frames->frame_folder, name);
}

/* Frames of an earlier run, complete or not. Files of other names stay. */
void ab_frames_clear(const char *path) {
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
    if (status != AB_OK) return status;
    frames->of_body = calloc(frames->bodies, sizeof *frames->of_body);
    if (frames->of_body == NULL) return ab_report_failure(report, "no memory for the output");
    for (size_t b = 0; b < frames->bodies && status == AB_OK; b++) {
        if (frames->bodies < 2 && cells_of(frames->domains[b]).count == 0) continue;
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

/* A folder of ours, and no link to another one. */
static ab_status frame_folder_make(const ab_frames *frames, ab_report *report) {
    struct stat found;
    if (lstat(frames->frame_folder, &found) == 0 && S_ISLNK(found.st_mode))
        return ab_report_failure(report, "'%s' is a link to another place, where nothing is to be written; remove it",
                                 frames->frame_folder);
    return ab_folder_make(frames->frame_folder, report);
}

ab_status ab_frames_open(ab_frames *frames, const char *folder, ab_report *report) {
    frames->folder = ab_path_join(folder, "");
    frames->frame_folder = ab_path_join(folder, "frames");
    frames->path = ab_path_join(folder, "results.h5");
    if (frames->folder == NULL || frames->frame_folder == NULL || frames->path == NULL)
        return ab_report_failure(report, "no memory for the output");
    AB_TRY(frame_folder_make(frames, report));
    AB_TRY(xdmf_open(frames, report));
    return ab_frames_contacts_begin(frames, report);
}

ab_status ab_frames_begin(ab_frames *frames, const char *folder, ab_report *report) {
    AB_TRY(ab_frames_open(frames, folder, report));
    ab_frames_clear(frames->frame_folder);
    return AB_OK;
}

static hid_t stored_type(const column *c) { return c->integer ? H5T_STD_I64LE : H5T_IEEE_F64LE; }

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
    } else { /* xx yy zz xy, and nothing out of the plane */
        for (size_t p = 0; p < points; p++) {
            memcpy(out + 6 * p, in + 4 * p, 4 * sizeof *out);
            out[6 * p + 4] = out[6 * p + 5] = 0;
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
    const hid_t space = ab_hdf5_space(points, c->written);
    const int result = ab_hdf5_dataset(group, c->name, c->unit, c->names, stored_type(c), c->integer ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE,
                                       space, H5P_DEFAULT, rows);
    H5Sclose(space);
    return result < 0 ? ab_hdf5_trouble("build a frame", report) : AB_OK;
}

/* The rows of every body one after the other, as a view of the bodies' own datasets; NaN where a body lacks the field. */
static int cloud_column_write(const ab_frames *frames, const column *c, const frame_record *record, const char *frame, hid_t group) {
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE), space = ab_hdf5_space(record->total, c->written);
    const double none = (double)NAN;
    int result = c->integer ? 0 : H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, &none);
    hsize_t first[2] = {0, 0};
    for (size_t b = 0; b < frames->bodies && result >= 0; b++) {
        const hsize_t size[2] = {record->points[b], (hsize_t)c->written};
        if (c->of_body[b] && record->points[b] > 0) {
            char source[400];
            snprintf(source, sizeof source, "/%s/%.300s/%s", frame, frames->scene->bodies[b].name, c->name);
            const hid_t part = ab_hdf5_space(record->points[b], c->written);
            result = H5Sselect_hyperslab(space, H5S_SELECT_SET, first, NULL, size, NULL);
            if (result >= 0) result = H5Pset_virtual(creation, space, ".", source, part);
            H5Sclose(part);
        }
        first[0] += record->points[b];
    }
    H5Sselect_all(space);
    if (result >= 0) result = ab_hdf5_dataset(group, c->name, c->unit, c->names, stored_type(c), H5I_INVALID_HID, space, creation, NULL);
    H5Sclose(space);
    H5Pclose(creation);
    return result;
}

/* The group `all`, in the file of the frame and again in the gathered one (a virtual dataset names the file it stands in). */
int ab_frames_cloud(ab_frames *frames, size_t number, const char *frame, hid_t parent) {
    const frame_record *record = &frames->records[number];
    const hid_t group = H5Gcreate2(parent, "all", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (group < 0) return -1;
    int result = 0;
    for (size_t c = 0; c < frames->column_count && result >= 0; c++)
        result = cloud_column_write(frames, frames->columns[c], record, frame, group);
    if (result >= 0 && record->topology[frames->bodies] == number) {
        result = grow(&frames->rows, &frames->row_capacity, record->total + 1) ? ab_hdf5_vertices(group, record->total, frames->rows) : -1;
    }
    return H5Gclose(group) < 0 ? -1 : result;
}

hid_t ab_frames_group(const frame_record *record, const char *name, hid_t file) {
    const hid_t group = H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const int64_t step = record->step;
    if (group < 0) return group;
    if (ab_hdf5_value(group, "time", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &record->time) >= 0 && ab_hdf5_text(group, "time_unit", "s") >= 0 &&
        ab_hdf5_value(group, "step", H5T_STD_I64LE, H5T_NATIVE_INT64, &step) >= 0)
        return group;
    H5Gclose(group);
    return H5I_INVALID_HID;
}

/* How the rows of a body hang together. The scratch has held fields of that many points before. */
static int topology_write(const ab_frames *frames, size_t body, size_t points, hid_t group) {
    const ab_cells cells = cells_of(frames->domains[body]);
    return cells.count > 0 ? ab_hdf5_connectivity(group, &cells) : ab_hdf5_vertices(group, points, frames->rows);
}

static ab_status frame_fill(ab_frames *frames, const ab_contact_totals *contacts, size_t number, hid_t file, const char *name,
                            ab_report *report) {
    const frame_record *record = &frames->records[number];
    const hid_t frame = ab_frames_group(record, name, file);
    if (frame < 0) return ab_hdf5_trouble("build a frame", report);
    ab_status status = AB_OK;
    for (size_t b = 0; b < frames->bodies && status == AB_OK; b++) {
        const hid_t group = H5Gcreate2(frame, frames->scene->bodies[b].name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        if (group < 0) status = ab_hdf5_trouble("build a frame", report);
        for (size_t c = 0; c < frames->column_count && status == AB_OK; c++)
            if (frames->columns[c]->of_body[b]) status = column_write(frames, frames->columns[c], b, record->points[b], group, report);
        if (status == AB_OK && record->topology[b] == number && topology_write(frames, b, record->points[b], group) < 0)
            status = ab_hdf5_trouble("build a frame", report);
        if (group >= 0) H5Gclose(group);
    }
    if (status == AB_OK) status = ab_frames_contacts_fill(frames, contacts, frame, report);
    if (status == AB_OK && ab_frames_cloud(frames, number, name, frame) < 0) status = ab_hdf5_trouble("build a frame", report);
    H5Gclose(frame);
    return status;
}

frame_record *ab_frames_record(ab_frames *frames) {
    if (frames->count == frames->capacity) {
        const size_t capacity = frames->capacity == 0 ? 64 : 2 * frames->capacity;
        frame_record *records = realloc(frames->records, capacity * sizeof *records);
        if (records == NULL) return NULL;
        frames->records = records;
        frames->capacity = capacity;
    }
    frame_record *record = &frames->records[frames->count];
    *record = (frame_record){0};
    record->points = calloc(3 * frames->bodies + 1 + frames->scene->contact_count, sizeof *record->points);
    if (record->points == NULL) return NULL;
    record->cells = record->points + frames->bodies;
    record->topology = record->cells + frames->bodies;
    record->contacts = record->topology + frames->bodies + 1;
    return record;
}

ab_status ab_frames_xdmf(ab_frames *frames, size_t number, ab_report *report) {
    const frame_record *record = &frames->records[number];
    ab_xdmf_field fields[MOST_FIELDS];
    for (size_t b = 0; b <= frames->bodies; b++) {
        const bool cloud = b == frames->bodies;
        if (!cloud && frames->of_body[b] == NULL) continue;
        size_t count = 0;
        for (size_t c = 0; c < frames->column_count; c++)
            if (cloud || frames->columns[c]->of_body[b])
                fields[count++] = (ab_xdmf_field){frames->columns[c]->name, frames->columns[c]->written, frames->columns[c]->integer};
        const ab_cells cells = cloud ? (ab_cells){0} : cells_of(frames->domains[b]);
        const ab_xdmf_grid grid = {.frame = number,
                                   .topology_frame = record->topology[b],
                                   .group = cloud ? "all" : frames->scene->bodies[b].name,
                                   .time = record->time,
                                   .points = cloud ? record->total : record->points[b],
                                   .cells = cells.count,
                                   .cell_nodes = cells.nodes};
        AB_TRY(ab_xdmf_add(cloud ? frames->cloud : frames->of_body[b], &grid, fields, count, report));
    }
    return AB_OK;
}

ab_status ab_frames_write(ab_frames *frames, const ab_contact_totals *contacts, double time, long step, ab_report *report) {
    const size_t number = frames->count;
    frame_record *record = ab_frames_record(frames);
    if (record == NULL) return ab_report_failure(report, "no memory for frame %zu", number);
    record->time = time;
    record->step = step;
    const frame_record *before = number > frames->first ? &frames->records[number - 1] : NULL;
    for (size_t b = 0; b < frames->bodies; b++) {
        record->total += record->points[b] = frames->domains[b]->ops->count(frames->domains[b]);
        record->cells[b] = cells_of(frames->domains[b]).count;
        const bool same = before && before->points[b] == record->points[b] && before->cells[b] == record->cells[b];
        record->topology[b] = same ? before->topology[b] : number;
    }
    for (size_t k = 0; frames->scene->output_contact && k < frames->scene->contact_count; k++)
        record->contacts[k] = contacts[k].list != NULL ? contacts[k].list->count : 0;
    record->topology[frames->bodies] = before && before->total == record->total ? before->topology[frames->bodies] : number;
    if (record->total > INT32_MAX)
        return ab_report_failure(report, "a frame of %zu points is more than the result files can number", record->total);

    char name[32];
    snprintf(name, sizeof name, "frame_%06zu", number);
    char *path = ab_frames_path(frames, number);
    ab_status status = path == NULL ? ab_report_failure(report, "no memory for frame %zu", number) : AB_OK;
    H5E_BEGIN_TRY {
        const hid_t file = status == AB_OK ? ab_hdf5_create() : H5I_INVALID_HID;
        if (status == AB_OK && file < 0) status = ab_hdf5_trouble("build a frame", report);
        if (status == AB_OK) status = frame_fill(frames, contacts, number, file, name, report);
        if (status == AB_OK) status = ab_hdf5_save(file, path, &record->bytes, report);
        if (file >= 0) H5Fclose(file);
        if (status == AB_OK) {
            frames->count++;
            status = ab_frames_link(frames, report);
        }
    }
    H5E_END_TRY
    free(path);
    if (status != AB_OK && frames->count == number) free(record->points);
    if (status == AB_OK) status = ab_frames_xdmf(frames, number, report);
    return status == AB_OK ? ab_frames_contacts_xdmf(frames, number, report) : status;
}

size_t ab_frames_count(const ab_frames *frames) { return frames == NULL ? 0 : frames->count - frames->first; }

void ab_frames_destroy(ab_frames *frames) {
    if (frames == NULL) return;
    for (size_t k = 0; k < frames->count; k++) free(frames->records[k].points);
    for (size_t c = 0; c < frames->column_count; c++) free(frames->columns[c]);
    ab_xdmf_destroy(frames->cloud);
    for (size_t b = 0; frames->of_body != NULL && b < frames->bodies; b++) ab_xdmf_destroy(frames->of_body[b]);
    free(frames->of_body);
    ab_frames_contacts_destroy(frames);
    free(frames->records);
    free(frames->values);
    free(frames->rows);
    free(frames->folder);
    free(frames->frame_folder);
    free(frames->path);
    free(frames->kept_columns);
    free(frames);
}
