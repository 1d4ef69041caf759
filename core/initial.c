/* initial.c: the stress that a body begins with.
 *
 * K0: with the depth d of the body above a place, along gravity, the stress along gravity is -(density g d + surcharge) and K0 times that in all directions across
 * (the procedure named after it in geotechnical programs; K0 = 1 - sin(phi): Jaky 1944). The depth is the length of the ray upwards that lies in the body, summed over
 * the edges of the outline that it crosses: what is above a cave or an overhang counts, the air between does not. It is in equilibrium where surface and layers lie
 * across gravity; under a slope it is not, as it has no shear. */
#include "core/initial.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct ab_initial {
    const ab_scene *scene;
    const ab_body_spec *spec;
    double up[2], weight; /* unit, against gravity; N/m3 */
    double (*edge)[4];    /* across and along: from (u, s) to (u, s), u along the right-hand normal of up */
    size_t count;
    /* edges by where they are across: those of bin k are list[first[k]] .. */
    double low, width;
    size_t bins, *first, *list;
};

static void turn(const double up[2], const double x[2], double *u, double *s) {
    *u = x[0] * up[1] - x[1] * up[0];
    *s = x[0] * up[0] + x[1] * up[1];
}

static size_t bin_of(const ab_initial *in, double u) {
    const double k = floor((u - in->low) / in->width);
    return k > 0.0 ? (k < (double)in->bins ? (size_t)k : in->bins - 1) : 0;
}

/* Lists, for each bin, the edges that reach into it. False: no memory. */
static bool sort_edges(ab_initial *in) {
    double high = -INFINITY;
    in->low = INFINITY;
    for (size_t e = 0; e < in->count; e++)
        for (int end = 0; end < 4; end += 2) in->low = fmin(in->low, in->edge[e][end]), high = fmax(high, in->edge[e][end]);
    in->bins = in->count > 0 ? in->count : 1;
    in->width = high > in->low ? (high - in->low) / (double)in->bins : 1.0;
    in->first = calloc(in->bins + 2, sizeof *in->first);
    if (!in->first) return false;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t e = 0; e < in->count; e++) {
            const double a = in->edge[e][0], b = in->edge[e][2];
            if (a == b) continue; /* along the rays */
            for (size_t k = bin_of(in, fmin(a, b)); k <= bin_of(in, fmax(a, b)); k++)
                if (pass)
                    in->list[in->first[k + 1]++] = e;
                else
                    in->first[k + 2]++;
        }
        if (pass) break;
        for (size_t k = 2; k < in->bins + 2; k++) in->first[k] += in->first[k - 1];
        in->list = malloc((in->first[in->bins + 1] + 1) * sizeof *in->list);
        if (!in->list) return false;
    }
    return true;
}

ab_status ab_initial_open(const ab_scene *scene, size_t body, const double (*edges)[4], size_t count, ab_initial **initial,
                          ab_report *report) {
    const ab_body_spec *spec = scene->bodies + body;
    *initial = NULL;
    if (spec->initial.kind != AB_INITIAL_K0 && spec->initial.kind != AB_INITIAL_STRESS) return AB_OK;
    ab_initial *in = calloc(1, sizeof *in);
    if (!in) return ab_report_failure(report, "body '%s': no memory for its initial stress", spec->name);
    in->scene = scene;
    in->spec = spec;
    *initial = in;
    if (spec->initial.kind == AB_INITIAL_STRESS) return AB_OK;
    double g[2];
    for (int c = 0; c < 2; c++) g[c] = ab_number_at(scene->gravity + c, 0.0, 0.0, 0.0, 0.0);
    const double size = hypot(g[0], g[1]);
    if (!(size > 0.0) || !isfinite(size)) {
        ab_initial_close(in);
        *initial = NULL;
        return ab_report_error(report, spec->initial.mark,
                               "bodies.%s.initial: K0 is the stress of weight, and gravity at t = 0 is (%g, %g) m/s2", spec->name, g[0],
                               g[1]);
    }
    for (int c = 0; c < 2; c++) in->up[c] = -g[c] / size;
    in->weight = scene->materials[spec->material].density * size;
    in->edge = malloc((count + 1) * sizeof *in->edge);
    in->count = count;
    for (size_t e = 0; in->edge && e < count; e++) {
        turn(in->up, edges[e], &in->edge[e][0], &in->edge[e][1]);
        turn(in->up, edges[e] + 2, &in->edge[e][2], &in->edge[e][3]);
    }
    if (in->edge && sort_edges(in)) return AB_OK;
    ab_initial_close(in);
    *initial = NULL;
    return ab_report_failure(report, "body '%s': no memory for its initial stress", spec->name);
}

void ab_initial_close(ab_initial *in) {
    if (!in) return;
    free(in->edge), free(in->first), free(in->list), free(in);
}

