// A planar subdivision as rings: each vertex with its neighbours in counter-clockwise order.
//
// A vertex with few neighbours is one cache line, with its coordinates: what is looked at together lies
// together. An edge is in the rings of both of its ends, and no link leads from one to the other: short rings
// are searched faster than links are followed.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/predicates.hpp"

namespace vorotool::core {

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
  Point point;

  void clear(const Point& place) {
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

  // The place of a neighbour in the ring.
  std::uint32_t find(Vertex neighbour) const {
    const Vertex* entries = ring();
    std::uint32_t place = 0;
    while (entries[place] != neighbour) ++place;
    return place;
  }

  void insert(std::uint32_t place, Vertex neighbour, RingStore& store) {
    if (degree_ == capacity()) grow(store);
    Vertex* entries = ring();
    std::copy_backward(entries + place, entries + degree_, entries + degree_ + 1);
    entries[place] = neighbour;
    ++degree_;
  }

  void erase(std::uint32_t place) {
    Vertex* entries = ring();
    std::copy(entries + place + 1, entries + degree_, entries + place);
    --degree_;
  }

 private:
  std::uint32_t capacity() const {
    return is_long_ ? long_.capacity : static_cast<std::uint32_t>(short_.size());
  }

  void grow(RingStore& store) {
    const std::uint32_t capacity = 2 * degree_;
    Vertex* entries = store.take(capacity);
    std::copy_n(ring(), degree_, entries);
    is_long_ = true;
    long_ = {entries, capacity};
  }

  struct Long {
    Vertex* entries;
    std::uint32_t capacity;
  };
  std::uint32_t degree_ : 31, is_long_ : 1;
  union {
    std::array<Vertex, 10> short_;
    Long long_;
  };
};
static_assert(sizeof(RingVertex) == 64);

}  // namespace vorotool::core
