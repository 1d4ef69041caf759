/* scene_contacts.c: pairs of bodies, their algorithm and response, loads. */
#include <math.h>
#include <string.h>

#include "core/scene_reader.h"
#include "core/settings.h"

enum { MOST_CONTACTS = 10000, MOST_NAMES = 256, MOST_ENTRIES = 1000, MOST_WARNINGS = 20 };

typedef struct pairs { /* who meets whom so far: 1 + entry of `contact`; 0: nobody */
    uint32_t *entry;
    size_t bodies, now; /* now: the entry that is read */
    const ab_node *list;
} pairs;

static uint32_t *pair(pairs *all, size_t a, size_t b) { return &all->entry[(a < b ? a : b) * all->bodies + (a < b ? b : a)]; }

static const ab_loaded_class *contact_class(ab_scene_reader *r, const ab_node *node, const char *where, const char *key, uint32_t gives) {
    char path[AB_WHERE];
    const char *name = ab_scene_word(r, node, ab_where_join(path, where, key), "the name of a contact plugin");
    if (name == NULL) return NULL;
    const ab_loaded_class *found = ab_registry_find(r->registry, AB_CONTACT, name, node->mark, r->base.report);
    if (found == NULL) return NULL;
    if (!(found->class_.gives & gives)) {
        ab_report_error(
            r->base.report, node->mark, "%s: '%s' %s (`abut plugins` lists what there is)", path, name,
            gives == AB_GIVE_POINTS
                ? "gives impulses but finds no contact points; name it as response, and as algorithm one that finds, such as multi-velocity"
                : "finds contact points but gives no impulses; name it as algorithm, and as response one that does, such as coulomb");
        return NULL;
    }
    const char *space;
    if (!(found->class_.spaces & ab_scene_space(r->scene, &space)))
        ab_report_error(r->base.report, node->mark, "%s: '%s' does not work in %s", path, name, space);
    return found;
}

/* Algorithm, response and their settings. */
static void take_plugins(ab_scene_reader *r, const ab_node *node, const ab_node *const *v, const char *where, ab_contact_spec *contact) {
    if (v[CONTACT_ALGORITHM] != NULL) contact->finder = contact_class(r, v[CONTACT_ALGORITHM], where, "algorithm", AB_GIVE_POINTS);
    if (v[CONTACT_RESPONSE] != NULL) {
        contact->responder = contact_class(r, v[CONTACT_RESPONSE], where, "response", AB_GIVE_IMPULSE);
    } else if (contact->finder != NULL) {
        if (contact->finder->class_.gives & AB_GIVE_IMPULSE)
            contact->responder = contact->finder;
        else
            contact->responder = ab_registry_find(r->registry, AB_CONTACT, "coulomb", node->mark, r->base.report);
    }
    if (contact->finder == NULL || contact->responder == NULL) return;
    const char *names[MOST_NAMES];
    size_t count = ab_settings_names(&contact->finder->class_, names, 0, MOST_NAMES);
    if (contact->responder != contact->finder) count = ab_settings_names(&contact->responder->class_, names, count, MOST_NAMES);
    const bool swapped =
        (v[CONTACT_ALGORITHM] && v[CONTACT_ALGORITHM]->override_) || (v[CONTACT_RESPONSE] && v[CONTACT_RESPONSE]->override_);
    ab_section_unknown(&r->base, &ab_section_contact, names, count, swapped, node, where);
    contact->finder_settings = ab_settings_read(&r->base, &contact->finder->class_, node, where);
    contact->responder_settings = contact->responder == contact->finder
                                      ? contact->finder_settings
                                      : ab_settings_read(&r->base, &contact->responder->class_, node, where);
}

static void add_pair(ab_scene_reader *r, pairs *all, const ab_contact_spec *contact, size_t a, size_t b, ab_mark mark, const char *where) {
    ab_scene *scene = r->scene;
    uint32_t *seen = pair(all, a, b);
    if (*seen != 0) {
        const int at = all->list->items[*seen - 1]->mark.line; /* 0: written with --set */
        char line[32] = "";
        if (at > 0) snprintf(line, sizeof line, " (line %d)", at);
        ab_report_error(r->base.report, mark, "%s: bodies '%s' and '%s' meet already in contact[%u]%s; one entry a pair", where,
                        scene->bodies[a].name, scene->bodies[b].name, *seen - 1, line);
        return;
    }
    if (scene->contact_count == MOST_CONTACTS) {
        ab_report_error(r->base.report, mark, "%s: more than %d pairs of bodies", where, MOST_CONTACTS);
        return;
    }
    scene->contacts[scene->contact_count] = *contact;
    scene->contacts[scene->contact_count].body[0] = a;
    scene->contacts[scene->contact_count].body[1] = b;
    scene->contact_count++;
    *seen = (uint32_t)all->now + 1;
}

