# The viewer in a browser (preset `web`, Debian's package emscripten): the rooms that draw, and viewer/web. Instead of Dependencies.cmake.

# Of the libraries only headers are used, linked into a folder of their own: beside them /usr/include has those of another C library.
set(CMAKE_POSITION_INDEPENDENT_CODE OFF)
set(headers ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${headers})
foreach(library boost flatbuffers fmt glm nlohmann)
  if(NOT EXISTS /usr/include/${library})
    message(FATAL_ERROR "/usr/include/${library} does not exist: config/setup.sh installs it")
  endif()
  file(CREATE_LINK /usr/include/${library} ${headers}/${library} SYMBOLIC)
endforeach()
add_library(yuragi_web_headers INTERFACE)
target_include_directories(yuragi_web_headers SYSTEM INTERFACE ${headers} ${PROJECT_SOURCE_DIR}/config/cmake/web_headers)
target_compile_definitions(yuragi_web_headers INTERFACE FMT_HEADER_ONLY)
foreach(library Boost::headers flatbuffers::flatbuffers fmt::fmt glm::glm nlohmann_json::nlohmann_json
                PkgConfig::EPOXY PkgConfig::STB Threads::Threads yuragi_asio)
  add_library(${library} ALIAS yuragi_web_headers)
endforeach()
find_program(FLATC_PROGRAM flatc REQUIRED CMAKE_FIND_ROOT_PATH_BOTH)
find_program(PYTHON3_PROGRAM NAMES python3 PATHS /usr/bin REQUIRED NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH)

# Exceptions and vectors as WebAssembly has them, which is what every browser of 2023 and newer knows. libc++ 13 lacks some of C++20.
add_compile_options(-fwasm-exceptions -include ${PROJECT_SOURCE_DIR}/config/cmake/web_headers/missing_in_libcxx_13.hpp)
add_link_options(-fwasm-exceptions)

# Of these rooms other programs' sources and headers alone are needed.
foreach(room engine_platform engine_wind_judging)
  add_library(yuragi_${room} INTERFACE)
  target_link_libraries(yuragi_${room} INTERFACE yuragi_flags)
endforeach()

foreach(room engine/base engine/math engine/wind engine/pose engine/look engine/wire viewer/meshes viewer/light viewer/gl viewer/stream
             viewer/looks viewer/pace viewer/picture viewer/web)
  add_subdirectory(${room})
endforeach()
