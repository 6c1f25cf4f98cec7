# The viewer for browsers, for the package and for the daemon's /wall: in share/yuragi/wall beside bin. It is built, once for all
# presets, where emscripten is installed (config/setup.sh --web); elsewhere /wall states that it is not there.
find_program(EMXX_PROGRAM em++)
find_program(BROTLI_PROGRAM brotli)
if(NOT EMXX_PROGRAM OR NOT BROTLI_PROGRAM OR NOT YURAGI_VIEWER OR YURAGI_SANITIZE)
  return()
endif()
set(web_build ${PROJECT_SOURCE_DIR}/build/web)
set(wall ${PROJECT_BINARY_DIR}/share/yuragi/wall)
# gzip's file has no time in it (-n): each package has the same bytes.
add_custom_target(yuragi_wall ALL
  COMMAND sh -c "\"$0\" --preset web --log-level=WARNING >/dev/null" ${CMAKE_COMMAND}
  COMMAND ${CMAKE_COMMAND} --build ${web_build}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${wall}
  COMMAND ${CMAKE_COMMAND} -E copy_if_different ${web_build}/share/yuragi/wall/viewer.js ${web_build}/share/yuragi/wall/viewer.wasm ${wall}
  COMMAND ${CMAKE_COMMAND} -E chdir ${wall} gzip -9 -n -k -f viewer.js viewer.wasm
  COMMAND ${CMAKE_COMMAND} -E chdir ${wall} ${BROTLI_PROGRAM} -q 11 -k -f viewer.js viewer.wasm
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} VERBATIM)
install(DIRECTORY ${wall} DESTINATION ${CMAKE_INSTALL_DATADIR}/yuragi FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