static void take_pair(ab_scene_reader *r, pairs *all, const ab_node *node, const char *where, const ab_contact_spec *contact) {
    const size_t bodies = r->scene->body_count;
    char path[AB_WHERE];
    ab_where_join(path, where, "bodies");
    if (node->kind == AB_NODE_SCALAR && strcmp(node->text, "all") == 0) {
        if (bodies < 2) ab_report_error(r->base.report, node->mark, "%s: all means every pair, but there is only one body", path);
        for (size_t a = 0; a < bodies && r->scene->contact_count < MOST_CONTACTS; a++)
            for (size_t b = a + 1; b < bodies && r->scene->contact_count < MOST_CONTACTS; b++)
                add_pair(r, all, contact, a, b, node->mark, where);
        if (bodies * (bodies - 1) / 2 > MOST_CONTACTS)
            ab_report_error(r->base.report, node->mark, "%s: more than %d pairs of bodies", path, MOST_CONTACTS);
        return;
    }
    if (node->kind != AB_NODE_LIST || node->count != 2) {
        ab_report_error(r->base.report, node->mark, "%s must be two names [a, b], or all", path);
        return;
    }
    int body[2] = {-1, -1};
    for (int i = 0; i < 2; i++) {
        const char *name = ab_scene_word(r, node->items[i], path, "two names [a, b]");
        if (name != NULL) body[i] = ab_scene_body_named(r, name, node->items[i]->mark, path);
    }
    if (body[0] < 0 || body[1] < 0) return;
    if (body[0] == body[1])
        ab_report_error(r->base.report, node->mark, "%s: body '%s' cannot be in contact with itself; split it into two bodies", path,
                        r->scene->bodies[body[0]].name);
    else
        add_pair(r, all, contact, (size_t)body[0], (size_t)body[1], node->mark, where);
}

/* Bodies that lie together without an entry are more often forgotten than meant. */
static void warn_strangers(ab_scene_reader *r, pairs *all) {
    const ab_scene *scene = r->scene;
    size_t said = 0;
    for (size_t a = 0; a < scene->body_count; a++) {
        double low[2], high[2], other_low[2], other_high[2];
        if (!ab_body_bounds(&scene->bodies[a], low, high)) continue;
        const double slack = 1e-6 * (scene->grid_cell > 0 ? scene->grid_cell : fmin(high[0] - low[0], high[1] - low[1]));
        for (size_t b = a + 1; b < scene->body_count && said < MOST_WARNINGS; b++) {
            if (*pair(all, a, b) != 0 || !ab_body_bounds(&scene->bodies[b], other_low, other_high)) continue;
            bool apart = false;
            for (int d = 0; d < 2; d++) apart = apart || low[d] > other_high[d] + slack || other_low[d] > high[d] + slack;
            if (apart) continue;
            said++;
            ab_report_warning(r->base.report, scene->bodies[b].mark,
                              "bodies '%s' and '%s' touch or overlap at the start but have no entry in contact: they do not see each other",
                              scene->bodies[a].name, scene->bodies[b].name);
        }
    }
}

void ab_scene_take_contacts(ab_scene_reader *r, const ab_node *node) {
    ab_scene *scene = r->scene;
    const size_t bodies = scene->body_count;
    size_t entries = node != NULL && node->kind == AB_NODE_LIST ? node->count : 0;
    if (entries > MOST_ENTRIES) {
        ab_report_error(r->base.report, node->mark, "contact has %zu entries, more than %d; bodies: all stands for every pair", entries,
                        MOST_ENTRIES);
        entries = 0;
    }
    size_t room = bodies * (bodies > 0 ? bodies - 1 : 0) / 2;
    if (room > MOST_CONTACTS) room = MOST_CONTACTS;
    pairs all = {ab_reader_take(&r->base, bodies * bodies, sizeof(uint32_t)), bodies, 0, node};
    scene->contacts = ab_reader_take(&r->base, room, sizeof *scene->contacts);
    if (all.entry == NULL || scene->contacts == NULL) return;
    if (node != NULL) ab_scene_is_list(r, node, "contact", "entries - {bodies: [a, b], algorithm: ...}");
    for (size_t i = 0; i < entries; i++) {
        char where[AB_WHERE];
        const ab_node *v[CONTACT_KEYS];
        snprintf(where, sizeof where, "contact[%zu]", i);
        all.now = i;
        ab_contact_spec contact = {.mark = node->items[i]->mark};
        if (!ab_section_open(&r->base, &ab_section_contact, node->items[i], where, v)) continue;
        take_plugins(r, node->items[i], v, where, &contact);
        if (v[CONTACT_BODIES] != NULL) take_pair(r, &all, v[CONTACT_BODIES], where, &contact);
    }
    if (bodies > 1) warn_strangers(r, &all);
}

