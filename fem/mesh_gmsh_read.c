/* mesh_gmsh_read.c: asks libgmsh for the contents of a .msh file. The library is large and reads whatever it is given, so it is loaded only here, and only in a
 * process of its own with bounds on memory and time: a damaged file costs that process, not the run. What comes back is
 * one stream of numbers: mesh_gmsh_stream.c. */
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

enum { MOST_SECONDS = 30, TEXT = FEM_GMSH_TEXT };

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

typedef struct kind { /* elements of one type, gathered one by one */
    size_t count, nodes, capacity, *id, *node;
} kind;

enum { TYPES = 256, MOST_GAPS = 200000 };

static double number_of(int pipe, void *library, const char *option) {
    double number = 0;
    int error = 0;
    CALL(gmshOptionGetNumber)(option, &number, &error);
    return error == 0 ? number : 0;
}

static void gather(int pipe, kind *k, size_t id, const size_t *node, size_t nodes) {
    if (k->count == k->capacity) {
        k->capacity = 2 * k->capacity + 64;
        k->nodes = nodes;
        k->id = realloc(k->id, k->capacity * sizeof *k->id);
        k->node = realloc(k->node, k->capacity * nodes * sizeof *k->node);
        if (k->id == NULL || k->node == NULL) fail(pipe, "there is no memory for its elements");
    }
    if (nodes != k->nodes) fail(pipe, "elements of one type have different numbers of nodes; save it anew");
    k->id[k->count] = id;
    memcpy(k->node + k->count++ * nodes, node, nodes * sizeof *node);
}

/* gmshModelMeshGetElements gives of each surface only the triangles like its first triangle and the quadrilaterals like its first quadrilateral, and loses the
 * others without a word. Where it counts more than it gives, every element is asked for by its number. Returns the table of types, or NULL: nothing is lost. */
static kind *gather_lost(int pipe, void *library, size_t given) {
    const double all = number_of(pipe, library, "Mesh.NbTriangles") + number_of(pipe, library, "Mesh.NbQuadrangles");
    if (all <= (double)given) return NULL;
    kind *kinds = calloc(TYPES, sizeof *kinds);
    if (kinds == NULL) fail(pipe, "there is no memory for its elements");
    int error = 0, dimension[TYPES] = {0};
    size_t found = 0, gaps = 0;
    CALL(gmshLoggerStop)(&error); /* each gap between numbers would be a line of it */
    __typeof__(&gmshModelMeshGetElement) ask = CALL(gmshModelMeshGetElement);
    __typeof__(&gmshModelMeshGetElementProperties) describe = CALL(gmshModelMeshGetElementProperties);
    __typeof__(&gmshFree) release = CALL(gmshFree);
    for (size_t id = 1; (double)found < all && gaps < MOST_GAPS; id++) {
        int type = 0;
        size_t *node = NULL, nodes = 0;
        ask(id, &type, &node, &nodes, &error);
        if (error != 0 || type <= 0 || type >= TYPES || nodes == 0) {
            gaps++;
            continue;
        }
        if (dimension[type] == 0) {
            char *name = NULL;
            double *local = NULL;
            int order = 0, count = 0, corners = 0;
            size_t locals = 0;
            describe(type, &name, &dimension[type], &order, &count, &local, &locals, &corners, &error);
        }
        if (dimension[type] == 2) {
            gather(pipe, &kinds[type], id, node, nodes);
            found++;
        }
        release(node);
    }
    if ((double)found < all)
        fail(pipe,
             "a surface has elements of several types, and not all can be found by their numbers; save elements of one type and order "
             "(Mesh.ElementOrder, Mesh.RecombineAll = 1), numbered anew");
    return kinds;
}

static void put_gathered(int pipe, const kind *kinds, uint64_t *blocks, bool count_only) {
    for (uint64_t type = 0; type < TYPES; type++) {
        const kind *k = &kinds[type];
        if (k->count == 0) continue;
        ++*blocks;
        if (count_only) continue;
        put_number(pipe, type);
        put_number(pipe, 2);
        put_number(pipe, k->nodes);
        put_number(pipe, k->count);
        put_ids(pipe, k->id, k->count);
        put_ids(pipe, k->node, k->count * k->nodes);
    }
}

