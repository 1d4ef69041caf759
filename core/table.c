/* table.c: the few lines at the end of a run. */
#include <math.h>
#include <string.h>

#include "core/results_inner.h"

static void ledger(const ab_results *results, const ab_state_view *view, FILE *stream) {
    fprintf(stream, "\n  %-14s %14s %14s\n", "energy, J", "start", "end");
    for (size_t term = 0; term < AB_TERMS; term++) {
        double start = 0;
        for (size_t b = 0; b < view->scene->body_count; b++) start += ab_term_value(&results->energy_start[b], term);
        const double end = ab_term_value(&view->total, term);
        if (start == 0 && end == 0) continue; /* nothing of this kind in the scene */
        fprintf(stream, "  %-14s %14.6g %14.6g\n", ab_term_name(term), start, end);
    }
    fprintf(stream, "  %-14s %14s %14.6g", "remainder", "", view->remainder);
    if (ab_results_moved(results, view) > 0)
        fprintf(stream, "  %.3g %% of the largest that moved", 100 * ab_results_remainder(results, view));
    fprintf(stream, "\n");
}

static void contacts(const ab_results *results, const ab_state_view *view, FILE *stream) {
    const ab_scene *scene = view->scene;
    if (scene->contact_count == 0) return;
    const double span = view->time > 0 ? view->time : 1;
    fprintf(stream, "\n  %-29s %11s %11s %11s %6s %6s %11s\n", "contact", "normal, N", "mean", "friction, N", "points", "active",
            "deepest, m");
    for (size_t k = 0; k < scene->contact_count; k++) {
        const ab_contact_totals *c = &view->contacts[k];
        char name[30];
        snprintf(name, sizeof name, "%.13s - %.13s", scene->bodies[scene->contacts[k].body[0]].name,
                 scene->bodies[scene->contacts[k].body[1]].name);
        fprintf(stream, "  %-29s %11.5g %11.5g %11.5g %6zu %6zu %11.3g\n", name, c->normal_force, results->contacts[k].normal / span,
                c->friction_force, c->points, c->active, results->contacts[k].deepest);
    }
}

static void expects(const ab_results *results, FILE *stream) {
    if (results->expect_count == 0) return;
    fprintf(stream, "\n  %-30s %14s %14s %10s %10s\n", "expect", "value", "reference", "error", "tolerance");
    for (size_t e = 0; e < results->expect_count; e++) {
        const ab_outcome o = ab_expect_end(&results->expects[e]);
        fprintf(stream, "  %-30.30s %14.7g %14.7g %10.3g %10.3g  %s\n", results->expects[e].spec->name, o.value, o.reference, o.error,
                o.tolerance, o.pass ? "pass" : "MISS");
    }
}

/* "120 points, 1 element and 2 rigid bodies": what a step goes over. */
static void work(const ab_run_facts *facts, char *text, size_t size) {
    const struct {
        size_t count;
        const char *one, *many;
    } parts[] = {
        {facts->points, "point", "points"}, {facts->elements, "element", "elements"}, {facts->rigid, "rigid body", "rigid bodies"}};
    size_t left = 0, used = 0;
    for (int k = 0; k < 3; k++) left += parts[k].count > 0;
    text[0] = '\0';
    for (int k = 0; k < 3 && used < size; k++) {
        if (parts[k].count == 0) continue;
        left--;
        used += (size_t)snprintf(text + used, size - used, "%zu %s%s", parts[k].count, parts[k].count == 1 ? parts[k].one : parts[k].many,
                                 left > 1    ? ", "
                                 : left == 1 ? " and "
                                             : "");
    }
}

void ab_results_table(const ab_results *results, const ab_state_view *view, const ab_run_facts *facts, FILE *stream) {
    char what[128];
    work(facts, what, sizeof what);
    fprintf(stream, "\n  %s: t = %.6g s, %ld steps of %s in %.3g s\n", facts->outcome, view->time, facts->steps, what, facts->wall_seconds);
    fprintf(stream, "  %.3g s of processor time, %d thread%s, %.4g MB at most\n  ", facts->cpu_seconds, facts->threads,
            facts->threads == 1 ? "" : "s", 1e-6 * (double)facts->peak_bytes);
    const bool points = facts->points > 0, elements = facts->elements > 0;
    if (points) fprintf(stream, "%.4g million point-steps", 1e-6 * facts->point_steps_per_second);
    if (points && elements) fprintf(stream, " and ");
    if (elements) fprintf(stream, "%.4g million element-steps", 1e-6 * facts->element_steps_per_second);
    if (!points && !elements)
        fprintf(stream, "%.4g thousand steps", 1e-3 * (facts->wall_seconds > 0 ? (double)facts->steps / facts->wall_seconds : 0));
    fprintf(stream, " per second\n");
    ledger(results, view, stream);
    contacts(results, view, stream);
    expects(results, stream);
    fprintf(stream, "\n  results in %s\n", results->folder);
    fflush(stream);
}
