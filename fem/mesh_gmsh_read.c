/* mesh_gmsh_read.c: asks libgmsh for the contents of a .msh file. The library is large and reads whatever it is given, so it is loaded only here, and only in a
 * process of its own with bounds on memory and time: a damaged file costs that process, not the run. What comes back is one stream of 8-byte numbers:
 *   failed (0 or 1), bytes of text, text (to a multiple of 8); then, unless failed,
 *   nodes, their ids, 3 coordinates each; blocks, and of each: type, dimension, nodes an element, elements, their ids, the ids of their nodes. */
#define _GNU_SOURCE
#include "fem/mesh_gmsh.h"

#ifdef ABUT_WITH_GMSH

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <gmshc.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#define TEXT_OF(x) #x
#define VERSION_TEXT(major, minor) "libgmsh.so." TEXT_OF(major) "." TEXT_OF(minor)
static const char library_name[] = VERSION_TEXT(GMSH_API_VERSION_MAJOR, GMSH_API_VERSION_MINOR); /* its soname: the header's own version */

enum { MOST_SECONDS = 30, TEXT = 400 };

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define RESERVES_MEMORY
#endif
#endif
#if !defined(__SANITIZE_ADDRESS__) && !defined(RESERVES_MEMORY) /* the sanitizer reserves terabytes */
#define MEMORY ((uint64_t)2 << 30)                              /* bytes, on top of a multiple of the file's size */
#endif

/* ---- in the other process -------------------------------------------------------------------------------------------------------- */

static void put(int pipe, const void *bytes, size_t count) {
    const char *from = bytes;
    while (count > 0) {
        const ssize_t n = write(pipe, from, count);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) _exit(3);
        from += n;
        count -= (size_t)n;
    }
}

static void put_number(int pipe, uint64_t number) { put(pipe, &number, sizeof number); }

static void put_ids(int pipe, const size_t *ids, size_t count) {
    _Static_assert(sizeof(size_t) == sizeof(uint64_t), "ids are sent as they lie");
    put(pipe, ids, count * sizeof *ids);
}

static void put_text(int pipe, bool failed, const char *text) {
    char padded[TEXT + 8] = "";
    snprintf(padded, TEXT, "%s", text);
    const size_t length = strlen(padded);
    put_number(pipe, failed);
    put_number(pipe, length);
    put(pipe, padded, (length + 7) / 8 * 8);
}

static void fail(int pipe, const char *text) {
    put_text(pipe, true, text);
    _exit(0);
}

static void *wanted(int pipe, void *library, const char *name) {
    void *symbol = dlsym(library, name);
    if (symbol == NULL) fail(pipe, dlerror());
    return symbol;
}
#define CALL(name) ((__typeof__(&name))wanted(pipe, library, #name))

static void put_elements(int pipe, void *library, int dimension, uint64_t *blocks, bool count_only) {
    int *type = NULL, error = 0;
    size_t types = 0, **id = NULL, *ids = NULL, ids_n = 0, **node = NULL, *nodes = NULL, nodes_n = 0;
    CALL(gmshModelMeshGetElements)(&type, &types, &id, &ids, &ids_n, &node, &nodes, &nodes_n, dimension, -1, &error);
    if (error != 0 || ids_n != types || nodes_n != types) fail(pipe, "its elements cannot be read");
    for (size_t k = 0; k < types; k++) {
        if (ids[k] == 0) continue;
        ++*blocks;
        if (count_only) continue;
        put_number(pipe, (uint64_t)type[k]);
        put_number(pipe, (uint64_t)dimension);
        put_number(pipe, nodes[k] / ids[k]);
        put_number(pipe, ids[k]);
        put_ids(pipe, id[k], ids[k]);
        put_ids(pipe, node[k], nodes[k] / ids[k] * ids[k]);
    }
}

