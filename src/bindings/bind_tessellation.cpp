#include "bindings.hpp"

namespace vorotool::bindings {

void bind_tessellation(nanobind::module_&) {}

}  // namespace vorotool::bindings
