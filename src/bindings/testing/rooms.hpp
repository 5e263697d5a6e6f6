// What the parts of vorotool._core_testing share: one function a part, called by module.cpp.
#pragma once

#include <nanobind/nanobind.h>

namespace vorotool::bindings::testing {

void bind_alpha(nanobind::module_& room);
void bind_exact_signs(nanobind::module_& room);
void bind_insertion_predicates(nanobind::module_& room);
void bind_tessellation(nanobind::module_& room);

}  // namespace vorotool::bindings::testing
