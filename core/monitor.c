/* monitor.c: reads monitors when somebody asks, each field once a step for all of them. */
#include "core/monitor.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/columns.h"
#include "core/monitor_inner.h"

static ab_status read_field(ab_monitors *monitors, size_t body, const ab_state_view *view, const char *name, int components,
                            const double **values, ab_report *report) {
    body_points *points = &monitors->of_body[body];
    const ab_domain *domain = view->domains[body];
    const size_t count = domain->ops->count(domain);
    field_values *slot = NULL;
    for (int f = 0; f < FIELDS_PER_BODY && slot == NULL; f++)
        if (!points->fields[f].used || strcmp(points->fields[f].name, name) == 0) slot = &points->fields[f];
    if (slot == NULL)
        return ab_report_failure(report, "monitors: more than %d fields of body '%s'", FIELDS_PER_BODY, view->scene->bodies[body].name);
    if (!slot->used) {
        snprintf(slot->name, sizeof slot->name, "%s", name);
        slot->components = components;
        slot->used = true;
        slot->step = -1;
    }
    const size_t wanted = count * (size_t)components;
    if (wanted > slot->capacity) {
        double *grown = realloc(slot->values, wanted * sizeof *grown);
        if (grown == NULL) return ab_report_failure(report, "no memory to read '%s' of %zu points", name, count);
        slot->values = grown;
        slot->capacity = wanted;
    }
    if (slot->step != view->step) AB_TRY(domain->ops->read(domain, name, slot->values, report));
    slot->step = view->step;
    *values = slot->values;
    return AB_OK;
}

/* The place now of the point that stood at place `start`; SIZE_MAX where it has left. Values come in order of id. */
static size_t place_now(const body_points *points, size_t start, size_t count, const double *id) {
    if (id == NULL) return start;
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (id[middle] < points->id[start])
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && id[low] == points->id[start] ? low : SIZE_MAX;
}

static double energy_value(const monitor *m, const ab_state_view *view) {
    const bool scene = m->spec->body < 0;
    const ab_energy *e = scene ? &view->total : &view->energy[m->spec->body];
    if (m->offset == SIZE_MAX - 1) return e->kinetic + e->strain + e->potential;
    if (m->offset < AB_TERMS) return ab_term_value(e, m->offset);
    return scene ? view->remainder : ab_energy_balance(e) - ab_energy_balance(&view->energy_start[m->spec->body]);
}

static double number_at(const void *object, size_t offset) {
    double value;
    memcpy(&value, (const char *)object + offset, sizeof value);
    return value;
}

static double motion_value(const ab_monitors *monitors, const monitor *m, const ab_state_view *view) {
    if (m->spec->body < 0) {
        double sum = 0;
        for (size_t b = 0; b < monitors->bodies; b++) sum += number_at(&view->motion[b], m->offset);
        return sum;
    }
    const ab_motion *motion = &view->motion[m->spec->body];
    const double value = number_at(motion, m->offset);
    if (m->by_mass) return value / motion->mass;
    return m->from_start ? value - number_at(&monitors->start[m->spec->body], m->offset) : value;
}

static double contact_value(const monitor *m, const ab_state_view *view) {
    const ab_contact_totals *totals = &view->contacts[m->spec->contact];
    if (!m->is_size) return number_at(totals, m->offset);
    size_t value;
    memcpy(&value, (const char *)totals + m->offset, sizeof value);
    return (double)value;
}

/* Sum of the contact forces on a body, or (component 2) of their moments about its centre of mass: where that was when they acted, a step ago. */
static double force_value(const monitor *m, const ab_state_view *view) {
    const size_t body = (size_t)m->spec->body;
    double force[3] = {0};
    for (size_t k = 0; k < view->scene->contact_count; k++) {
        const ab_contact_totals *totals = &view->contacts[k];
        for (int side = 0; side < 2; side++) {
            if (view->scene->contacts[k].body[side] != body) continue;
            const double sign = side == 0 ? -1 : 1; /* totals are those on the second body */
            force[0] += sign * totals->force[0];
            force[1] += sign * totals->force[1];
            force[2] += sign * totals->moment;
        }
    }
    if (m->component < 2) return force[m->component];
    const ab_motion *motion = &view->motion[body];
    double centre[2];
    for (int c = 0; c < 2; c++) centre[c] = motion->centre[c] - (motion->mass > 0 ? view->dt * motion->momentum[c] / motion->mass : 0);
    return force[2] - (centre[0] * force[1] - centre[1] * force[0]);
}

static double reaction_value(const monitor *m, const ab_state_view *view) {
    const ab_domain *domain = view->domains[m->spec->body];
    double force[3] = {0};
    domain->ops->reaction(domain, force);
    return force[m->component];
}

static double point_value(const monitor *m, const body_points *points, const double *row, size_t start, int dimension) {
    switch (m->quantity) {
    case THE_LENGTH: return dimension == 3 ? sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]) : hypot(row[0], row[1]);
    case THE_PRESSURE: return -(row[0] + row[1] + row[2]) / 3;
    case THE_DISPLACEMENT:
        return row[m->component] -
               (points->datum != NULL ? points->datum : points->position)[start * (size_t)dimension + (size_t)m->component];
    default: return row[m->component];
    }
}

