/* frames_inner.h: what results_hdf5.c (a frame), results_data.c (groups, datasets, attributes) and results_gather.c (all frames in one file) share.
 * Functions that return int answer as HDF5 does: negative when they failed. */
#ifndef AB_FRAMES_INNER_H
#define AB_FRAMES_INNER_H

#include <hdf5.h>
#include <sys/types.h>

#include "core/frames.h"

enum { MOST_FIELDS = 24, MOST_COMPONENTS = 9 };

typedef struct column {              /* a dataset of each frame and body */
    const char *name, *unit, *names; /* names of the components */
    int given, written;              /* components as the body has them, as the file has them */
    bool integer;
    bool of_body[]; /* body_count: a body of another method may lack a field */
} column;

typedef struct frame_record {
    size_t *points; /* per body */
    size_t total;
    size_t *cells;    /* elements per body; 0: a cloud of points */
    size_t *topology; /* per body, and of the cloud last: the frame that holds `vertices` or `connectivity` for this number of them */
    size_t *contacts; /* points per contact, where they are written */
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
    size_t first; /* those before it lie in another folder: the run went on from a checkpoint there */
    char *kept_columns; /* of a run that goes on: those of the frames before */
    double *values, *rows; /* as a body gives them; as the file has them */
    size_t value_capacity, row_capacity;
    ab_xdmf *cloud, **of_body; /* of_body[b]: NULL where body b is all there is, and is a cloud */
    ab_xdmf **of_contact;      /* NULL unless contact points are written */
};

/* ---- results_data.c ---- */

/* A failure whose text ends in what the library says last. */
ab_status ab_hdf5_trouble(const char *what, ab_report *report);
/* A file that exists in memory only; negative without memory. */
hid_t ab_hdf5_create(void);
/* Puts such a file on the disk in one piece. bytes: its size; may be NULL. */
ab_status ab_hdf5_save(hid_t file, const char *path, off_t *bytes, ab_report *report);
int ab_hdf5_text(hid_t object, const char *name, const char *text);
int ab_hdf5_value(hid_t object, const char *name, hid_t stored, hid_t given, const void *value);
hid_t ab_hdf5_space(size_t points, int components);
/* A dataset with its unit and the names of its components; values NULL: nothing is written (a virtual one). */
int ab_hdf5_dataset(hid_t group, const char *name, const char *unit, const char *names, hid_t stored, hid_t given, hid_t space,
                    hid_t creation, const void *values);
int ab_hdf5_vertices(hid_t group, size_t points, void *scratch);
int ab_hdf5_connectivity(hid_t group, const ab_cells *cells);

/* ---- results_hdf5.c ---- */

/* DIR/frames/frame_000012.h5; the caller frees it. */
char *ab_frames_path(const ab_frames *frames, size_t number);
/* A new group /frame_000012 with its attributes; negative when that failed. */
hid_t ab_frames_group(const frame_record *record, const char *name, hid_t file);
/* The group `all` of a frame, in the frame's own file and again in the gathered one (a virtual dataset names the file it stands in). */
int ab_frames_cloud(ab_frames *frames, size_t number, const char *frame, hid_t parent);
/* Removes the frames of an earlier run, complete or not. Files of other names stay. */
void ab_frames_clear(const char *path);

/* The paths in a folder, and results.xdmf without grids. */
ab_status ab_frames_open(ab_frames *frames, const char *folder, ab_report *report);
frame_record *ab_frames_record(ab_frames *frames); /* a new one at the end, not counted yet; NULL: no memory */
ab_status ab_frames_xdmf(ab_frames *frames, size_t number, ab_report *report);

/* ---- results_contacts.c: nothing is done unless contact points are asked for ---- */

enum { CONTACT_NAME = 32 };
void ab_frames_contact_name(size_t contact, char name[CONTACT_NAME]); /* of its group */
ab_status ab_frames_contacts_check(const ab_frames *frames, ab_report *report);
ab_status ab_frames_contacts_begin(ab_frames *frames, ab_report *report);
/* Puts the groups of one frame into it. */
ab_status ab_frames_contacts_fill(ab_frames *frames, const ab_contact_totals *contacts, hid_t frame, ab_report *report);
ab_status ab_frames_contacts_xdmf(ab_frames *frames, size_t number, ab_report *report);
ab_status ab_frames_contacts_finish(ab_frames *frames, ab_report *report);
void ab_frames_contacts_destroy(ab_frames *frames);

/* ---- results_gather.c ---- */

ab_status ab_frames_link(const ab_frames *frames, ab_report *report);
/* A frame from one file into another. */
int ab_frames_copy(ab_frames *frames, size_t number, hid_t from, hid_t into);

#endif
