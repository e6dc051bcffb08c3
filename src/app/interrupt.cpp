#include "app/interrupt.hpp"

#include <atomic>
#include <csignal>

namespace quicksand {

namespace {

std::atomic<int> noted_signal = 0;
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may touch nothing else");

void note(int signal) { noted_signal = signal; }

}  // namespace

void catch_interrupts() {
  noted_signal = 0;
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = note;
    // Not for SIGTERM, which timeout(1) and batch systems may send more than once.
    action.sa_flags = SA_RESTART | (signal == SIGINT ? static_cast<int>(SA_RESETHAND) : 0);
    sigaction(signal, &action, nullptr);
  }
}

int interrupt_signal() { return noted_signal; }

}  // namespace quicksand
