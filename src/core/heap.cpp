#include "core/heap.hpp"

#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace quicksand {

void keep_freed_memory() {
#ifdef __GLIBC__
  // The largest that glibc takes; arrays beyond cost more to fill than to map.
  constexpr int largest_kept = 32 << 20;
  constexpr int never = -1;
  ::mallopt(M_MMAP_THRESHOLD, largest_kept);
  ::mallopt(M_TRIM_THRESHOLD, never);
#endif
}

}  // namespace quicksand
