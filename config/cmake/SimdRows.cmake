# The SIMD rows: the instruction sets that each kernel file (yuragi_kernel) is compiled for, one list for each processor, from the
# base row, which every machine of the kind runs, to the widest. All rows compute the same bits.

set(YURAGI_SIMD_ROWS "")
set(simd_row_entries "")

# simd_row(NAME [FLAGS ...] [NEEDS ...])
# FLAGS: the compiler's. NEEDS: features as __builtin_cpu_supports() names them; the row runs on machines that have all of them.
function(simd_row name)
  cmake_parse_arguments(ARG "" "" "FLAGS;NEEDS" ${ARGN})
  if(YURAGI_SANITIZE AND YURAGI_SIMD_ROWS)
    return() # sanitizer builds have the base row alone
  endif()
  string(REPLACE "_" "-" printed ${name})
  list(TRANSFORM ARG_NEEDS REPLACE "(.+)" "__builtin_cpu_supports(\"\\1\")")
  list(JOIN ARG_NEEDS " && " runnable)
  if(NOT runnable)
    set(runnable true)
  endif()
  set(YURAGI_SIMD_ROWS ${YURAGI_SIMD_ROWS} ${name} PARENT_SCOPE)
  set(YURAGI_SIMD_FLAGS_${name} ${ARG_FLAGS} PARENT_SCOPE)
  string(APPEND simd_row_entries " \\\n  MACRO(${name}, \"${printed}\", (${runnable}) __VA_OPT__(, ) __VA_ARGS__)")
  set(simd_row_entries "${simd_row_entries}" PARENT_SCOPE)
endfunction()

if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|amd64|AMD64)$")
  set(v3 avx2 fma bmi2)
  simd_row(x86_64 FLAGS -march=x86-64)
  simd_row(x86_64_v3 FLAGS -march=x86-64-v3 NEEDS ${v3})
  simd_row(x86_64_v4 FLAGS -march=x86-64-v4 -mprefer-vector-width=512
    NEEDS ${v3} avx512f avx512bw avx512cd avx512dq avx512vl)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
  simd_row(aarch64 FLAGS -march=armv8-a) # NEON is part of it
else()
  simd_row(base) # whatever the compiler generates by default
endif()

file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/engine/base/simd_rows.hpp @ONLY CONTENT
"// Generated from config/cmake/SimdRows.cmake: add a row there.
#pragma once

/// MACRO(name, \"printed name\", (is it runnable on this machine?), further arguments) once for each SIMD row, the base row first.
#define YURAGI_SIMD_ROWS(MACRO, ...)@simd_row_entries@
")
