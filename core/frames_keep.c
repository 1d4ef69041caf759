/* frames_keep.c: frames across a checkpoint. While a run lasts each frame is a file of its own, so going on is leaving those before the checkpoint and removing those behind
 * it. Frames that were gathered already, as the run was stopped in good order or has ended, are taken out of results.h5 again. */
#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/checkpoint.h"
#include "core/files.h"
#include "core/frames_inner.h"

/* "position id body stress contact": what frames have in them. */
static char *columns_of(const ab_frames *frames) {
    ab_text text = {0};
    for (size_t k = 0; k < frames->column_count; k++) ab_text_add(&text, "%s ", frames->columns[k]->name);
    if (frames->scene->output_contact) ab_text_add(&text, "(contact points)");
    char *line = text.failed || text.count == 0 ? NULL : strdup(text.bytes);
    ab_text_clear(&text);
    return line;
}

/* Numbers of one record, in a row. */
static size_t row_of(const ab_frames *frames) { return 3 * frames->bodies + 1 + frames->scene->contact_count; }

void ab_frames_keep(ab_frames *frames, ab_checkpoint *c) {
    const bool loads = ab_checkpoint_loads(c);
    size_t count = frames != NULL ? frames->count : 0, first = frames != NULL ? frames->first : 0;
    if (!ab_keep_count(c, "frames", &count, 24) || !ab_keep_size(c, "first_frame", &first) || frames == NULL) return;
    if (first > count) {
        ab_checkpoint_refuse(c, "its frames are damaged");
        return;
    }
    const size_t row = row_of(frames);
    uint64_t *numbers = malloc((count * row + 1) * sizeof *numbers), *totals = malloc((2 * count + 1) * sizeof *totals);
    double *times = malloc((count + 1) * sizeof *times);
    char *columns = columns_of(frames);
    bool good = numbers != NULL && totals != NULL && times != NULL && columns != NULL;
    for (size_t k = 0; good && !loads && k < count; k++) {
        const frame_record *record = &frames->records[k];
        for (size_t i = 0; i < row; i++) numbers[k * row + i] = record->points[i]; /* the other lists stand behind it */
        totals[2 * k] = record->total;
        totals[2 * k + 1] = (uint64_t)record->step;
        times[k] = record->time;
    }
    size_t length = 0;
    const char *before = loads ? ab_checkpoint_get(c, "columns", &length) : NULL;
    if (good && !loads) good = ab_checkpoint_put(c, "columns", columns, strlen(columns));
    if (good && before != NULL) good = (frames->kept_columns = strndup(before, length)) != NULL;
    good = good && (count == 0 || (ab_keep_u64(c, "frame_numbers", numbers, count * row) &&
                                   ab_keep_u64(c, "frame_totals", totals, 2 * count) && ab_keep_doubles(c, "frame_times", times, count)));
    for (size_t k = 0; good && loads && k < count; k++) {
        frame_record *record = ab_frames_record(frames);
        good = record != NULL;
        if (!good) break;
        for (size_t i = 0; i < row; i++) record->points[i] = numbers[k * row + i];
        record->total = totals[2 * k];
        record->step = (long)totals[2 * k + 1];
        record->time = times[k];
        frames->count++;
    }
    if (good && loads) frames->first = first;
    if (!good) ab_checkpoint_refuse(c, "its frames cannot be brought back");
    free(numbers), free(totals), free(times), free(columns);
}

/* Is this file the frame of that step? */
static bool is_frame(const ab_frames *frames, size_t number, const char *path) {
    char name[32];
    snprintf(name, sizeof name, "frame_%06zu", number);
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0) return false;
    int64_t step = -1;
    const hid_t group = H5Lexists(file, name, H5P_DEFAULT) > 0 ? H5Gopen2(file, name, H5P_DEFAULT) : H5I_INVALID_HID;
    const hid_t attribute = group >= 0 ? H5Aopen(group, "step", H5P_DEFAULT) : H5I_INVALID_HID;
    if (attribute >= 0 && H5Aread(attribute, H5T_NATIVE_INT64, &step) < 0) step = -1;
    if (attribute >= 0) H5Aclose(attribute);
    if (group >= 0) H5Gclose(group);
    H5Fclose(file);
    return step == frames->records[number].step;
}

