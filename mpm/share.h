/* share.h: the tiles of a body among threads.
 *
 * Every thread has a run of tiles that lie side by side and hold as many points as any other's, and has the same run in every pass: what it wrote in one pass
 * (patches, nodes, points) is in its own cache in the next. A thread that is through with its run takes tiles from the far end of another's, so none waits
 * for one that was held up. Tiles are visited in any order by any thread, so a visit may write only what belongs to its tile. */
#ifndef AB_MPM_SHARE_H
#define AB_MPM_SHARE_H

#include "mpm/body.h"

typedef void (*mpm_visit)(mpm_body *, size_t tile, void *context);

/* Every tile once; returns when all are done. */
void mpm_each_tile(mpm_body *, mpm_visit, void *context);
void mpm_share_destroy(mpm_body *);

#endif