/* Length of the ray upwards from (u, s) inside the body. False: it runs through a gap between two edges, or along a side: look a little beside it. */
static bool ray(const ab_initial *in, double u, double s, double *length) {
    double sum = 0.0;
    int crossings = 0; /* out less in: 1 from inside */
    const size_t k = bin_of(in, u);
    for (size_t n = in->first[k]; n < in->first[k + 1]; n++) {
        const double *e = in->edge[in->list[n]];
        if ((u < e[0]) == (u < e[2])) continue;
        const double at = e[1] + (e[3] - e[1]) * (u - e[0]) / (e[2] - e[0]) - s;
        if (!(at > 0.0)) continue;
        const int out = e[2] < e[0] ? 1 : -1; /* the body on the left: below an edge that runs back */
        sum += out * at;
        crossings += out;
    }
    *length = sum;
    return crossings == 1;
}

double ab_initial_above(const ab_initial *in, const double place[2]) {
    double u, s, length = 0.0;
    turn(in->up, place, &u, &s);
    if (ray(in, u, s, &length)) return length;
    for (double beside = 1e-9; beside < 1.0; beside *= 4.0)
        for (int sign = -1; sign <= 1; sign += 2)
            if (ray(in, u + sign * beside * in->width, s, &length)) return length;
    return 0.0; /* on or above the outline by rounding */
}

/* Rows of eight: xx, yy, zz, xy. */
static ab_status stress_at(const ab_initial *in, const double place[2][8], double stress[4][8], ab_report *report) {
    static const char *const NAME[4] = {"xx", "yy", "zz", "xy"};
    const ab_initial_spec *spec = &in->spec->initial;
    for (int l = 0; l < 8; l++) {
        const double x[2] = {place[0][l], place[1][l]};
        if (spec->kind == AB_INITIAL_STRESS) {
            for (int c = 0; c < 4; c++) {
                stress[c][l] = ab_number_at(spec->stress + c, 0.0, x[0], x[1], 0.0);
                AB_TRY(ab_number_finite(spec->stress + c, stress[c][l], 0.0, x, report, "bodies.%s.initial.stress s%s", in->spec->name,
                                        NAME[c]));
            }
            continue;
        }
        const double along = -(in->weight * ab_initial_above(in, x) + spec->surcharge), across = spec->k0 * along, *up = in->up;
        stress[0][l] = across + (along - across) * up[0] * up[0];
        stress[1][l] = across + (along - across) * up[1] * up[1];
        stress[2][l] = across;
        stress[3][l] = (along - across) * up[0] * up[1];
    }
    return AB_OK;
}

static const double SAME = 1e-7; /* of the stress: rounding of a return to a yield surface is below */

ab_status ab_initial_eight(const ab_initial *in, const ab_material_spec *material, ab_service *service, void *self,
                           const double place[2][8], ab_material_start *start, ab_report *report) {
    const ab_body_spec *spec = in->spec;
    double borne[4][8], stress[4][8];
    AB_TRY(stress_at(in, place, stress, report));
    int lane = -1;
    const char *why = service->message;
    const int code = ab_material_start_from(material, self, stress, start, borne);
    for (int l = 7; l >= 0; l--) {
        double size = 0.0, off = 0.0;
        for (int c = 0; c < 4; c++) size = fmax(size, fabs(stress[c][l])), off = fmax(off, fabs(borne[c][l] - stress[c][l]));
        if (!(off <= SAME * size)) lane = l;
    }
    if (code == 0 && lane < 0) return AB_OK;
    if (code != 0 && lane < 0) lane = 0;
    char text[700];
    snprintf(
        text, sizeof text,
        "bodies.%s.initial: material '%s' (%s) does not bear the stress (%.4g, %.4g, %.4g, %.4g) Pa (xx, yy, zz, xy) at (%.6g, %.6g) m: ",
        spec->name, material->name, material->loaded->class_.name, stress[0][lane], stress[1][lane], stress[2][lane], stress[3][lane],
        place[0][lane], place[1][lane]);
    if (code != 0) return ab_report_error(report, spec->initial.mark, "%s%s", text, why[0] ? why : "it gave no reason");
    if (material->loaded->class_.needs & AB_NEED_DEFORMATION_GRADIENT)
        return ab_report_error(report, spec->initial.mark,
                               "%sit knows its stress from its deformation, and there is none at the start; use a material in rates "
                               "(linear-elastic, soils), or stress: gravity",
                               text);
    return ab_report_error(
        report, spec->initial.mark,
        "%sof that it would keep (%.4g, %.4g, %.4g, %.4g) Pa; use another K0 (with friction phi between tan(45 - phi/2)^2 and its "
        "inverse), more strength, or stress: gravity, under which it yields where it must",
        text, borne[0][lane], borne[1][lane], borne[2][lane], borne[3][lane]);
}
