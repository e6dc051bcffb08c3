# Language standard, optimization and warnings.
#
# quicksand_options   everything that shapes the generated code; all targets get it, those of users of the libraries too
# quicksand_warnings  warnings; private to our own targets
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

# Newer compilers know new warnings; a user who only wants to run a case should not stumble over them.
set(tested_compiler OFF)
if((CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION MATCHES "^12\\.")
   OR (CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_CXX_COMPILER_VERSION MATCHES "^14\\."))
  set(tested_compiler ON)
endif()

option(QUICKSAND_NATIVE "Compile for this machine's processor" ON)
option(QUICKSAND_WERROR "Warnings are errors (by default with the compilers the code is tested with)" ${tested_compiler})
set(QUICKSAND_SANITIZE "" CACHE STRING "Sanitizers, such as address,undefined or thread")
set(QUICKSAND_SMALLEST_THREADED_LOOP 2048 CACHE STRING "Loops of less work, in points of a simple loop, run on one thread; less is for tests")
mark_as_advanced(QUICKSAND_SMALLEST_THREADED_LOOP)

add_library(quicksand_options INTERFACE)
set_target_properties(quicksand_options PROPERTIES EXPORT_NAME options)
# -ffp-contract=off: a*b + c*d fused into one multiply-add rounds its two products differently, so that mirror images would
# no longer stay mirror images and results would depend on what a compiler happens to fuse. The loops are bound by memory.
# -fno-math-errno, -fno-trapping-math: let loops with sqrt and comparisons become vectors; values stay the same.
target_compile_options(quicksand_options INTERFACE -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(QUICKSAND_NATIVE)
  target_compile_options(quicksand_options INTERFACE -march=native)
endif()
if(QUICKSAND_SANITIZE)
  target_compile_options(quicksand_options INTERFACE -fsanitize=${QUICKSAND_SANITIZE} -fno-omit-frame-pointer
                                                     -fno-sanitize-recover=all)
  target_link_options(quicksand_options INTERFACE -fsanitize=${QUICKSAND_SANITIZE})
endif()
target_compile_definitions(quicksand_options
                           INTERFACE QUICKSAND_SMALLEST_THREADED_LOOP=${QUICKSAND_SMALLEST_THREADED_LOOP})
string(REGEX REPLACE "-O2" "-O3" CMAKE_CXX_FLAGS_RELWITHDEBINFO "${CMAKE_CXX_FLAGS_RELWITHDEBINFO}")

add_library(quicksand_warnings INTERFACE)
target_compile_options(quicksand_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  # `omp simd` asks for vectors; where clang sees no gain it says so, and that is no fault of ours.
  target_compile_options(quicksand_warnings INTERFACE -Wno-pass-failed)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION MATCHES "^12\\.")
  # False alarms of g++ 12 in its own headers: overlapping copies in std::string for plain `"text" + string` (GCC bug
  # 105651), uninitialized vectors in the AVX-512 intrinsics that Eigen calls (GCC bug 105593).
  target_compile_options(quicksand_warnings INTERFACE -Wno-restrict -Wno-maybe-uninitialized)
endif()
if(QUICKSAND_WERROR)
  target_compile_options(quicksand_warnings INTERFACE -Werror)
endif()

find_program(CCACHE_PROGRAM ccache)
mark_as_advanced(CCACHE_PROGRAM)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()
