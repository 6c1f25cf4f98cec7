# How the project's own targets are declared. A room (ARCHITECTURE.md) is a library: engine/wind is yuragi_engine_wind.

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${PROJECT_SOURCE_DIR}/config/cmake/compile_cached.sh ${PROJECT_SOURCE_DIR})
  set(CMAKE_C_COMPILER_LAUNCHER ${CMAKE_CXX_COMPILER_LAUNCHER})
endif()

# Flags that every target of ours is compiled with.
#  -ffp-contract=off     the same sums on every machine: poses are compared bit for bit
#  -fno-math-errno, -fno-trapping-math   allow the plain loops of the kernels to be vectorised
add_library(yuragi_flags INTERFACE)
target_include_directories(yuragi_flags INTERFACE ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR})
target_compile_options(yuragi_flags INTERFACE
  -ffp-contract=off -fno-math-errno -fno-trapping-math
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wold-style-cast -Wnon-virtual-dtor
  -Woverloaded-virtual -Wimplicit-fallthrough -Wdouble-promotion
  $<$<BOOL:${YURAGI_WERROR}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(yuragi_flags INTERFACE --param=ggc-min-heapsize=524288) # its garbage collection waits: 5 to 10 % less CPU time (measured), up to 0.3 GB more memory
endif()
if(YURAGI_PRECOMPILE_HEADERS)
  target_compile_options(yuragi_flags INTERFACE -pthread) # as libraries that some rooms use want it: headers are read once for all
endif()
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(yuragi_flags INTERFACE -Wno-subobject-linkage) # each of our files seems a header there
endif()
if(YURAGI_SANITIZE)
  # Of the folder, so that a target's own options follow and can take a part of them back.
  add_compile_options(-fsanitize=${YURAGI_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${YURAGI_SANITIZE})
  if(YURAGI_SANITIZE MATCHES undefined)
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # gcc 12 takes what the sanitizers add for reads of what was never written (GCC bug 105562).
    target_compile_options(yuragi_flags INTERFACE -Wno-maybe-uninitialized)
  endif()
  if(YURAGI_SANITIZE MATCHES thread AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(yuragi_flags INTERFACE -Wno-tsan) # atomic_thread_fence inside Asio
  endif()
endif()

# The options of code that is compiled as it stands. There each access through a pointer would be checked for null and for alignment,
# a third of the compilation with sanitizers. The address sanitizer reports a null pointer that is used as well, and what reads
# bytes as numbers is in hot rooms, where the checks stay.
set(YURAGI_UNOPTIMIZED -O0)
if(YURAGI_SANITIZE MATCHES undefined)
  list(APPEND YURAGI_UNOPTIMIZED -fno-sanitize=null,alignment)
endif()

# The rooms where a running program spends its time: poses and wind, readings, recordings and their import, the stream, pictures.
# They are compiled with the preset's optimization. All others (options, settings, JSON, tables, the web page, the set-up of
# devices, simulators) run once or wait for others: they are compiled with -O1, which is faster. With YURAGI_COLD_UNOPTIMIZED only
# those have the preset's optimization in which tests compute for long, all others -O0: their compilation takes longer. With sanitizers
# only the engine has it, and what tests run longest in -O1.
set(YURAGI_HOT_ROOMS engine drivers/decode drivers/windlog daemon/animation daemon/pictures daemon/sensing daemon/stream
                     daemon/tools/csv daemon/tools/logs viewer)
set(YURAGI_WARM_ROOMS "[^/]+")
if(YURAGI_COLD_UNOPTIMIZED)
  set(YURAGI_WARM_ROOMS "")
  set(YURAGI_HOT_ROOMS engine drivers/decode drivers/windlog viewer)
endif()
if(YURAGI_SANITIZE)
  set(YURAGI_WARM_ROOMS drivers/decode drivers/windlog daemon/tools/csv daemon/tools/logs viewer)
  set(YURAGI_HOT_ROOMS engine)
endif()
list(JOIN YURAGI_HOT_ROOMS "|" YURAGI_HOT_ROOMS)
list(JOIN YURAGI_WARM_ROOMS "|" YURAGI_WARM_ROOMS)

# yuragi_room(engine/wind SOURCES a.cpp b.cpp LINK yuragi_engine_base ...)
# A library of one folder. LINK lists the rooms and libraries whose headers it includes; tests/architecture holds its sources against it.
# DESKTOP lists sources that a browser has no use for.
function(yuragi_room folder)
  cmake_parse_arguments(ARG "" "" "SOURCES;DESKTOP;LINK" ${ARGN})
  if(NOT EMSCRIPTEN)
    list(APPEND ARG_SOURCES ${ARG_DESKTOP})
  endif()
  string(REPLACE "/" "_" name "yuragi_${folder}")
  if(ARG_SOURCES)
    add_library(${name} STATIC ${ARG_SOURCES})
    target_link_libraries(${name} PUBLIC yuragi_flags ${ARG_LINK})
    if(NOT folder MATCHES "^(${YURAGI_HOT_ROOMS})(/|$)")
      if(folder MATCHES "^(${YURAGI_WARM_ROOMS})(/|$)")
        target_compile_options(${name} PRIVATE -O1)
      else()
        target_compile_options(${name} PRIVATE ${YURAGI_UNOPTIMIZED})
      endif()
    endif()
    if(YURAGI_FUZZ AND NOT folder MATCHES "^engine/(fft|math|noise|operators|scenes|wind)|^viewer/(app|film|picture)$")
      target_compile_options(${name} PRIVATE -fsanitize=fuzzer-no-link) # the fuzzer sees which branches ran
    endif()
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE yuragi_flags ${ARG_LINK})
  endif()
endfunction()

# yuragi_program(yuragi-sim LINK ...)
# A program that is installed, of the folder's main.cpp.
function(yuragi_program name)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  add_executable(${name} main.cpp)
  target_link_libraries(${name} PRIVATE ${ARG_LINK})
  if(YURAGI_COLD_UNOPTIMIZED)
    target_compile_options(${name} PRIVATE ${YURAGI_UNOPTIMIZED})
  endif()
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()

# yuragi_kernel(yuragi_engine_pose strand_kernels.cpp)
# Compiles a kernel file once for each SIMD row (SimdRows.cmake), together with the other kernels of the target in a unity build,
# with YURAGI_SIMD_ROW set to the row's name; engine/base/simd_row.hpp chooses among them at start.
function(yuragi_kernel target source)
  foreach(row IN LISTS YURAGI_SIMD_ROWS)
    set(object ${target}_kernels_${row})
    if(TARGET ${object})
      target_sources(${object} PRIVATE ${source})
      continue()
    endif()
    add_library(${object} OBJECT ${source})
    target_link_libraries(${object} PRIVATE yuragi_flags)
    target_compile_definitions(${object} PRIVATE YURAGI_SIMD_ROW=${row})
    # gcc gives a loop over many arrays up if it must check more than 10 pairs of them for overlap.
    target_compile_options(${object} PRIVATE -O3 ${YURAGI_SIMD_FLAGS_${row}}
      $<$<CXX_COMPILER_ID:GNU>:--param=vect-max-version-for-alias-checks=64>)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${object}>)
  endforeach()
endfunction()

# yuragi_table(yuragi_daemon_commands HEADER daemon/commands/command.hpp TYPE daemon::commands::Command
#              TABLE daemon::commands::command_table ENTRIES daemon::commands::kRunCommand ...)
# Writes the function `std::span<const TYPE* const> TABLE()` over constants `extern const TYPE ENTRY`; all names as seen
# from namespace yuragi. Static registration would be dropped by the linker; this cannot be. Where a table has entries of
# several folders, each folder lists its own: yuragi_entries(DRIVERS drivers::text::kLineDriver ...), of which a table is
# made by `ENTRIES_OF DRIVERS`, in the order of the folders.
function(yuragi_entries list)
  set_property(GLOBAL APPEND PROPERTY YURAGI_ENTRIES_OF_${list} ${ARGN})
endfunction()

function(yuragi_table target)
  cmake_parse_arguments(ARG "" "HEADER;TYPE;TABLE;ENTRIES_OF" "ENTRIES" ${ARGN})
  if(ARG_ENTRIES_OF)
    get_property(ARG_ENTRIES GLOBAL PROPERTY YURAGI_ENTRIES_OF_${ARG_ENTRIES_OF})
  endif()
  set(declarations "")
  set(pointers "")
  foreach(entry IN LISTS ARG_ENTRIES)
    string(REGEX MATCH "^(.+)::([^:]+)$" matched ${entry})
    string(APPEND declarations "namespace ${CMAKE_MATCH_1} { extern const ${ARG_TYPE} ${CMAKE_MATCH_2}; }\n")
    string(APPEND pointers "  static_cast<const ${ARG_TYPE}*>(&${entry}),\n")
  endforeach()
  string(REGEX REPLACE "^.*::" "" table ${ARG_TABLE})
  set(file ${CMAKE_CURRENT_BINARY_DIR}/${table}.cpp)
  file(CONFIGURE OUTPUT ${file} @ONLY CONTENT
"// Generated from ${CMAKE_CURRENT_SOURCE_DIR}/CMakeLists.txt: add an entry there.
#include <array>
#include \"@ARG_HEADER@\"
namespace yuragi {
@declarations@
std::span<const @ARG_TYPE@* const> @ARG_TABLE@() {
  static const std::array entries{
@pointers@  };
  return entries;
}
}  // namespace yuragi
")
  target_sources(${target} PRIVATE ${file})
endfunction()

# yuragi_test(NAME SOURCES ... LINK ... [NEEDS ...] [LABELS ...] [UNSANITIZED ...] [LONG ...] [ALONE]): one GoogleTest program, each of
# its cases a CTest test; with sanitizers, where a process costs more than a case, a part of its cases is one. Those of the engine are
# labelled `engine`; where there are no threads (all but its base, its platform and its workers) `engine_threadless`. NEEDS names other programs that it
# runs. UNSANITIZED names cases that repeat for their statistics what shorter cases do once: a sanitizer sees the same memory accesses
# there, and leaves the long ones out; and cases that cannot run with one. They are labelled `native`. LONG names cases that do on other
# records what the others do on one: they are labelled `long`.
#
# In a unity build the programs of a folder of tests/ that have the same labels are built as one (yuragi_join_tests), and the program
# itself only when it is named. With YURAGI_WITHOUT_SANITIZED those with UNSANITIZED cases are a program of their own. ALONE: not this
# one, which replaces operator new or is compiled in another way.
function(yuragi_test name)
  cmake_parse_arguments(ARG "ALONE" "" "SOURCES;LINK;NEEDS;LABELS;LONG;UNSANITIZED" ${ARGN})
  if(CMAKE_CURRENT_SOURCE_DIR MATCHES "/tests/engine/(base|platform|workers)")
    set(ARG_LABELS engine)
  elseif(CMAKE_CURRENT_SOURCE_DIR MATCHES "/tests/engine/" AND NOT ARG_LABELS)
    set(ARG_LABELS engine_threadless) # one label, since CTest's list of them gets lost in a list of properties
  endif()
  yuragi_test_program(${name})
  if(CMAKE_UNITY_BUILD AND NOT ARG_ALONE)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL TRUE)
    string(REGEX REPLACE "^.*/tests/([a-z]+).*$" "\\1_tests" group ${CMAKE_CURRENT_SOURCE_DIR})
    foreach(label IN LISTS ARG_LABELS)
      string(APPEND group _${label})
    endforeach()
    string(REGEX REPLACE "_engine" "" group ${group})
    if(ARG_UNSANITIZED AND YURAGI_WITHOUT_SANITIZED)
      string(APPEND group _unsanitized)
    endif()
    list(TRANSFORM ARG_SOURCES PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ REGEX "^[^/]")
    get_directory_property(ARG_OPTIONS COMPILE_OPTIONS)
    set_property(GLOBAL APPEND PROPERTY YURAGI_TESTS ${group})
    foreach(part SOURCES LINK NEEDS LABELS LONG UNSANITIZED OPTIONS)
      set_property(GLOBAL APPEND PROPERTY ${group}_${part} ${ARG_${part}})
    endforeach()
  else()
    yuragi_add_to_ctest(${name} 4)
  endif()
endfunction()

# yuragi_join_tests(): adds the joined programs. Call it after the last yuragi_test().
function(yuragi_join_tests)
  get_property(groups GLOBAL PROPERTY YURAGI_TESTS)
  list(REMOVE_DUPLICATES groups)
  foreach(group IN LISTS groups)
    foreach(part SOURCES LINK NEEDS LABELS LONG UNSANITIZED OPTIONS)
      get_property(ARG_${part} GLOBAL PROPERTY ${group}_${part})
    endforeach()
    list(REMOVE_DUPLICATES ARG_LABELS)
    list(REMOVE_DUPLICATES ARG_OPTIONS)
    yuragi_test_program(${group})
    set_property(TARGET ${group} PROPERTY COMPILE_OPTIONS ${ARG_OPTIONS}) # of its folder
    yuragi_add_to_ctest(${group} 12)
  endforeach()
endfunction()

# Adds the program that the caller's ARG_ variables describe.
macro(yuragi_test_program name)
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE yuragi_flags ${ARG_LINK} yuragi_test_places GTest::gtest_main GTest::gmock)
  yuragi_needs(${name} ${ARG_NEEDS})
