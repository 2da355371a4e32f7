# Tools in Python that users call like executables. finray_python_tool(NAME SCRIPT)
# puts a launcher NAME beside the executables, in the build tree and where they are
# installed. It runs SCRIPT, a path in the source tree, from share/finray.
function(finray_python_tool name script)
  set(launcher ${PROJECT_BINARY_DIR}/${name})
  set(FINRAY_TOOL_SCRIPT ${script})
  configure_file(${PROJECT_SOURCE_DIR}/cmake/python_tool.in ${launcher} @ONLY
    FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                     WORLD_READ WORLD_EXECUTE)
  set_property(GLOBAL APPEND PROPERTY FINRAY_TOOL_FILES ${launcher})
  install(PROGRAMS ${launcher} DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
endfunction()
