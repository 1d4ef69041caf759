/* body.c: a material-point body as the scheduler sees it: its table of functions, from creation to ledger. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "mpm/share.h"

/* How often a material whose wave speed changes is asked for it, steps. */
enum { WAVE_SPEED_EVERY = 16 };

/* A thread is worth its waking up from about this many points on. */
enum { POINTS_PER_THREAD = 4000 };

/* dt c/h at which the scheme is neutrally stable, worst over the places of points in their cells (frozen). Points that stand as they come (cvt, in a mesh) are now
 * closer, now farther apart than their number says: the least of the limits around it. */
static double stable_courant(const mpm_body *body) {
    const ab_body_spec *spec = body->domain.spec;
    if (spec->fill != AB_FILL_CVT && spec->shape.kind != AB_SHAPE_MESH)
        return body->kernel->courant[(int)fmin(ceil(sqrt(spec->per_cell)), 8.0) - 1];
    const int middle = (int)fmin(fmax(ceil(body->h * sqrt((double)body->born / body->area)), 2.0), 7.0); /* points per direction */
    return fmin(body->kernel->courant[middle - 1], fmin(body->kernel->courant[middle - 2], body->kernel->courant[middle]));
}

static void destroy(ab_domain *domain) {
    mpm_body *body = (mpm_body *)domain;
    if (body->self && body->material->loaded->class_.destroy) body->material->loaded->class_.destroy(body->self);
    ab_memory_give(body->blocks, body->block_capacity * 64 * (size_t)body->rows.count);
    ab_memory_give(body->ids, body->block_capacity * 8 * sizeof *body->ids);
    ab_memory_give(body->spare_blocks, body->spare_capacity * 64 * (size_t)body->rows.count);
    ab_memory_give(body->spare_ids, body->spare_capacity * 8 * sizeof *body->ids);
    ab_memory_give(body->tiles, body->tile_capacity * sizeof *body->tiles);
    ab_memory_give(body->keys, body->tile_capacity * sizeof *body->keys);
    ab_memory_give(body->own, body->own_capacity * sizeof(double) * OWN_RECORD * AB_TILE_NODES);
    ab_memory_give(body->filter, body->filter_capacity * sizeof(double) * FILTER_RECORD * AB_TILE_NODES);
    ab_memory_give(body->volumetric, body->volumetric_capacity * sizeof(double) * VOLUMETRIC_RECORD * AB_TILE_NODES);
    ab_memory_give(body->slivers, body->sliver_capacity * sizeof *body->slivers);
    ab_memory_give(body->sums, body->sums_capacity * sizeof *body->sums);
    ab_memory_give(body->patches, body->patch_capacity * sizeof(double) * mpm_patch_doubles(body));
    mpm_light_destroy(body);
    mpm_damp_destroy(body);
    mpm_share_destroy(body);
    mpm_trace_destroy(body->trace);
    mpm_surface_destroy(body->surface);
    mpm_outline_destroy(body->outline);
    mpm_body_force_destroy(body);
    mpm_edges_destroy(body);
    free(body->loads), free(body->slot), free(body->birth), free(body->datum), free(body->fields), free(body);
}

static double critical_dt(ab_domain *domain, const char **limit) {
    mpm_body *body = (mpm_body *)domain;
    if (body->largest_speed > body->wave_speed)
        snprintf(body->limit, sizeof body->limit, "points of '%s' at %.4g m/s, wave speed %.4g m/s, in cells of %.4g m", domain->spec->name, body->largest_speed,
                 body->wave_speed, body->h);
    else
        snprintf(body->limit, sizeof body->limit, "wave speed %.4g m/s of '%s' in cells of %.4g m", body->wave_speed, domain->spec->name, body->h);
    *limit = body->limit;
    body->last_limit = stable_courant(body) * body->h / (body->wave_speed + body->largest_speed);
    return body->last_limit;
}

static void scatter_tile(mpm_body *body, size_t k, void *unused) {
    (void)unused;
    if (body->tiles[k].patch >= 0) body->kernel->scatter[body->rows.affine >= 0](body, k);
}

static void scatter_all(mpm_body *body) { mpm_each_tile(body, scatter_tile, NULL); }

