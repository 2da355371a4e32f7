# Man pages and bash completions from the flags, and the Debian packages:
#   cpack --config <build>/CPackConfig.cmake
set(FINRAY_PAGES ${PROJECT_BINARY_DIR}/pages)
get_property(FINRAY_TOOL_FILES GLOBAL PROPERTY FINRAY_TOOL_FILES)
foreach(app ${FINRAY_APP_NAMES})
  list(APPEND FINRAY_TOOL_FILES $<TARGET_FILE:${app}>)
endforeach()
add_custom_command(OUTPUT ${FINRAY_PAGES}/stamp
  COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/scripts/package/make_pages.py
    ${FINRAY_VERSION} ${FINRAY_PAGES} ${FINRAY_TOOL_FILES}
  COMMAND ${CMAKE_COMMAND} -E touch ${FINRAY_PAGES}/stamp
  DEPENDS ${FINRAY_APP_NAMES} ${PROJECT_SOURCE_DIR}/scripts/package/make_pages.py
  COMMENT "Man pages and completions")
add_custom_target(finray_pages ALL DEPENDS ${FINRAY_PAGES}/stamp)
install(DIRECTORY ${FINRAY_PAGES}/man1/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
  COMPONENT tools)
install(DIRECTORY ${FINRAY_PAGES}/completions/
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT tools)

# A wheel takes nothing of the following.
if(NOT FINRAY_SHARED OR SKBUILD)
  return()
endif()

# In Debian 1.0.0~rc1 comes before 1.0.0.
string(REPLACE "-" "~" FINRAY_DEBIAN_VERSION ${FINRAY_VERSION})

# What Debian asks of every package: its copyright and its changelog.
find_program(GZIP_PROGRAM gzip)
set(FINRAY_PACKAGE_tools finray)
set(FINRAY_PACKAGE_runtime libfinray${FINRAY_SOVERSION})
set(FINRAY_PACKAGE_dev libfinray-dev)
set(FINRAY_PACKAGE_python python3-finray)
set(FINRAY_COMPONENTS tools runtime dev)
if(TARGET finray_python)
  list(APPEND FINRAY_COMPONENTS python)
endif()
set(FINRAY_DEBIAN ${PROJECT_BINARY_DIR}/debian)
file(READ ${PROJECT_SOURCE_DIR}/LICENSE FINRAY_LICENSE)
string(REGEX REPLACE "\n+$" "" FINRAY_LICENSE "${FINRAY_LICENSE}")
string(REPLACE "\n" "\n " FINRAY_LICENSE "${FINRAY_LICENSE}")
string(REPLACE "\n \n" "\n .\n" FINRAY_LICENSE "${FINRAY_LICENSE}")
configure_file(${PROJECT_SOURCE_DIR}/cmake/copyright.in ${FINRAY_DEBIAN}/copyright @ONLY)
string(TIMESTAMP FINRAY_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(${PROJECT_SOURCE_DIR}/cmake/changelog.Debian.in
  ${FINRAY_DEBIAN}/changelog.Debian @ONLY)
execute_process(COMMAND ${GZIP_PROGRAM} -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md
  OUTPUT_FILE ${FINRAY_DEBIAN}/changelog.gz)
execute_process(COMMAND ${GZIP_PROGRAM} -9nc ${FINRAY_DEBIAN}/changelog.Debian
  OUTPUT_FILE ${FINRAY_DEBIAN}/changelog.Debian.gz)
foreach(component ${FINRAY_COMPONENTS})
  set(package ${FINRAY_PACKAGE_${component}})
  install(FILES ${FINRAY_DEBIAN}/copyright ${FINRAY_DEBIAN}/changelog.gz
    ${FINRAY_DEBIAN}/changelog.Debian.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
  if(EXISTS ${PROJECT_SOURCE_DIR}/cmake/lintian/${package})
    install(FILES ${PROJECT_SOURCE_DIR}/cmake/lintian/${package}
      DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides COMPONENT ${component})
  endif()
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL ${FINRAY_COMPONENTS})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGE_NAME finray)
set(CPACK_PACKAGE_VERSION ${FINRAY_DEBIAN_VERSION})
set(CPACK_PACKAGE_CONTACT "finray developers <finray@localhost.localdomain>")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
  GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_THREADS 0)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(this "${FINRAY_DEBIAN_VERSION}-1")

set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS "python3, python3-numpy, python3-yaml") # finray_import
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS
  "python3-matplotlib, python3-jinja2")
set(CPACK_COMPONENT_TOOLS_DESCRIPTION
"contact sensing and calibration of Fin-Ray fingers: executables
Estimates where and how hard a soft Fin-Ray gripper finger is touched from its
strain gauges, with uncertainty, and calibrates fingers from logs that have a
reference force sensor.")

set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
file(WRITE ${FINRAY_DEBIAN}/shlibs
  "libfinray ${FINRAY_SOVERSION} libfinray${FINRAY_SOVERSION} (>= ${FINRAY_DEBIAN_VERSION})\n")
file(WRITE ${FINRAY_DEBIAN}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA
  "${FINRAY_DEBIAN}/shlibs;${FINRAY_DEBIAN}/triggers")
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
"contact sensing and calibration of Fin-Ray fingers: shared library
The library behind finray: statics of Fin-Ray fingers, estimation of contacts
from strain gauges, and calibration.")

set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libfinray${FINRAY_SOVERSION} (= ${this})")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "libceres-dev, pkg-config")
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS cmake)
set(CPACK_COMPONENT_DEV_DESCRIPTION
"contact sensing and calibration of Fin-Ray fingers: development
Headers of finray, its packages for CMake and pkg-config, and examples in C++
and for ROS 2.
Residuals of one's own (finray/residuals.h) need libceres-dev too.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
  "libfinray${FINRAY_SOVERSION} (= ${this}), finray (= ${this}), ${FINRAY_DEBIAN_PYTHON}, python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-matplotlib, python3-pandas")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
  "${PROJECT_SOURCE_DIR}/cmake/debian/postinst;${PROJECT_SOURCE_DIR}/cmake/debian/prerm")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
"contact sensing and calibration of Fin-Ray fingers: Python 3
Simulates, estimates, senses live, calibrates and reconstructs on NumPy arrays
and pandas tables, with the numbers of the executables.")
include(CPack)
# CPack would pack the folder as it lies there, with its builds. Sources are packed by
# scripts/source_archive.
file(REMOVE ${PROJECT_BINARY_DIR}/CPackSourceConfig.cmake)
