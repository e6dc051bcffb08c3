#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "app/command_line.hpp"
#include "core/errors.hpp"
#include "core/heap.hpp"
#include "core/threads.hpp"

/// Runs the command line; the only place where failures become exit codes.
int main(int argc, char** argv) {
  using namespace quicksand;
  start_with_patient_threads(argv);
  keep_freed_memory();
  const auto fail = [](const char* message, int code) {
    std::cerr << message << '\n';
    return code;
  };
  try {
    const int code = execute(parse_command_line({argv + 1, argv + argc}), std::cout, std::cerr);
    std::cout.flush();
    if (!std::cout) return fail("standard output: can't be written", 4);
    return code;
  } catch (const InputError& error) {
    return fail(error.what(), 2);
  } catch (const NumericalError& error) {
    return fail(error.what(), 3);
  } catch (const FileError& error) {
    return fail(error.what(), 4);
  } catch (const std::bad_alloc&) {
    return fail("out of memory: the grid has too many cells for this machine", 3);
  } catch (const std::exception& error) {
    return fail((std::string("internal error: ") + error.what()).c_str(), 1);
  }
}
