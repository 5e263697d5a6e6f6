// By which factor discs must be enlarged for one to hold others.
#pragma once

#include <cstddef>
#include <vector>

namespace vorotool::core::pruning {

struct Disc {
  double x, y, radius;
};

// Discs in a fixed order, and boxes around groups of them that follow each other.
class DiscEnlargement {
 public:
  // By `rounding` centers and radii may be wrong.
  DiscEnlargement(std::vector<Disc> discs, double rounding);

  // A factor, and the disc that needs it.
  struct Need {
    double factor = 0;
    std::size_t disc = 0;
  };

  // The smallest factor for which the disc, enlarged, holds all of first ... last - 1, or some factor not
  // below `enough` if that is none below it. The disc `likely` is looked at first, if it is one of them.
  Need factor(const Disc& disc, std::size_t first, std::size_t last, double enough, std::size_t likely) const;

 private:
  struct Box {
    double least_x, most_x, least_y, most_y, most_radius;
  };
  struct Search;

  double pair_factor(double squared_distance, double difference) const;
  double bound(const Disc& disc, const Box& box) const;
  Box box_of(std::size_t first, std::size_t last) const;
  void visit(Search& task, std::size_t first, std::size_t last) const;
  void search(Search& task, std::size_t level, std::size_t number) const;

  static constexpr std::size_t leaf_size = 8, fan_bits = 2;

  std::vector<Disc> discs_;
  double rounding_;
  std::vector<std::vector<Box>> levels_;  // [0] of leaf_size discs each, [k + 1] of 4 boxes of [k]
};

}  // namespace vorotool::core::pruning
