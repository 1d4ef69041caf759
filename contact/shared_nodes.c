/* shared_nodes.c: the grid nodes where both bodies of a pair have mass. Tiles are compared only when a body's list of tiles has changed. */
#include <stdlib.h>

#include "contact/contact.h"
#include "core/memory.h"

ab_status contact_shared_nodes(contact_pair *pair, ab_report *report) {
    ab_node_tiles a, b;
    pair->a->ops->node_tiles(pair->a, &a);
    pair->b->ops->node_tiles(pair->b, &b);
    if (a.version != pair->version_a || b.version != pair->version_b) {
        pair->tile_count = 0;
        for (size_t i = 0, j = 0; i < a.count && j < b.count;) {
            if (a.key[i] < b.key[j])
                ++i;
            else if (a.key[i] > b.key[j])
                ++j;
            else {
                if (!ab_memory_append(&pair->tiles, &pair->tile_capacity, pair->tile_count + 1, sizeof *pair->tiles)) goto no_memory;
                pair->tiles[pair->tile_count][0] = (uint32_t)i++;
                pair->tiles[pair->tile_count++][1] = (uint32_t)j++;
            }
        }
        pair->version_a = a.version;
        pair->version_b = b.version;
    }
    pair->node_count = 0;
    for (size_t k = 0; k < pair->tile_count; ++k) {
        const uint32_t ta = pair->tiles[k][0], tb = pair->tiles[k][1];
        const double *ma = a.mass + (size_t)ta * AB_TILE_NODES * a.stride, *mb = b.mass + (size_t)tb * AB_TILE_NODES * b.stride;
        for (uint32_t n = 0; n < AB_TILE_NODES; ++n) {
            if (!(ma[n * a.stride] > 0.0 && mb[n * b.stride] > 0.0)) continue;
            size_t capacity = pair->node_capacity;
            if (!ab_memory_append(&pair->nodes_a, &capacity, pair->node_count + 1, sizeof *pair->nodes_a)) goto no_memory;
            if (!ab_memory_append(&pair->nodes_b, &pair->node_capacity, pair->node_count + 1, sizeof *pair->nodes_b)) goto no_memory;
            pair->nodes_a[pair->node_count] = ta * AB_TILE_NODES + n;
            pair->nodes_b[pair->node_count++] = tb * AB_TILE_NODES + n;
        }
    }
    return AB_OK;
no_memory:
    return ab_report_failure(report, "no memory for the nodes shared by '%s' and '%s'", pair->a->spec->name, pair->b->spec->name);
}
