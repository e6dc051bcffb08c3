#include "app/progress.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace quicksand {

namespace {

constexpr double seconds_between_redraws = 0.2;

std::string format_duration(double seconds) {
  char text[32];
  if (seconds < 60) {
    std::snprintf(text, sizeof text, "%.0f s", seconds);
  } else if (seconds < 3600) {
    std::snprintf(text, sizeof text, "%.0f min %02.0f s", std::floor(seconds / 60), std::fmod(seconds, 60));
  } else {
    std::snprintf(text, sizeof text, "%.0f h %02.0f min", std::floor(seconds / 3600),
                  std::floor(std::fmod(seconds, 3600) / 60));
  }
  return text;
}

}  // namespace

Progress::Progress(double end, bool quiet) : end_(end), quiet_(quiet), terminal_(isatty(STDOUT_FILENO) != 0) {}

Progress::~Progress() { clear_line(); }

double Progress::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Progress::clear_line() {
  if (drawn_) std::printf("\r\033[K");
  drawn_ = false;
  std::fflush(stdout);
}

void Progress::step(double time, long step, double dt) {
  cell_steps_ += static_cast<double>(cells_);
  const double now = elapsed();
  if (quiet_ || !terminal_ || now - last_drawn_ < seconds_between_redraws) return;
  last_drawn_ = now;
  const double left = time > 0 ? now * (end_ - time) / time : 0;
  std::printf("\r\033[Kt = %.5g of %.5g  step %ld  dt %.3g  %.3g cells/s  %s left", time, end_, step, dt,
              now > 0 ? cell_steps_ / now : 0.0, format_duration(left).c_str());
  drawn_ = true;
  std::fflush(stdout);
}

void Progress::wrote(double time, long step, const std::string& file) {
  if (quiet_) return;
  clear_line();
  std::printf("t = %-10.6g step %-8ld %s\n", time, step, file.c_str());
  std::fflush(stdout);
}

void Progress::say(const std::string& text) {
  if (quiet_) return;
  clear_line();
  std::printf("%s\n", text.c_str());
  std::fflush(stdout);
}

}  // namespace quicksand
