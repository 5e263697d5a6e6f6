#include "core/arrangement/sweep_status.hpp"

namespace vorotool::core::arrangement {

std::int32_t SweepStatus::new_place() {
  if (!free_.empty()) {
    const std::int32_t place = free_.back();
    free_.pop_back();
    return place;
  }
  const auto place = static_cast<std::int32_t>(nodes_.size());
  auto hash = static_cast<std::uint32_t>(place) * 0x9E3779B9U;  // Fibonacci hashing, then mixed
  hash = (hash ^ hash >> 15) * 0x85EBCA6BU;
  nodes_.push_back({none, none, none, none, none, none, hash ^ hash >> 13});
  return place;
}

void SweepStatus::replace_child(std::int32_t parent, std::int32_t old_child, std::int32_t child) {
  if (parent == none) {
    root_ = child;
  } else if (node(parent).left == old_child) {
    node(parent).left = child;
  } else {
    node(parent).right = child;
  }
  if (child != none) node(child).parent = parent;
}

// Rotates a node above its parent.
void SweepStatus::lift(std::int32_t place) {
  const std::int32_t parent = node(place).parent;
  replace_child(node(parent).parent, parent, place);
  if (node(parent).left == place) {
    const std::int32_t inner = node(place).right;
    node(parent).left = inner;
    if (inner != none) node(inner).parent = parent;
    node(place).right = parent;
  } else {
    const std::int32_t inner = node(place).left;
    node(parent).right = inner;
    if (inner != none) node(inner).parent = parent;
    node(place).left = parent;
  }
  node(parent).parent = place;
}

std::int32_t SweepStatus::insert(std::int32_t segment, std::int32_t below, std::int32_t above) {
  const std::int32_t place = new_place();
  Node& fresh = node(place);
  fresh.segment = segment;
  fresh.left = fresh.right = fresh.parent = none;
  fresh.below = below;
  fresh.above = above;
  if (below != none) node(below).above = place;
  if (above != none) node(above).below = place;
  // of two neighbors one is in the subtree of the other: the free place is right of the lower or left of the
  // upper
  if (below != none && node(below).right == none) {
    node(below).right = place;
    fresh.parent = below;
  } else if (above != none) {
    node(above).left = place;
    fresh.parent = above;
  } else {
    root_ = place;
  }
  while (node(place).parent != none && node(node(place).parent).priority < node(place).priority) lift(place);
  return place;
}

void SweepStatus::erase(std::int32_t place) {
  while (node(place).left != none && node(place).right != none) {
    const std::int32_t left = node(place).left, right = node(place).right;
    lift(node(left).priority > node(right).priority ? left : right);
  }
  const Node& gone = node(place);
  replace_child(gone.parent, place, gone.left != none ? gone.left : gone.right);
  if (gone.below != none) node(gone.below).above = gone.above;
  if (gone.above != none) node(gone.above).below = gone.below;
  free_.push_back(place);
}

}  // namespace vorotool::core::arrangement
