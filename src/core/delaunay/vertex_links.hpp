// A planar subdivision as rings: each vertex with its neighbors in counter-clockwise order.
//
// A vertex with few neighbors is one cache line, with its coordinates: what is looked at together lies
// together. An edge is in the rings of both of its ends, and no link leads from one to the other: short rings
// are searched faster than links are followed.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "core/kernel/point.hpp"

namespace vorotool::core::delaunay {

using Vertex = std::int32_t;

// Memory for rings too long for their vertex, given back all at once.
class RingStore {
 public:
  Vertex* take(std::size_t size) {
    if (size > left_) {
      left_ = std::max(size, block_size);
      blocks_.push_back(std::make_unique_for_overwrite<Vertex[]>(left_));
      next_ = blocks_.back().get();
    }
    left_ -= size;
    return std::exchange(next_, next_ + size);
  }

 private:
  static constexpr std::size_t block_size = 4096;
  std::vector<std::unique_ptr<Vertex[]>> blocks_;
  Vertex* next_ = nullptr;
  std::size_t left_ = 0;
};

// A vertex and its ring. It is trivial, so that an array of them costs nothing until it is filled: what it
// has before `clear` has no meaning.
class alignas(64) RingVertex {
 public:
  kernel::Point point;

  void clear(const kernel::Point& place) {
    point = place;
    degree_ = 0;
    is_long_ = false;
  }

  std::uint32_t degree() const { return degree_; }
  const Vertex* ring() const { return is_long_ ? long_.entries : short_.data(); }
  Vertex* ring() { return is_long_ ? long_.entries : short_.data(); }
  Vertex front() const { return ring()[0]; }
  Vertex back() const { return ring()[degree_ - 1]; }

  std::uint32_t after(std::uint32_t place) const { return place + 1 == degree_ ? 0 : place + 1; }
  std::uint32_t before(std::uint32_t place) const { return (place == 0 ? degree_ : place) - 1; }

  // The place of a neighbor in the ring.
  std::uint32_t find(Vertex neighbor) const {
    if (is_long_) return find_outwards(neighbor);
    std::uint32_t place = 0;
    while (short_[place] != neighbor) ++place;
    return place;
  }

  void insert(std::uint32_t place, Vertex neighbor, RingStore& store) {
    const bool in_front = is_long_ && 2 * place < degree_;
    if (!has_room(in_front)) make_room(store);
    Vertex* entries = ring();
    if (in_front) {
      std::copy(entries, entries + place, entries - 1);
      --long_.entries;
    } else {
      std::copy_backward(entries + place, entries + degree_, entries + degree_ + 1);
    }
    ++degree_;
    ring()[place] = neighbor;
    if (is_long_) long_.changed = place;
  }

  void erase(std::uint32_t place) {
    Vertex* entries = ring();
    --degree_;
    if (is_long_ && 2 * place < degree_) {
      std::copy_backward(entries, entries + place, entries + place + 1);
      ++long_.entries;
    } else {
      std::copy(entries + place + 1, entries + degree_ + 1, entries + place);
    }
    if (is_long_) long_.changed = place;
  }

 private:
  // In a long ring it is mostly near the place of the last change.
  std::uint32_t find_outwards(Vertex neighbor) const {
    std::uint32_t high = std::min<std::uint32_t>(long_.changed, degree_ - 1), low = high;
    for (;;) {
      if (long_.entries[high] == neighbor) return high;
      if (long_.entries[low] == neighbor) return low;
      high += high + 1 < degree_;
      low -= low > 0;
    }
  }

  bool has_room(bool in_front) const {
    if (!is_long_) return degree_ < short_.size();
    return in_front ? long_.entries > long_.memory : long_.entries + degree_ < long_.memory + long_.capacity;
  }

  // At both ends of the ring, in new memory unless enough of what it has is free.
  void make_room(RingStore& store) {
    const bool is_enough = is_long_ && 4 * (long_.capacity - degree_) >= degree_;
    const std::uint32_t capacity = is_enough ? long_.capacity : 2 * degree_;
    Vertex* memory = is_enough ? long_.memory : store.take(capacity);
    Vertex* entries = memory + (capacity - degree_) / 2;
    std::memmove(entries, ring(), degree_ * sizeof(Vertex));
    is_long_ = true;
    long_ = {entries, memory, capacity, 0};
  }

  // Both ends move, so that few entries do.
  struct Long {
    Vertex* entries;
    Vertex* memory;
    std::uint32_t capacity;
    std::uint32_t changed;  // where the last change was
  };
  std::uint32_t degree_ : 31, is_long_ : 1;
  union {
    std::array<Vertex, 10> short_;
    Long long_;
  };
};
static_assert(sizeof(RingVertex) == 64);

}  // namespace vorotool::core::delaunay