endmacro()

# yuragi_needs(TARGET PROGRAM...): TARGET runs these programs. They are there when it is linked; with add_dependencies its sources would
# not be compiled before, and the largest of them alone at the end.
function(yuragi_needs target)
  foreach(program IN LISTS ARGN)
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS $<TARGET_FILE:${program}>)
  endforeach()
endfunction()

# Registers the program with CTest: one test a case, or with sanitizers `parts` tests. Reads the caller's ARG_ variables.
function(yuragi_add_to_ctest name parts)
  # What a sanitizer leaves out is not built for it.
  if((YURAGI_SANITIZE AND "native" IN_LIST ARG_LABELS) OR
     (YURAGI_SANITIZE MATCHES thread AND ARG_LABELS MATCHES threadless))
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL TRUE)
    return()
  endif()
  # The sanitizer builds run it: it is not built here.
  if(YURAGI_WITHOUT_SANITIZED AND NOT ARG_UNSANITIZED AND NOT ARG_LABELS MATCHES "native|engine")
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL TRUE)
    return()
  endif()
  add_dependencies(yuragi_tests ${name})
  set(properties TIMEOUT 600) # only a hang takes so long, on however busy a machine
  if(ARG_LABELS)
    list(APPEND properties LABELS ${ARG_LABELS})
  endif()
  if(NOT YURAGI_SANITIZE)
    list(JOIN ARG_LONG ":" long)
    list(JOIN ARG_UNSANITIZED ":" unsanitized)
    gtest_discover_tests(${name} TEST_FILTER "-${long}:${unsanitized}" DISCOVERY_TIMEOUT 60 PROPERTIES ${properties})
    if(ARG_LONG)
      gtest_discover_tests(${name} TEST_FILTER "${long}" TEST_LIST ${name}_long DISCOVERY_TIMEOUT 60
        PROPERTIES TIMEOUT 600 LABELS long)
    endif()
    if(ARG_UNSANITIZED)
      gtest_discover_tests(${name} TEST_FILTER "${unsanitized}" TEST_LIST ${name}_unsanitized DISCOVERY_TIMEOUT 60
        PROPERTIES TIMEOUT 600 LABELS native)
    endif()
    return()
  endif()
  list(JOIN ARG_UNSANITIZED ":" left_out)
  math(EXPR last "${parts} - 1")
  foreach(part RANGE ${last})
    add_test(NAME ${name}.${part} COMMAND ${name} --gtest_filter=-${left_out})
    set_tests_properties(${name}.${part} PROPERTIES ${properties} ENVIRONMENT
      "GTEST_TOTAL_SHARDS=${parts};GTEST_SHARD_INDEX=${part};GTEST_OUTPUT=xml:${PROJECT_BINARY_DIR}/cases/${name}.${part}.xml")
  endforeach()