static ab_status begin(ab_domain *domain, const ab_step *step, ab_report *report) {
    mpm_body *body = (mpm_body *)domain;
    if (body->sort_due) {
        AB_TRY(mpm_points_sort(body, report));
        body->scattered = false;
    }
    if (!body->scattered) scatter_all(body);
    body->scattered = false;
    body->external_before = body->energy.external;
    AB_TRY(mpm_body_force_find(body, step, report));
    if (!mpm_strains_first(body->update)) {
        mpm_loads_scatter(body, step);
        mpm_body_force_scatter(body);
    }
    mpm_grid_assemble(body, step, !step->early && !mpm_strains_first(body->update));
    return mpm_light_tie(body, report);
}

/* Beside a body that strains first: velocities before any force, which contact has worked on, give way to the trial ones. */
static ab_status trial(ab_domain *domain, const ab_step *step, ab_report *report) {
    mpm_body *body = (mpm_body *)domain;
    if (!step->early || mpm_strains_first(body->update)) return AB_OK;
    mpm_grid_assemble(body, step, true);
    return mpm_light_tie(body, report);
}

typedef struct pass { /* what a pass over the tiles is told */
    const ab_step *step;
    bool advance, fuse, remap;
} pass;

static void stress_tile(mpm_body *body, size_t k, void *context) {
    const pass *told = context;
    if (body->tiles[k].patch < 0) return;
    body->sums[k].culprit = body->kernel->stress(body, k, told->step, told->advance, body->sums + k);
    if (told->fuse) body->kernel->scatter[body->rows.affine >= 0](body, k);
}

/* Strain and stress of every tile; with `fuse` each tile scatters at once while its points are in cache, ready for the next step. */
static ab_status stress_all(mpm_body *body, const ab_step *whole, bool advance, bool fuse, ab_report *report) {
    const bool halves = body->update == MPM_USAVG;
    ab_step part = *whole;
    const ab_step *step = &part;
    if (halves) part.dt *= 0.5;
    body->from_end = halves && !advance;
    mpm_light_follow(body);
    if (!body->from_end) {
        mpm_loads_follow(body, whole);
        mpm_edges_follow(body, whole);
        mpm_outline_follow(body, whole);
    }
    body->ask_wave_speed = (body->material->loaded->class_.gives & AB_GIVE_WAVE_SPEED) &&
                           (body->material->loaded->class_.needs & (AB_NEED_DEFORMATION_GRADIENT | AB_NEED_DENSITY)) &&
                           step->number % WAVE_SPEED_EVERY == 0;
    if (body->f_bar) mpm_volumetric_strain(body, step);
    mpm_each_tile(body, stress_tile, &(pass){.step = step, .advance = advance, .fuse = fuse});
    int first = -1; /* block of the first tile that failed, whichever thread met it */
    for (size_t k = 0; first < 0 && k < body->tile_count; ++k)
        if (body->tiles[k].patch >= 0) first = body->sums[k].culprit;
    if (first >= 0) {
        const double *x = mpm_block(body, (size_t)first);
        return ab_report_failure(
            report, "material '%s' of body '%s' gave up at t = %.9g s near (%.6g, %.6g) m (step %ld, dt %.4g s, limit %.4g s): %s; %s",
            body->material->name, body->domain.spec->name, step->time, x[8 * ROW_X] + body->origin[0], x[8 * (ROW_X + 1)] + body->origin[1],
            step->number, whole->dt, body->last_limit, body->service.message[0] ? body->service.message : "no reason given",
            whole->dt > body->last_limit ? "dt is above the limit: use a smaller one, or cfl" : "a smaller dt or a finer grid may help");
    }
    double fastest = 0.0;
    body->last_strain = 0.0;
    for (size_t k = 0; k < body->tile_count; ++k) {
        if (body->tiles[k].patch < 0) continue;
        body->last_strain += body->sums[k].strain;
        body->energy.plastic += body->sums[k].plastic;
        fastest = fmax(fastest, body->sums[k].wave_speed);
    }
    body->energy.strain += body->last_strain;
    if (body->ask_wave_speed && fastest > 0.0) body->wave_speed = fastest;
    if (body->f_bar) {
        if (advance && body->sort_due) AB_TRY(mpm_points_sort(body, report)); /* cells are those of the new places */
        mpm_volumetric_stress(body);
    }
    return AB_OK;
}

