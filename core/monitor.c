/* monitor.c: finds what each monitor means at the start, reads it when asked. */
#include "core/monitor.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/columns.h"

typedef enum source { OF_MOTION, OF_ENERGY, OF_CONTACT, OF_POINTS, OF_ROTATION, OF_DT } source;
typedef enum quantity { THE_COMPONENT, THE_LENGTH, THE_PRESSURE, THE_DISPLACEMENT } quantity; /* what is made of a field's components */
typedef enum gather { AT_POINT, MEAN_BY_MASS, MEAN_BY_VOLUME, LARGEST, SMALLEST, SUM } gather;

typedef struct field_values { /* one field of one body, read once a step */
    char name[64];
    int components;
    double *values;
    size_t capacity;
    long step;
    bool used;
} field_values;

enum { FIELDS_PER_BODY = 16 };

typedef struct body_points { /* what is kept of a body's start, where a monitor needs it */
    size_t count;            /* points at the start */
    double *position;        /* count x dimension */
    double *id;              /* count */
    field_values fields[FIELDS_PER_BODY];
} body_points;

typedef struct monitor {
    const ab_monitor_spec *spec;
    source source;
    gather gather;
    quantity quantity;
    size_t offset;   /* of a number in ab_motion or ab_contact_totals; of an energy the term, SIZE_MAX - 1: total, SIZE_MAX: remainder */
    bool is_size;    /* the number is a size_t */
    bool by_mass;    /* momentum / mass */
    bool from_start; /* displacement: less the value at the start */
    int component;
    const char *unit, *field;
    size_t *selected; /* points at the start, ascending; NULL: all */
    size_t selected_count;
    long step;
    double value;
} monitor;

struct ab_monitors {
    monitor *items;
    size_t count, bodies;
    int dimension;
    body_points *of_body;
    ab_motion *start;
};

/* ---- fields ---- */

static const ab_field *find_field(const ab_domain *domain, const char *name) {
    size_t count = 0;
    const ab_field *fields = domain->ops->fields(domain, &count);
    for (size_t f = 0; f < count; f++)
        if (strcmp(fields[f].name, name) == 0) return &fields[f];
    return NULL;
}

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

/* ---- finding, once ---- */

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

static bool find_points(monitor *m, const ab_domain *domain, const char *base, const char *component) {
    const ab_monitor_spec *spec = m->spec;
    m->source = OF_POINTS;
    const ab_field *field = find_field(domain, base);
    if (field == NULL && strcmp(base, "speed") == 0 && component[0] == '\0') {
        field = find_field(domain, "velocity");
        m->quantity = THE_LENGTH;
    } else if (field == NULL && strcmp(base, "pressure") == 0 && component[0] == '\0') {
        field = find_field(domain, "stress");
        m->quantity = THE_PRESSURE;
    } else if (field == NULL && strcmp(base, "displacement") == 0) {
        field = find_field(domain, "position");
        m->quantity = THE_DISPLACEMENT;
    }
    if (field == NULL) return false;
    m->field = field->name;
    m->unit = field->unit;
    if (m->quantity == THE_COMPONENT || m->quantity == THE_DISPLACEMENT) {
        m->component = field->components == 1 && component[0] == '\0' ? 0 : component_of(field->component_names, component);
        if (m->component < 0 || m->component >= field->components) return false;
    }
    const char *over = spec->over != NULL ? spec->over : strcmp(base, "mass") == 0 || strcmp(base, "volume") == 0 ? "sum" : "mass";
    m->gather = spec->has_at                  ? AT_POINT
                : strcmp(over, "mass") == 0   ? MEAN_BY_MASS
                : strcmp(over, "volume") == 0 ? MEAN_BY_VOLUME
                : strcmp(over, "max") == 0    ? LARGEST
                : strcmp(over, "min") == 0    ? SMALLEST
                                              : SUM;
    return true;
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
    if (axis >= view->domains[spec->body]->dimension) return false;
    const bool whole = !spec->has_at && !spec->has_where && (spec->over == NULL || strcmp(spec->over, "mass") == 0);
    const bool is_mass = strcmp(base, "mass") == 0; /* of a point, or its mean, where that is asked for */
    if (whole && !(is_mass && spec->over != NULL) && find_motion(m, base, axis, false)) return true;
    if (strcmp(spec->value, "rotation-rate") == 0) {
        m->source = OF_ROTATION;
        m->unit = "s-1";
        return whole;
    }
    return find_points(m, view->domains[spec->body], base, component);
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

static ab_status find(ab_monitors *monitors, monitor *m, const ab_state_view *view, ab_report *report) {
    const ab_monitor_spec *spec = m->spec;
    if (!find_value(m, view))
        return ab_report_error(report, spec->mark, "monitor '%s': there is no value '%s' of %s", spec->name, spec->value,
                               spec->contact >= 0 ? "a contact"
                               : spec->body >= 0  ? "this body, or not in this form"
                                                  : "the whole scene");
    if (m->source != OF_POINTS) return AB_OK;
    const bool all = !spec->has_at && (!spec->has_where || spec->where.all);
    if (all && m->quantity != THE_DISPLACEMENT) return AB_OK;
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

/* ---- reading ---- */

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

static double point_value(const monitor *m, const body_points *points, const double *row, size_t start, int dimension) {
    switch (m->quantity) {
    case THE_LENGTH: return dimension == 3 ? sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]) : hypot(row[0], row[1]);
    case THE_PRESSURE: return -(row[0] + row[1] + row[2]) / 3;
    case THE_DISPLACEMENT: return row[m->component] - points->position[start * (size_t)dimension + (size_t)m->component];
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

static ab_status points_value(ab_monitors *monitors, monitor *m, const ab_state_view *view, ab_report *report) {
    const size_t body = (size_t)m->spec->body;
    const body_points *points = &monitors->of_body[body];
    const ab_domain *domain = view->domains[body];
    const size_t count = domain->ops->count(domain);
    const ab_field *field = find_field(domain, m->field);
    const size_t width = (size_t)field->components;
    const double *values, *weight = NULL, *id = NULL;
    AB_TRY(read_field(monitors, body, view, m->field, field->components, &values, report));
    if (m->gather == MEAN_BY_MASS) AB_TRY(read_field(monitors, body, view, "mass", 1, &weight, report));
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
        const double q = point_value(m, points, values + p * width, start, monitors->dimension), w = weight != NULL ? weight[p] : 1;
        sum += w * q;
        sum_weight += w;
        largest = q > largest || isnan(q) ? q : largest;
        smallest = q < smallest || isnan(q) ? q : smallest;
        seen++;
    }
    m->value = seen == 0               ? (m->gather == SUM ? 0 : (double)NAN)
               : m->gather == LARGEST  ? largest
               : m->gather == SMALLEST ? smallest
               : m->gather == SUM      ? sum
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
    double inertia = 0;
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
        case OF_CONTACT: m->value = contact_value(m, view); break;
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
    }
    free(monitors->items);
    free(monitors->of_body);
    free(monitors->start);
    free(monitors);
}
