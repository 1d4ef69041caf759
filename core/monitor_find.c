/* monitor_find.c: finds at the start what each monitor means: a number of the body's motion or energy, of a contact, or a field of points. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/columns.h"
#include "core/monitor_inner.h"
#include "core/vocabulary.h"

const ab_field *ab_monitor_field(const ab_domain *domain, const char *name) {
    size_t count = 0;
    const ab_field *fields = domain->ops->fields(domain, &count);
    for (size_t f = 0; f < count; f++)
        if (strcmp(fields[f].name, name) == 0) return &fields[f];
    return NULL;
}

static ab_status keep_start(ab_monitors *monitors, size_t body, const ab_state_view *view, ab_report *report) {
    body_points *points = &monitors->of_body[body];
    if (points->position != NULL) return AB_OK;
    const ab_domain *domain = view->domains[body];
    points->count = domain->ops->count(domain);
    points->position = malloc((points->count + 1) * (size_t)domain->dimension * sizeof *points->position);
    points->id = malloc((points->count + 1) * sizeof *points->id);
    if (points->position == NULL || points->id == NULL)
        return ab_report_failure(report, "no memory for monitors of %zu points", points->count);
    AB_TRY(domain->ops->read(domain, "position", points->position, report));
    return domain->ops->read(domain, "id", points->id, report);
}

static int component_of(const char *names, const char *wanted) { /* place of a word in "xx yy zz xy"; -1 */
    int place = 0;
    for (const char *word = names; word != NULL && *word != '\0'; place++) {
        const size_t length = strcspn(word, " ");
        if (strlen(wanted) == length && strncmp(word, wanted, length) == 0) return place;
        word += length;
        word += strspn(word, " ");
    }
    return -1;
}

static bool energy_offset(const char *term, size_t *offset) {
    if (strcmp(term, "total") == 0)
        *offset = SIZE_MAX - 1;
    else if (strcmp(term, "remainder") == 0)
        *offset = SIZE_MAX;
    else {
        for (size_t t = 0; t < AB_TERMS; t++) {
            if (strcmp(ab_term_name(t), term) != 0) continue;
            *offset = t;
            return true;
        }
        return false;
    }
    return true;
}

static bool find_motion(monitor *m, const char *base, int axis, bool scene) {
    const size_t step = axis >= 0 ? (size_t)axis * sizeof(double) : 0;
    m->source = OF_MOTION;
    if (strcmp(base, "momentum") == 0 && axis >= 0) {
        m->offset = offsetof(ab_motion, momentum) + step;
        m->unit = "kg m s-1";
    } else if (strcmp(base, "angular-momentum") == 0 && axis < 0) {
        m->offset = offsetof(ab_motion, angular_momentum) + 2 * sizeof(double);
        m->unit = "kg m2 s-1";
    } else if (strcmp(base, "mass") == 0 && axis < 0) {
        m->offset = offsetof(ab_motion, mass);
        m->unit = "kg";
    } else if (scene || axis < 0) {
        return false;
    } else if (strcmp(base, "position") == 0 || strcmp(base, "displacement") == 0) {
        m->offset = offsetof(ab_motion, centre) + step;
        m->from_start = base[0] == 'd';
        m->unit = "m";
    } else if (strcmp(base, "velocity") == 0) {
        m->offset = offsetof(ab_motion, momentum) + step;
        m->by_mass = true;
        m->unit = "m s-1";
    } else {
        return false;
    }
    return true;
}

static bool find_contact(monitor *m, const char *base, int axis) {
    static const struct {
        const char *name, *unit;
        size_t offset;
        bool vector, size;
    } known[] = {
        {"force", "N", offsetof(ab_contact_totals, force), true, false},
        {"impulse", "N s", offsetof(ab_contact_totals, impulse), true, false},
        {"moment", "N m", offsetof(ab_contact_totals, moment), false, false},
        {"normal-force", "N", offsetof(ab_contact_totals, normal_force), false, false},
        {"friction-force", "N", offsetof(ab_contact_totals, friction_force), false, false},
        {"points", "1", offsetof(ab_contact_totals, points), false, true},
        {"active", "1", offsetof(ab_contact_totals, active), false, true},
        {"pressure.max", "Pa", offsetof(ab_contact_totals, peak_pressure), false, false},
        {"length", "m", offsetof(ab_contact_totals, area), false, false},
        {"penetration", "m", offsetof(ab_contact_totals, penetration), false, false},
        {"work.friction", "J", offsetof(ab_contact_totals, friction_work), false, false},
        {"work.contact", "J", offsetof(ab_contact_totals, contact_work), false, false},
    };
    m->source = OF_CONTACT;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        const char *name = known[k].vector ? base : m->spec->value;
        if (strcmp(known[k].name, name) != 0 || known[k].vector != (axis >= 0)) continue;
        m->offset = known[k].offset + (known[k].vector ? (size_t)axis * sizeof(double) : 0);
        m->unit = known[k].unit;
        m->is_size = known[k].size;
        return true;
    }
    return false;
}