endfunction()

# yuragi_tool(NAME SOURCES ... LINK ...): a program by which people look at something, and which no test runs: built without sanitizers,
# and without optimization, for what takes time is in the rooms that it links.
function(yuragi_tool name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE yuragi_flags ${ARG_LINK})
  target_compile_options(${name} PRIVATE ${YURAGI_UNOPTIMIZED})
  if(YURAGI_SANITIZE)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL TRUE)
  endif()
endfunction()

# yuragi_join(NAME TARGET...): with YURAGI_JOIN_ROOMS, compiles these rooms and programs as one file, which parses each library's
# headers and generates the code of its inline functions once instead of once a room. Each target stays, as it is linked, with an
# empty source. All must be optimised alike. A source with compile properties of its own stays in its target. yuragi_unity_groups
# keeps apart what cannot stand in one file.
function(yuragi_join name)
  if(NOT YURAGI_JOIN_ROOMS)
    return()
  endif()
  set(joined yuragi_joined_${name})
  set(empty ${PROJECT_BINARY_DIR}/empty.cpp)
  file(CONFIGURE OUTPUT ${empty} CONTENT "")
  add_library(${joined} STATIC)
  foreach(target IN LISTS ARGN)
    get_target_property(type ${target} TYPE)
    if(type STREQUAL EXECUTABLE AND YURAGI_TESTS)
      continue() # tests link the rooms, and have a main() of their own
    endif()
    get_target_property(folder ${target} SOURCE_DIR)
    get_target_property(sources ${target} SOURCES)
    set(kept ${empty})
    foreach(source IN LISTS sources)
      get_filename_component(source ${source} ABSOLUTE BASE_DIR ${folder})
      get_source_file_property(definitions ${source} TARGET_DIRECTORY ${target} COMPILE_DEFINITIONS)
      get_source_file_property(stands_alone ${source} TARGET_DIRECTORY ${target} SKIP_UNITY_BUILD_INCLUSION)
      if(definitions OR stands_alone)
        list(APPEND kept ${source})
      else()
        target_sources(${joined} PRIVATE ${source})
      endif()
    endforeach()
    set_property(TARGET ${target} PROPERTY SOURCES ${kept})
    foreach(property COMPILE_DEFINITIONS COMPILE_OPTIONS)
      get_target_property(values ${target} ${property})
      if(values)
        set_property(TARGET ${joined} APPEND PROPERTY ${property} ${values})
      endif()
    endforeach()
    if(type STREQUAL EXECUTABLE) # its main() is found in the library, which therefore needs what the program links
      get_target_property(links ${target} LINK_LIBRARIES)
      target_link_libraries(${joined} PUBLIC ${links})
      target_link_libraries(${target} PRIVATE ${joined})
    else()
      target_link_libraries(${joined} PUBLIC ${target})
      target_link_libraries(${target} PUBLIC ${joined})
    endif()
  endforeach()