static size_t put_elements(int pipe, void *library, int dimension, uint64_t *blocks, bool count_only) {
    int *type = NULL, error = 0;
    size_t types = 0, **id = NULL, *ids = NULL, ids_n = 0, **node = NULL, *nodes = NULL, nodes_n = 0;
    CALL(gmshModelMeshGetElements)(&type, &types, &id, &ids, &ids_n, &node, &nodes, &nodes_n, dimension, -1, &error);
    if (error != 0 || ids_n != types || nodes_n != types) fail(pipe, "its elements cannot be read; save it anew");
    size_t given = 0;
    for (size_t k = 0; k < types; k++) {
        if (ids[k] == 0) continue;
        given += ids[k];
        ++*blocks;
        if (count_only) continue;
        put_number(pipe, (uint64_t)type[k]);
        put_number(pipe, (uint64_t)dimension);
        put_number(pipe, nodes[k] / ids[k]);
        put_number(pipe, ids[k]);
        put_ids(pipe, id[k], ids[k]);
        put_ids(pipe, node[k], nodes[k] / ids[k] * ids[k]);
    }
    return given;
}

/* libgmsh names the node that is missing, not the element that wants it: that is looked up in the file, where it is text of format 2. */
static void explain(int file, char text[TEXT]) {
    unsigned long long missing = 0, id = 0;
    char line[4096], said[TEXT / 2] = "";
    snprintf(said, sizeof said, "%.*s", (int)sizeof said - 1, text);
    FILE *stream = sscanf(text, "Wrong node index %llu", &missing) == 1 && lseek(file, 0, SEEK_SET) == 0 ? fdopen(file, "r") : NULL;
    bool elements = false, found = false;
    double version = 0;
    for (int number = 1; stream != NULL && !found && fgets(line, sizeof line, stream) != NULL; number++) {
        if (number == 2 && (sscanf(line, "%lf", &version) != 1 || version >= 3)) break;
        if (strncmp(line, "$Elements", 9) == 0) elements = true;
        if (!elements || line[0] == '$') continue;
        char *at = line;
        unsigned long long field = 0, tags = 0;
        for (unsigned long long k = 0; !found; k++) { /* id, type, tags, the tags, nodes */
            char *end = at;
            field = strtoull(at, &end, 10);
            if (end == at) break;
            at = end;
            if (k == 0) id = field;
            if (k == 2) tags = field;
            found = k > 2 && k - 3 >= tags && field == missing;
        }
    }
    if (found)
        snprintf(text, TEXT,
                 "element %llu names node %llu, which the file does not have (%s); the file is damaged or cut off, save it anew", id,
                 missing, said);
    else
        snprintf(text, TEXT, "%s; the file is damaged, cut off or of another kind, save it anew from Gmsh", said);
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
    if (text[0] != '\0' && strstr(text, path) == NULL) explain(file, text);
    if ((merged != 0 && text[0] == '\0') || strstr(text, path) != NULL)
        snprintf(text, sizeof text, "it is damaged, or ends too early; save it anew");
    if (text[0] != '\0') fail(pipe, text);
    size_t *id = NULL, ids = 0, coords = 0, parameters = 0;
    double *coord = NULL, *parameter = NULL;
    CALL(gmshModelMeshGetNodes)(&id, &ids, &coord, &coords, &parameter, &parameters, -1, -1, 0, 0, &error);
    if (error != 0 || coords != 3 * ids) fail(pipe, "its nodes cannot be read");
    uint64_t blocks = 0;
    const kind *lost = gather_lost(pipe, library, put_elements(pipe, library, 2, &blocks, true));
    put_text(pipe, false, "");
    put_number(pipe, ids);
    put_ids(pipe, id, ids);
    put(pipe, coord, coords * sizeof *coord);
    if (lost != NULL) {
        blocks = 0;
        put_gathered(pipe, lost, &blocks, true);
    }
    put_elements(pipe, library, 3, &blocks, true);
    put_number(pipe, blocks);
    if (lost != NULL)
        put_gathered(pipe, lost, &blocks, false);
    else
        put_elements(pipe, library, 2, &blocks, false);
    put_elements(pipe, library, 3, &blocks, false);
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
    const int taken = fem_gmsh_take(file->bytes, count, file, text);
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
