#pragma once
/// \file
/// An archive that keeps what it is given in memory.
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/archive.hpp"

namespace quicksand::testing {

/// Takes values first and gives them back after rewind(); every name once.
class MemoryArchive final : public Archive {
 public:
  bool loading() const override { return loading_; }
  void rewind() { loading_ = true; }
  void exchange(const std::string& name, std::vector<double>& values) override { swap_in(reals_, name, values); }
  void exchange(const std::string& name, std::vector<std::int64_t>& values) override {
    swap_in(integers_, name, values);
  }
  void exchange(const std::string& name, std::string& text) override { swap_in(texts_, name, text); }
  [[noreturn]] void refuse(const std::string& name, const std::string& why) const override {
    throw std::runtime_error(name + ": " + why);
  }

  friend bool operator==(const MemoryArchive& a, const MemoryArchive& b) {
    return a.reals_ == b.reals_ && a.integers_ == b.integers_ && a.texts_ == b.texts_;
  }
  /// Names under which two archives hold other values.
  friend std::string differences(const MemoryArchive& a, const MemoryArchive& b) {
    std::string names;
    for (const auto& [name, values] : a.reals_) {
      const auto other = b.reals_.find(name);
      if (other == b.reals_.end() || other->second != values) names += name + " ";
    }
    for (const auto& [name, values] : a.integers_) {
      const auto other = b.integers_.find(name);
      if (other == b.integers_.end() || other->second != values) names += name + " ";
    }
    return names;
  }

 private:
  template <class T>
  void swap_in(std::map<std::string, T>& stored, const std::string& name, T& value) {
    if (loading_) {
      value = stored.at(name);
    } else if (!stored.emplace(name, value).second) {
      throw std::logic_error("two values are called " + name);
    }
  }

  bool loading_ = false;
  std::map<std::string, std::vector<double>> reals_;
  std::map<std::string, std::vector<std::int64_t>> integers_;
  std::map<std::string, std::string> texts_;
};

}  // namespace quicksand::testing
