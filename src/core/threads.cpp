#include "core/threads.hpp"

#include <omp.h>
#include <sched.h>
#include <unistd.h>

#include <cstdlib>
#include <initializer_list>
#include <vector>

namespace quicksand {

namespace {

/// Of the innermost scope: like OpenMP's own number of threads it belongs to the thread that starts the loops.
thread_local ThreadScope::Limit limit;

constexpr double longest_limit = 1e6;  ///< seconds; more are none

/// Undoes what OpenMP has done where threads are to be bound: it has tied this thread to one processor, which would be
/// the only one that a program started anew finds.
void untie() {
  cpu_set_t processors;
  CPU_ZERO(&processors);
  for (int place = 0; place < omp_get_num_places(); ++place) {
    std::vector<int> ids(static_cast<std::size_t>(omp_get_place_num_procs(place)));
    omp_get_place_proc_ids(place, ids.data());
    for (const int id : ids) CPU_SET(static_cast<std::size_t>(id), &processors);
  }
  if (CPU_COUNT(&processors) > 0) ::sched_setaffinity(0, sizeof processors, &processors);
}

}  // namespace

void start_with_patient_threads(char** arguments) {
  // Bound threads have their processors for themselves, so it seems: they may wait through parts of a step on one
  // thread.
  const bool bound = omp_get_proc_bind() != omp_proc_bind_false;
  const char* const rounds = bound ? "100000" : "10000";  // for libgomp: one or two milliseconds, or a tenth
  const char* const milliseconds = bound ? "1" : "0";     // for clang's library
  for (const char* name : {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT", "KMP_BLOCKTIME"}) {
    if (std::getenv(name) != nullptr) return;
  }
  ::setenv("GOMP_SPINCOUNT", rounds, 1);
  ::setenv("KMP_BLOCKTIME", milliseconds, 1);
  untie();
  ::execv("/proc/self/exe", arguments);
  // Where that is not possible the program goes on as it is.
}

void set_threads(int count) {
  if (count > 0) omp_set_num_threads(count);
}

int thread_count() { return omp_get_max_threads(); }

ThreadScope::ThreadScope(int count, double seconds, int fewer) : count_before_(thread_count()), limit_before_(limit) {
  set_threads(count);
  limit = {};
  if (seconds < longest_limit) {
    limit.end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    limit.fewer = fewer;
  }
}

ThreadScope::~ThreadScope() {
  set_threads(count_before_);
  limit = limit_before_;
}

void detail::run_team(std::ptrdiff_t count, LoopPart part, const void* body) {
  int threads = thread_count();
  if (threads > limit.fewer && limit.end < ThreadScope::Clock::time_point::max() &&
      ThreadScope::Clock::now() > limit.end) {
    threads = limit.fewer;
    set_threads(threads);
  }
  if (threads == 1) {
    part(body, 0, count);
    return;
  }
#pragma omp parallel for schedule(static, 1) num_threads(threads)
  for (int t = 0; t < threads; ++t) part(body, count * t / threads, count * (t + 1) / threads);
}

}  // namespace quicksand
