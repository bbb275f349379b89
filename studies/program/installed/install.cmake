# What `cmake --install` puts where, and the Debian packages that `cpack` makes of it: `frahm` is the program with its
# manual, completions and studies; `libfrahm-dev` the rooms as static libraries for programs of one's own;
# `python3-frahm` the Python package (studies/python/CMakeLists.txt says where it goes).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(here ${CMAKE_CURRENT_LIST_DIR})
set(made ${CMAKE_BINARY_DIR}/installed)

# The program.
install(TARGETS frahm RUNTIME COMPONENT program)
install(DIRECTORY studies/ DESTINATION ${CMAKE_INSTALL_DATADIR}/frahm/studies COMPONENT program
  FILES_MATCHING PATTERN "*.toml" PATTERN "*.csv" PATTERN "*.mtx" PATTERN "README.md" PATTERN "*.txt" EXCLUDE
  PATTERN program EXCLUDE PATTERN reading EXCLUDE PATTERN provenance EXCLUDE PATTERN map EXCLUDE PATTERN motion EXCLUDE)
# The documents, in their folders, so that their links hold.
file(GLOB_RECURSE documents RELATIVE ${CMAKE_SOURCE_DIR} CONFIGURE_DEPENDS
  engine/*.md results/*.md solvers/*.md studies/*.md tests/README.md results/report/*.png)
foreach(document README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff ${documents})
  get_filename_component(folder ${document} DIRECTORY)
  install(FILES ${document} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder} COMPONENT program)
endforeach()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libfrahm-dev RENAME copyright COMPONENT development)

# Completion of commands and options, by the program itself from its command tree; manual pages from its help.
set(shells bash zsh fish)
set(bash_file ${CMAKE_INSTALL_DATADIR}/bash-completion/completions/frahm)
set(zsh_file ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions/_frahm)
set(fish_file ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d/frahm.fish)
foreach(shell ${shells})
  add_custom_command(OUTPUT ${made}/frahm.${shell} DEPENDS frahm
    COMMAND ${CMAKE_COMMAND} -E make_directory ${made}
    COMMAND frahm completion ${shell} > ${made}/frahm.${shell} VERBATIM)
  cmake_path(GET ${shell}_file PARENT_PATH folder)
  cmake_path(GET ${shell}_file FILENAME name)
  install(FILES ${made}/frahm.${shell} DESTINATION ${folder} RENAME ${name} COMPONENT program)
  list(APPEND from_program ${made}/frahm.${shell})
endforeach()
find_program(FRAHM_HELP2MAN help2man)
if(FRAHM_HELP2MAN)
  add_custom_command(OUTPUT ${made}/man/frahm.1.gz DEPENDS frahm ${here}/manual.sh
    COMMAND sh ${here}/manual.sh $<TARGET_FILE:frahm> ${made}/man VERBATIM)
  install(DIRECTORY ${made}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
  list(APPEND from_program ${made}/man/frahm.1.gz)
else()
  message(WARNING "no manual pages: help2man was not found (Debian: apt-get install help2man)")
endif()
add_custom_target(frahm_installed_texts ALL DEPENDS ${from_program})

# The libraries: find_package(frahm) and pkg-config.
set(rooms solvers engine results report studies)
list(TRANSFORM rooms PREPEND frahm_ OUTPUT_VARIABLE libraries)
foreach(room options ${rooms})
  set_target_properties(frahm_${room} PROPERTIES EXPORT_NAME ${room})
endforeach()
target_compile_features(frahm_options INTERFACE cxx_std_20)
install(TARGETS frahm_options ${libraries} EXPORT frahm
  ARCHIVE COMPONENT development INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/frahm)
install(EXPORT frahm NAMESPACE frahm:: FILE frahm-targets.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/frahm COMPONENT development)
foreach(room solvers engine results studies)
  install(DIRECTORY ${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/frahm COMPONENT development
    FILES_MATCHING PATTERN "*.hpp" PATTERN page EXCLUDE PATTERN data EXCLUDE
    PATTERN binding.hpp EXCLUDE PATTERN one_blas_thread.hpp EXCLUDE)
endforeach()
configure_package_config_file(${here}/frahm-config.cmake.in ${made}/frahm-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/frahm NO_SET_AND_CHECK_MACRO)
# Before 1.0 any minor version may change what programs of others use.
write_basic_package_version_file(${made}/frahm-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${made}/frahm-config.cmake ${made}/frahm-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/frahm COMPONENT development)
set(pc_flags -fno-math-errno -fno-trapping-math)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64" AND FRAHM_CPU)
  list(APPEND pc_flags -march=${FRAHM_CPU})
endif()
list(JOIN pc_flags " " pc_flags)
set(pc_mpi)
if(FRAHM_WITH_MPI)
  list(JOIN MPI_C_LIBRARIES " " pc_mpi)
endif()
configure_file(${here}/frahm.pc.in ${made}/frahm.pc @ONLY)
install(FILES ${made}/frahm.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

# Debian packages: cpack -G DEB in the build folder.
set(CPACK_PACKAGE_CONTACT "The Frahm authors <frahm@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME frahm)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "Parameter studies, tunings and identifications from study files,
on every core or MPI rank, to HDF5 files that open as labelled arrays.")   # the project's own goes before
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libfrahm-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "g++, libeigen3-dev, libfmt-dev, libsundials-dev, coinor-libipopt-dev, \
libnlopt-dev, libhdf5-dev, libisal-dev, libdeflate-dev, libxxhash-dev, libtomlplusplus-dev, libudunits2-dev, libsuitesparse-dev")
if(FRAHM_WITH_MPI)
  string(APPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ", libopenmpi-dev")
endif()
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "Static libraries and headers: solvers, studies and results for
programs of one's own, by find_package(frahm) or pkg-config.")
if(FRAHM_WITH_PYTHON)
  install(DIRECTORY studies/python/notebooks studies/python/dakota studies/python/openmdao
    DESTINATION ${CMAKE_INSTALL_DATADIR}/frahm/studies/python COMPONENT python PATTERN __pycache__ EXCLUDE)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-frahm RENAME copyright COMPONENT python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-frahm)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), \
python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-xarray, python3-h5netcdf, frahm")
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "Python package: studies, points, rows, runs, tunings and identifications with
NumPy arrays and xarray datasets.")
endif()
include(CPack)
