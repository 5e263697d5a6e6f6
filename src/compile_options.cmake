# How all C++ here is compiled: the core, its bindings, and the tests of both.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3")

option(VOROTOOL_SANITIZE "Build with address and undefined-behaviour sanitizers" OFF)
if(VOROTOOL_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer -g -O1)
  add_link_options(-fsanitize=address,undefined)
endif()

# Contraction of a*b+c would change results between machines; where a fused operation is wanted it is written.
add_compile_options(-Wall -Wextra -Wpedantic -ffp-contract=off)
