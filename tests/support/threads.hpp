#pragma once
/// \file
/// Numbers of threads for parts of a test.
#include "core/threads.hpp"

namespace quicksand::testing {

/// Sets the number of threads for the life of the object.
class Threads {
 public:
  explicit Threads(int count) : before_(thread_count()) { set_threads(count); }
  ~Threads() { set_threads(before_); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  int before_;
};

}  // namespace quicksand::testing
