#include "core/threads.hpp"

#include <omp.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <optional>
#include <vector>

namespace quicksand {

namespace {

using Clock = std::chrono::steady_clock;

/// Of the innermost scope: like OpenMP's own number of threads it belongs to the thread that starts the loops.
thread_local detail::TimeLimit limit;

constexpr double longest_limit = 1e6;  ///< seconds; more are none

/// Pieces of a loop that are left of a thread's part: it takes them from the front, and threads that are through with
/// theirs from the back.
class alignas(64) Share {
 public:
  void set(std::uint32_t first, std::uint32_t last) { ends_.store(packed(first, last), std::memory_order_relaxed); }
  std::optional<std::uint32_t> take_first() { return take(true); }
  std::optional<std::uint32_t> take_last() { return take(false); }

 private:
  static std::uint64_t packed(std::uint32_t first, std::uint32_t last) {
    return static_cast<std::uint64_t>(first) << 32 | last;
  }

  std::optional<std::uint32_t> take(bool front) {
    // Numbers of pieces are all that threads tell each other here: what bodies write is ordered by the loop's ends.
    std::uint64_t ends = ends_.load(std::memory_order_relaxed);
    while (true) {
      const auto first = static_cast<std::uint32_t>(ends >> 32);
      const auto last = static_cast<std::uint32_t>(ends);
      if (first == last) return std::nullopt;
      const std::uint64_t rest = front ? packed(first + 1, last) : packed(first, last - 1);
      if (ends_.compare_exchange_weak(ends, rest, std::memory_order_relaxed)) return front ? first : last - 1;
    }
  }

  std::atomic<std::uint64_t> ends_;
};

/// Few enough that taking them costs nothing, and enough that threads are through at the same time.
constexpr std::ptrdiff_t pieces_of_share = 8;

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
    limit.fewer = std::max(fewer, 1);
  }
}

ThreadScope::~ThreadScope() {
  set_threads(count_before_);
  limit = limit_before_;
}

void detail::run_team(std::ptrdiff_t count, LoopPart part, const void* body) {
  int threads = thread_count();
  if (threads > limit.fewer && limit.end < Clock::time_point::max() && Clock::now() > limit.end) {
    threads = limit.fewer;
    set_threads(threads);
  }
  if (threads == 1 || count == 1) {
    part(body, 0, count);
    return;
  }
  const std::ptrdiff_t pieces = std::min(count, threads * pieces_of_share);
  const auto run = [&](std::uint32_t piece) { part(body, count * piece / pieces, count * (piece + 1) / pieces); };
  const auto begin = [&](int t) { return static_cast<std::uint32_t>(pieces * t / threads); };
  std::vector<Share> shares(static_cast<std::size_t>(threads));
  for (int t = 0; t < threads; ++t) shares[static_cast<std::size_t>(t)].set(begin(t), begin(t + 1));
#pragma omp parallel num_threads(threads)
  {
    const auto own = static_cast<std::size_t>(omp_get_thread_num());
    while (const auto piece = shares[own].take_first()) run(*piece);
    for (std::size_t k = 1; k < shares.size(); ++k) {
      Share& other = shares[(own + k) % shares.size()];
      while (const auto piece = other.take_last()) run(*piece);
    }
  }
}

}  // namespace quicksand
