/* mesh_gmsh.c: meshes in Gmsh files. */
#include "fem/mesh_parts.h"

ab_status fem_mesh_gmsh(const ab_body_spec *spec, const char *folder, fem_mesh **mesh, ab_report *report) {
    (void)folder;
    (void)mesh;
    return ab_report_error(
        report, spec->mesh.mark,
        "body '%s': mesh files are not read by this program, which was built without libgmsh; install libgmsh-dev and build "
        "again, or write the mesh as box or patch",
        spec->name);
}
