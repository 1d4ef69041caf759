/* results_gather.c: results.h5 itself: a list of links while the run lasts, one self-contained file at its end. results_hdf5.c says why. */
#define _GNU_SOURCE /* fallocate */
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/files.h"
#include "core/frames_inner.h"

/* results.h5 while the run lasts: a link to each frame. */
ab_status ab_frames_link(const ab_frames *frames, ab_report *report) {
    const hid_t file = ab_hdf5_create();
    if (file < 0) return ab_hdf5_trouble("build the list of frames", report);
    ab_status status = AB_OK;
    for (size_t k = frames->first; k < frames->count && status == AB_OK; k++) {
        char name[32], target[48];
        snprintf(name, sizeof name, "frame_%06zu", k);
        snprintf(target, sizeof target, "frames/%s.h5", name);
        if (H5Lcreate_external(target, name, file, name, H5P_DEFAULT, H5P_DEFAULT) < 0) status = ab_hdf5_trouble("link a frame", report);
    }
    if (status == AB_OK) status = ab_hdf5_save(file, frames->path, NULL, report);
    H5Fclose(file);
    return status;
}

/* Room for the gathered file: blocks are set aside before the library writes into them, because it does not survive a write that fails. */
static bool reserve(const char *path, off_t bytes) {
    struct rlimit limit;
    if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && (rlim_t)bytes > limit.rlim_cur) return false;
    const int file = open(path, O_RDWR | O_CLOEXEC);
    if (file < 0) return false;
    bool done = fallocate(file, FALLOC_FL_KEEP_SIZE, 0, bytes) == 0;
    if (!done && errno == EOPNOTSUPP) done = posix_fallocate(file, 0, bytes) == 0;
    close(file);
    return done;
}

int ab_frames_copy(ab_frames *frames, size_t number, hid_t from, hid_t into) {
    char name[32];
    snprintf(name, sizeof name, "frame_%06zu", number);
    const hid_t source = H5Gopen2(from, name, H5P_DEFAULT), target = ab_frames_group(&frames->records[number], name, into);
    int result = source < 0 || target < 0 ? -1 : 0;
    for (size_t b = 0; b < frames->bodies && result >= 0; b++) {
        const char *body = frames->scene->bodies[b].name;
        result = H5Ocopy(source, body, target, body, H5P_DEFAULT, H5P_DEFAULT);
    }
    for (size_t k = 0; frames->scene->output_contact && k < frames->scene->contact_count && result >= 0; k++) {
        char contact[CONTACT_NAME];
        ab_frames_contact_name(k, contact);
        result = H5Ocopy(source, contact, target, contact, H5P_DEFAULT, H5P_DEFAULT);
    }
    if (result >= 0) result = ab_frames_cloud(frames, number, name, target);
    if (source >= 0) H5Gclose(source);
    if (target >= 0) H5Gclose(target);
    return result;
}

static int gather_frame(ab_frames *frames, size_t number, hid_t into) {
    char *path = ab_frames_path(frames, number);
    if (path == NULL) return -1;
    const hid_t from = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    free(path);
    if (from < 0) return -1;
    const int result = ab_frames_copy(frames, number, from, into);
    H5Fclose(from);
    return result;
}

static int gather(ab_frames *frames, const char *path, off_t bytes, ab_report *report) {
    hid_t file = ab_hdf5_create();
    if (file < 0) return -1;
    const ab_status empty = ab_hdf5_save(file, path, NULL, report);
    H5Fclose(file);
    if (empty != AB_OK || !reserve(path, bytes)) return -1;
    if ((file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT)) < 0) return -1;
    int result = 0;
    for (size_t k = frames->first; k < frames->count && result >= 0; k++) result = gather_frame(frames, k, file);
    if (H5Fclose(file) < 0) return -1;
    struct stat found;
    if (stat(path, &found) != 0 || truncate(path, found.st_size) != 0) return -1; /* gives back what was set aside and not needed */
    return result;
}

ab_status ab_frames_finish(ab_frames *frames, ab_report *report) {
    if (frames->cloud != NULL) AB_TRY(ab_xdmf_finish(frames->cloud, report));
    for (size_t b = 0; frames->of_body != NULL && b < frames->bodies; b++)
        if (frames->of_body[b] != NULL) AB_TRY(ab_xdmf_finish(frames->of_body[b], report));
    AB_TRY(ab_frames_contacts_finish(frames, report));
    if (frames->count == frames->first) {
        rmdir(frames->frame_folder);
        return AB_OK;
    }
    off_t bytes = 1 << 20;
    for (size_t k = frames->first; k < frames->count; k++) bytes += frames->records[k].bytes + 65536;
    char *beside = malloc(strlen(frames->path) + 6);
    if (beside == NULL) return ab_report_failure(report, "no memory to gather the frames");
    sprintf(beside, "%s.part", frames->path);
    int result = -1;
    H5E_BEGIN_TRY { result = gather(frames, beside, bytes, report); }
    H5E_END_TRY
    if (result >= 0 && rename(beside, frames->path) == 0) {
        ab_frames_clear(frames->frame_folder);
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
