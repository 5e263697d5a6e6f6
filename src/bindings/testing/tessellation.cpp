// The floor of the benchmarks of the tessellation.
#include "bindings/support/arrays.hpp"
#include "bindings/testing/rooms.hpp"
#include "core/tessellation/stream_fill.hpp"

namespace vorotool::bindings::testing {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using Image = Aligned<nb::ndim<2>, nb::c_contig, nb::device::cpu>;

void stream_fill(const Image& out, unsigned threads) {
  core::tessellation::stream_fill(static_cast<char*>(out.data()), out.nbytes(), threads);
}

}  // namespace

void bind_tessellation(nb::module_& room) {
  room.def("stream_fill", &stream_fill, "out"_a, "threads"_a, "Fills an array past the caches.");
}

}  // namespace vorotool::bindings::testing
