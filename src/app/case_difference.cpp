#include "app/case_difference.hpp"

#include <algorithm>
#include <iterator>

#include "app/case_codec.hpp"

namespace quicksand {

namespace {

constexpr const char* free_keys[] = {"time.end", "time.until_steady", "output"};

std::string text_of(const ConfigNode* node) {
  if (node == nullptr) return "absent";
  if (node->kind == ConfigNode::Kind::scalar) return node->text;
  return std::to_string(node->children.size()) + (node->kind == ConfigNode::Kind::list ? " items" : " keys");
}

std::optional<std::string> difference(const std::string& path, const ConfigNode* before, const ConfigNode* now) {
  if (std::find(std::begin(free_keys), std::end(free_keys), path) != std::end(free_keys)) return {};
  const auto differ = [&] { return path + " was " + text_of(before) + ", is " + text_of(now); };
  if (before == nullptr || now == nullptr || before->kind != now->kind) return differ();
  if (before->kind == ConfigNode::Kind::list) {
    if (before->children.size() != now->children.size()) return differ();
    for (std::size_t i = 0; i < now->children.size(); ++i) {
      if (auto found = difference(child_path(path, i), &before->children[i], &now->children[i])) return found;
    }
    return {};
  }
  if (before->kind != ConfigNode::Kind::map) {
    return before->text == now->text ? std::nullopt : std::optional(differ());
  }
  for (const ConfigNode& child : now->children) {
    if (auto found = difference(child_path(path, child.key), before->find(child.key), &child)) return found;
  }
  for (const ConfigNode& child : before->children) {
    if (now->find(child.key) != nullptr) continue;
    if (auto found = difference(child_path(path, child.key), &child, nullptr)) return found;
  }
  return {};
}

}  // namespace

std::optional<std::string> difference_that_matters(const CaseConfig& before, const CaseConfig& now) {
  const ConfigNode then = case_codec().write(before);
  const ConfigNode today = case_codec().write(now);
  return difference("", &then, &today);
}

}  // namespace quicksand