static ab_status early(ab_domain *domain, const ab_step *step, ab_report *report) {
    mpm_body *body = (mpm_body *)domain;
    AB_TRY(stress_all(body, step, false, !body->f_bar, report));
    if (body->f_bar) scatter_all(body);
    mpm_loads_scatter(body, step);
    mpm_body_force_scatter(body);
    mpm_grid_assemble(body, step, true);
    return mpm_light_tie(body, report);
}

/* A point is outside the grid: stop, naming it, or let it go where the side says outflow. */
static ab_status look_outside(mpm_body *body, const ab_step *step, ab_report *report) {
    static const char *const SIDE[AB_SIDES] = {"left", "right", "bottom", "top"};
    for (size_t slot = 0; slot < body->block_count * 8; ++slot) {
        if (body->ids[slot] == UINT64_MAX) continue;
        const double *block = mpm_block(body, slot / 8) + slot % 8;
        const double x[2] = {block[8 * ROW_NEXT], block[8 * (ROW_NEXT + 1)]}, v[2] = {block[8 * ROW_V], block[8 * (ROW_V + 1)]};
        int side = -1;
        for (int c = 0; c < 2; ++c) {
            if (!(x[c] >= 0.0)) side = 2 * c;
            if (!(x[c] <= body->span[c])) side = 2 * c + 1;
        }
        if (side < 0) continue;
        if (!isfinite(x[0]) || !isfinite(x[1]))
            return ab_report_failure(report,
                                     "body '%s': point %llu has no finite place any more at t = %.9g s (step %ld): the run has blown up; "
                                     "use a smaller dt; of bases and updates gimp and musl are the safest",
                                     body->domain.spec->name, (unsigned long long)body->ids[slot], step->time + step->dt, step->number);
        if (body->side[side] != AB_SIDE_OUTFLOW)
            return ab_report_failure(report,
                                     "body '%s': point %llu left the grid through its %s side at (%.6g, %.6g) m, velocity (%.4g, %.4g) "
                                     "m/s, t = %.9g s (step %ld); make the grid larger, "
                                     "hold that side (roller, fixed) or say 'outflow' there",
                                     body->domain.spec->name, (unsigned long long)body->ids[slot], SIDE[side], x[0] + body->origin[0],
                                     x[1] + body->origin[1], v[0], v[1], step->time + step->dt, step->number);
        double spin, inertia;
        const double carried = 0.5 * block[8 * ROW_MASS] * (v[0] * v[0] + v[1] * v[1] + mpm_affine_inner(body, slot, &spin, &inertia));
        body->energy.outflow += carried;
        body->energy.kinetic -= carried; /* which this step's sum holds still */
        body->sort_due = true;
    }
    return AB_OK;
}

/* Adds up the tiles' sums; sees to points that leave their tile's patch, or the grid. */
static ab_status close_step(mpm_body *body, const ab_step *step, ab_report *report) {
    ab_motion motion = {0};
    double kinetic = 0.0, speed2 = 0.0, low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    bool far = false;
    for (size_t k = 0; k < body->tile_count; ++k) {
        const mpm_tile *tile = body->tiles + k;
        if (tile->patch < 0) continue;
        const mpm_sums *s = body->sums + k;
        motion.mass += s->mass;
        kinetic += s->kinetic;
        motion.angular_momentum[2] += s->angular;
        motion.own_inertia += s->own_inertia;
        body->energy.potential += s->potential;
        speed2 = fmax(speed2, s->speed2);
        for (int c = 0; c < 2; ++c) {
            motion.momentum[c] += s->momentum[c];
            motion.centre[c] += s->first[c];
            low[c] = fmin(low[c], s->low[c]);
            high[c] = fmax(high[c], s->high[c]);
            const double at = (c ? tile->ty : tile->tx) * AB_TILE, first = s->begin[c] - at, last = s->end[c] - at;
            if (first < -1 || last > AB_TILE) body->sort_due = true;
            if (first < -AB_TILE || last >= 2 * AB_TILE) far = true;
        }
    }
    for (int c = 0; c < 2; ++c) motion.centre[c] = motion.mass > 0.0 ? motion.centre[c] / motion.mass + body->origin[c] : 0.0;
    motion.angular_momentum[2] += body->origin[0] * motion.momentum[1] - body->origin[1] * motion.momentum[0];
    body->motion = motion;
    body->energy.kinetic = kinetic;
    /* Forces gave half of what their work over the whole step is booked as: the rest, as large as what they gave, goes with what the stop has taken. */
    if (step->from_rest) body->energy.damping += body->energy.kinetic;
    body->largest_speed = sqrt(speed2);
    AB_TRY(mpm_too_far(body, step, false, report)); /* first: a point that was thrown is not one for which the grid is too small */
    if (!isfinite(kinetic)) AB_TRY(look_outside(body, step, report));
    if (!isfinite(kinetic))
        return ab_report_failure(report,
                                 "body '%s': the kinetic energy is no finite number any more at t = %.9g s (step %ld): the run has blown "
                                 "up; use a smaller dt; of bases and updates gimp and musl are the safest",
                                 body->domain.spec->name, step->time + step->dt, step->number);
    if (low[0] < 0.0 || low[1] < 0.0 || high[0] > body->span[0] || high[1] > body->span[1]) AB_TRY(look_outside(body, step, report));
    return far ? mpm_too_far(body, step, far, report) : AB_OK;
}

