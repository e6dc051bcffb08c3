#pragma once
/// \file
/// The kinds of failure a user can meet. Each maps to one exit code of the program.
#include <stdexcept>
#include <string>

namespace quicksand {

/// Wrong input (configuration, command line): exit code 2. The message names file, line and key.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A solve that failed or a state that is not finite: exit code 3.
struct NumericalError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reading or writing failed: exit code 4.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace quicksand