/* The start's place of the point that is now at place p (needed for displacements when points have left). */
static size_t place_before(const body_points *points, const double *id, size_t p) {
    size_t low = 0, high = points->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (points->id[middle] < id[p])
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* The value of a point less the formula where it stood at the start. */
static ab_status take_away(const monitor *m, const ab_state_view *view, const double start[2], double *value, ab_report *report) {
    const double minus = ab_number_of(&m->spec->minus, view->time, start, start);
    *value -= minus;
    return ab_number_finite(&m->spec->minus, minus, view->time, start, report, "minus of monitor '%s'", m->spec->name);
}

static ab_status points_value(ab_monitors *monitors, monitor *m, const ab_state_view *view, ab_report *report) {
    const size_t body = (size_t)m->spec->body;
    const body_points *points = &monitors->of_body[body];
    const ab_domain *domain = view->domains[body];
    const size_t count = domain->ops->count(domain);
    const ab_field *field = ab_monitor_field(domain, m->field);
    const size_t width = (size_t)field->components;
    const double *values, *weight = NULL, *id = NULL;
    AB_TRY(read_field(monitors, body, view, m->field, field->components, &values, report));
    const bool squared = m->gather == MEAN_SQUARE;
    if (m->gather == MEAN_BY_MASS || squared) AB_TRY(read_field(monitors, body, view, "mass", 1, &weight, report));
    if (m->gather == MEAN_BY_VOLUME) AB_TRY(read_field(monitors, body, view, "volume", 1, &weight, report));
    if (points->position != NULL && count != points->count) AB_TRY(read_field(monitors, body, view, "id", 1, &id, report));
    const bool chosen = m->selected != NULL;
    const size_t n = chosen ? m->selected_count : count;
    double sum = 0, sum_weight = 0, largest = -INFINITY, smallest = INFINITY;
    size_t seen = 0;
    for (size_t k = 0; k < n; k++) {
        const size_t p = chosen ? place_now(points, m->selected[k], count, id) : k;
        if (p == SIZE_MAX) continue;
        const size_t start = chosen ? m->selected[k] : id != NULL ? place_before(points, id, k) : k;
        double q = point_value(m, points, values + p * width, start, monitors->dimension);
        if (m->spec->has_minus) AB_TRY(take_away(m, view, points->position + start * (size_t)monitors->dimension, &q, report));
        const double w = weight != NULL ? weight[p] : 1;
        sum += w * (squared ? q * q : q);
        sum_weight += w;
        largest = q > largest || isnan(q) ? q : largest;
        smallest = q < smallest || isnan(q) ? q : smallest;
        seen++;
    }
    m->value = seen == 0               ? (m->gather == SUM ? 0 : (double)NAN)
               : m->gather == LARGEST  ? largest
               : m->gather == SMALLEST ? smallest
               : m->gather == SUM      ? sum
               : squared               ? sqrt(sum / sum_weight)
                                       : sum / sum_weight;
    return AB_OK;
}

/* Spin of the body as a whole: angular momentum about its centre by its moment of inertia. */
static ab_status rotation_value(ab_monitors *monitors, monitor *m, const ab_state_view *view, ab_report *report) {
    const size_t body = (size_t)m->spec->body;
    const ab_domain *domain = view->domains[body];
    const ab_motion *motion = &view->motion[body];
    const size_t count = domain->ops->count(domain), width = (size_t)domain->dimension;
    const double *position, *mass;
    AB_TRY(read_field(monitors, body, view, "position", domain->dimension, &position, report));
    AB_TRY(read_field(monitors, body, view, "mass", 1, &mass, report));
    double inertia = motion->own_inertia;
    for (size_t p = 0; p < count; p++) {
        const double dx = position[p * width] - motion->centre[0], dy = position[p * width + 1] - motion->centre[1];
        inertia += mass[p] * (dx * dx + dy * dy);
    }
    m->value = (motion->angular_momentum[2] - motion->centre[0] * motion->momentum[1] + motion->centre[1] * motion->momentum[0]) / inertia;
    return AB_OK;
}

ab_status ab_monitor_value(ab_monitors *monitors, size_t index, const ab_state_view *view, double *value, ab_report *report) {
    monitor *m = &monitors->items[index];
    if (m->step != view->step) {
        switch (m->source) {
        case OF_MOTION: m->value = motion_value(monitors, m, view); break;
        case OF_ENERGY: m->value = energy_value(m, view); break;
        case OF_BOUNDARY: m->value = number_at(&view->boundaries[m->spec->boundary], m->offset); break;
        case OF_CONTACT: m->value = contact_value(m, view); break;
        case OF_ALL_CONTACTS: m->value = force_value(m, view); break;
        case OF_REACTION: m->value = reaction_value(m, view); break;
        case OF_DT: m->value = view->dt; break;
        case OF_ROTATION: AB_TRY(rotation_value(monitors, m, view, report)); break;
        case OF_POINTS: AB_TRY(points_value(monitors, m, view, report)); break;
        }
        m->step = view->step;
    }
    *value = m->value;
    return AB_OK;
}

const char *ab_monitor_unit(const ab_monitors *monitors, size_t index) { return monitors->items[index].unit; }

bool ab_monitor_is_cheap(const ab_monitors *monitors, size_t index) {
    return monitors->items[index].source != OF_POINTS && monitors->items[index].source != OF_ROTATION;
}

void ab_monitors_destroy(ab_monitors *monitors) {
    if (monitors == NULL) return;
    for (size_t k = 0; k < monitors->count; k++) free(monitors->items[k].selected);
    for (size_t b = 0; b < monitors->bodies; b++) {
        for (int f = 0; f < FIELDS_PER_BODY; f++) free(monitors->of_body[b].fields[f].values);
        free(monitors->of_body[b].position);
        free(monitors->of_body[b].id);
        free(monitors->of_body[b].datum);
    }
    free(monitors->items);
    free(monitors->of_body);
    free(monitors->start);
    free(monitors);
}
