/* results_contacts.c: the contact points of the last step as a group of each frame, and the XDMF that shows them. Only where the scene says output: {contact: true}. */
#include <stdlib.h>
#include <string.h>

#include "core/files.h"
#include "core/frames_inner.h"

enum { AT_MOST = 3 };
typedef enum quantity { POSITION, NORMAL, GAP, AREA, FORCE, PRESSURE, SHEAR, SLIP, QUANTITIES } quantity;
static const struct {
    const char *name, *unit, *names;
    int components;
} WRITTEN[QUANTITIES] = {{"position", "m", "x y z", 3}, {"normal", "1", "x y z", 3}, {"gap", "m", "gap", 1},
                         {"area", "m", "area", 1},      {"force", "N", "x y z", 3},  {"pressure", "Pa", "pressure", 1},
                         {"shear", "Pa", "shear", 1},   {"slip", "m s-1", "slip", 1}};

void ab_frames_contact_name(size_t contact, char name[CONTACT_NAME]) { snprintf(name, CONTACT_NAME, "contact_%zu", contact); }

ab_status ab_frames_contacts_check(const ab_frames *frames, ab_report *report) {
    const ab_scene *scene = frames->scene;
    for (size_t k = 0; scene->output_contact && k < scene->contact_count; k++)
        for (size_t b = 0; b < scene->body_count; b++) {
            char name[CONTACT_NAME];
            ab_frames_contact_name(k, name);
            if (strcmp(scene->bodies[b].name, name) == 0)
                return ab_report_error(report, scene->bodies[b].mark,
                                       "a body cannot be named '%s' where contact points are written: results.h5 has a group of that name",
                                       name);
        }
    return AB_OK;
}

ab_status ab_frames_contacts_begin(ab_frames *frames, ab_report *report) {
    const ab_scene *scene = frames->scene;
    if (!scene->output_contact) return AB_OK;
    frames->of_contact = calloc(scene->contact_count + 1, sizeof *frames->of_contact);
    if (frames->of_contact == NULL) return ab_report_failure(report, "no memory for the output");
    for (size_t k = 0; k < scene->contact_count; k++) {
        char name[CONTACT_NAME], file[2 * CONTACT_NAME];
        ab_frames_contact_name(k, name);
        snprintf(file, sizeof file, "results_%s.xdmf", name);
        char *path = ab_path_join(frames->folder, file);
        if (path == NULL) return ab_report_failure(report, "no memory for the output");
        const ab_status status = ab_xdmf_create(path, name, &frames->of_contact[k], report);
        free(path);
        AB_TRY(status);
    }
    return AB_OK;
}

static size_t count_of(const ab_contact_totals *contact) { return contact->list != NULL ? contact->list->count : 0; }

/* Component c of a quantity of point i. */
static double value_of(const ab_contact_totals *contact, const double origin[2], quantity what, size_t i, size_t c) {
    const ab_points *p = contact->list;
    if (c >= 2) return 0;
    switch (what) {
    case POSITION: return p->position[c * p->ld + i] + origin[c];
    case NORMAL: return p->normal[c * p->ld + i];
    case GAP: return p->gap[i];
    case AREA: return p->area[i];
    case FORCE: return contact->normal[i] * p->normal[c * p->ld + i] + contact->tangential[i] * (c ? p->normal[i] : -p->normal[p->ld + i]);
    case PRESSURE: return contact->pressure ? contact->pressure[i] : p->area[i] > 0.0 ? contact->normal[i] / p->area[i] : 0.0;
    case SHEAR: return contact->shear ? contact->shear[i] : p->area[i] > 0.0 ? contact->tangential[i] / p->area[i] : 0.0;
    default: return contact->slip[i];
    }
}

static int fill(const ab_contact_totals *contact, const double origin[2], double *rows, hid_t group) {
    const size_t points = count_of(contact);
    int result = 0;
    for (int what = 0; what < QUANTITIES && result >= 0; what++) {
        const size_t components = (size_t)WRITTEN[what].components;
        for (size_t i = 0; i < points; i++)
            for (size_t c = 0; c < components; c++) rows[i * components + c] = value_of(contact, origin, (quantity)what, i, c);
        const hid_t space = ab_hdf5_space(points, WRITTEN[what].components);
        result = ab_hdf5_dataset(group, WRITTEN[what].name, WRITTEN[what].unit, WRITTEN[what].names, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
                                 space, H5P_DEFAULT, rows);
        H5Sclose(space);
    }
    return result < 0 ? result : ab_hdf5_vertices(group, points, rows);
}

ab_status ab_frames_contacts_fill(ab_frames *frames, const ab_contact_totals *contacts, hid_t frame, ab_report *report) {
    const ab_scene *scene = frames->scene;
    for (size_t k = 0; scene->output_contact && k < scene->contact_count; k++) {
        double *rows = malloc((count_of(&contacts[k]) + 1) * AT_MOST * sizeof *rows);
        if (rows == NULL) return ab_report_failure(report, "no memory for %zu contact points", count_of(&contacts[k]));
        char name[CONTACT_NAME];
        ab_frames_contact_name(k, name);
        const hid_t group = H5Gcreate2(frame, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        const int result = group < 0 ? -1 : fill(&contacts[k], scene->grid_from, rows, group);
        if (group >= 0) H5Gclose(group);
        free(rows);
        if (result < 0) return ab_hdf5_trouble("build a frame", report);
    }
    return AB_OK;
}

ab_status ab_frames_contacts_xdmf(ab_frames *frames, size_t number, ab_report *report) {
    for (size_t k = 0; frames->of_contact != NULL && k < frames->scene->contact_count; k++) {
        if (frames->records[number].contacts[k] == 0) continue; /* readers stumble over grids without points */
        char name[CONTACT_NAME];
        ab_frames_contact_name(k, name);
        ab_xdmf_field fields[QUANTITIES];
        for (int what = 0; what < QUANTITIES; what++) fields[what] = (ab_xdmf_field){WRITTEN[what].name, WRITTEN[what].components, false};
        const ab_xdmf_grid grid = {.frame = number,
                                   .topology_frame = number,
                                   .group = name,
                                   .time = frames->records[number].time,
                                   .points = frames->records[number].contacts[k]};
        AB_TRY(ab_xdmf_add(frames->of_contact[k], &grid, fields, QUANTITIES, report));
    }
    return AB_OK;
}

ab_status ab_frames_contacts_finish(ab_frames *frames, ab_report *report) {
    for (size_t k = 0; frames->of_contact != NULL && k < frames->scene->contact_count; k++)
        if (frames->of_contact[k] != NULL) AB_TRY(ab_xdmf_finish(frames->of_contact[k], report));
    return AB_OK;
}

void ab_frames_contacts_destroy(ab_frames *frames) {
    for (size_t k = 0; frames->of_contact != NULL && k < frames->scene->contact_count; k++) ab_xdmf_destroy(frames->of_contact[k]);
    free(frames->of_contact);
}
