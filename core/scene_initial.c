/* scene_initial.c: what a body begins with: K0 by its own rule or given, a stress that is written out, or the stage that gravity makes. */
#include <math.h>
#include <string.h>

#include "core/scene_reader.h"

/* A setting of the material that is a number above 0, or 0. */
static double setting(const ab_material_spec *material, const char *name) {
    const ab_class *class_ = &material->loaded->class_;
    for (uint32_t k = 0; k < class_->nparam; k++)
        if (strcmp(class_->param[k].name, name) == 0 && class_->param[k].type == AB_REAL && material->settings[k].real > 0.0 &&
            isfinite(material->settings[k].real))
            return material->settings[k].real;
    return 0.0;
}

/* The coefficient where the scene gives none: by the friction of a soil that has yielded as it was laid down, else by elasticity between sides that hold. */
static void choose_k0(ab_scene_reader *r, ab_mark mark, const char *where, ab_body_spec *body) {
    ab_initial_spec *initial = &body->initial;
    if (body->material >= r->scene->material_count) return; /* it is not there, and the report says so */
    const ab_material_spec *material = r->scene->materials + body->material;
    if (material->loaded == NULL || material->settings == NULL) return;
    const double friction = setting(material, "friction"), nu = setting(material, "nu"), M = setting(material, "M");
    if (friction > 0.0) {
        initial->k0 = 1.0 - sin(friction);
        initial->rule = "1 - sin(friction)";
    } else if (M > 0.0) { /* critical state: sin(phi) = 3M/(6 + M) in triaxial compression */
        ab_report_error(
            r->base.report, mark,
            "%s: material '%s' has no rule of its own for K0; give it: K0: %.3g would be 1 - sin(phi) with M = 6 sin(phi)/(3 - sin(phi))",
            where, material->name, 1.0 - 3.0 * M / (6.0 + M));
    } else if (nu > 0.0) {
        initial->k0 = nu / (1.0 - nu);
        initial->rule = "nu/(1 - nu)";
    } else if (setting(material, "E") > 0.0) {
        initial->k0 = 0.0;
        initial->rule = "nu/(1 - nu), nu being 0";
    } else {
        ab_report_error(r->base.report, mark, "%s: material '%s' has neither friction nor nu to find K0 from; give it: K0: 0.5, say", where,
                        material->name);
    }
}

/* [sxx, syy, szz, sxy] */
static void take_stress(ab_scene_reader *r, const ab_node *node, const char *where, ab_initial_spec *initial) {
    char path[AB_WHERE];
    ab_where_join(path, where, "stress");
    if (node->kind != AB_NODE_LIST || node->count != 4) {
        ab_report_error(r->base.report, node->mark,
                        "%s must be K0, gravity or four numbers or formulas [sxx, syy, szz, sxy], tension positive", path);
        return;
    }
    initial->kind = AB_INITIAL_STRESS;
    for (int c = 0; c < 4; c++)
        ab_read_formula(&r->base, &ab_section_initial.keys[INITIAL_STRESS], node->items[c], where, &initial->stress[c]);
}