endfunction()

# yuragi_unity_groups(): to be called last. Where a unity build compiles a target as one file, sources whose unnamed namespaces
# declare the same name get files of their own; config/cmake/unity_groups.py lists them. A source that changes is read again.
function(yuragi_unity_groups)
  if(NOT CMAKE_UNITY_BUILD)
    return()
  endif()
  set(lines "")
  yuragi_targets(targets)
  foreach(target IN LISTS targets)
    get_target_property(sources ${target} SOURCES)
    get_target_property(source_folder ${target} SOURCE_DIR)
    list(FILTER sources INCLUDE REGEX "^[^$]*\\.cpp$")
    list(TRANSFORM sources PREPEND ${source_folder}/ REGEX "^[^/]")
    list(LENGTH sources count)
    if(count GREATER 1)
      list(JOIN sources "\t" sources)
      string(APPEND lines "${target}\t${source_folder}\t${sources}\n")
      string(REPLACE "\t" ";" sources "${sources}")
      set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${sources})
    endif()
  endforeach()
  set(listed ${PROJECT_BINARY_DIR}/unity_targets.txt)
  set(groups ${PROJECT_BINARY_DIR}/unity_groups.cmake)
  file(WRITE ${listed} "${lines}")
  execute_process(COMMAND ${PYTHON3_PROGRAM} ${PROJECT_SOURCE_DIR}/config/cmake/unity_groups.py ${listed}
    OUTPUT_FILE ${groups} COMMAND_ERROR_IS_FATAL ANY)
  include(${groups})
