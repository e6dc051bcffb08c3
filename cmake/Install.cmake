# What `cmake --install` copies: program, libraries with headers and CMake package, cases, manual page, completion.
include(CMakePackageConfigHelpers)

install(TARGETS quicksand quicksand_options quicksand_core quicksand_solvers quicksand_physics quicksand_app_lib
        EXPORT quicksandTargets)

# Headers that show another library's types serve the sources beside them only.
file(GLOB_RECURSE headers RELATIVE ${PROJECT_SOURCE_DIR}/src CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.hpp)
list(REMOVE_ITEM headers solvers/anderson.hpp)
foreach(header IN LISTS headers)
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES src/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/quicksand/${folder})
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/generated/core/version.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/quicksand/core)

# The package. Code compiled for this machine's processor must meet the like: see quicksandConfig.cmake.
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/quicksand)
set(QUICKSAND_VECTOR_UNITS "")
if(QUICKSAND_NATIVE)
  quicksand_vector_units(QUICKSAND_VECTOR_UNITS)
endif()
configure_package_config_file(cmake/quicksandConfig.cmake.in quicksandConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(quicksandConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT quicksandTargets NAMESPACE quicksand:: DESTINATION ${package})
install(FILES ${PROJECT_BINARY_DIR}/quicksandConfig.cmake ${PROJECT_BINARY_DIR}/quicksandConfigVersion.cmake
              cmake/FindHYPRE.cmake cmake/FindUDUNITS2.cmake cmake/VectorUnits.cmake DESTINATION ${package})

add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/quicksand.1 COMMAND quicksand manual > ${PROJECT_BINARY_DIR}/quicksand.1
                   DEPENDS quicksand VERBATIM)
add_custom_target(manual_page ALL DEPENDS ${PROJECT_BINARY_DIR}/quicksand.1)
install(FILES ${PROJECT_BINARY_DIR}/quicksand.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES tools/completion/quicksand.bash RENAME quicksand
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES tools/completion/_quicksand DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES tools/completion/quicksand.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/quicksand)
install(DIRECTORY examples/driver DESTINATION ${CMAKE_INSTALL_DATADIR}/quicksand/examples)
