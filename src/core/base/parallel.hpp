// Runs independent pieces of work on several threads; the calling thread works too and serves the monitor.
// A call that starts one more thread takes 23 microseconds (tests/benchmarks/core_parts.cpp), and pieces
// take milliseconds: a pool of threads, as oneTBB keeps one, could save no more than that.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

#include "core/base/monitor.hpp"

namespace vorotool::core::base {

// 0 means as many threads as this process may use; the result is at least 1.
unsigned resolve_threads(unsigned threads);

// Calls body(0) ... body(count - 1), each once, on up to `threads` threads.
//
// Threads take the next index in increasing order, so which thread runs an index is not determined: the
// results must not depend on it. The monitor is called on the calling thread only: between two of its pieces
// and, while it waits for the others, every 20 ms, with the fraction of pieces done; so pieces should take
// some milliseconds, not more. When the monitor returns false no further piece is started and Interrupted is
// thrown once the running ones have ended. When pieces throw, no further piece is started and the exception
// of the smallest index is rethrown: smaller indices have been started before, so it is
// always the same one.
void parallel_for(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& body,
                  const Monitor& monitor = {});

// Number of pieces of about `grain` items for `items` items: at least 1 unless there are no items.
constexpr std::size_t piece_count(std::size_t items, std::size_t grain) {
  return items == 0 ? 0 : 1 + (items - 1) / (grain == 0 ? 1 : grain);
}

// Calls body(piece, begin, end) for the pieces of `grain` items each that `items` items are cut into.
template <class Body>
void for_pieces(std::size_t items, std::size_t grain, unsigned threads, const Monitor& monitor,
                const Body& body) {
  const auto run = [&](std::size_t piece) {
    body(piece, piece * grain, std::min(items, (piece + 1) * grain));
  };
  parallel_for(piece_count(items, grain), threads, run, monitor);
}

// Calls body(item) for each item, those of a piece one after the other.
template <class Body>
void for_items(std::size_t items, std::size_t grain, unsigned threads, const Monitor& monitor,
               const Body& body) {
  for_pieces(items, grain, threads, monitor, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t item = begin; item < end; ++item) body(item);
  });
}

}  // namespace vorotool::core::base
