/* plugin_elf.h: what an object file says about itself before any of its code runs.
 *
 * dlopen runs constructors, so the first numbers of a descriptor are read from the file. The reader follows the way the loader of the system
 * goes (program headers, dynamic table, symbol hash), not the section headers, which a file may lack or which may tell another story. It is
 * a few functions on <elf.h>; libelf would save the structs, which the C library brings anyway, and none of the bounds checks. */
#ifndef AB_PLUGIN_ELF_H
#define AB_PLUGIN_ELF_H

#include <stdbool.h>
#include <stdint.h>

typedef struct ab_plugin_head { /* the first fields of every ab_plugin of every version; none of them is relocated */
    uint32_t struct_size, abi_major, abi_minor, size_of_double, size_of_size_t, class_count;
    uint64_t symbol_size; /* bytes of the symbol, from the symbol table */
} ab_plugin_head;

typedef struct ab_refusal {
    char text[600];
} ab_refusal; /* why a file is not taken, as the end of "FILE: ..." */

/* Formats the reason; returns false, so that `return ab_refuse(...)` reads well. */
bool ab_refuse(ab_refusal *refusal, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Reads the head of the data symbol `symbol` from the image of an object file. Every offset in the file is checked against its size.
 * head: out. False with the reason when the file is no whole shared object of this machine or has no such data. */
bool ab_elf_read_head(const char *path, const char *symbol, ab_plugin_head *head, ab_refusal *refusal);

#endif
