# How the program was built, for provenance/build_facts.cpp: known only here. The commit is that of the sources when CMake
# last ran, which it does again when the commit changes.
find_package(Git QUIET)
set(commit "unknown")
if(GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} describe --always --abbrev=40 --exclude=* --dirty
    WORKING_DIRECTORY ${CMAKE_SOURCE_DIR} OUTPUT_VARIABLE described RESULT_VARIABLE failed
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    set(commit "${described}")
  endif()
  if(EXISTS ${CMAKE_SOURCE_DIR}/.git/logs/HEAD)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/.git/logs/HEAD)
  endif()
endif()

pkg_check_modules(UDUNITS2_PACKAGE QUIET udunits)
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
set(flags "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}}")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64" AND FRAHM_CPU)
  string(APPEND flags " -march=${FRAHM_CPU}")
endif()
if(FRAHM_SANITIZE)
  string(APPEND flags " -fsanitize=${FRAHM_SANITIZE}")
endif()
string(STRIP "${flags}" flags)

set(libraries
  "Eigen ${Eigen3_VERSION}" "Boost ${Boost_VERSION}" "SUNDIALS ${SUNDIALS_VERSION}"
  "Ipopt ${IPOPT_VERSION}" "NLopt ${NLOPT_VERSION}" "HDF5 ${HDF5_VERSION}"
  "ISA-L ${ISAL_VERSION}" "libdeflate ${DEFLATE_VERSION}" "xxHash ${XXHASH_VERSION}"
  "UDUNITS ${UDUNITS2_PACKAGE_VERSION}" "toml++ ${tomlplusplus_VERSION}" "CLI11 ${CLI11_VERSION}"
  "JSON for Modern C++ ${nlohmann_json_VERSION}" "fmt ${fmt_VERSION}" "OpenMP ${OpenMP_CXX_VERSION}")
list(JOIN libraries "|" libraries)

set_property(SOURCE provenance/build_facts.cpp APPEND PROPERTY COMPILE_DEFINITIONS
  FRAHM_VERSION="${PROJECT_VERSION}"
  FRAHM_COMMIT="${commit}"
  FRAHM_COMPILER="${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
  FRAHM_FLAGS="${flags}"
  FRAHM_LIBRARIES="${libraries}")
