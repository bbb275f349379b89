# The documents of all rooms as one site, where Sphinx, MyST, the theme and KaTeX are installed: target `site`.
find_program(FRAHM_SPHINX sphinx-build)
set(FRAHM_WITH_SITE FALSE)
if(FRAHM_SPHINX)
  execute_process(COMMAND ${FRAHM_SPHINX} --version RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
  execute_process(COMMAND /usr/bin/python3 -c "import sphinx, myst_parser, furo" RESULT_VARIABLE missing OUTPUT_QUIET ERROR_QUIET)
  if(failed EQUAL 0 AND missing EQUAL 0 AND EXISTS /usr/share/nodejs/katex)
    set(FRAHM_WITH_SITE TRUE)
  endif()
endif()
if(FRAHM_WITH_SITE)
  # Of every document in its place, each time anew; a warning is an error.
  set(FRAHM_SITE_COMMAND ${FRAHM_SPHINX} -q -W --keep-going -n -E -c ${CMAKE_SOURCE_DIR}/studies/site ${CMAKE_SOURCE_DIR})
  add_custom_target(site
    COMMAND ${FRAHM_SITE_COMMAND} ${CMAKE_BINARY_DIR}/site
    COMMENT "The documents as a site: ${CMAKE_BINARY_DIR}/site/index.html" VERBATIM)
endif()