endfunction()

# yuragi_targets(RESULT): all targets of the project's folders.
function(yuragi_targets result)
  set(all "")
  set(folders ${PROJECT_SOURCE_DIR})
  while(folders)
    list(POP_FRONT folders folder)
    get_directory_property(below DIRECTORY ${folder} SUBDIRECTORIES)
    list(APPEND folders ${below})
    get_directory_property(targets DIRECTORY ${folder} BUILDSYSTEM_TARGETS)
    list(APPEND all ${targets})
  endwhile()
  set(${result} ${all} PARENT_SCOPE)
endfunction()

# yuragi_precompile_headers(): to be called last. With YURAGI_PRECOMPILE_HEADERS the headers that most sources include are read once
# for all targets that are compiled with the same options: a second of each source's compilation.
function(yuragi_precompile_headers)
  if(NOT YURAGI_PRECOMPILE_HEADERS)
    return()
  endif()
  set(headers <algorithm> <array> <atomic> <chrono> <cmath> <condition_variable> <deque> <filesystem> <fstream> <functional> <map>
    <memory> <mutex> <numeric> <optional> <random> <ranges> <set> <span> <sstream> <string> <thread> <tuple> <unordered_map> <utility>
    <variant> <vector> <fmt/format.h> <gmock/gmock.h> <gtest/gtest.h> <nlohmann/json.hpp>)
  find_file(YURAGI_GMOCK_HEADER gmock/gmock.h)
  set_source_files_properties(${YURAGI_GMOCK_HEADER} PROPERTIES LANGUAGE CXX)
  set(empty ${PROJECT_BINARY_DIR}/empty.cpp)
  file(CONFIGURE OUTPUT ${empty} CONTENT "")
  set(kinds "")
  yuragi_targets(targets)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    get_target_property(options ${target} COMPILE_OPTIONS)
    get_target_property(sources ${target} SOURCES)
    list(FILTER sources INCLUDE REGEX "\\.(cpp|cc)$")
    get_target_property(linked ${target} LINK_LIBRARIES)
    get_target_property(disabled ${target} DISABLE_PRECOMPILE_HEADERS)
    if(disabled OR NOT type MATCHES "STATIC_LIBRARY|EXECUTABLE" OR NOT sources OR NOT linked MATCHES "yuragi_") # by which it has yuragi_flags
      continue()
    endif()
    if(NOT options)
      set(options "")
    endif()
    # Of several levels the last counts, each where CMake first met it.
    list(REMOVE_DUPLICATES options)
    list(TRANSFORM options REPLACE "^SHELL:" "")
    set(levels ${options})
    list(FILTER levels INCLUDE REGEX "^-O")
    list(FILTER options EXCLUDE REGEX "^-O")
    if(levels)
      list(GET levels -1 level)
      list(APPEND options ${level})
    endif()
    string(MAKE_C_IDENTIFIER "yuragi_precompiled_${type}_${options}" kind)
    list(APPEND kinds ${kind})
    list(APPEND ${kind} ${target})
    set(${kind}_options ${options})
  endforeach()
  list(REMOVE_DUPLICATES kinds)
  foreach(kind IN LISTS kinds)
    list(LENGTH ${kind} count)
    if(count LESS 4)
      continue() # it would take longer than it saves
    endif()
    # By clang a header of a library, after which the others are read: what is precompiled names all files that it is made of, and
    # those of a clone are not found from another.
    if(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
      set(source ${YURAGI_GMOCK_HEADER})
    else()
      set(source ${empty})
    endif()
    add_library(${kind} OBJECT EXCLUDE_FROM_ALL ${source})
    if(kind MATCHES EXECUTABLE)
      list(APPEND ${kind}_options -fPIE) # libraries have -fPIC
      set_target_properties(${kind} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
    endif()
    target_link_libraries(${kind} PRIVATE yuragi_flags GTest::gtest nlohmann_json::nlohmann_json fmt::fmt) # with their definitions
    set_target_properties(${kind} PROPERTIES COMPILE_OPTIONS "${${kind}_options}")
    if(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
      list(TRANSFORM headers REPLACE "^<(.*)>$" "SHELL:-include \\1" OUTPUT_VARIABLE included)
      target_compile_options(${kind} PRIVATE ${included} "SHELL:-x c++-header" "SHELL:-Xclang -fno-pch-timestamp")
      set_target_properties(${kind} PROPERTIES UNITY_BUILD OFF)
      add_custom_target(${kind}_ready DEPENDS $<TARGET_OBJECTS:${kind}>)
      foreach(target IN LISTS ${kind})
        target_compile_options(${target} PRIVATE "SHELL:$<$<COMPILE_LANGUAGE:CXX>:-include-pch CMakeFiles/${kind}.dir${YURAGI_GMOCK_HEADER}.o>")
        add_dependencies(${target} ${kind}_ready)
      endforeach()
      continue()
    endif()
    target_precompile_headers(${kind} PRIVATE ${headers})
    foreach(target IN LISTS ${kind})
      target_precompile_headers(${target} REUSE_FROM ${kind})
    endforeach()
    set_target_properties(${kind} ${${kind}} PROPERTIES PCH_WARN_INVALID OFF)
  endforeach()
endfunction()

# yuragi_fuzz(NAME SOURCES ... LINK ...): one libFuzzer program; CTest runs it for a few seconds.
function(yuragi_fuzz name)
  if(NOT YURAGI_FUZZ)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE yuragi_flags ${ARG_LINK})
  target_compile_options(${name} PRIVATE -fsanitize=fuzzer)
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
  add_test(NAME ${name} COMMAND ${name} -max_total_time=4 -timeout=10 -rss_limit_mb=2048)
  set_tests_properties(${name} PROPERTIES PROCESSORS 2) # a core of its own: it works for so long, however much that is
endfunction()
