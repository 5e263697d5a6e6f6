// Values in groups, side by side in one array: a counting sort.
#pragma once

#include <cstddef>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace vorotool::core::base {

template <class Value>
class Groups {
 public:
  // visit(add) calls add(group, value) for all values. It is called twice, and does the same both times: those
  // of a group come in the order in which they are added.
  template <class Visit>
  Groups(std::size_t count, const Visit& visit) : start_(count + 2) {
    visit([this](auto group, const Value&) { ++start_[static_cast<std::size_t>(group) + 2]; });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    values_.resize(start_.back());
    visit([this](auto group, const Value& value) {
      values_[start_[static_cast<std::size_t>(group) + 1]++] = value;
    });
    start_.pop_back();
  }

  std::size_t size() const { return start_.size() - 1; }

  template <class Index>
  std::span<const Value> operator[](Index group) const {
    const auto g = static_cast<std::size_t>(group);
    return std::span(values_).subspan(start_[g], start_[g + 1] - start_[g]);
  }
  template <class Index>
  std::span<Value> operator[](Index group) {
    const auto g = static_cast<std::size_t>(group);
    return std::span(values_).subspan(start_[g], start_[g + 1] - start_[g]);
  }

  // All of them, group by group.
  std::vector<Value> take() { return std::move(values_); }

 private:
  std::vector<std::size_t> start_;
  std::vector<Value> values_;
};

}  // namespace vorotool::core::base
