#pragma once
/// \file
/// How many threads the loops use.

namespace quicksand {

/// Sets the number of threads of all loops to come; 0 leaves OpenMP's choice.
void set_threads(int count);
/// Number of threads of the loops to come.
int thread_count();

}  // namespace quicksand