static void finish_tile(mpm_body *body, size_t k, void *context) {
    const pass *told = context;
    if (body->tiles[k].patch >= 0) body->kernel->finish[body->finish](body, k, told->step, told->remap, body->sums + k);
}

static ab_status finish(ab_domain *domain, const ab_step *step, ab_report *report) {
    mpm_body *body = (mpm_body *)domain;
    if (step->measure) mpm_measure(body, step);
    if (step->damping > 0.0) {
        mpm_light_quiet(body);
        mpm_damp(body, step);
    }
    mpm_light_settle(body);
    mpm_light_follow(body);
    mpm_filter(body);
    const bool remap = mpm_maps_back(body->update);
    if (!remap) {
        mpm_loads_work(body, step);
        mpm_body_force_work(body, step);
    }
    mpm_each_tile(body, finish_tile, &(pass){.step = step, .remap = remap});
    AB_TRY(mpm_outline_move(body, step, report));
    AB_TRY(close_step(body, step, report));
    if (body->update == MPM_USL) mpm_grid_limit_light(body);
    return AB_OK;
}

static ab_status remap(ab_domain *domain, const ab_step *step, ab_report *report) {
    (void)report;
    mpm_body *body = (mpm_body *)domain;
    mpm_grid_assemble_remap(body);
    mpm_light_remap(body);
    mpm_loads_work(body, step); /* what points gain from a nodal force is force x (mapped velocity before + after)/2, exactly */
    mpm_body_force_work(body, step);
    if (step->damping > 0.0) mpm_damp_book(body);
    return AB_OK;
}

static ab_status stress(ab_domain *domain, const ab_step *step, ab_report *report) {
    mpm_body *body = (mpm_body *)domain;
    if (body->update != MPM_USF) {
        const bool fuse = !body->sort_due && !body->f_bar;
        AB_TRY(stress_all(body, step, true, fuse, report));
        body->scattered = fuse;
        return AB_OK;
    }
    const size_t rows = 8 * (size_t)body->rows.count;
#pragma omp parallel for schedule(static) num_threads(body->threads)
    for (size_t b = 0; b < body->block_count; ++b)
        memcpy(body->blocks + b * rows + 8 * ROW_X, body->blocks + b * rows + 8 * ROW_NEXT, 16 * sizeof(double));
    return AB_OK;
}

/* Velocities and stresses are half a step apart (the scheme is a leap-frog): stresses are ahead when they are updated last and behind when they are
 * updated first. Half of the last increment brings the strain energy to the time of the kinetic one; without it their sum sways with w dt/2. USAVG has them
 * together. */
static void ledger(const ab_domain *domain, ab_energy *energy, ab_motion *motion) {
    const mpm_body *body = (const mpm_body *)domain;
    *energy = body->energy;
    if (body->update != MPM_USAVG) energy->strain += (body->update == MPM_USF ? 0.5 : -0.5) * body->last_strain;
    *motion = body->motion;
}

static void node_tiles(const ab_domain *domain, ab_node_tiles *tiles) {
    const mpm_body *body = (const mpm_body *)domain;
    *tiles = (ab_node_tiles){
        .count = body->tile_count, .key = body->keys, .mass = body->own + OWN_MASS, .stride = OWN_RECORD, .version = body->version};
}

