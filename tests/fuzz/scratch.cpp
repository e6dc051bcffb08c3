// The folder of the fuzzed functions.
#include <stdlib.h>

#include <stdexcept>

#include "fuzz/fuzz.hpp"

namespace quicksand::fuzz {

namespace {

struct Scratch {
  Scratch() {
    std::string name = (std::filesystem::exists("/dev/shm") ? "/dev/shm" : "/tmp") + std::string("/quicksand_XXXXXX");
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for scratch files");
    path = name;
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  std::filesystem::path path;
};

}  // namespace

const std::filesystem::path& scratch_folder() {
  static const Scratch scratch;
  return scratch.path;
}

}  // namespace quicksand::fuzz
