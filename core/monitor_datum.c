/* monitor_datum.c: where the displacements of monitors are counted from, after a stage has set them to zero. */
#include <stdlib.h>
#include <string.h>

#include "core/checkpoint.h"
#include "core/monitor_inner.h"

static bool take_datum(body_points *points, int dimension) {
    const size_t count = points->count * (size_t)dimension;
    if (points->datum == NULL) points->datum = malloc((count + 1) * sizeof *points->datum);
    return points->datum != NULL;
}

ab_status ab_monitors_datum(ab_monitors *monitors, const ab_state_view *view, ab_report *report) {
    const size_t dimension = (size_t)monitors->dimension;
    for (size_t b = 0; b < monitors->bodies; b++) {
        body_points *points = &monitors->of_body[b];
        monitors->start[b] = view->motion[b];
        if (points->position == NULL) continue;
        const ab_domain *domain = view->domains[b];
        const size_t count = domain->ops->count(domain);
        double *place = malloc((count * dimension + 1) * sizeof *place), *id = malloc((count + 1) * sizeof *id);
        const bool room = place != NULL && id != NULL && take_datum(points, monitors->dimension);
        ab_status status = room ? domain->ops->read(domain, "position", place, report)
                                : ab_report_failure(report, "no memory for monitors of %zu points", count);
        if (status == AB_OK) status = domain->ops->read(domain, "id", id, report);
        size_t k = 0;
        for (size_t p = 0; status == AB_OK && p < points->count; p++) { /* both ascend; points may have left */
            while (k < count && id[k] < points->id[p]) k++;
            const bool here = k < count && id[k] == points->id[p];
            memcpy(points->datum + p * dimension, here ? place + k * dimension : points->position + p * dimension,
                   dimension * sizeof *place);
        }
        free(place), free(id);
        AB_TRY(status);
    }
    return AB_OK;
}

void ab_monitors_keep(ab_monitors *monitors, ab_checkpoint *c) {
    const size_t dimension = (size_t)monitors->dimension;
    for (size_t b = 0; b < monitors->bodies; b++) {
        body_points *points = &monitors->of_body[b];
        bool set = points->datum != NULL;
        size_t count = points->count;
        ab_checkpoint_enter(c, "monitors[%zu]", b);
        bool good =
            ab_keep_struct(c, "motion", &monitors->start[b]) && ab_keep_flags(c, "datum_set", &set, 1) && ab_keep_size(c, "count", &count);
        /* monitors may have changed since: without places of that time, displacements of new ones are counted from the start */
        if (good && set && points->position != NULL && count == points->count) {
            if (!take_datum(points, monitors->dimension))
                good = ab_checkpoint_refuse(c, "no memory for monitors of %zu points", points->count);
            good = good && ab_keep_doubles(c, "datum", points->datum, points->count * dimension);
        }
        ab_checkpoint_leave(c);
    }
}