static void read_there(int pipe, int file) {
    void *library = dlopen(library_name, RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) fail(pipe, dlerror());
    int error = 0;
    char path[40];
    snprintf(path, sizeof path, "/proc/self/fd/%d", file); /* so that no beam.msh.opt beside it is executed */
#ifdef ABUT_GMSH_RUN
    CALL(gmshInitialize)(0, NULL, 0, 0, &error);
#else
    CALL(gmshInitialize)(0, NULL, 0, &error);
#endif
    if (error != 0) fail(pipe, "libgmsh does not start");
    CALL(gmshOptionSetNumber)("General.Terminal", 0, &error);
    CALL(gmshOptionSetNumber)("General.NumThreads", 1, &error);
    CALL(gmshLoggerStart)(&error);
    CALL(gmshMerge)(path, &error);
    const int merged = error;
    char **log = NULL, text[TEXT] = "";
    size_t lines = 0;
    CALL(gmshLoggerGet)(&log, &lines, &error);
    for (size_t i = 0; i < lines && text[0] == '\0'; i++)
        if (strncmp(log[i], "Error", 5) == 0) snprintf(text, sizeof text, "%s", log[i] + strspn(log[i] + 5, ": ") + 5);
    if ((merged != 0 && text[0] == '\0') || strstr(text, path) != NULL)
        snprintf(text, sizeof text, "it is damaged, or ends too early; save it anew");
    if (text[0] != '\0') fail(pipe, text);
    size_t *id = NULL, ids = 0, coords = 0, parameters = 0;
    double *coord = NULL, *parameter = NULL;
    CALL(gmshModelMeshGetNodes)(&id, &ids, &coord, &coords, &parameter, &parameters, -1, -1, 0, 0, &error);
    if (error != 0 || coords != 3 * ids) fail(pipe, "its nodes cannot be read");
    put_text(pipe, false, "");
    put_number(pipe, ids);
    put_ids(pipe, id, ids);
    put(pipe, coord, coords * sizeof *coord);
    uint64_t blocks = 0;
    for (int d = 2; d <= 3; d++) put_elements(pipe, library, d, &blocks, true);
    put_number(pipe, blocks);
    for (int d = 2; d <= 3; d++) put_elements(pipe, library, d, &blocks, false);
    _exit(0);
}

static void bound(int resource, uint64_t most) {
    struct rlimit limit;
    if (getrlimit(resource, &limit) != 0) return;
    if (limit.rlim_max == RLIM_INFINITY || limit.rlim_max > most) limit.rlim_cur = limit.rlim_max = most;
    setrlimit(resource, &limit);
}

/* Bounds first; then nothing of what libgmsh prints is to be seen. */
static void prepare_there(off_t size) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (int s = 1; s < 32; s++) signal(s, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    alarm((unsigned)(20 * MOST_SECONDS + size / 1000000)); /* against a wait without end */
    bound(RLIMIT_CORE, 0);
    bound(RLIMIT_CPU, MOST_SECONDS + (uint64_t)size / 1000000);
#ifdef MEMORY
    unsigned long pages = 0; /* what this process has already, as a copy of the one that reads */
    FILE *stream = fopen("/proc/self/statm", "r");
    if (stream != NULL && fscanf(stream, "%lu", &pages) != 1) pages = 0;
    if (stream != NULL) fclose(stream);
    bound(RLIMIT_AS, (uint64_t)pages * (uint64_t)sysconf(_SC_PAGESIZE) + MEMORY + 16 * (uint64_t)size);
#endif
    const int nowhere = open("/dev/null", O_RDWR);
    if (nowhere < 0) return;
    for (int k = 0; k < 3; k++) dup2(nowhere, k);
}

/* ---- here ------------------------------------------------------------------------------------------------------------------------ */

/* All that comes through the pipe. NULL: no memory; the rest is read and dropped. */
static char *slurp(int pipe, size_t *count) {
    size_t capacity = (size_t)1 << 16, n = 0;
    char *bytes = malloc(capacity);
    for (;;) {
        char spare[4096];
        if (bytes != NULL && n == capacity) {
            char *more = realloc(bytes, 2 * capacity);
            if (more == NULL) free(bytes);
            bytes = more;
            capacity *= 2;
        }
        const ssize_t got = bytes != NULL ? read(pipe, bytes + n, capacity - n) : read(pipe, spare, sizeof spare);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        n += bytes != NULL ? (size_t)got : 0;
    }
    *count = n;
    return bytes;
}

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

