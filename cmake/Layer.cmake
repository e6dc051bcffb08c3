# quicksand_layer(NAME FOLDER folder [BELOW layer] [PRIVATE_LIBRARIES ...])
# Static library of all sources in src/<folder> (main.cpp apart) on top of the layer below.
function(quicksand_layer name)
  cmake_parse_arguments(PARSE_ARGV 1 layer "" "FOLDER;BELOW" "PRIVATE_LIBRARIES")
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${layer_FOLDER}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
  if(NOT sources)  # a static library needs one source
    set(sources ${PROJECT_BINARY_DIR}/no_source_yet.cpp)
    file(CONFIGURE OUTPUT ${sources} CONTENT "")
  endif()

  add_library(${name} STATIC ${sources})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR}/src)
  target_compile_definitions(${name} PRIVATE QUICKSAND_VERSION="${PROJECT_VERSION}")
  target_link_libraries(${name} PUBLIC ${layer_BELOW} quicksand_options OpenMP::OpenMP_CXX
                                PRIVATE quicksand_warnings ${layer_PRIVATE_LIBRARIES})
endfunction()
