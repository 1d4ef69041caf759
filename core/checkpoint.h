/* checkpoint.h: the state of a run in one file. Every part of a run has one function that says what its state is, item by item; the same function saves it and
 * brings it back, so that nothing can be saved and forgotten when it is read, or the other way round.
 *
 * The file: a head (name, format, byte order, bytes in all, check sum, version), then records {length of the name, type, count, name, values}, each padded to eight
 * bytes. It is read as a whole, held against its length and its check sum (CRC-32), and cut into records before anything looks at them. Not HDF5: the bits of one
 * version of one program need no other reader, and a file that a crash or a full disk has cut off has to be told for sure. */
#ifndef AB_CHECKPOINT_H
#define AB_CHECKPOINT_H

#include <stdint.h>

#include "abut_plugin.h"
#include "core/report.h"

/* In the folder of the results. */
#define AB_CHECKPOINT_NAME "checkpoint.abut"
#define AB_CHECKPOINT_PREVIOUS "checkpoint.previous.abut"

typedef struct ab_checkpoint ab_checkpoint;

/* A new file beside `path`, which takes its place in ab_checkpoint_commit. */
ab_status ab_checkpoint_create(const char *path, ab_checkpoint **checkpoint, ab_report *report);
/* Puts the file on the disk for good (fsync), under its name; the one that had the name before becomes `previous`. At every moment there is a whole file of the name.
 * Reports what failed since the creation, a full disk above all; then the one before is kept. */
ab_status ab_checkpoint_commit(ab_checkpoint *checkpoint, const char *previous);
/* Reads a file. A file of another version, damaged or cut off: AB_BAD_INPUT with name and cause. */
ab_status ab_checkpoint_open(const char *path, ab_checkpoint **checkpoint, ab_report *report);
void ab_checkpoint_destroy(ab_checkpoint *checkpoint); /* a new file that was not committed is gone */

bool ab_checkpoint_loads(const ab_checkpoint *checkpoint); /* items are brought back; false: they are saved */
ab_report *ab_checkpoint_report(const ab_checkpoint *checkpoint);
const char *ab_checkpoint_path(const ab_checkpoint *checkpoint);
/* AB_OK until the first item that failed; everything after that does nothing. The cause is in the report. */
ab_status ab_checkpoint_status(const ab_checkpoint *checkpoint);
/* What was brought back cannot be, or there is no memory for it (printf): ends the loading with the name of the file. Returns false. */
bool ab_checkpoint_refuse(ab_checkpoint *checkpoint, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Names of the items that follow begin with this; sections may stand in each other. */
void ab_checkpoint_enter(ab_checkpoint *checkpoint, const char *format, ...) __attribute__((format(printf, 2, 3)));
void ab_checkpoint_leave(ab_checkpoint *checkpoint);

/* Each saves `count` values, or brings them back where the file has as many of that name and type. False: nothing was changed, see ab_checkpoint_status. */
bool ab_keep_doubles(ab_checkpoint *checkpoint, const char *name, double *values, size_t count);
bool ab_keep_u64(ab_checkpoint *checkpoint, const char *name, uint64_t *values, size_t count);
bool ab_keep_u32(ab_checkpoint *checkpoint, const char *name, uint32_t *values, size_t count);
bool ab_keep_bytes(ab_checkpoint *checkpoint, const char *name, void *values, size_t count);
bool ab_keep_flags(ab_checkpoint *checkpoint, const char *name, bool *values, size_t count);
bool ab_keep_long(ab_checkpoint *checkpoint, const char *name, long *value);
bool ab_keep_size(ab_checkpoint *checkpoint, const char *name, size_t *value);
/* The length of lists that follow, `each` bytes an entry: one that the file has no room for is refused, so it may be trusted with memory. */
bool ab_keep_count(ab_checkpoint *checkpoint, const char *name, size_t *count, size_t each);
/* A struct made of doubles alone. */
#define ab_keep_struct(checkpoint, name, pointer) ab_keep_doubles(checkpoint, name, (double *)(pointer), sizeof *(pointer) / sizeof(double))

/* Bytes whose number only the writer knows. Loading: they stay the checkpoint's; NULL: there are none of that name, and that is no failure. */
bool ab_checkpoint_put(ab_checkpoint *checkpoint, const char *name, const void *bytes, size_t count);
const void *ab_checkpoint_get(ab_checkpoint *checkpoint, const char *name, size_t *count);

/* What an instance of a plugin keeps beside its declared states, by its save and load; nothing for a class without them. */
bool ab_keep_plugin(ab_checkpoint *checkpoint, const char *name, const ab_class *class_, void *self);

#endif
