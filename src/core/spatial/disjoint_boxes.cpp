#include "core/spatial/disjoint_boxes.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <functional>
#include <map>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

namespace vorotool::core::spatial {

using base::Monitor;

namespace {

constexpr std::size_t tried_sheets = 32;  // boxes of maps and images mostly fit into fewer

// The boxes of a sheet that may reach the column where the sweep is, by their rows: they are disjoint there.
class Sheet {
 public:
  // Boxes come from left to right.
  bool add(const ClosedBox& box) {
    auto at = reach_.upper_bound(box.most_y);  // those that begin above are clear of it
    while (at != reach_.begin()) {
      --at;
      if (at->second.most_x < box.least_x) {
        at = reach_.erase(at);
      } else if (at->second.most_y >= box.least_y) {
        return false;
      } else {
        break;  // what lies below one that is clear of it is clear, too
      }
    }
    reach_[box.least_y] = {box.most_y, box.most_x};
    return true;
  }

 private:
  struct Reach {
    std::int64_t most_y, most_x;
  };
  std::map<std::int64_t, Reach> reach_;
};

// The largest power of two that has a multiple among the rows of a box, and that multiple.
std::pair<int, std::int64_t> cutting_line(const ClosedBox& box) {
  const auto differing = static_cast<std::uint64_t>(box.least_y ^ box.most_y);
  const int level = std::bit_width(differing);
  return {level, level < 64 ? box.most_y >> level : 0};
}

class Divider {
 public:
  Divider(std::span<const ClosedBox> boxes, const Monitor& monitor)
      : boxes_(boxes), monitor_(monitor), sheet_(boxes.size(), -1) {}

  std::vector<std::int32_t> run() {
    std::vector<std::int32_t> order(boxes_.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, {}, [&](std::int32_t k) { return std::pair(box(k).least_x, k); });
    std::vector<std::int32_t> left_over = first_fit(order);
    by_lines(left_over);
    return std::move(sheet_);
  }

 private:
  const ClosedBox& box(std::int32_t k) const { return boxes_[static_cast<std::size_t>(k)]; }
  std::int32_t& sheet(std::int32_t k) { return sheet_[static_cast<std::size_t>(k)]; }

  std::vector<std::int32_t> first_fit(const std::vector<std::int32_t>& order) {
    std::vector<Sheet> sheets;
    std::vector<std::int32_t> left_over;
    for (std::size_t i = 0; i < order.size(); ++i) {
      base::report_item(monitor_, i);
      const auto fits = [&](Sheet& sheet) { return sheet.add(box(order[i])); };
      const auto found = std::find_if(sheets.begin(), sheets.end(), fits);
      if (found != sheets.end()) {
        sheet(order[i]) = static_cast<std::int32_t>(found - sheets.begin());
      } else if (sheets.size() < tried_sheets) {
        sheet(order[i]) = static_cast<std::int32_t>(sheets.size());
        sheets.emplace_back().add(box(order[i]));
      } else {
        left_over.push_back(order[i]);
      }
    }
    next_ = static_cast<std::int32_t>(sheets.size());
    return left_over;
  }

  void by_lines(std::vector<std::int32_t>& left_over) {
    std::ranges::sort(left_over, {}, [&](std::int32_t k) {
      const auto [level, line] = cutting_line(box(k));
      return std::tuple(level, line, box(k).least_x, k);
    });
    for (std::size_t begin = 0, end; begin < left_over.size(); begin = end) {
      const int level = cutting_line(box(left_over[begin])).first;
      std::int32_t most = 0;
      for (end = begin; end < left_over.size() && cutting_line(box(left_over[end])).first == level;) {
        const std::size_t first = end;
        const auto line = cutting_line(box(left_over[first]));
        while (end < left_over.size() && cutting_line(box(left_over[end])) == line) ++end;
        most = std::max(most, share_columns(std::span(left_over).subspan(first, end - first)));
      }
      next_ += most;
    }
  }

  // Gives boxes that one line cuts, from left to right, sheets from next_ on; returns how many.
  std::int32_t share_columns(std::span<const std::int32_t> boxes) {
    using Use = std::pair<std::int64_t, std::int32_t>;  // where it ends, and the sheet
    std::priority_queue<Use, std::vector<Use>, std::greater<>> in_use;
    std::int32_t count = 0;
    for (const std::int32_t k : boxes) {
      std::int32_t taken = count;
      if (!in_use.empty() && in_use.top().first < box(k).least_x) {
        taken = in_use.top().second;
        in_use.pop();
      } else {
        ++count;
      }
      in_use.emplace(box(k).most_x, taken);
      sheet(k) = next_ + taken;
    }
    return count;
  }

  std::span<const ClosedBox> boxes_;
  const Monitor& monitor_;
  std::vector<std::int32_t> sheet_;
  std::int32_t next_ = 0;
};

}  // namespace

std::vector<std::int32_t> disjoint_sheets(std::span<const ClosedBox> boxes, const Monitor& monitor) {
  return Divider(boxes, monitor).run();
}

}  // namespace vorotool::core::spatial
