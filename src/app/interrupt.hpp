#pragma once
/// \file
/// Ending a run early on the user's wish.

namespace quicksand {

/// From now on SIGINT and SIGTERM are noted instead of ending the program; a second SIGINT ends it as usual. Signals
/// that the program was started to ignore stay ignored.
void catch_interrupts();
/// The signal noted, 0 if none.
int interrupt_signal();

}  // namespace quicksand
