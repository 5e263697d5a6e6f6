// How much memory there is for more.
#pragma once

#include <cstddef>

namespace vorotool::core::base {

// Bytes that this process may still use, about: the least of what the system has, what the control group of the process
// leaves, and what a limit of its addresses leaves. SIZE_MAX where none of them can be told.
std::size_t available_memory();

}  // namespace vorotool::core::base
