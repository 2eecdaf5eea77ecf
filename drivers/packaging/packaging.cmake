# The manual page and the completions of shells, which the program writes itself, and the Debian packages.

find_program(GZIP_PROGRAM gzip)
set(manual ${PROJECT_BINARY_DIR}/manual)
file(MAKE_DIRECTORY ${manual})
# Made with the program, so that whoever installs it has those of its options.
add_custom_command(TARGET traceraft POST_BUILD
  COMMAND $<TARGET_FILE:traceraft> man > ${manual}/traceraft.1
  COMMAND $<TARGET_FILE:traceraft> completions bash > ${manual}/traceraft.bash
  COMMAND $<TARGET_FILE:traceraft> completions zsh > ${manual}/_traceraft
  COMMAND $<TARGET_FILE:traceraft> completions fish > ${manual}/traceraft.fish
  VERBATIM)
install(FILES ${manual}/traceraft.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  RENAME traceraft COMPONENT program)
install(FILES ${manual}/traceraft.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
  COMPONENT program)
set(zsh_folder site-functions)
if(TRACERAFT_DEBIAN)
  set(zsh_folder vendor-completions)
endif()
install(FILES ${manual}/_traceraft DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/${zsh_folder} COMPONENT program)

if(NOT TRACERAFT_DEBIAN)
  install(FILES ${manual}/traceraft.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
  return()
endif()

# Debian's policy wants manual page and changelogs compressed, and a copyright file of each package.
if(NOT GZIP_PROGRAM)
  message(FATAL_ERROR "TRACERAFT_DEBIAN needs gzip")
endif()
set(package_version ${PROJECT_VERSION}-1)
execute_process(COMMAND date --utc --rfc-email --date ${TRACERAFT_RELEASE_DATE}
  OUTPUT_VARIABLE release_date OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
set(TRACERAFT_MAINTAINER "The traceraft developers <maintainers@traceraft.invalid>" CACHE STRING
  "Maintainer of the Debian packages, with an address")
set(changelog ${manual}/changelog.Debian)
configure_file(${CMAKE_CURRENT_LIST_DIR}/changelog.in ${changelog} @ONLY)
add_custom_command(TARGET traceraft POST_BUILD
  COMMAND ${GZIP_PROGRAM} -9 -n -c ${manual}/traceraft.1 > ${manual}/traceraft.1.gz
  COMMAND ${GZIP_PROGRAM} -9 -n -c ${changelog} > ${manual}/changelog.Debian.gz
  COMMAND ${GZIP_PROGRAM} -9 -n -c ${PROJECT_SOURCE_DIR}/CHANGELOG.md > ${manual}/changelog.gz
  VERBATIM)
install(FILES ${manual}/traceraft.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
foreach(component program development)
  set(folder ${CMAKE_INSTALL_DATADIR}/doc/traceraft)
  if(component STREQUAL development)
    set(folder ${folder}-dev)
  endif()
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/copyright ${manual}/changelog.Debian.gz ${manual}/changelog.gz
    DESTINATION ${folder} COMPONENT ${component})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGE_NAME traceraft)
set(CPACK_PACKAGE_VENDOR "The traceraft developers")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${TRACERAFT_MAINTAINER})

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME traceraft)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "simulation of lipid rafts on liposomes
Predicts how lipid rafts form and coarsen on giant vesicles and other smooth
closed surfaces: the surface Cahn-Hilliard equation by trace finite elements,
with time integrators and linear solvers to choose from, calibration from
measurements, and a search for what a model is missing.")
# What the program is linked with, dpkg-shlibdeps finds.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# Charts, vesicles to turn on pages, and mpirun.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "gnuplot-nox | gnuplot, libjs-three")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "paraview, traceraft-dev (= ${package_version})")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME traceraft-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "simulation of lipid rafts on liposomes - libraries
Static libraries and headers of traceraft: trace finite elements on implicit
surfaces, the surface Cahn-Hilliard equation, time integrators and linear
solvers. CMake finds them by find_package(traceraft).")
# What traceraftConfig.cmake looks for.
set(development_depends "traceraft (= ${package_version})" libeigen3-dev libgif-dev libmuparser-dev libnlopt-dev
  libopenblas-dev libpng-dev libsodium-dev libsuitesparse-dev libsundials-dev zlib1g-dev)
if(with_mpi)
  string(APPEND CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS ", openmpi-bin")
  list(APPEND development_depends libopenmpi-dev)
endif()
if(with_trilinos)
  list(APPEND development_depends trilinos-all-dev)
endif()
list(JOIN development_depends ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
include(CPack)
