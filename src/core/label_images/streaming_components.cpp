#include "core/label_images/streaming_components.hpp"

#include <stdexcept>

namespace vorotool::core::label_images {

using base::Monitor;

namespace {

// Components that are known: the ones that begin in a band come in order, and what joins has one number
// already.
class KnownComponents {
 public:
  explicit KnownComponents(std::span<const std::uint32_t> fresh) : fresh_(fresh) {}

  std::uint32_t add() {
    if (used_ == fresh_.size()) throw std::invalid_argument("the mask has more components than numbers");
    return fresh_[used_++];
  }
  void unite(std::uint32_t, std::uint32_t) {}
  bool are_used() const { return used_ == fresh_.size(); }

 private:
  std::span<const std::uint32_t> fresh_;
  std::size_t used_ = 0;
};

template <class Sets>
void scan_rows(ComponentScan<Sets>& scan, std::size_t width, std::span<const std::uint8_t> mask,
               std::span<std::uint32_t> numbers, const Monitor& monitor) {
  const std::size_t piece = rows_per_piece(width) * width;
  for (std::size_t row = 0; row < mask.size(); row += width) {
    if (row % piece == 0) base::report(monitor, static_cast<double>(row) / static_cast<double>(mask.size()));
    scan.add_row(mask.subspan(row, width), numbers.subspan(row, width));
  }
}

}  // namespace

StreamingComponents::StreamingComponents(std::size_t width, Connectivity connectivity)
    : width_(width), scan_(width, connectivity, from_one_) {}

void StreamingComponents::add(std::span<const std::uint8_t> mask, std::span<std::uint32_t> provisional,
                              const Monitor& monitor) {
  scan_rows(scan_, width_, mask, provisional, monitor);
}

// The smallest of a set is that of the component's first pixel, as no run above has it.
std::uint32_t StreamingComponents::settle(std::span<std::uint32_t> number) { return sets_.settle(number); }

void number_band(std::span<const std::uint8_t> mask, Connectivity connectivity,
                 std::span<const std::uint32_t> above, std::span<const std::uint32_t> fresh,
                 std::span<std::uint32_t> numbers, const Monitor& monitor) {
  KnownComponents known(fresh);
  ComponentScan<KnownComponents> scan(above.size(), connectivity, known);
  scan.begin_below(above);
  scan_rows(scan, above.size(), mask, numbers, monitor);
  if (!known.are_used()) throw std::invalid_argument("the mask has fewer components than numbers");
}

}  // namespace vorotool::core::label_images
