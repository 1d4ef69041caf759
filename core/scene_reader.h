/* scene_reader.h: what the files that read a scene share; nobody else includes it. */
#ifndef AB_SCENE_READER_H
#define AB_SCENE_READER_H

#include "core/scene.h"
#include "core/scene_keys.h"

struct ab_scene_private {
    ab_document *document;
    ab_formulas *formulas;
    ab_units *units;
    ab_arena *arena;
};

typedef struct ab_scene_reader {
    ab_reader base;
    ab_scene *scene;
    ab_registry *registry;
    bool end_by_set;                        /* time.end came by --set */
    const ab_node *side_boundary[AB_SIDES]; /* boundary plugins at sides of the grid; NULL: none */
    double side_at[AB_SIDES];               /* m, where the sides were written */
} ab_scene_reader;

/* One section each; `node` NULL: not written. Mistakes go to the report; what could not be read keeps its default. */
void ab_scene_take_constants(ab_scene_reader *reader, const ab_node *node);
void ab_scene_take_damping(ab_scene_reader *reader, const ab_node *node);
void ab_scene_take_checked(ab_scene_reader *r, const ab_node *node);
void ab_scene_take_watchdog(ab_scene_reader *reader, const ab_node *node);
void ab_scene_take_time(ab_scene_reader *reader, const ab_node *node);
void ab_scene_take_sides(ab_scene_reader *reader, const ab_node *node, const char *where, ab_side_kind side[AB_SIDES]);
/* Stages, after time and grid; `root`: of the scene. */
void ab_scene_take_stages(ab_scene_reader *reader, const ab_node *root, const ab_node *time, const ab_node *node);
/* `stages:` of a load or a support: a bit for each stage in which it does not act. */
uint64_t ab_scene_take_absent(ab_scene_reader *reader, const ab_node *node, const char *where);
/* What a body begins with; its material is known. After bodies: does it go with gravity, motion and the first stage? */
void ab_scene_take_initial(ab_scene_reader *reader, const ab_node *node, const char *where, ab_body_spec *body);
void ab_scene_check_initial(ab_scene_reader *reader);
void ab_scene_take_grid(ab_scene_reader *reader, const ab_node *node);
void ab_scene_take_materials(ab_scene_reader *reader, const ab_node *node);
void ab_scene_take_bodies(ab_scene_reader *reader, const ab_node *node);
void ab_scene_take_contacts(ab_scene_reader *reader, const ab_node *node);
void ab_scene_take_loads(ab_scene_reader *reader, const ab_node *node);
void ab_scene_take_boundaries(ab_scene_reader *reader, const ab_node *node);
void ab_scene_take_monitors(ab_scene_reader *reader, const ab_node *node);
void ab_scene_take_history(ab_scene_reader *reader, const ab_node *node);
void ab_scene_take_checkpoint(ab_scene_reader *reader, const ab_node *node);
void ab_scene_take_output(ab_scene_reader *reader, const ab_node *node);
void ab_scene_take_expects(ab_scene_reader *reader, const ab_node *node);
void ab_scene_take_trade(ab_scene_reader *reader, const ab_node *node); /* after the expects */
void ab_scene_take_extremes(ab_scene_reader *reader, const ab_node *node);
/* Of `trade` and `extremes`: a path as for --set or a list of them; false with the mistake reported. */
bool ab_scene_take_paths(ab_scene_reader *reader, const ab_node *node, const char *where, const char ***paths, size_t *count);

bool ab_scene_take_shape(ab_scene_reader *reader, const ab_node *node, const char *where, ab_shape_spec *shape);
bool ab_scene_take_where(ab_scene_reader *reader, const ab_node *node, const char *where, ab_where *set);
bool ab_scene_take_mesh(ab_scene_reader *reader, const ab_node *node, const char *where, ab_mesh_spec *mesh);
void ab_scene_take_fix(ab_scene_reader *reader, const ab_node *node, const char *where, ab_body_spec *body);
void ab_scene_take_motion(ab_scene_reader *reader, const ab_node *node, const char *where, ab_body_spec *body);
void ab_scene_check_mass(ab_scene_reader *reader, const ab_body_spec *body, const char *where);
/* Bounds of a shape; false when it could not be read. */
bool ab_shape_bounds(const ab_shape_spec *shape, double low[2], double high[2]);
/* Bounds of a body, from its shape or mesh; false where they are not known: a mistake, or a mesh in a file. */
bool ab_body_bounds(const ab_body_spec *body, double low[2], double high[2]);

/* After bodies and contacts: is there a grid where one is needed, and are the bodies that need it inside? `root`: of the scene. */
void ab_scene_check_grid(ab_scene_reader *reader, const ab_node *root);
/* In axisymmetric scenes. The grid's left side: a roller where it is the axis. After bodies and contacts: what cannot be, or is not there yet. */
void ab_scene_take_axis(ab_scene_reader *reader, ab_mark mark);
/* A rigid body: it moves along the axis only. */
void ab_scene_hold_radius(ab_scene_reader *reader, ab_body_spec *body);
void ab_scene_check_axisymmetric(ab_scene_reader *reader);
/* AB_PLANE_STRAIN or AB_AXISYMMETRIC: what a plugin must be able to do for this scene; and its name. */
uint32_t ab_scene_space(const ab_scene *scene, const char **name);

/* True when a pair's finder looks at the nodes of the grid. */
bool ab_contact_needs_grid(const ab_contact_spec *contact);

/* Index of a body or material by name, or -1 with the mistake reported. `where` is the place of the name. */
int ab_scene_body_named(ab_scene_reader *reader, const char *name, ab_mark mark, const char *where);
/* A declared state of the material of a body (SIZE_MAX: of any body), by name; NULL: none. */
const ab_state *ab_scene_state_named(const ab_scene *scene, size_t body, const char *name);
/* True when node is a list; else the mistake is reported. */
bool ab_scene_is_list(ab_scene_reader *reader, const ab_node *node, const char *where, const char *of);
/* The text of a scalar, or NULL with "where must be WANTED" reported. */
const char *ab_scene_word(ab_scene_reader *reader, const ab_node *node, const char *where, const char *wanted);

#endif