static bool find_boundary(monitor *m) {
    static const struct {
        const char *name, *unit;
        size_t offset;
    } known[] = {
        {"force.x", "N", offsetof(ab_boundary_totals, force)},
        {"force.y", "N", offsetof(ab_boundary_totals, force) + sizeof(double)},
        {"moment", "N m", offsetof(ab_boundary_totals, moment)},
        {"impulse.x", "N s", offsetof(ab_boundary_totals, impulse)},
        {"impulse.y", "N s", offsetof(ab_boundary_totals, impulse) + sizeof(double)},
        {"work", "J", offsetof(ab_boundary_totals, work)},
        {"work.dashpot", "J", offsetof(ab_boundary_totals, dashpot)},
        {"work.spring", "J", offsetof(ab_boundary_totals, spring)},
        {"work.other", "J", offsetof(ab_boundary_totals, other)},
        {"length", "m", offsetof(ab_boundary_totals, area)},
    };
    m->source = OF_BOUNDARY;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        if (strcmp(known[k].name, m->spec->value) != 0) continue;
        m->offset = known[k].offset;
        m->unit = known[k].unit;
        return true;
    }
    return false;
}

static bool find_points(monitor *m, const ab_domain *domain, const char *base, const char *component) {
    const ab_monitor_spec *spec = m->spec;
    m->source = OF_POINTS;
    const ab_field *field = ab_monitor_field(domain, base);
    if (field == NULL && strcmp(base, "speed") == 0 && component[0] == '\0') {
        field = ab_monitor_field(domain, "velocity");
        m->quantity = THE_LENGTH;
    } else if (field == NULL && strcmp(base, "pressure") == 0 && component[0] == '\0') {
        field = ab_monitor_field(domain, "stress");
        m->quantity = THE_PRESSURE;
    } else if (field == NULL && strcmp(base, "displacement") == 0) {
        field = ab_monitor_field(domain, "position");
        m->quantity = THE_DISPLACEMENT;
    }
    if (field == NULL) return false;
    m->field = field->name;
    m->unit = field->unit;
    if (m->quantity == THE_COMPONENT || m->quantity == THE_DISPLACEMENT) {
        m->component = field->components == 1 && component[0] == '\0'
                           ? 0
                           : component_of(ab_component_names(field->component_names, field->components), component);
        if (m->component < 0 || m->component >= field->components) return false;
    }
    const char *over = spec->over != NULL ? spec->over : strcmp(base, "mass") == 0 || strcmp(base, "volume") == 0 ? "sum" : "mass";
    m->gather = spec->has_at                  ? AT_POINT
                : strcmp(over, "mass") == 0   ? MEAN_BY_MASS
                : strcmp(over, "volume") == 0 ? MEAN_BY_VOLUME
                : strcmp(over, "max") == 0    ? LARGEST
                : strcmp(over, "min") == 0    ? SMALLEST
                : strcmp(over, "rms") == 0    ? MEAN_SQUARE
                                              : SUM;
    return true;
}

/* force.x, force.y and moment of all contacts of a body; reaction.x, reaction.y, reaction.moment. */
static bool find_force(monitor *m, const ab_domain *domain, const char *base, const char *component, int axis) {
    const bool contact = strcmp(base, "force") == 0 || strcmp(m->spec->value, "moment") == 0;
    const bool moment = strcmp(m->spec->value, "moment") == 0 || strcmp(component, "moment") == 0;
    m->source = contact ? OF_ALL_CONTACTS : OF_REACTION;
    m->component = moment ? 2 : axis;
    m->unit = moment ? "N m" : "N";
    return (contact || domain->ops->reaction != NULL) && m->component >= 0;
}