/* Points carry no forces of their own, rigid bodies no tractions or pressures. */
static void check_load_method(ab_scene_reader *r, const ab_node *const *v, const char *where, const ab_load_spec *load) {
    const ab_body_spec *body = &r->scene->bodies[load->body];
    if (body->method == NULL) return;
    const ab_node *node = v[LOAD_FORCE] != NULL ? v[LOAD_FORCE] : v[LOAD_AT];
    if (load->point && strcmp(body->method, "material-points") == 0)
        ab_report_error(r->base.report, node->mark,
                        "%s: a force at one place of material points makes a hole there, not a load; spread it over part of the outline of "
                        "'%s': where: {side: top, x: [a, b]}, traction: [.., ..] (force by length)",
                        where, body->name);
    node = load->press ? v[LOAD_PRESSURE] : v[LOAD_TRACTION] != NULL ? v[LOAD_TRACTION] : v[LOAD_WHERE];
    if (!load->point && strcmp(body->method, "rigid") == 0)
        ab_report_error(r->base.report, node->mark,
                        "%s: '%s' is rigid, so only the sum of a %s would count; write that sum: at: [x, y] (its middle), force: [.., ..]",
                        where, body->name, load->press ? "pressure" : "traction");
}

/* Which kind of load it is, and whether all that belongs to it is there. False: no kind. */
static bool take_kind(ab_scene_reader *r, const ab_node *node, const ab_node *const *v, const char *where, ab_load_spec *load) {
    const bool spread = v[LOAD_WHERE] != NULL || v[LOAD_TRACTION] != NULL || v[LOAD_PRESSURE] != NULL;
    load->point = v[LOAD_AT] != NULL || v[LOAD_FORCE] != NULL;
    load->press = v[LOAD_PRESSURE] != NULL;
    if (spread == load->point) {
        ab_report_error(r->base.report, node->mark, "%s needs where and traction (or pressure), or at and force%s", where,
                        spread ? ", not of both" : "");
        return false;
    }
    if (load->press && v[LOAD_TRACTION] != NULL) {
        ab_report_error(r->base.report, v[LOAD_PRESSURE]->mark, "%s has a traction and a pressure; write one entry for each", where);
        return false;
    }
    for (int k = LOAD_WHERE; k <= LOAD_FORCE; k++) {
        const bool stands_in = k == LOAD_PRESSURE || (k == LOAD_TRACTION && load->press);
        if (v[k] == NULL && !stands_in && (k >= LOAD_AT) == load->point)
            ab_report_error(r->base.report, node->mark, "key '%s'%s is missing in %s: %s", ab_section_load.keys[k].name,
                            k == LOAD_TRACTION ? " or 'pressure'" : "", where, ab_section_load.keys[k].help);
    }
    return true;
}

static void take_load(ab_scene_reader *r, const ab_node *node, const char *where, ab_load_spec *load) {
    const ab_node *v[LOAD_KEYS];
    char path[AB_WHERE];
    bool known = false;
    load->mark = node->mark;
    if (!ab_section_open(&r->base, &ab_section_load, node, where, v)) return;
    if (v[LOAD_BODY] != NULL) {
        const char *name = ab_scene_word(r, v[LOAD_BODY], ab_where_join(path, where, "body"), "the name of a body");
        const int body = name == NULL ? -1 : ab_scene_body_named(r, name, v[LOAD_BODY]->mark, path);
        known = body >= 0;
        if (known) load->body = (size_t)body;
    }
    if (v[LOAD_WHERE] != NULL) ab_scene_take_where(r, v[LOAD_WHERE], ab_where_join(path, where, "where"), &load->where);
    const ab_key *key = ab_section_load.keys;
    ab_read_vector(&r->base, &key[LOAD_TRACTION], v[LOAD_TRACTION], where, load->traction);
    ab_read_formula(&r->base, &key[LOAD_PRESSURE], v[LOAD_PRESSURE], where, &load->pressure);
    ab_read_point(&r->base, &key[LOAD_AT], v[LOAD_AT], where, load->at);
    ab_read_vector(&r->base, &key[LOAD_FORCE], v[LOAD_FORCE], where, load->force);
    if (v[LOAD_STAGES] != NULL) load->absent = ab_scene_take_absent(r, v[LOAD_STAGES], ab_where_join(path, where, "stages"));
    if (take_kind(r, node, v, where, load) && known) check_load_method(r, v, where, load);
}

void ab_scene_take_loads(ab_scene_reader *r, const ab_node *node) {
    ab_scene *scene = r->scene;
    if (node == NULL ||
        !ab_scene_is_list(
            r, node, "loads",
            "entries - {body: ..., where: ..., traction: ...}, {body: ..., where: ..., pressure: ...} or {body: ..., at: ..., force: ...}"))
        return;
    if (node->count > MOST_ENTRIES) {
        ab_report_error(r->base.report, node->mark, "loads has %zu entries, more than %d", node->count, MOST_ENTRIES);
        return;
    }
    scene->loads = ab_reader_take(&r->base, node->count, sizeof *scene->loads);
    if (scene->loads == NULL) return;
    scene->load_count = node->count;
    for (size_t i = 0; i < node->count; i++) {
        char where[AB_WHERE];
        snprintf(where, sizeof where, "loads[%zu]", i);
        take_load(r, node->items[i], where, &scene->loads[i]);
    }
}
