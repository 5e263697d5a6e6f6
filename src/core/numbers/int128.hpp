// Integers of 128 bits, as the compilers of all targets have them.
#pragma once

namespace vorotool::core::numbers {

__extension__ typedef __int128 int128;
__extension__ typedef unsigned __int128 uint128;

}  // namespace vorotool::core::numbers