/* A field that is the same number all over the body. */
static bool find_common(monitor *m, const ab_domain *domain, const char *unit) {
    const ab_field *field = ab_monitor_field(domain, m->spec->value);
    if (field == NULL || field->components != 1 || domain->ops->count(domain) == 0) return false;
    m->source = OF_POINTS;
    m->field = field->name;
    m->unit = unit;
    m->component = 0;
    m->gather = AT_POINT;
    m->selected = calloc(1, sizeof *m->selected); /* the first point there is */
    m->selected_count = 1;
    return m->selected != NULL;
}

static bool find_value(monitor *m, const ab_state_view *view) {
    const ab_monitor_spec *spec = m->spec;
    char base[128];
    snprintf(base, sizeof base, "%s", spec->value);
    char *dot = strrchr(base, '.');
    const char *component = "";
    if (dot != NULL) {
        *dot = '\0';
        component = dot + 1;
    }
    const int axis = component[0] >= 'x' && component[0] <= 'z' && component[1] == '\0' ? component[0] - 'x' : -1;
    if (spec->of_boundary) return find_boundary(m);
    if (dot != NULL && strcmp(base, "energy") == 0 && spec->contact < 0) {
        m->source = OF_ENERGY;
        m->unit = "J";
        return energy_offset(component, &m->offset);
    }
    if (spec->contact >= 0) return find_contact(m, base, axis);
    if (spec->body < 0) {
        m->source = OF_DT;
        m->unit = "s";
        return strcmp(spec->value, "dt") == 0 || (axis < (int)view->scene->dimension && find_motion(m, base, axis, true));
    }
    const ab_domain *domain = view->domains[spec->body];
    if (axis >= domain->dimension) return false;
    const bool whole = !spec->has_at && !spec->has_where && !spec->has_minus && (spec->over == NULL || strcmp(spec->over, "mass") == 0);
    const bool is_mass = strcmp(base, "mass") == 0; /* of a point, or its mean, where that is asked for */
    if (whole && !(is_mass && spec->over != NULL) && find_motion(m, base, axis, false)) return true;
    if (strcmp(base, "force") == 0 || strcmp(spec->value, "moment") == 0 || strcmp(base, "reaction") == 0)
        return whole && find_force(m, domain, base, component, axis);
    if (strcmp(spec->value, "rotation") == 0) return whole && find_common(m, domain, "rad");
    if (strcmp(spec->value, "rotation-rate") == 0) {
        if (whole && find_common(m, domain, "s-1")) return true;
        m->source = OF_ROTATION;
        m->unit = "s-1";
        return whole;
    }
    return find_points(m, domain, base, component);
}

static void find_nearest(monitor *m, const body_points *points, int dimension) {
    double best = INFINITY;
    for (size_t p = 0; p < points->count; p++) {
        const double dx = points->position[p * (size_t)dimension] - m->spec->at[0],
                     dy = points->position[p * (size_t)dimension + 1] - m->spec->at[1];
        const double distance = dx * dx + dy * dy;
        if (distance < best) {
            best = distance;
            m->selected[0] = p;
        }
    }
    m->selected_count = points->count > 0 ? 1 : 0;
}

/* Points of a set of places. A side, and a single value of x or y, mean the layer of points nearest to it. */
static void find_where(monitor *m, const body_points *points, int dimension) {
    const ab_where *where = &m->spec->where;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, nearest[2] = {INFINITY, INFINITY};
    for (size_t p = 0; p < points->count; p++)
        for (int c = 0; c < 2; c++) {
            const double x = points->position[p * (size_t)dimension + (size_t)c];
            low[c] = fmin(low[c], x);
            high[c] = fmax(high[c], x);
            if (where->has[c]) nearest[c] = fmin(nearest[c], fabs(x - where->range[c][0]));
        }
    for (size_t p = 0; p < points->count; p++) {
        const double *x = points->position + p * (size_t)dimension;
        bool in = true;
        for (int c = 0; c < 2; c++) {
            const double slack = 1e-6 * (high[c] - low[c]);
            if (where->has[c] && where->range[c][0] == where->range[c][1])
                in = in && fabs(x[c] - where->range[c][0]) <= nearest[c] + slack;
            else if (where->has[c])
                in = in && x[c] >= where->range[c][0] && x[c] <= where->range[c][1];
            if (where->side >= 0 && where->side / 2 == c)
                in = in && (where->side % 2 == 0 ? x[c] <= low[c] + slack : x[c] >= high[c] - slack);
        }
        if (in) m->selected[m->selected_count++] = p;
    }
}

