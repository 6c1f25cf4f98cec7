# The guide as HTML, for the package and for the daemon's page: in share/yuragi/guide beside bin.
if(YURAGI_SANITIZE) # nobody reads the guide of such a build
  return()
endif()
set(guide ${PROJECT_BINARY_DIR}/share/yuragi/guide)
file(GLOB guide_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/config/guide/*)
add_custom_command(OUTPUT ${guide}/keys.html
  COMMAND ${PYTHON3_PROGRAM} -B ${PROJECT_SOURCE_DIR}/config/guide/make_html.py ${guide} $<TARGET_FILE:yuragi> ${CMAKE_CROSSCOMPILING_EMULATOR}
  DEPENDS yuragi ${guide_sources} VERBATIM)
add_custom_target(yuragi_guide ALL DEPENDS ${guide}/keys.html)
install(DIRECTORY ${guide} DESTINATION ${CMAKE_INSTALL_DATADIR}/yuragi)
