# cmake --install. Components: tools (executables and what they read), runtime (the
# shared library), dev (headers, packages for CMake and pkg-config), python.

# Folders of a package are for all to read, whatever the umask.
set(CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
  GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

install(TARGETS ${FINRAY_APP_NAMES} DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)

# Files that executables read lie as in the source tree (io/resources.h). Python tools
# add their folder here.
set(FINRAY_RESOURCE_FOLDERS calib/report configs scripts/perception scripts/benchmark
    scripts/peers scripts/common scripts/import scripts/convert
    datasets/simulated_r15)
foreach(folder ${FINRAY_RESOURCE_FOLDERS})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}/
    DESTINATION ${CMAKE_INSTALL_DATADIR}/finray/${folder} COMPONENT tools
    PATTERN __pycache__ EXCLUDE)
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/scripts/studies/calibration_speed.py
  DESTINATION ${CMAKE_INSTALL_DATADIR}/finray/scripts/studies COMPONENT tools)
# Tools in Python read their version there.
install(FILES ${PROJECT_SOURCE_DIR}/CMakeLists.txt
  DESTINATION ${CMAKE_INSTALL_DATADIR}/finray COMPONENT tools)
install(PROGRAMS ${PROJECT_SOURCE_DIR}/apps/finray_import ${PROJECT_SOURCE_DIR}/apps/finray_convert
  DESTINATION ${CMAKE_INSTALL_DATADIR}/finray/apps COMPONENT tools)
install(FILES ${PROJECT_SOURCE_DIR}/scripts/make_dataset.py
  DESTINATION ${CMAKE_INSTALL_DATADIR}/finray/scripts COMPONENT tools)
