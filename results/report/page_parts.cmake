# The page of `frahm report` is bundled from page/ and libraries of the npm registry, and stands in the program as
# text. Without Node.js and npm, or where the registry cannot be reached, all else builds and `frahm report` says
# what is missing.
set(FRAHM_REPORT AUTO CACHE STRING "The page of frahm report: ON, OFF, or AUTO (where Node.js and npm are found)")

set(report_source ${CMAKE_CURRENT_SOURCE_DIR}/report)
set(FRAHM_REPORT_BUILD ${CMAKE_CURRENT_BINARY_DIR}/report)
set(page_parts ${report_source}/no_page_parts.cpp)
set(FRAHM_WITH_REPORT FALSE)

function(refuse_report reason)
  if(FRAHM_REPORT STREQUAL "AUTO")
    message(WARNING "frahm report will have no page: ${reason}")
  else()
    message(FATAL_ERROR "FRAHM_REPORT=ON: ${reason}")
  endif()
endfunction()

# The packages of the lock file, beside the build; again only where that has changed.
function(install_page_packages)
  file(SHA256 ${report_source}/package-lock.json lock)
  set(stamp ${FRAHM_REPORT_BUILD}/installed.sha256)
  set(installed "")
  if(EXISTS ${stamp})
    file(READ ${stamp} installed)
  endif()
  if(NOT installed STREQUAL lock)
    file(COPY ${report_source}/package.json ${report_source}/package-lock.json ${report_source}/.npmrc
      DESTINATION ${FRAHM_REPORT_BUILD})
    execute_process(COMMAND ${FRAHM_NPM} ci --ignore-scripts --loglevel=error
      WORKING_DIRECTORY ${FRAHM_REPORT_BUILD} RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE complaint TIMEOUT 300)
    if(failed)
      refuse_report("npm could not install its packages: ${complaint}")
      return()
    endif()
    file(WRITE ${stamp} ${lock})
  endif()
  set(FRAHM_WITH_REPORT TRUE PARENT_SCOPE)
endfunction()

if(FRAHM_REPORT)
  find_program(FRAHM_NODE NAMES node nodejs)
  find_program(FRAHM_NPM npm)
  if(FRAHM_NODE AND FRAHM_NPM)
    install_page_packages()
  else()
    refuse_report("node and npm were not found (Debian: apt-get install nodejs npm), then configure again")
  endif()
endif()

if(FRAHM_WITH_REPORT)
  set(page_parts ${FRAHM_REPORT_BUILD}/page_parts.cpp)
  file(GLOB_RECURSE page_sources CONFIGURE_DEPENDS ${report_source}/page/*)
  add_custom_command(OUTPUT ${page_parts}
    COMMAND ${FRAHM_NODE} ${report_source}/bundle.mjs ${FRAHM_REPORT_BUILD}/node_modules ${page_parts}
    DEPENDS ${report_source}/bundle.mjs ${report_source}/package-lock.json ${page_sources}
    COMMENT "Bundling the report's page"
    VERBATIM)
endif()
