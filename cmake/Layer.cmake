# quicksand_layer(NAME FOLDER folder [BELOW layer] [PRIVATE_LIBRARIES ...])
# Static library of all sources in src/<folder> (main.cpp apart) on top of the layer below; quicksand::<folder> inside and
# outside this project.
function(quicksand_layer name)
  cmake_parse_arguments(PARSE_ARGV 1 layer "" "FOLDER;BELOW" "PRIVATE_LIBRARIES")
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${layer_FOLDER}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
  if(NOT sources)  # a static library needs one source
    set(sources ${PROJECT_BINARY_DIR}/no_source_yet.cpp)
    file(CONFIGURE OUTPUT ${sources} CONTENT "")
  endif()

  add_library(${name} STATIC ${sources})
  add_library(quicksand::${layer_FOLDER} ALIAS ${name})
  set_target_properties(${name} PROPERTIES EXPORT_NAME ${layer_FOLDER})
  target_compile_features(${name} PUBLIC cxx_std_20)
  # Headers include each other from src on; users may write <quicksand/physics/flow.hpp> as well.
  target_include_directories(
    ${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>
                   $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
                   $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/quicksand>)
  target_link_libraries(${name} PUBLIC ${layer_BELOW} quicksand_options OpenMP::OpenMP_CXX
                                PRIVATE $<BUILD_INTERFACE:quicksand_warnings> ${layer_PRIVATE_LIBRARIES})
endfunction()
