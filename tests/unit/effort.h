/* effort.h: how much a unit test does of the same: all of it as a rule, less under a sanitizer, which makes it many times as long and looks at the same lines. */
#ifndef EFFORT_H
#define EFFORT_H

#ifndef __has_feature /* clang's way of saying what gcc says by macros */
#define __has_feature(x) 0
#endif
#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__ || __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define EFFORT(all, sanitized) (sanitized)
#else
#define EFFORT(all, sanitized) (all)
#endif

#endif
