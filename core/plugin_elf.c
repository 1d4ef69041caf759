/* plugin_elf.c: finds a data symbol in a shared object and reads its first bytes, from the file and with nothing loaded. */
#include "core/plugin_elf.h"

#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SEGMENTS_MAX = 256, DYNAMIC_MAX = 4096, CHAIN_MAX = 1 << 20 };

typedef struct image {
    int file;
    uint64_t size;
    ElfW(Ehdr) header;
    ElfW(Phdr) segment[SEGMENTS_MAX];
    ElfW(Addr) symbols, strings, gnu_hash, sysv_hash; /* addresses from the dynamic table; 0: not there */
    uint64_t strings_size;
} image;

bool ab_refuse(ab_refusal *refusal, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(refusal->text, sizeof refusal->text, format, arguments);
    va_end(arguments);
    return false;
}

/* `bytes` bytes at `offset` of the file; false past its end. */
static bool read_file(const image *elf, uint64_t offset, void *buffer, uint64_t bytes) {
    if (offset > elf->size || bytes > elf->size - offset) return false;
    char *to = buffer;
    while (bytes > 0) {
        const ssize_t got = pread(elf->file, to, (size_t)bytes, (off_t)offset);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        to += got, offset += (uint64_t)got, bytes -= (uint64_t)got;
    }
    return true;
}

/* `bytes` bytes at a virtual address, where they come from the file and not from zero filling. */
static bool read_address(const image *elf, ElfW(Addr) address, void *buffer, uint64_t bytes) {
    for (size_t s = 0; s < elf->header.e_phnum; s++) {
        const ElfW(Phdr) *segment = &elf->segment[s];
        if (segment->p_type != PT_LOAD || address < segment->p_vaddr) continue;
        const uint64_t inside = address - segment->p_vaddr;
        if (inside < segment->p_filesz && bytes <= segment->p_filesz - inside)
            return read_file(elf, segment->p_offset + inside, buffer, bytes);
    }
    return false;
}

static bool read_header(image *elf, ab_refusal *refusal) {
    ElfW(Ehdr) *header = &elf->header;
    const int own_class = sizeof(void *) == 8 ? ELFCLASS64 : ELFCLASS32;
    if (!read_file(elf, 0, header->e_ident, EI_NIDENT) || memcmp(header->e_ident, ELFMAG, SELFMAG) != 0)
        return ab_refuse(refusal, "is not a shared object (it does not begin as an ELF file does)");
    if (!read_file(elf, 0, header, sizeof *header)) return ab_refuse(refusal, "is damaged: it ends inside its header");
    if (header->e_ident[EI_CLASS] != own_class)
        return ab_refuse(refusal, "is an object for machines with %s-bit addresses; build it for this one",
                         header->e_ident[EI_CLASS] == ELFCLASS32 ? "32" : "64");
    ElfW(Ehdr) own; /* what this program runs on */
    const int self = open("/proc/self/exe", O_RDONLY | O_CLOEXEC);
    if (self >= 0) {
        const bool read_own = pread(self, &own, sizeof own, 0) == (ssize_t)sizeof own;
        close(self);
        if (read_own && (own.e_machine != header->e_machine || own.e_ident[EI_DATA] != header->e_ident[EI_DATA]))
            return ab_refuse(refusal, "is an object for another machine (ELF machine %u, this program is %u); build it for this one",
                             (unsigned)header->e_machine, (unsigned)own.e_machine);
    }
    if (header->e_type != ET_DYN) return ab_refuse(refusal, "is an ELF file but not a shared object; link it with -shared");
    if (header->e_phentsize != sizeof(ElfW(Phdr)) || header->e_phnum == 0 || header->e_phnum > SEGMENTS_MAX)
        return ab_refuse(refusal, "is damaged: its program headers make no sense");
    if (!read_file(elf, header->e_phoff, elf->segment, header->e_phnum * sizeof *elf->segment))
        return ab_refuse(refusal, "is damaged: it ends inside its program headers");
    const uint64_t sections = (uint64_t)header->e_shnum * header->e_shentsize; /* mostly the last thing in the file; may be stripped off */
    if (header->e_shoff != 0 && (header->e_shoff > elf->size || sections > elf->size - header->e_shoff))
        return ab_refuse(refusal,
                         "is damaged: it is %llu bytes long and its section headers should stand at byte %llu; copy or build it again",
                         (unsigned long long)elf->size, (unsigned long long)header->e_shoff);
    for (size_t s = 0; s < header->e_phnum; s++) { /* the loader maps what is missing and dies on the first touch */
        const ElfW(Phdr) *segment = &elf->segment[s];
        if (segment->p_type == PT_LOAD && (segment->p_offset > elf->size || segment->p_filesz > elf->size - segment->p_offset))
            return ab_refuse(refusal, "is damaged: it is %llu bytes long and should go on to byte %llu; copy or build it again",
                             (unsigned long long)elf->size, (unsigned long long)(segment->p_offset + segment->p_filesz));
    }
    return true;
}

