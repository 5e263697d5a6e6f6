// Boost's diagram of line segments, timed: boost_voronoi FILE RUNS.
//
// FILE holds four int32 a segment, x and y of both ends. Prints the version of Boost, the least nanoseconds
// of `construct_voronoi` over RUNS runs, of which there are fewer once they take 20 s together, the most
// bytes that the process grew by in the first run, and the numbers of vertices and edges.

#include <boost/polygon/voronoi.hpp>
#include <boost/version.hpp>

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace {

struct Point {
  std::int32_t x, y;
};

struct Segment {
  Point low, high;
};

/// Most bytes that the process has held. On Linux `getrusage` may tell those of the process that started it.
long long peak() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmHWM:") {
      long long kilobytes = 0;
      status >> kilobytes;
      return kilobytes * 1024;
    }
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

std::vector<Segment> read(const char* path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<Segment> segments(static_cast<std::size_t>(file.tellg()) / sizeof(Segment));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(segments.data()),
            static_cast<std::streamsize>(segments.size() * sizeof(Segment)));
  return segments;
}

}  // namespace

namespace boost::polygon {

template <>
struct geometry_concept<Point> {
  using type = point_concept;
};

template <>
struct point_traits<Point> {
  using coordinate_type = std::int32_t;

  static coordinate_type get(const Point& point, orientation_2d orient) {
    return orient == HORIZONTAL ? point.x : point.y;
  }
};

template <>
struct geometry_concept<Segment> {
  using type = segment_concept;
};

template <>
struct segment_traits<Segment> {
  using coordinate_type = std::int32_t;
  using point_type = Point;

  static point_type get(const Segment& segment, direction_1d end) {
    return end.to_int() != 0 ? segment.high : segment.low;
  }
};

}  // namespace boost::polygon

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "usage: boost_voronoi FILE RUNS\n");
    return 2;
  }
  const std::vector<Segment> segments = read(arguments[1]);
  const int runs = std::atoi(arguments[2]);
  const long long before = peak();
  long long memory = 0;
  double least = 0, all = 0;
  std::size_t vertices = 0, edges = 0;
  for (int run = 0; run < runs && all < 20; ++run) {
    boost::polygon::voronoi_diagram<double> diagram;
    const auto start = std::chrono::steady_clock::now();
    boost::polygon::construct_voronoi(segments.begin(), segments.end(), &diagram);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (run == 0) {
      memory = peak() - before;
    }
    least = run == 0 ? seconds : std::min(least, seconds);
    all += seconds;
    vertices = diagram.num_vertices();
    edges = diagram.num_edges() / 2;
  }
  std::printf("%s %.0f %lld %zu %zu\n", BOOST_LIB_VERSION, 1e9 * least, memory, vertices, edges);
  return 0;
}
