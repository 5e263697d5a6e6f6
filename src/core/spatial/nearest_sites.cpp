#include "core/spatial/nearest_sites.hpp"

#include <cmath>
#include <limits>

#include "core/base/parallel.hpp"
#include "core/spatial/kd_tree.hpp"

namespace vorotool::core::spatial {

template <std::size_t Axes>
std::vector<NearestOther> nearest_other_sites(const std::array<std::span<const double>, Axes>& columns,
                                              std::span<const std::uint32_t> labels, unsigned threads,
                                              const base::Monitor& monitor) {
  using Tree = KdTree<double, double, Axes>;
  constexpr std::size_t piece_size = 4096;
  const Tree tree(columns, labels, monitor);
  std::vector<NearestOther> result(tree.size());
  // In the order of the tree, where neighbors share most of their paths.
  base::for_items(tree.size(), piece_size, threads, monitor, [&](std::size_t i) {
    const typename Tree::Site& site = tree.site(static_cast<std::ptrdiff_t>(i));
    const typename Tree::Nearest found = tree.nearest(site.at, {}, site.index);
    NearestOther& other = result[site.index];
    if (found.place < 0) {
      other = {-1, std::numeric_limits<double>::quiet_NaN()};
    } else {
      other = {tree.site(found.place).index, std::sqrt(found.d2)};
    }
  });
  return result;
}

template std::vector<NearestOther> nearest_other_sites(const std::array<std::span<const double>, 2>&,
                                                       std::span<const std::uint32_t>, unsigned,
                                                       const base::Monitor&);
template std::vector<NearestOther> nearest_other_sites(const std::array<std::span<const double>, 3>&,
                                                       std::span<const std::uint32_t>, unsigned,
                                                       const base::Monitor&);

}  // namespace vorotool::core::spatial
