#include "bindings.hpp"

namespace vorotool::bindings {

void bind_regions(nanobind::module_&) {}

}  // namespace vorotool::bindings
