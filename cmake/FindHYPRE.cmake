# Finds hypre, which in Debian comes without a CMake configuration.
#
# Result: target HYPRE::HYPRE and HYPRE_VERSION. HYPRE_ROOT (variable or environment) names another build, with MPI or
# without: HYPRE_config.h tells which.
find_path(HYPRE_INCLUDE_DIR HYPRE_struct_ls.h PATH_SUFFIXES hypre)
find_library(HYPRE_LIBRARY NAMES HYPRE hypre)
mark_as_advanced(HYPRE_INCLUDE_DIR HYPRE_LIBRARY)

set(HYPRE_NEEDS_MPI OFF)
set(HYPRE_NEEDS_OPENMP OFF)
if(HYPRE_INCLUDE_DIR AND EXISTS ${HYPRE_INCLUDE_DIR}/HYPRE_config.h)
  file(STRINGS ${HYPRE_INCLUDE_DIR}/HYPRE_config.h hypre_config REGEX "^#define ")
  foreach(line IN LISTS hypre_config)
    if(line MATCHES "HYPRE_RELEASE_VERSION[ \t]+\"([^\"]+)\"")
      set(HYPRE_VERSION ${CMAKE_MATCH_1})
    elseif(line MATCHES "HYPRE_HAVE_MPI[ \t]+1")
      set(HYPRE_NEEDS_MPI ON)
    elseif(line MATCHES "HYPRE_USING_OPENMP[ \t]+1")
      set(HYPRE_NEEDS_OPENMP ON)
    endif()
  endforeach()
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(HYPRE REQUIRED_VARS HYPRE_LIBRARY HYPRE_INCLUDE_DIR VERSION_VAR HYPRE_VERSION)

if(HYPRE_FOUND AND NOT TARGET HYPRE::HYPRE)
  add_library(HYPRE::HYPRE UNKNOWN IMPORTED)
  set_target_properties(HYPRE::HYPRE PROPERTIES IMPORTED_LOCATION ${HYPRE_LIBRARY}
                                                INTERFACE_INCLUDE_DIRECTORIES ${HYPRE_INCLUDE_DIR})
  if(HYPRE_NEEDS_MPI)
    find_package(MPI REQUIRED COMPONENTS C)
    # Only the C interface of MPI is wanted; the C++ bindings in the same header are long obsolete.
    set_target_properties(HYPRE::HYPRE PROPERTIES INTERFACE_COMPILE_DEFINITIONS "OMPI_SKIP_MPICXX;MPICH_SKIP_MPICXX")
    target_link_libraries(HYPRE::HYPRE INTERFACE MPI::MPI_C)
  endif()
  if(HYPRE_NEEDS_OPENMP)
    target_link_libraries(HYPRE::HYPRE INTERFACE OpenMP::OpenMP_CXX)
  endif()
  if(HYPRE_LIBRARY MATCHES "\\.a$")
    find_package(LAPACK)
    if(LAPACK_FOUND)
      target_link_libraries(HYPRE::HYPRE INTERFACE LAPACK::LAPACK)
    endif()
    target_link_libraries(HYPRE::HYPRE INTERFACE m)
  endif()
endif()
