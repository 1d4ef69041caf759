/* mesh_gmsh_stream.c: what the process that reads a .msh file sends back, one stream of 8-byte numbers:
 *   failed (0 or 1), bytes of text, text (to a multiple of 8); then, unless failed,
 *   nodes, their ids, 3 coordinates each; blocks, and of each: type, dimension, nodes an element, elements, their ids, the ids of their nodes.
 * That process may have been led astray by a damaged file, so nothing in the stream is trusted. */
#include <stdlib.h>
#include <string.h>

#include "fem/mesh_gmsh.h"

typedef struct cursor {
    const char *at;
    size_t left;
} cursor;

/* The next `count` numbers of 8 bytes; NULL when there are fewer. */
static const void *take(cursor *c, uint64_t count) {
    if (count > c->left / 8) return NULL;
    const void *here = c->at;
    c->at += 8 * count;
    c->left -= 8 * count;
    return here;
}

static bool take_number(cursor *c, uint64_t *number) {
    const uint64_t *here = take(c, 1);
    if (here != NULL) *number = *here;
    return here != NULL;
}

static bool take_blocks(cursor *c, fem_gmsh_file *file) {
    uint64_t blocks = 0;
    if (!take_number(c, &blocks) || blocks > FEM_GMSH_BLOCKS) return false;
    file->block_count = blocks;
    for (uint64_t k = 0; k < blocks; k++) {
        fem_gmsh_block *block = &file->block[k];
        if (!take_number(c, &block->type) || !take_number(c, &block->dimension) || !take_number(c, &block->nodes) ||
            !take_number(c, &block->count) || block->nodes > 1000)
            return false;
        block->id = take(c, block->count);
        if (block->id == NULL) return false;
        block->node = take(c, block->count * block->nodes);
        if (block->node == NULL) return false;
    }
    return true;
}

int fem_gmsh_take(const char *bytes, size_t count, fem_gmsh_file *file, char text[FEM_GMSH_TEXT]) {
    cursor c = {bytes, count};
    uint64_t failed = 0, length = 0, nodes = 0;
    if (!take_number(&c, &failed) || !take_number(&c, &length) || length >= FEM_GMSH_TEXT) return -1;
    const char *said = take(&c, (length + 7) / 8);
    if (said == NULL) return -1;
    memcpy(text, said, length);
    text[length] = '\0';
    if (failed) return 0;
    if (!take_number(&c, &nodes)) return -1;
    file->node_count = nodes;
    file->node_id = take(&c, nodes);
    file->x = file->node_id == NULL || nodes > c.left ? NULL : take(&c, 3 * nodes);
    return file->x != NULL && take_blocks(&c, file) ? 1 : -1;
}

void fem_gmsh_forget(fem_gmsh_file *file) {
    free(file->bytes);
    *file = (fem_gmsh_file){0};
}
