/* scene_motion.c: what of a body's motion is given: nodes of a finite-element body that are held or driven (fix), the motion of a rigid body. */
#include <string.h>

#include "core/scene_reader.h"

enum { MOST_FIXES = 1000 };

/* [vx, vy] in which null leaves a direction free. False with the mistake reported. */
static bool take_velocity(ab_scene_reader *r, const ab_key *key, const ab_node *node, const char *where, bool has[2],
                          ab_number velocity[2]) {
    if (node->kind != AB_NODE_LIST || node->count != 2) {
        ab_report_error(r->base.report, node->mark, "%s.%s must be [vx, vy], null in place of a number for a direction that is free", where,
                        key->name);
        return false;
    }
    bool good = true;
    for (int d = 0; d < 2; d++) {
        if (ab_node_is_null(node->items[d])) continue;
        has[d] = ab_read_formula(&r->base, key, node->items[d], where, &velocity[d]);
        good = good && has[d];
    }
    return good;
}

void ab_scene_take_fix(ab_scene_reader *r, const ab_node *node, const char *where, ab_body_spec *body) {
    if (!ab_scene_is_list(r, node, where, "entries - {where: ..., velocity: [0, 0]}")) return;
    if (node->count > MOST_FIXES) {
        ab_report_error(r->base.report, node->mark, "%s has %zu entries, more than %d", where, node->count, MOST_FIXES);
        return;
    }
    body->fix = ab_reader_take(&r->base, node->count, sizeof *body->fix);
    if (body->fix == NULL) return;
    body->fix_count = node->count;
    for (size_t i = 0; i < node->count; i++) {
        char entry[AB_WHERE], path[AB_WHERE];
        const ab_node *v[FIX_KEYS];
        ab_fix_spec *fix = &body->fix[i];
        snprintf(entry, sizeof entry, "%.120s[%zu]", where, i);
        if (!ab_section_open(&r->base, &ab_section_fix, node->items[i], entry, v)) continue;
        if (v[FIX_WHERE] != NULL) ab_scene_take_where(r, v[FIX_WHERE], ab_where_join(path, entry, "where"), &fix->where);
        if (v[FIX_STAGES] != NULL) fix->absent = ab_scene_take_absent(r, v[FIX_STAGES], ab_where_join(path, entry, "stages"));
        if (v[FIX_VELOCITY] == NULL) continue;
        if (take_velocity(r, &ab_section_fix.keys[FIX_VELOCITY], v[FIX_VELOCITY], entry, fix->has, fix->velocity) && !fix->has[0] &&
            !fix->has[1])
            ab_report_error(r->base.report, v[FIX_VELOCITY]->mark, "%s.velocity leaves both directions free; leave the entry out", entry);
    }
}

void ab_scene_take_motion(ab_scene_reader *r, const ab_node *node, const char *where, ab_body_spec *body) {
    const ab_node *v[MOTION_KEYS];
    ab_motion_spec *motion = &body->motion;
    if (!ab_section_open(&r->base, &ab_section_motion, node, where, v)) return;
    const ab_key *key = ab_section_motion.keys;
    if (v[MOTION_VELOCITY] != NULL) take_velocity(r, &key[MOTION_VELOCITY], v[MOTION_VELOCITY], where, motion->has, motion->velocity);
    if (v[MOTION_SPIN] != NULL) motion->has_spin = ab_read_formula(&r->base, &key[MOTION_SPIN], v[MOTION_SPIN], where, &motion->spin);
    if (v[MOTION_CENTER] != NULL)
        motion->has_center = ab_read_point(&r->base, &key[MOTION_CENTER], v[MOTION_CENTER], where, motion->center);
    if (v[MOTION_MASS] != NULL) motion->has_mass = ab_read_number(&r->base, &key[MOTION_MASS], v[MOTION_MASS], where, &motion->mass);
    if (v[MOTION_INERTIA] != NULL)
        motion->has_inertia = ab_read_number(&r->base, &key[MOTION_INERTIA], v[MOTION_INERTIA], where, &motion->inertia);
}

/* A direction that is free needs a mass, a spin that is free an inertia. */
void ab_scene_check_mass(ab_scene_reader *r, const ab_body_spec *body, const char *where) {
    const ab_motion_spec *motion = &body->motion;
    if (body->material != SIZE_MAX || motion->has_mass) return;
    const bool moves = !motion->has[0] || !motion->has[1], turns = !motion->has_spin && !motion->has_inertia;
    if (!moves && !turns) return;
    ab_report_error(
        r->base.report, body->mark,
        "%s: its %s is not given and follows from forces, but its mass is not known; name a material, write motion.mass, or write "
        "motion: {velocity: [0, 0], spin: 0} for a body that stands still",
        where,
        moves && turns ? "motion"
        : moves        ? "velocity"
                       : "spin");
}