static void dofs(const ab_domain *domain, ab_dofs *d) {
    const mpm_body *body = (const mpm_body *)domain;
    *d = (ab_dofs){.velocity = body->own + OWN_VELOCITY,
                   .velocity_old = body->own + OWN_OLD,
                   .inverse_mass = body->own + OWN_INVERSE,
                   .velocity_stride = OWN_RECORD,
                   .old_stride = OWN_RECORD,
                   .mass_stride = OWN_RECORD};
}

static double modulus(const ab_domain *domain) { return ((const mpm_body *)domain)->modulus; }

/* The updates differ in two entries: USF strains early, MUSL maps velocities back, USAVG does both, USL neither. */
#define SAME_IN_ALL                                                                                                                        \
    .method = "material-points", .destroy = destroy, .critical_dt = critical_dt, .begin = begin, .trial = trial, .finish = finish,         \
    .stress = stress, .ledger = ledger, .node_tiles = node_tiles, .trace = mpm_trace, .dofs = dofs, .count = mpm_count,                    \
    .fields = mpm_fields, .faces = mpm_faces, .surface_points = mpm_surface_points, .modulus = modulus, .edges = mpm_edges,                \
    .read = mpm_read, .plan = mpm_plan, .keep = mpm_keep, .enter = mpm_enter, .rest = mpm_rest, .datum = mpm_datum, .balance = mpm_balance
static const ab_domain_ops OPS_USL = {SAME_IN_ALL};
static const ab_domain_ops OPS_USF = {SAME_IN_ALL, .early = early};
static const ab_domain_ops OPS_MUSL = {SAME_IN_ALL, .remap = remap};
static const ab_domain_ops OPS_USAVG = {SAME_IN_ALL, .early = early, .remap = remap};

/* Energy and motion before the first step. */
static void measure(mpm_body *body) {
    for (size_t slot = 0; slot < body->block_count * 8; ++slot) {
        const double *p = mpm_block(body, slot / 8) + slot % 8;
        const double m = p[8 * ROW_MASS], x = p[8 * ROW_X] + body->origin[0], y = p[8 * (ROW_X + 1)] + body->origin[1], vx = p[8 * ROW_V],
                     vy = p[8 * (ROW_V + 1)];
        double spin, inertia;
        body->energy.kinetic += 0.5 * m * (vx * vx + vy * vy + mpm_affine_inner(body, slot, &spin, &inertia));
        body->motion.own_inertia += m * inertia;
        body->motion.mass += m;
        body->motion.momentum[0] += m * vx;
        body->motion.momentum[1] += m * vy;
        body->motion.angular_momentum[2] += m * (x * vy - y * vx + spin);
        body->motion.centre[0] += m * x;
        body->motion.centre[1] += m * y;
        body->largest_speed = fmax(body->largest_speed, hypot(vx, vy));
    }
    for (int c = 0; c < 2; ++c) body->motion.centre[c] /= body->motion.mass;
}

/* Displacements need the places of the start: only where something asks for them. */
static bool wants_birth(const mpm_body *body) {
    const ab_scene *scene = body->scene;
    const ab_body_spec *spec = body->domain.spec;
    if (spec->has_force && ((ab_number_variables(spec->force) | ab_number_variables(spec->force + 1)) & AB_VARIABLES_START)) return true;
    for (size_t f = 0; f < scene->output_field_count; ++f)
        if (!strcmp(scene->output_fields[f], "displacement")) return true;
    for (size_t m = 0; m < scene->monitor_count; ++m)
        if (scene->monitors[m].body == (int)body->domain.index && !strncmp(scene->monitors[m].value, "displacement", 12)) return true;
    return false;
}

/* What is read from a file is not known to lie in the grid before. */
static ab_status check_inside(const mpm_body *body, const ab_fill *fill, ab_report *report) {
    const double slack = 1e-9 * body->h, *low = fill->low, *high = fill->high;
    bool inside = true;
    for (int c = 0; c < 2; ++c) inside = inside && low[c] >= body->origin[c] - slack && high[c] <= body->origin[c] + body->span[c] + slack;
    if (inside) return AB_OK;
    return ab_report_error(
        report, body->domain.spec->shape.mark,
        "body '%s' lies partly outside the grid: its mesh reaches from [%.10g, %.10g] to [%.10g, %.10g] m; make the grid larger or "
        "move the mesh",
        body->domain.spec->name, low[0], low[1], high[0], high[1]);
}

