/* child_runs.c: runs of a scene as processes: begun, watched, stopped at their limit or by a signal, collected. */
#include "core/child_runs.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "core/files.h"

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Two programs in one folder would take each other's runs for their own. The lock is gone with the last process that has it open: this program, or a run that it began and that has
 * yet to die with it; it can not be left behind. What is just ending is waited for. */
static ab_status lock_folder(ab_child_runs *runs, ab_report *report) {
    char path[4200], holder[40] = "";
    snprintf(path, sizeof path, "%s/lock", runs->folder);
    runs->lock = fopen(path, "a+");
    if (runs->lock == NULL) return ab_report_failure(report, "%s cannot be written: %s", path, strerror(errno));
    const double began = now();
    while (flock(fileno(runs->lock), LOCK_EX | LOCK_NB) != 0) {
        if (errno != EWOULDBLOCK && errno != EINTR) return AB_OK; /* a file system without locks */
        if (now() - began < 2) {
            nanosleep(&(struct timespec){0, 20000000}, NULL);
            continue;
        }
        rewind(runs->lock);
        if (fgets(holder, sizeof holder, runs->lock) == NULL) holder[0] = '\0';
        holder[strspn(holder, "0123456789")] = '\0';
        ab_child_runs_end(runs);
        return ab_report_failure(report,
                                 "another abut is at work in the folder %s%s%s: wait until it has ended, or give another folder with -o",
                                 runs->folder, holder[0] != '\0' ? ", process " : "", holder);
    }
    if (ftruncate(fileno(runs->lock), 0) == 0) fprintf(runs->lock, "%ld\n", (long)getpid()), fflush(runs->lock);
    return AB_OK;
}

void ab_child_runs_end(ab_child_runs *runs) {
    if (runs->lock != NULL) fclose(runs->lock);
    runs->lock = NULL;
}

static ab_status begin(const ab_child_runs *runs, ab_child *child, ab_report *report) {
    static char set_word[] = "--set", plugin_path[] = "--plugin-path", force[] = "--force-plugins";
    const size_t sets = runs->override_count + child->setting_count, most = 16 + 2 * sets;
    char **words = calloc(most, sizeof *words), **made = calloc(most, sizeof *made), threads[16], log[4200];
    size_t count = 0, made_count = 0;
    ab_status status = words == NULL || made == NULL ? ab_report_failure(report, "no memory to start a run") : AB_OK;
    if (status == AB_OK) {
        snprintf(threads, sizeof threads, "%d", runs->threads);
        snprintf(log, sizeof log, "%s.log", child->folder);
        const char *const head[] = {"abut", "run", runs->scene, "--quiet", "-j", threads, "-o", child->folder};
        for (size_t i = 0; i < sizeof head / sizeof *head; i++) words[count++] = (char *)(uintptr_t)head[i];
        if (runs->plugin_path != NULL) words[count++] = plugin_path, words[count++] = (char *)(uintptr_t)runs->plugin_path;
        if (runs->force_plugins) words[count++] = force;
    }
    for (size_t i = 0; status == AB_OK && i < sets; i++) {
        const ab_override *o = i < runs->override_count ? &runs->overrides[i] : &child->settings[i - runs->override_count];
        if (strcmp(o->path, AB_CHILD_THREADS) == 0) {
            snprintf(threads, sizeof threads, "%s", o->value);
            continue;
        }
        const size_t size = strlen(o->path) + strlen(o->value) + 2;
        char *set = made[made_count++] = malloc(size);
        if (set == NULL) {
            status = ab_report_failure(report, "no memory to start a run");
            break;
        }
        snprintf(set, size, "%s=%s", o->path, o->value);
        words[count++] = set_word;
        words[count++] = set;
    }
    if (status == AB_OK) {
        const pid_t parent = getpid(), process = fork();
        if (process == 0) {
            prctl(PR_SET_PDEATHSIG, SIGKILL); /* with this program, however it ends: nobody else would wait for it */
            if (getppid() != parent) _exit(127);
            const int file = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0666), nothing = open("/dev/null", O_RDWR);
            if (file >= 0) dup2(file, STDERR_FILENO);
            if (nothing >= 0) dup2(nothing, STDIN_FILENO), dup2(nothing, STDOUT_FILENO);
            execv("/proc/self/exe", words);
            _exit(127);
        }
        if (process < 0)
            status = ab_report_failure(report, "a run cannot be started: %s", strerror(errno));
        else {
            child->process = process;
            child->started = now();
            child->state = AB_CHILD_RUNNING;
        }
    }
    for (size_t i = 0; i < made_count; i++) free(made[i]);
    free(made), free(words);
    return status;
}

static volatile sig_atomic_t stopped;
static void on_signal(int number) { stopped = number; }

