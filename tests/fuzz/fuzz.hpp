#pragma once
/// \file
/// What the fuzzed functions share.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace quicksand::fuzz {

/// Bytes of a fuzzer as numbers; zeros when they are used up.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool empty() const { return next_ >= size_; }
  std::uint8_t byte() { return empty() ? std::uint8_t{0} : data_[next_++]; }
  /// A number below n.
  std::size_t below(std::size_t n) {
    const std::size_t high = byte();
    return (256 * high + byte()) % n;
  }
  std::string rest() {
    const std::string text(reinterpret_cast<const char*>(data_ + next_), size_ - next_);
    next_ = size_;
    return text;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t next_ = 0;
};

/// A folder in memory that goes with the process.
const std::filesystem::path& scratch_folder();

}  // namespace quicksand::fuzz

/// The function that is fuzzed; returns 0. What is wrong ends the process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
