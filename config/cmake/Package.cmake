# The Debian package: what is installed besides the programs, and its description for dpkg (config/package.sh builds it).
set(maintainer "The Yuragi authors <yuragi@example.org>")
set(package_folder ${PROJECT_SOURCE_DIR}/config/package)
set(units_folder ${PROJECT_SOURCE_DIR}/config/systemd)

install(FILES ${units_folder}/yuragi.service ${units_folder}/yuragi-viewer@.service ${units_folder}/yuragi-report.service
  ${units_folder}/yuragi-report.timer DESTINATION /lib/systemd/system)
install(PROGRAMS ${units_folder}/daily-report DESTINATION lib/yuragi)
install(FILES ${units_folder}/yuragi.sysusers DESTINATION lib/sysusers.d RENAME yuragi.conf)
# From which postinst makes /etc/yuragi/yuragi.toml, once: a file of dpkg's own would be asked about at an upgrade.
install(FILES ${units_folder}/yuragi.toml DESTINATION share/yuragi)
install(FILES ${package_folder}/copyright DESTINATION share/doc/yuragi)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/config/examples DESTINATION share/doc/yuragi
  PATTERN "*.log" EXCLUDE PATTERN "__pycache__" EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/config/garden.toml ${PROJECT_SOURCE_DIR}/engine/wire/pose.fbs DESTINATION share/doc/yuragi/examples)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/config/prometheus DESTINATION share/doc/yuragi)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/config/proxies DESTINATION share/doc/yuragi)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/config/nats DESTINATION share/doc/yuragi)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/config/rehearsals DESTINATION share/doc/yuragi)

# Made of what the programs say of themselves, when they are there.
set(programs ${PROJECT_BINARY_DIR}/bin/yuragi ${PROJECT_BINARY_DIR}/bin/yuragi-sim)
if(YURAGI_VIEWER)
  list(APPEND programs ${PROJECT_BINARY_DIR}/bin/yuragi-viewer)
endif()
if(CMAKE_CROSSCOMPILING)
  set(emulator -- ${CMAKE_CROSSCOMPILING_EMULATOR})
endif()
install(CODE "execute_process(COMMAND ${PYTHON3_PROGRAM} -B ${package_folder}/documents.py ${PROJECT_SOURCE_DIR}
  \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}\" ${PROJECT_VERSION} \"${maintainer}\" ${programs} ${emulator}
  COMMAND_ERROR_IS_FATAL ANY)")

# The libraries that the package needs are those of the distribution it is built on, or of the sysroot it is built against. Its version
# has the distribution: 0.2.0+deb12, 0.2.0+ubuntu24.04. "+", so that it is newer than 0.2.0, which was for Debian 12.
set(os_release ${CMAKE_SYSROOT}/usr/lib/os-release)
if(NOT EXISTS ${os_release})
  set(os_release /etc/os-release)
endif()
file(STRINGS ${os_release} os_release_lines REGEX "^(ID|VERSION_ID)=")
foreach(line IN LISTS os_release_lines)
  string(REGEX MATCH "^([A-Z_]+)=\"?([^\"]*)" matched "${line}")
  set(os_${CMAKE_MATCH_1} "${CMAKE_MATCH_2}")
endforeach()
string(REGEX REPLACE "^debian$" "deb" os_ID "${os_ID}")
set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION}+${os_ID}${os_VERSION_ID})

set(CPACK_GENERATOR DEB)
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/package)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PACKAGE_CONTACT ${maintainer})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION misc)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
if(CMAKE_CROSSCOMPILING) # config/package.sh gives dpkg-shlibdeps DEB_HOST_ARCH
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE ${YURAGI_DEBIAN_ARCHITECTURE})
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_SYSROOT}/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE})
endif()
set(CPACK_DEBIAN_PACKAGE_DEPENDS "systemd, tzdata, libegl1, gnuplot-nox | gnuplot-qt | gnuplot-x11")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "xinit, xserver-xorg-core, xserver-xorg-input-libinput, libgl1-mesa-dri, avahi-daemon, avahi-utils")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "bash-completion, ffmpeg")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "animation of grass, cloth, trees and flames by the real wind")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "Yuragi reads anemometers, follows the wind with a noise-driven animation
method, and streams moving skeletons to a viewer, for months, with nobody
there. Without a sensor it replays recorded winds, and makes up its own.
.
This package has the daemon, the viewer, simulated sensors, and units of
systemd for the daemon, for a wall at boot and for a daily report. It starts
none of them by itself.")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${package_folder}/postinst ${package_folder}/prerm ${package_folder}/postrm)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
