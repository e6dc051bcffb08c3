#pragma once
/// \file
/// How the process deals with memory that it frees.

namespace quicksand {

/// Keeps freed memory for the next allocation in place of giving it back to the system. Work arrays come and go with
/// the phases of every step; fresh pages for them would take a tenth of the time of a small case. Does nothing where
/// the C library is not glibc.
void keep_freed_memory();

}  // namespace quicksand
