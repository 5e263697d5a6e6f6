# How all C++ here is compiled: the core, its bindings, and the tests of both.

# Integers of 128 bits, vectors and builtins are those of GCC and Clang: on Windows clang-cl has them, MSVC has not.
if(NOT CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang" OR NOT CMAKE_SIZEOF_VOID_P EQUAL 8)
  message(FATAL_ERROR "vorotool is compiled by GCC or Clang, for 64 bits, and not by ${CMAKE_CXX_COMPILER}: set CXX to "
    "g++ or clang++; on Windows to clang-cl, or give Visual Studio the toolset ClangCL")
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# Contraction of a*b+c would change results between machines; where a fused operation is wanted it is written.
if(CMAKE_CXX_COMPILER_FRONTEND_VARIANT STREQUAL "MSVC")  # clang-cl, whose -Wall is every warning that there is
  set(CMAKE_CXX_FLAGS_RELEASE "/O2")
  add_compile_options(/W4 -Wpedantic /clang:-O3 /clang:-ffp-contract=off)
else()
  set(CMAKE_CXX_FLAGS_RELEASE "-O3")
  add_compile_options(-Wall -Wextra -Wpedantic -ffp-contract=off)
endif()

set(VOROTOOL_SANITIZE "" CACHE STRING "Sanitizers to build with: address,undefined or thread")
if(VOROTOOL_SANITIZE)
  add_compile_options(-fsanitize=${VOROTOOL_SANITIZE} -fno-omit-frame-pointer -g -O1)
  add_link_options(-fsanitize=${VOROTOOL_SANITIZE})
endif()
if(VOROTOOL_SANITIZE MATCHES undefined)
  add_compile_options(-fno-sanitize-recover=all)
endif()

option(VOROTOOL_TESTING "Build what only tests call: vorotool._core_testing, and the programs of tests/cpp" OFF)

# Where it is worked on. A compiler to come may warn of more, which is to stop nobody who only installs.
option(VOROTOOL_WERROR "Take warnings about our own C++ for errors" OFF)

function(vorotool_strict)
  foreach(target IN LISTS ARGN)
    set_property(TARGET ${target} PROPERTY COMPILE_WARNING_AS_ERROR ${VOROTOOL_WERROR})
  endforeach()
endfunction()
