/* light_dofs.c: degrees of freedom with next to no mass under points of contact. A face that has passed a line of the grid by eps of a cell leaves the nodes beyond it
 * eps^2 of a node's mass and of each push (by the basis at the material points), but eps of the stress: they fly off, as 1/eps, and their points creep after them, the slower the
 * smaller eps is, by up to what the row is strained. On shared nodes (multi_velocity) contact acts there itself; between surfaces such a dof goes with the
 * heavier ones of the points it serves, as slivers of cut elements are made part of their neighbours (Badia, Verdugo and Martin 2018): what it has of momentum beyond theirs is
 * theirs, in proportion to the same weights. Most bases have tied such nodes before it comes to contact (mpm/light_nodes.c); bspline3 and bodies about an axis have not. Momentum is kept to rounding; its moment but for that of eps of the stress, over a cell at most. */
#include <stdlib.h>
#include <string.h>

#include "contact/contact.h"

/* Of the mass of the heaviest dof of the same point: eps of 1e-3. Beyond, they find their balance within some thousand steps themselves. */
static const double LIGHT = 1e-6;

static bool reserve(contact_light *l, size_t lights, size_t dofs) {
    if (lights > l->capacity) {
        const size_t n = 2 * lights + 16;
        contact_light_dof *more = realloc(l->list, n * sizeof *more);
        if (!more) return false;
        l->list = more;
        l->capacity = n;
    }
    if (dofs <= l->dofs) return true;
    uint32_t *more = realloc(l->place, 2 * dofs * sizeof *more);
    if (!more) return false;
    memset(more + l->dofs, 0xff, (2 * dofs - l->dofs) * sizeof *more);
    l->place = more;
    l->dofs = 2 * dofs;
    return true;
}

void contact_light_destroy(contact_light *l) { free(l->list), free(l->place); }

static const double *inverse_mass(const contact_side *s, size_t e) {
    return s->dofs.inverse_mass + (size_t)s->dof[e] * s->dofs.mass_stride;
}

/* A dof that a side of the grid holds, in one direction or both, is left as it is, and carries nothing for others. */
static bool is_free(const double m[2]) { return m[0] > 0.0 && m[0] == m[1]; }

/* 1/mass of the heaviest free dof of point i; 0: none. */
static double heaviest(const contact_side *s, size_t i) {
    double least = 0.0;
    for (size_t e = s->start[i]; e < s->start[i + 1]; ++e) {
        const double *m = inverse_mass(s, e);
        if (is_free(m) && (least == 0.0 || m[0] < least)) least = m[0];
    }
    return least;
}

/* Mean velocity of the dofs of point i that are not light; or, with a push, what each of them gets of it. False: there are none. */
static bool over_heavy(const contact_side *s, size_t i, double least, const double *push, double mean[2]) {
    double all = 0.0;
    mean[0] = mean[1] = 0.0;
    for (size_t e = s->start[i]; e < s->start[i + 1]; ++e)
        if (is_free(inverse_mass(s, e)) && LIGHT * inverse_mass(s, e)[0] < least) all += s->weight[e];
    if (!(all > 0.0)) return false;
    for (size_t e = s->start[i]; e < s->start[i + 1]; ++e) {
        const double *m = inverse_mass(s, e);
        if (!is_free(m) || !(LIGHT * m[0] < least)) continue;
        double *v = s->dofs.velocity + (size_t)s->dof[e] * s->dofs.velocity_stride;
        for (size_t c = 0; c < 2; ++c) {
            if (push)
                v[c] += push[c] * (s->weight[e] / all) * m[c];
            else
                mean[c] += s->weight[e] / all * v[c];
        }
    }
    return true;
}

static bool one_side(contact_light *l, const contact_side *s) {
    const size_t count = s->points->count;
    l->count = 0;
    for (int back = 0; back < 2; ++back) { /* what they go with; then what they had goes to those */
        for (size_t i = 0; i < count; ++i) {
            const double least = heaviest(s, i);
            for (size_t e = s->start[i]; least > 0.0 && e < s->start[i + 1]; ++e) {
                const double *m = inverse_mass(s, e);
                double mean[2];
                if (!is_free(m) || LIGHT * m[0] < least || !(s->weight[e] > 0.0)) continue;
                if (back) {
                    const uint32_t place = l->place[s->dof[e]];
                    if (place == UINT32_MAX) continue;
                    const contact_light_dof *d = l->list + place;
                    const double part = s->weight[e] / d->weight, push[2] = {part * d->left[0], part * d->left[1]};
                    over_heavy(s, i, least, push, mean);
                    continue;
                }
                if (!reserve(l, l->count + 1, (size_t)s->dof[e] + 1)) return false;
                if (!over_heavy(s, i, least, NULL, mean)) continue;
                uint32_t *place = l->place + s->dof[e];
                if (*place == UINT32_MAX) {
                    *place = (uint32_t)l->count;
                    l->list[l->count++] = (contact_light_dof){.dof = s->dof[e]};
                }
                contact_light_dof *d = l->list + *place;
                d->weight += s->weight[e];
                for (size_t c = 0; c < 2; ++c) d->velocity[c] += s->weight[e] * mean[c];
            }
        }
        if (l->count == 0) return true;
        for (size_t k = 0; !back && k < l->count; ++k) {
            contact_light_dof *d = l->list + k;
            double *v = s->dofs.velocity + (size_t)d->dof * s->dofs.velocity_stride;
            const double mass = 1.0 / s->dofs.inverse_mass[(size_t)d->dof * s->dofs.mass_stride];
            for (size_t c = 0; c < 2; ++c) {
                const double wanted = d->velocity[c] / d->weight;
                d->left[c] = mass * (v[c] - wanted);
                v[c] = wanted;
            }
        }
    }
    for (size_t k = 0; k < l->count; ++k) l->place[l->list[k].dof] = UINT32_MAX;
    return true;
}

bool contact_light_dofs(contact_light *l, const contact_side side[2]) {
    for (int k = 0; k < 2; ++k)
        if (!side[k].dofs.spin && !one_side(l, side + k)) return false;
    return true;
}
