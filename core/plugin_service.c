/* plugin_service.c: what the host does for one instance of a plugin: memory, messages, lines for the user. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/plugin_host.h"

enum { ALIGNMENT = 64 };

static void *service_allocate(void *context, size_t bytes) {
    (void)context;
    if (bytes > SIZE_MAX - ALIGNMENT) return NULL;
    const size_t rounded = bytes ? (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT : ALIGNMENT;
    void *memory = aligned_alloc(ALIGNMENT, rounded);
    if (memory) memset(memory, 0, rounded);
    return memory;
}

static void service_release(void *context, void *pointer) {
    (void)context;
    free(pointer);
}

/* update calls this from several threads: the flag keeps one text whole. The last text stays. */
static void service_message(void *context, const char *text) {
    ab_service *service = context;
    while (atomic_flag_test_and_set_explicit(&service->busy, memory_order_acquire)) {}
    snprintf(service->message, sizeof service->message, "%s", text ? text : "(no text)");
    atomic_flag_clear_explicit(&service->busy, memory_order_release);
}

static void service_log(void *context, const char *text) {
    const ab_service *service = context;
    fprintf(stderr, "%s: %s\n", service->who, text ? text : "");
}

void ab_service_init(ab_service *service, const char *who) {
    memset(service, 0, sizeof *service);
    atomic_flag_clear(&service->busy);
    snprintf(service->who, sizeof service->who, "%s", who);
    service->host = (ab_host){.struct_size = sizeof(ab_host),
                              .abi_major = AB_ABI_MAJOR,
                              .abi_minor = AB_ABI_MINOR,
                              .context = service,
                              .allocate = service_allocate,
                              .release = service_release,
                              .message = service_message,
                              .log = service_log};
}
