/* main.c: the one place that knows every room: it hands core the methods that bodies can have, and contact between them. */
#include "contact/contact.h"
#include "core/commands.h"
#include "fem/body.h"
#include "fem/mesh.h"
#include "mpm/body.h"

/* Points may fill a mesh, which finite elements know how to make. */
static ab_status points_create(const ab_scene *scene, size_t index, int threads, ab_domain **domain, ab_report *report) {
    ab_mesh *mesh = NULL;
    if (scene->bodies[index].shape.kind == AB_SHAPE_MESH) AB_TRY(fem_mesh_read(scene, &scene->bodies[index], &mesh, report));
    const ab_status status = mpm_create_in(scene, index, mesh, threads, domain, report);
    fem_mesh_destroy(mesh);
    return status;
}

int main(int argc, char **argv) {
    static const ab_method methods[] = {{"material-points", points_create}, {"finite-elements", fem_create}, {"rigid", rigid_create}};
    return ab_command_main(argc, argv, methods, sizeof methods / sizeof *methods, contact_create);
}
