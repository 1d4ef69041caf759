/* frames.h: the frames of a run as HDF5 (results.h5) and the XDMF that shows them. Inside of results.c; nobody else calls it.
 *
 * results.h5, once a run has ended:
 *   /frame_000000            attributes time, time_unit, step
 *     /<body>                one group a body: position, id, body and the fields asked for. In the first frame, and in each that has another number of rows:
 *                            vertices (0, 1, 2 ...: a cloud of points) or connectivity (the nodes of each element)
 *     /contact_0             one group a contact where contact points are asked for: position, normal, gap, area, force, pressure, shear, slip, and vertices
 *     /all                   the same rows of every body one after the other, as virtual datasets: no second copy of the data
 * Every dataset has the attributes "unit" and "components". Vectors have three components, symmetric tensors six in the order
 * in which ParaView names and uses them (xx yy zz xy yz xz). That is why the XDMF calls them a Matrix: its own Tensor6 means another order, which
 * ParaView's reader passes on as it is, and then calls xy YY. */
#ifndef AB_FRAMES_H
#define AB_FRAMES_H

#include "core/results.h"

typedef struct ab_frames ab_frames;

/* Checks the fields asked for; writes nothing yet. */
ab_status ab_frames_create(const ab_scene *scene, ab_domain *const *domains, ab_frames **frames, ab_report *report);
/* Clears frames of an earlier run in this folder (which exists). */
ab_status ab_frames_begin(ab_frames *frames, const char *folder, ab_report *report);
/* For checkpoints: which frames there are. frames NULL: none are written. */
void ab_frames_keep(ab_frames *frames, struct ab_checkpoint *checkpoint);
/* Goes on in a folder: `there`, its frames are those before the checkpoint, and later ones go; else it has none of them, and numbers go on. AB_BAD_INPUT: some are
 * not there, or have other fields. */
ab_status ab_frames_continue(ab_frames *frames, const char *folder, bool there, ab_report *report);
/* contacts: of the last step, contact_count; looked at where the scene writes contact points. */
ab_status ab_frames_write(ab_frames *frames, const ab_contact_totals *contacts, double time, long step, ab_report *report);
/* Gathers the frames into one self-contained results.h5. Where there is no room for that the linked form stays, with a warning. */
ab_status ab_frames_finish(ab_frames *frames, ab_report *report);
size_t ab_frames_count(const ab_frames *frames);
void ab_frames_destroy(ab_frames *frames);

/* ---- results_xdmf.c ---- */

typedef struct ab_xdmf ab_xdmf; /* one .xdmf file that grows by a grid a frame */

typedef struct ab_xdmf_field {
    const char *name;
    int components;
    bool integer;
} ab_xdmf_field;

typedef struct ab_xdmf_grid {     /* /frame/group of results.h5 */
    size_t frame, topology_frame; /* topology_frame: the one that holds `vertices` or `connectivity` */
    const char *group;
    double time; /* s */
    size_t points;
    size_t cells; /* elements of `cell_nodes` (4 or 8) nodes; 0: each point is a vertex */
    int cell_nodes;
} ab_xdmf_grid;

ab_status ab_xdmf_create(const char *path, const char *title, ab_xdmf **xdmf, ab_report *report);
/* Adds a grid and writes the file anew, in one piece. */
ab_status ab_xdmf_add(ab_xdmf *xdmf, const ab_xdmf_grid *grid, const ab_xdmf_field *fields, size_t field_count, ab_report *report);
void ab_xdmf_hold(ab_xdmf *xdmf, bool held); /* held: grids are added, and nothing is written */
ab_status ab_xdmf_finish(ab_xdmf *xdmf, ab_report *report); /* writes what a very long series has held back */
void ab_xdmf_destroy(ab_xdmf *xdmf);

#endif
