// The extension module vorotool._core_testing: what only benchmarks call, in no wheel.
#include "bindings/support/arrays.hpp"
#include "core/tessellation/stream_fill.hpp"

namespace vorotool::bindings::testing {
namespace {

using Image = Aligned<nb::ndim<2>, nb::c_contig, nb::device::cpu>;

void stream_fill(const Image& out, unsigned threads) {
  core::tessellation::stream_fill(static_cast<char*>(out.data()), out.nbytes(), threads);
}

}  // namespace

NB_MODULE(_core_testing, module) {
  module.doc() = "Parts of the compiled core that only benchmarks call.";
  nb::module_ tessellation = module.def_submodule("tessellation", "The floor of the benchmarks.");
  tessellation.def("stream_fill", &stream_fill, "out"_a, "threads"_a, "Fills an array past the caches.");
}

}  // namespace vorotool::bindings::testing