static bool read_dynamic(image *elf, ab_refusal *refusal) {
    const ElfW(Phdr) *table = NULL;
    for (size_t s = 0; s < elf->header.e_phnum; s++)
        if (elf->segment[s].p_type == PT_DYNAMIC) table = &elf->segment[s];
    if (!table) return ab_refuse(refusal, "is an ELF file without a dynamic table; link it with -shared");
    const uint64_t count = table->p_filesz / sizeof(ElfW(Dyn));
    for (uint64_t i = 0; i < count && i < DYNAMIC_MAX; i++) {
        ElfW(Dyn) entry;
        if (!read_file(elf, table->p_offset + i * sizeof entry, &entry, sizeof entry))
            return ab_refuse(refusal, "is damaged: it ends inside its dynamic table");
        switch (entry.d_tag) {
        case DT_SYMTAB: elf->symbols = entry.d_un.d_ptr; break;
        case DT_STRTAB: elf->strings = entry.d_un.d_ptr; break;
        case DT_STRSZ: elf->strings_size = entry.d_un.d_val; break;
        case DT_GNU_HASH: elf->gnu_hash = entry.d_un.d_ptr; break;
        case DT_HASH: elf->sysv_hash = entry.d_un.d_ptr; break;
        default: break;
        }
        if (entry.d_tag == DT_NULL) break;
    }
    if (!elf->symbols || !elf->strings || (!elf->gnu_hash && !elf->sysv_hash))
        return ab_refuse(refusal, "is damaged: its dynamic table has no symbols");
    return true;
}

/* True when symbol number `index` has that name; it is then in *symbol. */
static bool symbol_is(const image *elf, uint32_t index, const char *name, ElfW(Sym) * symbol) {
    char text[64];
    const size_t length = strlen(name) + 1;
    return length <= sizeof text && read_address(elf, elf->symbols + (ElfW(Addr))index * sizeof *symbol, symbol, sizeof *symbol) &&
           symbol->st_name < elf->strings_size && length <= elf->strings_size - symbol->st_name &&
           read_address(elf, elf->strings + symbol->st_name, text, length) && memcmp(text, name, length) == 0;
}

static bool find_by_gnu_hash(const image *elf, const char *name, ElfW(Sym) * symbol) {
    uint32_t hash = 5381, head[4], index, word; /* head: buckets, first symbol, words of the filter, its shift */
    for (const unsigned char *c = (const unsigned char *)name; *c; c++) hash = hash * 33 + *c;
    if (!read_address(elf, elf->gnu_hash, head, sizeof head) || head[0] == 0) return false;
    const ElfW(Addr) buckets = elf->gnu_hash + sizeof head + (ElfW(Addr))head[2] * sizeof(ElfW(Addr));
    const ElfW(Addr) chains = buckets + (ElfW(Addr))head[0] * sizeof(uint32_t);
    if (!read_address(elf, buckets + (ElfW(Addr))(hash % head[0]) * sizeof index, &index, sizeof index) || index < head[1] || index == 0)
        return false;
    for (long steps = 0; steps < CHAIN_MAX; steps++, index++) {
        if (!read_address(elf, chains + (ElfW(Addr))(index - head[1]) * sizeof word, &word, sizeof word)) return false;
        if ((word | 1u) == (hash | 1u) && symbol_is(elf, index, name, symbol)) return true;
        if (word & 1u) return false;
    }
    return false;
}

