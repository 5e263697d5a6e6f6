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

  // Also while the ring is open.
  Vertex operator[](std::uint32_t place) const {
    if (!is_long_) return short_[place];
    return long_.entries[place < long_.gap ? place : place + gap_size()];
  }

  // The place of a neighbour in the ring.
  std::uint32_t find(Vertex neighbour) const {
    std::uint32_t place = 0;
    while ((*this)[place] != neighbour) ++place;
    return place;
  }

  // Opens a long ring.
  void insert(std::uint32_t place, Vertex neighbour, RingStore& store) {
    if (degree_ == capacity()) grow(store);
    if (is_long_) {
      move_gap(place);
      long_.entries[long_.gap++] = neighbour;
    } else {
      std::copy_backward(short_.data() + place, short_.data() + degree_, short_.data() + degree_ + 1);
      short_[place] = neighbour;
    }
    ++degree_;
  }

  void erase(std::uint32_t place) {
    Vertex* entries = ring();
    if (is_long_ && place >= long_.gap) {
      Vertex* after = entries + long_.gap + gap_size();
      std::copy_backward(after, entries + place + gap_size(), entries + place + gap_size() + 1);
    } else {
      const std::uint32_t end = is_long_ ? long_.gap-- : degree_;
      std::copy(entries + place + 1, entries + end, entries + place);
    }
    --degree_;
  }

  // Makes all entries follow each other, as ring(), front() and back() need them.
  void close() {
    if (is_long_) move_gap(degree_);
  }

 private:
  std::uint32_t capacity() const {
    return is_long_ ? long_.capacity : static_cast<std::uint32_t>(short_.size());
  }

  // Of a full ring, which has no gap.
  void grow(RingStore& store) {
    const std::uint32_t capacity = 2 * degree_;
    Vertex* entries = store.take(capacity);
    std::copy_n(ring(), degree_, entries);
    is_long_ = true;
    long_ = {entries, capacity, degree_};
  }

  std::uint32_t gap_size() const { return long_.capacity - degree_; }

  void move_gap(std::uint32_t place) {
    Vertex *low = long_.entries + std::min(place, long_.gap),
           *high = long_.entries + std::max(place, long_.gap);
    if (gap_size() == 0) {
      // nothing is in the way
    } else if (place < long_.gap) {
      std::copy_backward(low, high, high + gap_size());
    } else {
      std::copy(low + gap_size(), high + gap_size(), low);
    }
    long_.gap = place;
  }

  // Entries that are free follow the first `gap` ones: to put many neighbours in, side by side, moves few.
  struct Long {
    Vertex* entries;
    std::uint32_t capacity, gap;
  };
  std::uint32_t degree_ : 31, is_long_ : 1;
  union {
    std::array<Vertex, 10> short_;
    Long long_;
  };
};
static_assert(sizeof(RingVertex) == 64);

}  // namespace vorotool::core
