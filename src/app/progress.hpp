#pragma once
/// \file
/// What a run tells its user while it goes on.
#include <chrono>
#include <string>

namespace quicksand {

/// On a terminal a line that is redrawn: time, step, dt, cells per second, time left. In a pipe one line per output and
/// no control codes.
class Progress {
 public:
  Progress(double end, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// The steps that follow are on a grid with so many cells.
  void begin_grid(long cells) { cells_ = cells; }
  /// Called after every step; redraws a few times a second.
  void step(double time, long step, double dt);
  /// Called when fields were written.
  void wrote(double time, long step, const std::string& file);
  /// A message on a line of its own.
  void say(const std::string& text);

 private:
  double elapsed() const;
  void clear_line();

  double end_;
  long cells_ = 0;
  double cell_steps_ = 0;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double last_drawn_ = -1;
};

}  // namespace quicksand