static bool find_by_sysv_hash(const image *elf, const char *name, ElfW(Sym) * symbol) {
    uint32_t hash = 0, head[2], index; /* head: buckets, symbols */
    for (const unsigned char *c = (const unsigned char *)name; *c; c++) {
        hash = (hash << 4) + *c;
        const uint32_t high = hash & 0xf0000000u;
        hash = (hash ^ (high >> 24)) & ~high;
    }
    if (!read_address(elf, elf->sysv_hash, head, sizeof head) || head[0] == 0) return false;
    const ElfW(Addr) buckets = elf->sysv_hash + sizeof head, chains = buckets + (ElfW(Addr))head[0] * sizeof index;
    if (!read_address(elf, buckets + (ElfW(Addr))(hash % head[0]) * sizeof index, &index, sizeof index)) return false;
    for (long steps = 0; index != 0 && index < head[1] && steps < CHAIN_MAX; steps++) {
        if (symbol_is(elf, index, name, symbol)) return true;
        if (!read_address(elf, chains + (ElfW(Addr))index * sizeof index, &index, sizeof index)) return false;
    }
    return false;
}

static bool read_head(image *elf, const char *name, ab_plugin_head *head, ab_refusal *refusal) {
    ElfW(Sym) symbol;
    if (!read_header(elf, refusal) || !read_dynamic(elf, refusal)) return false;
    const bool found = elf->gnu_hash ? find_by_gnu_hash(elf, name, &symbol) : find_by_sysv_hash(elf, name, &symbol);
    if (!found || symbol.st_shndx == SHN_UNDEF)
        return ab_refuse(refusal, "has no symbol '%s', so it is not an abut plugin; define `AB_EXPORT const ab_plugin %s`", name, name);
    const int type = symbol.st_info & 0xf; /* ELF64_ST_TYPE and ELF32_ST_TYPE alike */
    if (type != STT_OBJECT)
        return ab_refuse(refusal, "has a symbol '%s' that is %s, not data; define `AB_EXPORT const ab_plugin %s`", name,
                         type == STT_FUNC || type == STT_GNU_IFUNC ? "a function"
                         : type == STT_TLS                         ? "thread-local"
                                                                   : "of no known type",
                         name);
    const size_t bytes = offsetof(ab_plugin_head, symbol_size);
    head->symbol_size = symbol.st_size;
    if (symbol.st_size < bytes)
        return ab_refuse(refusal, "has a descriptor '%s' of only %llu bytes", name, (unsigned long long)symbol.st_size);
    if (!read_address(elf, symbol.st_value, head, bytes))
        return ab_refuse(refusal, "has a descriptor '%s' whose content is not in the file; it must be initialised data", name);
    return true;
}

bool ab_elf_read_head(const char *path, const char *symbol, ab_plugin_head *head, ab_refusal *refusal) {
    struct stat status;
    image *elf = calloc(1, sizeof *elf);
    if (!elf) return ab_refuse(refusal, "cannot be read: no memory");
    bool good = false;
    elf->file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* nonblocking: a pipe of that name must not hang the program */
    if (elf->file < 0 || fstat(elf->file, &status) != 0) {
        ab_refuse(refusal, "cannot be read: %s", strerror(errno));
    } else if (!S_ISREG(status.st_mode)) {
        ab_refuse(refusal, "is not a file");
    } else {
        elf->size = (uint64_t)status.st_size;
        good = read_head(elf, symbol, head, refusal);
    }
    if (elf->file >= 0) close(elf->file);
    free(elf);
    return good;
}
