/* wrong_save.c: it saves what it remembers and cannot read it again. */
#include "abut_plugin.h"
static int save(void *self, const ab_stream *stream) { return (void)self, stream->write(stream->context, "", 1); }
#define SAVE save
#include "wrong.h"
