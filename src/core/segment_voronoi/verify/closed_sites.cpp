#include "core/segment_voronoi/verify/closed_sites.hpp"

#include <cstddef>
#include <span>

namespace vorotool::core::segment_voronoi::verify {

using build::DiagramView;
using build::IncidentSegments;
using kernel::LatticeSite;

namespace {

using Site = std::int32_t;

std::vector<Site> closed_site_numbers(const DiagramView& arrays, const IncidentSegments& incident) {
  std::vector<Site> numbers;
  for (std::size_t i = 0; i < arrays.site_count(); ++i) {
    const auto site = static_cast<Site>(i);
    if (!arrays.is_point(site) || incident.at(site).empty()) numbers.push_back(site);
  }
  return numbers;
}

std::vector<LatticeSite> places_of(const DiagramView& arrays, std::span<const Site> numbers) {
  std::vector<LatticeSite> sites;
  for (const Site number : numbers) sites.push_back(arrays.site(number));
  return sites;
}

}  // namespace

ClosedSites::ClosedSites(const DiagramView& arrays, const IncidentSegments& incident, unsigned threads,
                         const base::Monitor& monitor)
    : numbers_(closed_site_numbers(arrays, incident)), tree_(places_of(arrays, numbers_), threads, monitor) {}

}  // namespace vorotool::core::segment_voronoi::verify