void ab_scene_take_initial(ab_scene_reader *r, const ab_node *node, const char *where, ab_body_spec *body) {
    const ab_node *v[INITIAL_KEYS];
    const ab_key *key = ab_section_initial.keys;
    ab_initial_spec *initial = &body->initial;
    initial->mark = node->mark;
    if (!ab_section_open(&r->base, &ab_section_initial, node, where, v) || v[INITIAL_STRESS] == NULL) return;
    const ab_node *stress = v[INITIAL_STRESS];
    const bool word = stress->kind == AB_NODE_SCALAR;
    if (word && strcmp(stress->text, "K0") == 0)
        initial->kind = AB_INITIAL_K0;
    else if (word && strcmp(stress->text, "gravity") == 0)
        initial->kind = AB_INITIAL_GRAVITY;
    else
        take_stress(r, stress, where, initial);
    static const ab_initial_kind belongs[INITIAL_KEYS] = {
        [INITIAL_K0] = AB_INITIAL_K0, [INITIAL_SURCHARGE] = AB_INITIAL_K0, [INITIAL_TIME] = AB_INITIAL_GRAVITY};
    for (int k = INITIAL_K0; k < INITIAL_KEYS; k++)
        if (v[k] != NULL && initial->kind != AB_INITIAL_NONE && belongs[k] != initial->kind)
            ab_report_error(r->base.report, v[k]->mark, "%s.%s belongs to stress: %s; leave it out", where, key[k].name,
                            belongs[k] == AB_INITIAL_K0 ? "K0" : "gravity");
    ab_read_number(&r->base, &key[INITIAL_SURCHARGE], v[INITIAL_SURCHARGE], where, &initial->surcharge);
    if (v[INITIAL_TIME] != NULL) ab_read_number(&r->base, &key[INITIAL_TIME], v[INITIAL_TIME], where, &initial->time);
    if (initial->kind != AB_INITIAL_K0) return;
    if (v[INITIAL_K0] != NULL) {
        ab_read_number(&r->base, &key[INITIAL_K0], v[INITIAL_K0], where, &initial->k0);
        initial->rule = "as given";
    } else {
        choose_k0(r, node->mark, where, body);
    }
}

static bool is_zero(const ab_number *number) { return number->expression == NULL && number->value == 0.0; }

void ab_scene_check_initial(ab_scene_reader *r) {
    const ab_scene *scene = r->scene;
    const bool made = scene->stage_count > 0 && scene->stages[0].made;
    const ab_stage_spec *first = scene->stage_count > 0 ? scene->stages : NULL;
    for (size_t b = 0; b < scene->body_count; b++) {
        const ab_body_spec *body = scene->bodies + b;
        const ab_initial_spec *initial = &body->initial;
        for (size_t k = 0; k < scene->stage_count; k++)
            if (scene->stages[k].kinetic && body->update != NULL && strcmp(body->update, "usf") == 0)
                ab_report_error(r->base.report, scene->stages[k].mark,
                                "stage '%s': kinetic damping would lose the strain that body '%s' has yet to see, as update usf strains a step "
                                "behind; use update musl or usl there, or damping: {local: 0.7}",
                                scene->stages[k].name != NULL ? scene->stages[k].name : "", body->name);
        const bool stands = is_zero(&body->velocity[0]) && is_zero(&body->velocity[1]);
        if (made && !stands)
            ab_report_error(
                r->base.report, body->velocity[0].mark,
                "bodies.%s.velocity: a scene that settles under gravity first (initial: {stress: gravity}) begins at rest; leave it "
                "out, or set the stress by K0",
                body->name);
        if (initial->kind == AB_INITIAL_NONE || initial->kind == AB_INITIAL_STRESS) continue;
        const char *name = initial->kind == AB_INITIAL_K0 ? "K0" : "gravity";
        if (is_zero(&scene->gravity[0]) && is_zero(&scene->gravity[1]))
            ab_report_error(r->base.report, initial->mark, "bodies.%s.initial: stress %s is that of weight, and the scene has no gravity",
                            body->name, name);
        if (!body->gravity)
            ab_report_error(r->base.report, initial->mark,
                            "bodies.%s.initial: stress %s is that of weight, and gravity does not act on this body", body->name, name);
        if (initial->kind != AB_INITIAL_K0) continue;
        if (made)
            ab_report_error(
                r->base.report, initial->mark,
                "bodies.%s.initial: K0 here and gravity of another body exclude each other: gravity begins with none in the stage "
                "that is made; use one of them for all bodies",
                body->name);
        else if (first != NULL && first->gravity != AB_GRAVITY_KEEP)
            ab_report_error(
                r->base.report, initial->mark,
                "bodies.%s.initial: K0 is the stress under gravity, and the first stage begins without; write gravity: keep there",
                body->name);
    }
}
