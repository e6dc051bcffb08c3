#pragma once
/// \file
/// How many threads the loops use.

namespace quicksand {

/// Lets threads that wait for work give up their processor after some microseconds, unless the environment says how
/// they are to wait. OpenMP reads this before main() begins, so the program starts itself anew once.
///
/// Threads that spin, as is the custom, slow each other and all other programs down on a busy machine: two may then
/// take many times as long as one. \param arguments  argv of main()
void start_with_patient_threads(char** arguments);

/// Sets the number of threads of all loops to come; 0 leaves OpenMP's choice.
void set_threads(int count);
/// Number of threads of the loops to come.
int thread_count();

}  // namespace quicksand