ab_status mpm_create(const ab_scene *scene, size_t index, int threads, ab_domain **domain, ab_report *report) {
    return mpm_create_in(scene, index, NULL, threads, domain, report);
}

ab_status mpm_create_in(const ab_scene *scene, size_t index, const ab_mesh *mesh, int threads, ab_domain **domain, ab_report *report) {
    const ab_body_spec *spec = scene->bodies + index;
    mpm_body *body = calloc(1, sizeof *body);
    if (!body) return ab_report_failure(report, "no memory for body '%s'", spec->name);
    body->kernel = mpm_kernel_of(spec->basis, scene->space);
    body->axisymmetric = scene->space == AB_SPACE_AXISYMMETRIC;
    static const char *const UPDATES[] = {[MPM_USF] = "usf", [MPM_USL] = "usl", [MPM_MUSL] = "musl", [MPM_USAVG] = "usavg"};
    static const ab_domain_ops *const OPS[] = {
        [MPM_USF] = &OPS_USF, [MPM_USL] = &OPS_USL, [MPM_MUSL] = &OPS_MUSL, [MPM_USAVG] = &OPS_USAVG};
    body->update = MPM_MUSL;
    for (mpm_update u = MPM_USF; u <= MPM_USAVG; ++u)
        if (!strcmp(spec->update, UPDATES[u])) body->update = u;
    body->domain = (ab_domain){.ops = OPS[body->update], .spec = spec, .dimension = 2, .index = index};
    body->scene = scene;
    memcpy(body->side, scene->side, sizeof body->side);
    mpm_transfer_choose(body);
    body->contiguous = spec->contiguous;
    body->f_bar = spec->f_bar;
    body->gravity = spec->gravity;
    body->threads = threads;
    body->h = scene->grid_cell;
    body->inverse_h = 1.0 / body->h;
    for (int c = 0; c < 2; ++c) {
        body->origin[c] = scene->grid_from[c];
        body->span[c] = scene->grid_cells[c] * body->h;
    }
    body->material = scene->materials + spec->material;
    if (body->f_bar && !body->kernel->dilate) {
        free(body);
        return ab_report_error(report, spec->mark, "bodies.%s.f_bar: basis %s does not take it; use another basis, or leave f_bar out",
                               spec->name, spec->basis);
    }
    mpm_rows_plan(body);
    ab_fill *fill = NULL;
    const ab_fill_request request = {.rule = spec->fill,
                                     .per_cell = spec->per_cell,
                                     .cell = body->h,
                                     .points = (size_t)spec->points,
                                     .seed = (uint64_t)spec->seed,
                                     .tolerance = spec->fill_tolerance,
                                     .iterations = (int)spec->fill_rounds,
                                     .threads = threads,
                                     .mesh = mesh};
    ab_status status = ab_fill_make(&spec->shape, &request, spec->name, &fill, report);
    if (status == AB_OK && mesh) status = check_inside(body, fill, report);
    if (status == AB_OK) status = mpm_points_insert(body, fill, report);
    if (status == AB_OK) mpm_affine_start(body, fill);
    const size_t busy = 1 + body->points / POINTS_PER_THREAD; /* small bodies are slower on many threads; the answer is the same */
    if ((size_t)body->threads > busy) body->threads = (int)busy;
    if (status == AB_OK) status = mpm_material_start(body, fill, report);
    if (status == AB_OK) status = mpm_loads_create(body, fill, report);
    if (status == AB_OK) status = mpm_edges_create(body, fill, report);
    if (status == AB_OK) status = mpm_outline_create(body, fill, report);
    if (status == AB_OK && wants_birth(body)) {
        body->birth = malloc(2 * fill->count * sizeof *body->birth);
        if (!body->birth) status = ab_report_failure(report, "no memory for the initial places of body '%s'", spec->name);
        for (size_t p = 0; body->birth && p < fill->count; ++p)
            body->birth[2 * p] = fill->x[p] - body->origin[0], body->birth[2 * p + 1] = fill->y[p] - body->origin[1];
    }
    if (status == AB_OK) status = mpm_fields_create(body, report);
    ab_fill_destroy(fill);
    if (status != AB_OK) {
        destroy(&body->domain);
        return status;
    }
    measure(body);
    *domain = &body->domain;
    return AB_OK;
}
