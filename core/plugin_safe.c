/* plugin_safe.c: a plugin is code that runs as the user, so nobody else may be able to change it: neither the file nor a folder on the way to it. */
#define _GNU_SOURCE
#include <errno.h>
#include <grp.h>
#include <pwd.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/plugin_load.h"

/* Who could change the program or the whole system anyway. */
static bool is_trusted(uid_t owner) {
    struct stat found;
    return owner == 0 || owner == geteuid() || (stat("/proc/self/exe", &found) == 0 && found.st_uid == owner) ||
           (stat("/", &found) == 0 && found.st_uid == owner);
}

/* A group with nobody in it but its user, as many systems make one for each (its name is the user's). */
static bool is_private(gid_t group, uid_t owner) {
    char of_group[4096], of_user[4096];
    struct group g, *group_found = NULL;
    struct passwd u, *user_found = NULL;
    if (group == 0) return true;
    if (getgrgid_r(group, &g, of_group, sizeof of_group, &group_found) != 0 || !group_found) return false;
    if (getpwuid_r(owner, &u, of_user, sizeof of_user, &user_found) != 0 || !user_found) return false;
    if (strcmp(g.gr_name, u.pw_name) != 0) return false;
    for (char **member = g.gr_mem; *member; member++)
        if (strcmp(*member, u.pw_name) != 0) return false;
    return true;
}

/* One file or folder. far: not the folder that the file lies in, where the sticky bit keeps what is there from others. */
static bool check_one(const char *path, const char *what, bool far, ab_refusal *refusal) {
    static const char remedy[] = "take that right away (chmod go-w), or say --force-plugins";
    struct stat found;
    if (stat(path, &found) != 0) return ab_refuse(refusal, "cannot be looked at ('%s': %s)", path, strerror(errno));
    if (!is_trusted(found.st_uid))
        return ab_refuse(refusal, "may be changed by another user: %s '%s' belongs to user %u; own it, or say --force-plugins", what, path,
                         (unsigned)found.st_uid);
    if (far && (found.st_mode & S_ISVTX)) return true;
    if (found.st_mode & S_IWOTH)
        return ab_refuse(refusal, "may be changed by anybody: %s '%s' can be written to by all; %s", what, path, remedy);
    if ((found.st_mode & S_IWGRP) && !is_private(found.st_gid, found.st_uid))
        return ab_refuse(refusal, "may be changed by other users: %s '%s' can be written to by the group %u; %s", what, path,
                         (unsigned)found.st_gid, remedy);
    return true;
}

/* The file, its folder, and all above it. */
static bool check_way(const char *path, ab_refusal *refusal) {
    char *way = strdup(path);
    if (!way) return ab_refuse(refusal, "cannot be loaded: no memory");
    bool good = check_one(way, "the file", false, refusal), far = false;
    while (good) {
        char *slash = strrchr(way, '/');
        if (!slash || way[1] == '\0') break;
        slash[slash == way] = '\0';
        good = check_one(way, "the folder", far, refusal);
        far = true;
    }
    free(way);
    return good;
}

bool ab_plugin_is_safe(const char *path, ab_refusal *refusal) {
    char *real = realpath(path, NULL);
    if (!real) return true; /* a link to nowhere: whoever opens it says so */
    const bool good = check_way(path, refusal) && (strcmp(real, path) == 0 || check_way(real, refusal));
    free(real);
    return good;
}