static void tell(const ab_child_runs *runs, const ab_child *child) {
    static const char *const words[] = {"", "", "done", "failed", "refused", "over the limit", "skipped"};
    if (runs->quiet) return;
    size_t expected = 0;
    const size_t ended = runs->count(runs->owner, &expected);
    if (expected < ended) expected = ended;
    if (!isatty(STDERR_FILENO)) {
        const bool failed = child->state == AB_CHILD_FAILED && child->why != NULL; /* of a full disk, all that follow do */
        fprintf(stderr, "%4zu of %zu  %s: %s%s, %.3g s%s%.300s\n", ended, expected, child->label, words[child->state],
                child->kept ? " before" : "", child->cpu, failed ? ": " : "", failed ? child->why : "");
        return;
    }
    char bar[31];
    const size_t full = 30 * ended / (expected > 0 ? expected : 1);
    for (size_t i = 0; i < 30; i++) bar[i] = i < full ? '#' : '.';
    bar[30] = '\0';
    fprintf(stderr, "\r%s %zu of %zu  %.60s: %s\033[K", bar, ended, expected, child->label, words[child->state]);
    fflush(stderr);
}

/* A full disk or a lack of memory may be gone the next time; what the run itself said of its physics will not. */
static bool machine_failed(const ab_child *child, int status) {
    static const char *const said[] = {"memory",        "cannot be written", "could not be written",
                                       "No space left", "too large",         "cannot be made"};
    if (status == 127 || status == 128 + SIGKILL || status == AB_CHILD_STOPPED) return true; /* not begun, or ended from outside */
    for (size_t i = 0; i < sizeof said / sizeof *said; i++)
        if (child->why != NULL && strstr(child->why, said[i]) != NULL) return true;
    return false;
}

/* One that has ended; its times and memory from the system. */
static ab_status collect(const ab_child_runs *runs, ab_child *child, int how, const struct rusage *use, ab_report *report) {
    child->wall = now() - child->started;
    child->cpu = (double)(use->ru_utime.tv_sec + use->ru_stime.tv_sec) + 1e-6 * (double)(use->ru_utime.tv_usec + use->ru_stime.tv_usec);
    child->bytes = 1024.0 * (double)use->ru_maxrss;
    child->process = 0;
    const int status = WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how);
    if (child->wall > runs->limit && status > 3) {
        ab_child_over_limit(runs, child);
        return runs->keep_failures ? ab_child_keep(runs, child, AB_CHILD_STOPPED, report) : AB_OK;
    }
    if (stopped && status > 128) { /* with this program, by its signal: to be run again */
        child->state = AB_CHILD_WAITING;
        return AB_OK;
    }
    ab_child_conclude(child, status);
    child->machine = child->state == AB_CHILD_FAILED && machine_failed(child, status);
    if (child->state == AB_CHILD_FAILED && (!runs->keep_failures || child->machine)) return AB_OK;
    return ab_child_keep(runs, child, status, report);
}

static ab_status run_all(ab_child_runs *runs, ab_child **running, ab_report *report) {
    int count = 0;
    bool told = false;
    ab_status status = AB_OK;
    for (;;) {
        ab_child *child;
        while (status == AB_OK && !stopped && count < runs->jobs && (child = runs->next(runs->owner)) != NULL) {
            if (ab_child_take_kept(runs, child)) {
                runs->ended(runs->owner, child);
                tell(runs, child);
                continue;
            }
            status = begin(runs, child, report);
            if (status == AB_OK) running[count++] = child;
        }
        if (count == 0) return status;
        struct rusage use;
        int how;
        const pid_t process = wait4(-1, &how, WNOHANG, &use);
        if (process > 0) {
            for (int i = 0; i < count; i++)
                if (running[i]->process == process) {
                    child = running[i];
                    running[i] = running[--count];
                    const ab_status kept = collect(runs, child, how, &use, report);
                    if (status == AB_OK) status = kept;
                    if (child->state == AB_CHILD_WAITING) break;
                    runs->ended(runs->owner, child);
                    tell(runs, child);
                    break;
                }
            continue;
        }
        for (int i = 0; i < count; i++) {
            const bool late = now() - running[i]->started > runs->limit;
            if (late || (stopped && !told) || status != AB_OK) kill(running[i]->process, SIGTERM);
        }
        told = stopped != 0;
        nanosleep(&(struct timespec){0, 5000000}, NULL);
    }
}

ab_status ab_child_runs_run(ab_child_runs *runs, const ab_scene *scene, ab_registry *registry, ab_report *report) {
    char folder[4200];
    snprintf(folder, sizeof folder, "%s/runs", runs->folder);
    AB_TRY(ab_folder_make(folder, report));
    AB_TRY(lock_folder(runs, report));
    ab_child_fingerprint(runs, scene, registry);
    ab_child **running = calloc((size_t)runs->jobs, sizeof(ab_child *));
    if (running == NULL) return ab_report_failure(report, "no memory for %d runs at a time", runs->jobs);
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction action = {.sa_handler = on_signal}, old[3];
    stopped = 0;
    for (int i = 0; i < 3; i++) sigaction(signals[i], &action, &old[i]);
    const ab_status status = run_all(runs, running, report);
    for (int i = 0; i < 3; i++) sigaction(signals[i], &old[i], NULL);
    free(running);
    if (!runs->quiet && isatty(STDERR_FILENO)) fprintf(stderr, "\r\033[K");
    return status != AB_OK ? status : stopped ? (ab_status)(128 + stopped) : AB_OK;
}
