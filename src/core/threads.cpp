#include "core/threads.hpp"

#include <omp.h>

namespace quicksand {

void set_threads(int count) {
  if (count > 0) omp_set_num_threads(count);
}

int thread_count() { return omp_get_max_threads(); }

}  // namespace quicksand
