#pragma once
/// \file
/// How many threads the loops use, and the one place where a team of them is started.
#include <cstddef>

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

/// A part [first, last) of a loop, as a plain call: the loops' bodies need not know of OpenMP, nor be compiled twice.
using LoopPart = void (*)(const void* body, std::ptrdiff_t first, std::ptrdiff_t last);
void run_team(std::ptrdiff_t count, LoopPart part, const void* body);

}  // namespace detail

/// Calls body(first, last) on every thread, for equal parts of [0, count) in order. Bodies must not throw: with more
/// than one thread that ends the program.
template <class Body>
void share_among_threads(std::ptrdiff_t count, const Body& body) {
  detail::run_team(
      count,
      [](const void* b, std::ptrdiff_t first, std::ptrdiff_t last) { (*static_cast<const Body*>(b))(first, last); },
      &body);
}

}  // namespace quicksand