static bool is_in_contact(const ab_scene *scene, size_t body) {
    for (size_t k = 0; k < scene->contact_count; k++)
        if (scene->contacts[k].body[0] == body || scene->contacts[k].body[1] == body) return true;
    return false;
}

/* A value that cannot be: why, where more can be said than that. */
static ab_status complain(const ab_monitor_spec *spec, const ab_state_view *view, ab_report *report) {
    const ab_domain *domain = spec->body >= 0 ? view->domains[spec->body] : NULL;
    if (domain != NULL && strncmp(spec->value, "reaction.", 9) == 0 && domain->ops->reaction == NULL)
        return ab_report_error(
            report, spec->mark,
            "monitor '%s': body '%s' is of %s and has no reaction: nodes of it cannot be fixed, nor its motion prescribed; what "
            "sides of the grid take from it is in energy.boundary",
            spec->name, domain->spec->name, domain->ops->method);
    if (domain != NULL && strcmp(spec->value, "rotation") == 0)
        return ab_report_error(report, spec->mark,
                               "monitor '%s': body '%s' is of %s and has no one angle; rotation-rate is a value of every body", spec->name,
                               domain->spec->name, domain->ops->method);
    return ab_report_error(report, spec->mark, "monitor '%s': there is no value '%s' of %s", spec->name, spec->value,
                           spec->contact >= 0  ? "a contact"
                           : spec->of_boundary ? "a boundary"
                           : spec->body >= 0   ? "this body, or not in this form"
                                               : "the whole scene");
}

static ab_status find(ab_monitors *monitors, monitor *m, const ab_state_view *view, ab_report *report) {
    const ab_monitor_spec *spec = m->spec;
    if (!find_value(m, view)) return complain(spec, view, report);
    if (m->source == OF_ALL_CONTACTS && !is_in_contact(view->scene, (size_t)spec->body))
        return ab_report_error(report, spec->mark, "monitor '%s': body '%s' is in no contact, so none has a force on it", spec->name,
                               view->scene->bodies[spec->body].name);
    if (m->selected != NULL) return AB_OK; /* found already */
    if (m->source != OF_POINTS) return AB_OK;
    const bool all = !spec->has_at && (!spec->has_where || spec->where.all);
    if (all && m->quantity != THE_DISPLACEMENT && !spec->has_minus) return AB_OK;
    body_points *points = &monitors->of_body[spec->body];
    AB_TRY(keep_start(monitors, (size_t)spec->body, view, report));
    if (all) return AB_OK;
    m->selected = malloc((points->count + 1) * sizeof *m->selected);
    if (m->selected == NULL) return ab_report_failure(report, "no memory for monitor '%s'", spec->name);
    if (spec->has_at)
        find_nearest(m, points, monitors->dimension);
    else
        find_where(m, points, monitors->dimension);
    if (m->selected_count == 0)
        return ab_report_error(report, spec->mark, "monitor '%s': no point of body '%s' lies there at the start", spec->name,
                               view->scene->bodies[spec->body].name);
    return AB_OK;
}

ab_status ab_monitors_create(const ab_state_view *start, ab_monitors **result, ab_report *report) {
    const ab_scene *scene = start->scene;
    ab_monitors *monitors = calloc(1, sizeof *monitors);
    *result = monitors;
    if (monitors == NULL) return ab_report_failure(report, "no memory for monitors");
    monitors->dimension = scene->dimension;
    monitors->items = calloc(scene->monitor_count + 1, sizeof *monitors->items);
    monitors->of_body = calloc(scene->body_count + 1, sizeof *monitors->of_body);
    monitors->start = calloc(scene->body_count + 1, sizeof *monitors->start);
    if (!monitors->items || !monitors->of_body || !monitors->start) return ab_report_failure(report, "no memory for monitors");
    monitors->bodies = scene->body_count;
    monitors->count = scene->monitor_count;
    for (size_t b = 0; b < scene->body_count; b++) monitors->start[b] = start->motion[b];
    ab_status status = AB_OK;
    for (size_t k = 0; k < scene->monitor_count; k++) {
        monitors->items[k] = (monitor){.spec = &scene->monitors[k], .step = -1, .component = -1};
        const ab_status one = find(monitors, &monitors->items[k], start, report);
        if (one != AB_OK) status = one;
    }
    return status;
}