/* A frame that was gathered, back into a file of its own. */
static ab_status take_out(ab_frames *frames, size_t number, const char *path, ab_report *report) {
    ab_status status = AB_OK;
    if (!is_frame(frames, number, frames->path))
        return ab_report_error(
            report, AB_NOWHERE,
            "frame %zu, of step %ld, is neither in '%s' nor in '%s'; name another folder with -o, which then begins with the frames "
            "after the checkpoint",
            number, frames->records[number].step, frames->frame_folder, frames->path);
    const hid_t from = H5Fopen(frames->path, H5F_ACC_RDONLY, H5P_DEFAULT), into = ab_hdf5_create();
    if (from < 0 || into < 0 || ab_frames_copy(frames, number, from, into) < 0)
        status = ab_hdf5_trouble("take a frame out of it", report);
    else
        status = ab_hdf5_save(into, path, &frames->records[number].bytes, report);
    if (into >= 0) H5Fclose(into);
    if (from >= 0) H5Fclose(from);
    return status;
}

/* Each frame before the checkpoint has a file. */
static ab_status provide(ab_frames *frames, ab_report *report) {
    ab_status status = AB_OK;
    for (size_t k = frames->first; status == AB_OK && k < frames->count; k++) {
        char *path = ab_frames_path(frames, k);
        if (path == NULL) return ab_report_failure(report, "no memory for frame %zu", k);
        if (!is_frame(frames, k, path)) status = take_out(frames, k, path, report);
        struct stat found;
        if (stat(path, &found) == 0) frames->records[k].bytes = found.st_size;
        free(path);
    }
    return status;
}

/* Those behind the checkpoint, and what a killed run has not finished. */
static void remove_later(const ab_frames *frames) {
    DIR *folder = opendir(frames->frame_folder);
    for (const struct dirent *entry; folder != NULL && (entry = readdir(folder)) != NULL;) {
        char *end = NULL;
        if (strncmp(entry->d_name, "frame_", 6) != 0) continue;
        const unsigned long long number = strtoull(entry->d_name + 6, &end, 10);
        if (number < frames->first || number >= frames->count || strcmp(end, ".h5") != 0) unlinkat(dirfd(folder), entry->d_name, 0);
    }
    if (folder != NULL) closedir(folder);
}

static void hold(ab_frames *frames, bool held) {
    ab_xdmf_hold(frames->cloud, held);
    for (size_t b = 0; b < frames->bodies; b++)
        if (frames->of_body[b] != NULL) ab_xdmf_hold(frames->of_body[b], held);
    for (size_t k = 0; frames->of_contact != NULL && k < frames->scene->contact_count; k++) ab_xdmf_hold(frames->of_contact[k], held);
}

ab_status ab_frames_continue(ab_frames *frames, const char *folder, bool there, ab_report *report) {
    H5PLset_loading_state(0); /* a file to be read may ask for filters, and filters are code */
    if (!there) {
        frames->first = frames->count;
        return ab_frames_begin(frames, folder, report);
    }
    char *columns = columns_of(frames);
    const bool same = columns != NULL && frames->kept_columns != NULL && strcmp(columns, frames->kept_columns) == 0;
    free(columns);
    if (!same && frames->count > frames->first)
        return ab_report_error(report, AB_NOWHERE,
                               "output: its fields have changed since the checkpoint (there were: %s); name another folder with -o, which "
                               "then begins with the frames after the checkpoint",
                               frames->kept_columns != NULL ? frames->kept_columns : "none");
    AB_TRY(ab_frames_open(frames, folder, report));
    ab_status status = AB_OK;
    H5E_BEGIN_TRY {
        status = provide(frames, report);
        if (status == AB_OK) status = ab_frames_link(frames, report);
    }
    H5E_END_TRY
    AB_TRY(status);
    remove_later(frames);
    hold(frames, true);
    for (size_t k = frames->first; status == AB_OK && k < frames->count; k++) {
        status = ab_frames_xdmf(frames, k, report);
        if (status == AB_OK) status = ab_frames_contacts_xdmf(frames, k, report);
    }
    hold(frames, false);
    return status;
}
