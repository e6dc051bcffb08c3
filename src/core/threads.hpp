#pragma once
/// \file
/// How many threads the loops use, and the one place where a team of them is started.
#include <chrono>
#include <cstddef>
#include <limits>

namespace quicksand {

/// Lets threads that wait for work give up their processor after a tenth of a millisecond, bound ones after a
/// millisecond or two, unless the environment says how they are to wait. OpenMP reads this before main() begins, so the
/// program starts itself anew once.
///
/// Threads that spin, as is the custom, slow each other and all other programs down on a busy machine: two may then
/// take many times as long as one. \param arguments  argv of main()
void start_with_patient_threads(char** arguments);

/// Sets the number of threads of all loops to come; 0 leaves OpenMP's choice.
void set_threads(int count);
/// Number of threads of the loops to come.
int thread_count();

namespace detail {

/// From when on loops take fewer threads.
struct TimeLimit {
  std::chrono::steady_clock::time_point end = std::chrono::steady_clock::time_point::max();
  int fewer = 1;
};

}  // namespace detail

/// Sets the number of threads for its life, or for a time: that bounds how long a busy machine can make a piece of work
/// wait. Scopes may be nested; the innermost one counts.
class ThreadScope {
 public:
  /// \param count    threads of the loops that begin within `seconds` from now
  /// \param fewer    threads of those that begin later
  explicit ThreadScope(int count, double seconds = std::numeric_limits<double>::infinity(), int fewer = 1);
  ~ThreadScope();
  ThreadScope(const ThreadScope&) = delete;
  ThreadScope& operator=(const ThreadScope&) = delete;

 private:
  int count_before_;
  detail::TimeLimit limit_before_;
};

namespace detail {

/// A part [first, last) of a loop, as a plain call: the loops' bodies need not know of OpenMP, nor be compiled twice.
using LoopPart = void (*)(const void* body, std::ptrdiff_t first, std::ptrdiff_t last);
void run_team(std::ptrdiff_t count, LoopPart part, const void* body);

}  // namespace detail

/// Calls body(first, last) on all threads for pieces of [0, count). Every thread begins with its
/// part of equal ones, in order, which keeps data in the caches from loop to loop; one that is through helps others,
/// since the liquid is not everywhere and neither are a machine's other users. Bodies must not throw: with more than
/// one thread that ends the program.
template <class Body>
void share_among_threads(std::ptrdiff_t count, const Body& body) {
  detail::run_team(
      count,
      [](const void* b, std::ptrdiff_t first, std::ptrdiff_t last) { (*static_cast<const Body*>(b))(first, last); },
      &body);
}

}  // namespace quicksand