/* 1: read; 0: refused, with `text`; -1: the stream ends too early. */
static int take_file(const char *bytes, size_t count, fem_gmsh_file *file, char text[TEXT]) {
    cursor c = {bytes, count};
    uint64_t failed = 0, length = 0, nodes = 0;
    if (!take_number(&c, &failed) || !take_number(&c, &length) || length >= TEXT) return -1;
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

/* Only text or binary .msh: libgmsh would run anything else as a script. */
static ab_status open_mesh(const char *path, const char *body, ab_mark mark, int *handle, off_t *size, ab_report *report) {
    *handle = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat about;
    if (*handle < 0 || fstat(*handle, &about) != 0)
        return ab_report_error(report, mark, "body '%s': cannot open mesh file '%s': %s; it is looked for in the scene's folder", body,
                               path, strerror(errno));
    char head[16] = "";
    const ssize_t n = S_ISREG(about.st_mode) ? pread(*handle, head, sizeof head - 1, 0) : -1;
    *size = about.st_size;
    if (n > 0 && (strncmp(head, "$MeshFormat", 11) == 0 || strncmp(head, "$Comments", 9) == 0)) return AB_OK;
    return ab_report_error(report, mark, "body '%s': '%s' is no Gmsh mesh: it does not begin with $MeshFormat; save the mesh as .msh", body,
                           path);
}

static ab_status said_by(int status, const char *path, const char *body, ab_mark mark, ab_report *report) {
    if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGALRM || WTERMSIG(status) == SIGKILL))
        return ab_report_error(report, mark, "body '%s': libgmsh was stopped while it read '%s', for time or memory; the file is damaged",
                               body, path);
    if (WIFSIGNALED(status))
        return ab_report_error(report, mark, "body '%s': libgmsh fell over '%s' (%s); the file is damaged, save it anew", body, path,
                               strsignal(WTERMSIG(status)));
    return ab_report_error(report, mark, "body '%s': libgmsh gave up on '%s' (exit %d); the file is damaged, save it anew", body, path,
                           WIFEXITED(status) ? WEXITSTATUS(status) : -1);
}

ab_status fem_gmsh_read(const char *path, const char *body, ab_mark mark, fem_gmsh_file *file, ab_report *report) {
    int handle = -1, ends[2] = {-1, -1}, status = 0;
    off_t size = 0;
    *file = (fem_gmsh_file){0};
    ab_status result = open_mesh(path, body, mark, &handle, &size, report);
    if (result != AB_OK) {
        if (handle >= 0) close(handle);
        return result;
    }
    pid_t child = -1;
    if (pipe2(ends, O_CLOEXEC) == 0) child = fork();
    if (child == 0) {
        prepare_there(size);
        read_there(ends[1], handle);
    }
    close(handle);
    if (ends[1] >= 0) close(ends[1]);
    if (child < 0) {
        if (ends[0] >= 0) close(ends[0]);
        return ab_report_failure(report, "body '%s': no process to read '%s' in: %s", body, path, strerror(errno));
    }
    size_t count = 0;
    char text[TEXT] = "";
    file->bytes = slurp(ends[0], &count);
    close(ends[0]);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {}
    if (file->bytes == NULL) return ab_report_failure(report, "body '%s': no memory for the mesh in '%s'", body, path);
    const int taken = take_file(file->bytes, count, file, text);
    if (taken == 1) return AB_OK;
    fem_gmsh_forget(file);
    if (taken == 0) return ab_report_error(report, mark, "body '%s': libgmsh cannot read '%s': %s", body, path, text);
    return said_by(status, path, body, mark, report);
}

#else

#include <stdlib.h>

ab_status fem_gmsh_read(const char *path, const char *body, ab_mark mark, fem_gmsh_file *file, ab_report *report) {
    *file = (fem_gmsh_file){0};
    return ab_report_error(
        report, mark,
        "body '%s': '%s' cannot be read: this program was built without libgmsh; install libgmsh-dev, configure and build "
        "again, or write the mesh as box or patch",
        body, path);
}

#endif

void fem_gmsh_forget(fem_gmsh_file *file) {
    free(file->bytes);
    *file = (fem_gmsh_file){0};
}
