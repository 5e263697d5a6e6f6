#include "bindings.hpp"

namespace vorotool::bindings {

void bind_text(nanobind::module_&) {}

}  // namespace vorotool::bindings
