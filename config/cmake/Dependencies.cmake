# Every library from outside, each as one imported target. All are Debian 12 packages (config/setup.sh installs them).
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(Boost 1.81 REQUIRED)      # header-only use: System, Asio, Lockfree
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(FlatBuffers CONFIG REQUIRED)
find_package(date REQUIRED)
pkg_check_modules(FFTW3 REQUIRED IMPORTED_TARGET fftw3)
pkg_check_modules(LIBMODBUS REQUIRED IMPORTED_TARGET libmodbus)
pkg_check_modules(HIDAPI REQUIRED IMPORTED_TARGET hidapi-hidraw)
pkg_check_modules(LIBUSB REQUIRED IMPORTED_TARGET libusb-1.0)
pkg_check_modules(PORTAUDIO REQUIRED IMPORTED_TARGET portaudio-2.0)
pkg_check_modules(MOSQUITTO REQUIRED IMPORTED_TARGET libmosquitto)
pkg_check_modules(LIBLO REQUIRED IMPORTED_TARGET liblo)
pkg_check_modules(UMOCKDEV IMPORTED_TARGET umockdev-1.0) # yuragi-sim's --umockdev, where it is there
find_package(nlohmann_json REQUIRED)
find_program(FLATC_PROGRAM flatc REQUIRED)
find_program(PYTHON3_PROGRAM NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED) # that of Debian

# Asio compiled once, as its documentation's "separate compilation" has it, and not in each file that includes it.
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/asio.cpp CONTENT "#include <boost/asio/impl/src.hpp>\n")
add_library(yuragi_asio STATIC ${CMAKE_CURRENT_BINARY_DIR}/asio.cpp)
target_compile_definitions(yuragi_asio PUBLIC BOOST_ASIO_SEPARATE_COMPILATION)
target_link_libraries(yuragi_asio PUBLIC Boost::headers Threads::Threads)
if(YURAGI_SANITIZE)
  target_compile_options(yuragi_asio PRIVATE -fsanitize=${YURAGI_SANITIZE} -fno-omit-frame-pointer
    $<$<CXX_COMPILER_ID:GNU>:-Wno-tsan>)
endif()

if(YURAGI_VIEWER)
  find_package(glfw3 REQUIRED)
  find_package(glm REQUIRED)
  pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET epoxy)
  pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)
  pkg_check_modules(STB REQUIRED IMPORTED_TARGET stb)
endif()

if(YURAGI_TESTS)
  find_package(GTest REQUIRED)
  find_package(benchmark REQUIRED)
  pkg_check_modules(UMOCKDEV REQUIRED IMPORTED_TARGET umockdev-1.0)
  pkg_check_modules(ALSA REQUIRED IMPORTED_TARGET alsa)
  include(GoogleTest)
endif()
