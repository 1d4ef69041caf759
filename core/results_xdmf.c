/* results_xdmf.c: the text that tells ParaView and meshio what lies where in results.h5. One temporal collection of grids per file.
 *
 * results.xdmf shows all bodies as one cloud of points with a `body` number. results_<body>.xdmf shows one body alone, with its elements where it has
 * them; a scene of one cloud does without. No file shows elements and clouds side by side, because no form of that is read alike by both: a block per body
 * inside each time would suit ParaView, but meshio's time-series reader takes flat collections only; a topology of mixed cells is read by both, but meshio
 * knows no element of eight nodes there and wants a vertex without the count that ParaView wants. Points move: each grid has its own
 * geometry. meshio reads geometry once, from the first frame, so `position` stands among the attributes as well. */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/files.h"
#include "core/frames.h"

struct ab_xdmf {
    char *path, *title;
    ab_text text;      /* head and grids, without the closing tags */
    double cost, last; /* s: what the last writing took, and when it was */
    bool held;
    bool behind;       /* the file lacks grids that the text has */
};

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static ab_status put(ab_xdmf *xdmf, ab_report *report) {
    static const char closing[] = "</Grid>\n</Domain>\n</Xdmf>\n";
    const double start = now();
    const size_t kept = xdmf->text.count;
    ab_text_add(&xdmf->text, "%s", closing);
    if (xdmf->text.failed) return ab_report_failure(report, "no memory for '%s'", xdmf->path);
    const ab_status status = ab_file_replace(xdmf->path, xdmf->text.bytes, xdmf->text.count, report);
    xdmf->text.count = kept;
    xdmf->last = now();
    xdmf->cost = xdmf->last - start;
    xdmf->behind = status != AB_OK;
    return status;
}

ab_status ab_xdmf_create(const char *path, const char *title, ab_xdmf **result, ab_report *report) {
    ab_xdmf *xdmf = calloc(1, sizeof *xdmf);
    if (xdmf == NULL || (xdmf->path = strdup(path)) == NULL || (xdmf->title = strdup(title)) == NULL) {
        ab_xdmf_destroy(xdmf);
        return ab_report_failure(report, "no memory for '%s'", path);
    }
    *result = xdmf;
    ab_text_add(&xdmf->text, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n<Grid Name=\"");
    ab_text_add_xml(&xdmf->text, title);
    ab_text_add(&xdmf->text, "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
    return AB_OK;
}

static void add_data(ab_xdmf *xdmf, const char *type, int precision, size_t points, int columns, size_t frame, const char *group,
                     const char *name) {
    ab_text *text = &xdmf->text;
    ab_text_add(text, "<DataItem DataType=\"%s\" Precision=\"%d\" Dimensions=\"%zu", type, precision, points);
    if (columns > 0) ab_text_add(text, " %d", columns);
    ab_text_add(text, "\" Format=\"HDF\">results.h5:/frame_%06zu/", frame);
    ab_text_add_xml(text, group);
    ab_text_add(text, "/%s</DataItem>", name);
}

ab_status ab_xdmf_add(ab_xdmf *xdmf, const ab_xdmf_grid *grid, const ab_xdmf_field *fields, size_t field_count, ab_report *report) {
    ab_text *text = &xdmf->text;
    const bool meshed = grid->cells > 0;
    const size_t cells = meshed ? grid->cells : grid->points;
    const int nodes = meshed ? grid->cell_nodes : 1;
    ab_text_add(text, "<Grid Name=\"");
    ab_text_add_xml(text, xdmf->title);
    ab_text_add(text, "\" GridType=\"Uniform\">\n<Time Value=\"%.17g\"/>\n<Topology TopologyType=\"%s\" NumberOfElements=\"%zu\"",
                grid->time,
                !meshed      ? "Polyvertex"
                : nodes == 4 ? "Quadrilateral"
                             : "Quadrilateral_8",
                cells);
    ab_text_add(text, meshed ? ">" : " NodesPerElement=\"1\">");
    add_data(xdmf, "Int", 4, cells, nodes, grid->topology_frame, grid->group, meshed ? "connectivity" : "vertices");
    ab_text_add(text, "</Topology>\n<Geometry GeometryType=\"XYZ\">");
    add_data(xdmf, "Float", 8, grid->points, 3, grid->frame, grid->group, "position");
    ab_text_add(text, "</Geometry>\n");
    for (size_t f = 0; f < field_count; f++) {
        const int n = fields[f].components;
        ab_text_add(text, "<Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"Node\">", fields[f].name,
                    n == 1   ? "Scalar"
                    : n == 3 ? "Vector"
                    : n == 9 ? "Tensor"
                             : "Matrix");
        add_data(xdmf, fields[f].integer ? "Int" : "Float", 8, grid->points, n > 1 ? n : 0, grid->frame, grid->group, fields[f].name);
        ab_text_add(text, "</Attribute>\n");
    }
    ab_text_add(text, "</Grid>\n");
    /* The whole text is written for every frame. A series of many thousand frames would pay more for that than for its frames, so beyond 4 MB
     * writing is held to a twentieth of the time; the frames themselves are in results.h5 at once. */
    xdmf->behind = true;
    if (xdmf->held) return AB_OK;
    if (xdmf->text.count > ((size_t)4 << 20) && now() - xdmf->last < 20 * xdmf->cost) return AB_OK;
    return put(xdmf, report);
}

void ab_xdmf_hold(ab_xdmf *xdmf, bool held) { xdmf->held = held; }

ab_status ab_xdmf_finish(ab_xdmf *xdmf, ab_report *report) { return xdmf->behind ? put(xdmf, report) : AB_OK; }

void ab_xdmf_destroy(ab_xdmf *xdmf) {
    if (xdmf == NULL) return;
    ab_text_clear(&xdmf->text);
    free(xdmf->path);
    free(xdmf->title);
    free(xdmf);
}
