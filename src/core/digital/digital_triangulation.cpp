#include "core/digital/digital_triangulation.hpp"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "core/base/flat_map.hpp"
#include "core/base/parallel.hpp"
#include "core/label_images/corner_scan.hpp"

namespace vorotool::core::digital {

using base::Monitor;

namespace {

enum : std::uint8_t { at_three = 1, at_four = 2 };

void sort_pairs(std::vector<LabelPair>& pairs) {
  const auto key = [](const LabelPair& p) { return std::tie(p.a, p.b); };
  std::sort(pairs.begin(), pairs.end(), [=](const auto& p, const auto& q) { return key(p) < key(q); });
  const auto same = [=](const auto& p, const auto& q) { return key(p) == key(q); };
  pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
}

void sort_triples(std::vector<LabelTriple>& triples) {
  const auto key = [](const LabelTriple& t) { return std::tie(t.a, t.b, t.c); };
  std::sort(triples.begin(), triples.end(), [=](const auto& p, const auto& q) { return key(p) < key(q); });
  std::size_t kept = 0;
  for (const LabelTriple& triple : triples) {
    if (kept > 0 && key(triples[kept - 1]) == key(triple)) {
      triples[kept - 1].corners |= triple.corners;
    } else {
      triples[kept++] = triple;
    }
  }
  triples.resize(kept);
}

// The rows of one piece of work.
class Piece {
 public:
  explicit Piece(std::size_t width) : pair_(width), starts_(width) {}

  // The neighbors within a row.
  template <class Label>
  void link_row(std::span<const Label> row) {
    const std::size_t count = starts_.cut(row);
    for (std::size_t k = 1; k < count; ++k) link(row[starts_[k - 1]], row[starts_[k]]);
  }

  template <class Label>
  void add_pair(std::span<const Label> above, std::span<const Label> below) {
    pair_.walk(
        above, below, [&](std::uint32_t upper, std::uint32_t lower) { link(upper, lower); },
        [&](std::uint32_t, const label_images::Corner& corner) { add_corner(corner); });
  }

  DigitalTriangulation finish() {
    linked_.for_each([&](std::uint64_t key, std::uint64_t) {
      found_.edges.push_back({static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key)});
    });
    sort_triples(found_.triangles);
    return std::move(found_);
  }

 private:
  void link(std::uint32_t a, std::uint32_t b) {
    if (a == b || a == 0 || b == 0) return;
    linked_[std::uint64_t{std::min(a, b)} << 32 | std::max(a, b)] = 1;
  }

  // Each of the four pixels with its two 4-neighbors, which are 8-neighbors of each other.
  void add_corner(const label_images::Corner& corner) {
    const int labels = corner.labels();
    if (labels < 3) return;
    const auto [a, b, c, d] = corner;
    const bool four = labels == 4 && a != 0 && b != 0 && c != 0 && d != 0;
    const std::uint8_t kind = four ? at_four : at_three;
    int added = add(d, a, b, kind);
    added += add(a, b, c, kind);
    added += add(b, c, d, kind);
    added += add(c, d, a, kind);
    if (added > 0) ++(four ? found_.four_label_corners : found_.three_label_corners);
  }

  bool add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint8_t kind) {
    if (a == b || b == c || c == a || a == 0 || b == 0 || c == 0) return false;
    if (a > b) std::swap(a, b);
    if (b > c) std::swap(b, c);
    if (a > b) std::swap(a, b);
    found_.triangles.push_back({a, b, c, kind});
    return true;
  }

  label_images::RowPair pair_;
  label_images::RunStarts starts_;
  base::FlatMap linked_;  // label pairs, the smaller in the upper half; their values mean nothing
  DigitalTriangulation found_;
};

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

template <class Label>
void DigitalTriangulationScan::add_rows(std::span<const Label> rows, std::size_t width, unsigned threads,
                                        const Monitor& monitor) {
  if (width == 0 || rows.size() % width != 0) throw std::length_error("a band is no number of whole rows");
  const std::size_t height = rows.size() / width;
  const std::size_t step = label_images::rows_per_piece(width);
  std::vector<DigitalTriangulation> parts(base::piece_count(height, step));
  const auto read = [&](std::size_t number, std::size_t begin, std::size_t end) {
    Piece piece(width);
    for (std::size_t y = begin; y < end; ++y) {
      piece.link_row(rows.subspan(y * width, width));
      if (y + 1 < height)
        piece.add_pair(rows.subspan(y * width, width), rows.subspan((y + 1) * width, width));
    }
    parts[number] = piece.finish();
  };
  base::for_pieces(height, step, threads, monitor, read);
  for (const DigitalTriangulation& part : parts) {
    append(found_.edges, part.edges);
    append(found_.triangles, part.triangles);
    found_.three_label_corners += part.three_label_corners;
    found_.four_label_corners += part.four_label_corners;
  }
}

DigitalTriangulation DigitalTriangulationScan::finish() {
  sort_pairs(found_.edges);
  sort_triples(found_.triangles);
  return std::move(found_);
}

template void DigitalTriangulationScan::add_rows(std::span<const std::uint8_t>, std::size_t, unsigned,
                                                 const Monitor&);
template void DigitalTriangulationScan::add_rows(std::span<const std::uint16_t>, std::size_t, unsigned,
                                                 const Monitor&);
template void DigitalTriangulationScan::add_rows(std::span<const std::uint32_t>, std::size_t, unsigned,
                                                 const Monitor&);

}  // namespace vorotool::core::digital
