#include "core/spatial/nearest_sites.hpp"

#include <cmath>
#include <limits>

#include "core/base/parallel.hpp"
#include "core/spatial/kd_tree.hpp"

namespace vorotool::core::spatial {

std::vector<NearestOther> nearest_other_sites(std::span<const double> x, std::span<const double> y,
                                              std::span<const std::uint32_t> labels, unsigned threads,
                                              const base::Monitor& monitor) {
  using Tree = KdTree<double, double>;
  constexpr std::size_t piece_size = 4096;
  const Tree tree(x, y, labels, monitor);
  std::vector<NearestOther> result(tree.size());
  // In the order of the tree, where neighbours share most of their paths.
  base::for_items(tree.size(), piece_size, threads, monitor, [&](std::size_t i) {
    const Tree::Site& site = tree.site(static_cast<std::ptrdiff_t>(i));
    const Tree::Nearest found = tree.nearest(site.x, site.y, {}, site.index);
    NearestOther& other = result[site.index];
    if (found.place < 0) {
      other = {-1, std::numeric_limits<double>::quiet_NaN()};
    } else {
      other = {tree.site(found.place).index, std::sqrt(found.d2)};
    }
  });
  return result;
}

}  // namespace vorotool::core::spatial
