/* plugin_load.c: loads one plugin. Versions and sizes are read from the file first; then dlopen, with an eye on the floating-point
 * control word, because an object built with -ffast-math turns denormals off for the whole program as it loads; then the tables. */
#include "core/plugin_load.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#elif !defined(__aarch64__)
#include <fenv.h>
#endif

static const char *const symbol_name = "abut_plugin_v1";

/* ---- the floating-point control word --------------------------------------------------------------------------------------------- */

#if defined(__SSE2__)
enum { MXCSR_STATUS = 0x3f, MXCSR_DENORMALS = 0x8040 }; /* flags that arithmetic sets; flush-to-zero and denormals-are-zero */
static unsigned long control_word(void) { return _mm_getcsr() & ~(unsigned)MXCSR_STATUS; }
static void set_control_word(unsigned long word) { _mm_setcsr((_mm_getcsr() & (unsigned)MXCSR_STATUS) | (unsigned)word); }
static bool flushes(unsigned long word) { return (word & MXCSR_DENORMALS) != 0; }
#elif defined(__aarch64__)
static unsigned long control_word(void) {
    unsigned long word;
    __asm__ volatile("mrs %0, fpcr" : "=r"(word));
    return word;
}
static void set_control_word(unsigned long word) { __asm__ volatile("msr fpcr, %0" : : "r"(word)); }
static bool flushes(unsigned long word) { return (word & (1ul << 24)) != 0; }
#else
static unsigned long control_word(void) { return (unsigned long)fegetround(); }
static void set_control_word(unsigned long word) { fesetround((int)word); }
static bool flushes(unsigned long word) { return (void)word, false; }
#endif

/* ---- loading ----------------------------------------------------------------------------------------------------------------------- */

static bool take_tables(ab_plugin_file *file, const ab_plugin_head *head, const ab_plugin *given, ab_refusal *refusal) {
    if (!given) return ab_refuse(refusal, "has lost its symbol '%s' while it was loaded", symbol_name);
    if (memcmp(given, head, offsetof(ab_plugin_head, symbol_size)) != 0)
        return ab_refuse(refusal, "has a descriptor that says another thing loaded than it does in the file");
    memcpy(&file->plugin, given, head->struct_size < sizeof file->plugin ? head->struct_size : sizeof file->plugin);
    if (!ab_check_plugin(&file->plugin, refusal)) return false;
    file->classes = calloc(file->plugin.class_count, sizeof *file->classes);
    if (!file->classes) return ab_refuse(refusal, "cannot be loaded: no memory");
    for (uint32_t i = 0; i < file->plugin.class_count; i++) {
        if (!ab_check_class(file->plugin.classes[i], &file->classes[i], refusal)) return false;
        for (uint32_t other = 0; other < i; other++)
            if (file->classes[other].class_.kind == file->classes[i].class_.kind &&
                strcmp(file->classes[other].class_.name, file->classes[i].class_.name) == 0)
                return ab_refuse(refusal, "offers the %s class '%s' twice", ab_kind_name(file->classes[i].class_.kind),
                                 file->classes[i].class_.name);
    }
    return true;
}

bool ab_plugin_load(const char *path, ab_plugin_file *file, ab_refusal *refusal) {
    ab_plugin_head head;
    memset(file, 0, sizeof *file);
    if (!ab_elf_read_head(path, symbol_name, &head, refusal) || !ab_check_head(&head, refusal)) return false;
    const unsigned long before = control_word();
    dlerror();
    file->handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    const unsigned long after = control_word();
    set_control_word(before);
    if (!file->handle) {
        const char *why = dlerror();
        return ab_refuse(refusal, "cannot be loaded: %s", why ? why : "the system's loader does not say why");
    }
    bool good = false;
    if (after != before)
        ab_refuse(refusal,
                  "changes the floating-point mode of the program as it is loaded (%s; control word 0x%lx before, 0x%lx after); "
                  "build and link it without -ffast-math",
                  flushes(after) && !flushes(before) ? "it turns on flush-to-zero" : "rounding or traps", before, after);
    else
        good = take_tables(file, &head, dlsym(file->handle, symbol_name), refusal);
    if (!good) ab_plugin_unload(file);
    return good;
}

void ab_plugin_unload(ab_plugin_file *file) {
    const unsigned long word = control_word();
    free(file->classes);
    if (file->handle) dlclose(file->handle);
    set_control_word(word);
    memset(file, 0, sizeof *file);
}
