// A planar subdivision as half-edges in one flat array.
//
// Half-edges 2k and 2k + 1 are the two directions of edge k, so twins need no storage. Around a vertex the
// half-edges that leave it form a ring; `next` is the following one counter-clockwise, `previous` the one
// before.
#pragma once

#include <cstdint>
#include <utility>

#include "core/large_array.hpp"
#include "core/rings.hpp"

namespace vorotool::core {

using HalfEdge = std::int32_t;

inline constexpr HalfEdge no_edge = -1;

class HalfEdges {
 public:
  struct Record {
    Vertex origin;      // -1: the edge does not exist
    HalfEdge next;      // counter-clockwise around the origin
    HalfEdge previous;  // clockwise around the origin
  };

  // The edges are indeterminate until they are made or cleared.
  explicit HalfEdges(std::size_t edges) : records_(2 * edges) {}

  static HalfEdge twin(HalfEdge e) { return e ^ 1; }
  std::int32_t size() const { return static_cast<std::int32_t>(records_.size()); }
  bool exists(HalfEdge e) const { return at(e).origin >= 0; }
  Vertex origin(HalfEdge e) const { return at(e).origin; }
  Vertex target(HalfEdge e) const { return at(twin(e)).origin; }
  HalfEdge next_around(HalfEdge e) const { return at(e).next; }
  HalfEdge previous_around(HalfEdge e) const { return at(e).previous; }
  // The next half-edge of the face on the left.
  HalfEdge next_left(HalfEdge e) const { return at(twin(e)).previous; }
  // The previous half-edge of the face on the right, turned to leave the same vertex as `e`'s target does.
  HalfEdge previous_right(HalfEdge e) const { return at(twin(e)).next; }

  // Makes edge `e` / twin(e) from a to b, alone at both ends.
  void make(HalfEdge e, Vertex a, Vertex b) {
    at(e) = {a, e, e};
    at(twin(e)) = {b, twin(e), twin(e)};
  }

  // Makes b the half-edge after a, while a ring is made anew: each of its half-edges must get one after it.
  void link(HalfEdge a, HalfEdge b) {
    at(a).next = b;
    at(b).previous = a;
  }

  // Joins the rings of a and b into one, or cuts one ring in two: the successors of a and b change places.
  void splice(HalfEdge a, HalfEdge b) {
    const HalfEdge a_next = at(a).next;
    const HalfEdge b_next = at(b).next;
    at(a).next = b_next;
    at(b).next = a_next;
    at(b_next).previous = a;
    at(a_next).previous = b;
  }

  // Makes edge `e` one that does not exist.
  void clear(HalfEdge e) { at(e).origin = at(twin(e)).origin = -1; }

  // Takes an edge out of the rings of its ends.
  void remove(HalfEdge e) {
    splice(e, at(e).previous);
    splice(twin(e), at(twin(e)).previous);
    clear(e);
  }

  // Makes edge `e` from the target of `a` to the origin of `b`, so that a, e, b follow each other on one left
  // face.
  void connect(HalfEdge e, HalfEdge a, HalfEdge b) {
    make(e, target(a), origin(b));
    splice(e, next_left(a));
    splice(twin(e), b);
  }

  // Tells the processor that a half-edge, if there is one of this number, will be looked at soon.
  void prefetch(std::size_t e) const {
    if (e < records_.size()) __builtin_prefetch(&records_[e]);
  }

 private:
  Record& at(HalfEdge e) { return records_[static_cast<std::size_t>(e)]; }
  const Record& at(HalfEdge e) const { return records_[static_cast<std::size_t>(e)]; }

  LargeArray<Record> records_;
};

}  // namespace vorotool::core
