# SPDX-License-Identifier: MIT

# Warnings and sanitizers of everything that is ours.
add_library(lantern_options INTERFACE)
target_compile_options(lantern_options INTERFACE
  -Wall -Wextra -Wpedantic -Werror -Wshadow -Wconversion -Wnon-virtual-dtor -Wold-style-cast
  -Wunused -Woverloaded-virtual
  # gcc 12 sees overlaps where strings are joined (its bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # One rounding per operation, so that a picture's bits do not depend on what the compiler fuses.
  -ffp-contract=off)
if(LANTERN_SANITIZE)
  target_compile_options(lantern_options INTERFACE
    -fsanitize=${LANTERN_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(lantern_options INTERFACE -fsanitize=${LANTERN_SANITIZE})
endif()
if(LANTERN_WITH_FUZZERS)
  target_compile_options(lantern_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

# lantern_module(NAME SOURCES ... HEADERS ... PUBLIC ... PRIVATE ...): the library lantern::NAME of the
# folder src/lantern/NAME; each header is checked to compile alone.
function(lantern_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  add_library(lantern_${name} STATIC ${ARG_SOURCES})
  add_library(lantern::${name} ALIAS lantern_${name})
  target_sources(lantern_${name} PUBLIC FILE_SET HEADERS
    BASE_DIRS ${PROJECT_SOURCE_DIR}/src FILES ${ARG_HEADERS})
  target_link_libraries(lantern_${name} PUBLIC ${ARG_PUBLIC} PRIVATE lantern_options ${ARG_PRIVATE})
endfunction()

# lantern_test(NAME SOURCES ... LINK ...): a GoogleTest program; every test in it becomes a CTest test
# with the label NAME.
function(lantern_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE lantern_options lantern_test_support ${ARG_LINK})
  if(LANTERN_SANITIZE)
    # Sanitized, most of the time goes to compiling: what tests do themselves is little.
    target_compile_options(${name} PRIVATE -O0)
    # An order of magnitude slower: what takes long is left out or made small.
    target_compile_definitions(${name} PRIVATE LANTERN_SANITIZED)
  endif()
  set(properties TIMEOUT 300 LABELS ${name})
  if(LANTERN_SANITIZE MATCHES address)
    # Else the leak sanitizer may crash at the end of a process whose GL driver has threads: it follows
    # their blocks of thread-local storage after they are gone.
    list(APPEND properties ENVIRONMENT "ASAN_OPTIONS=intercept_tls_get_addr=0")
  endif()
  if(LANTERN_SANITIZE MATCHES thread)
    list(APPEND properties
      ENVIRONMENT "TSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/support/tsan.supp")
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST PROPERTIES ${properties})
endfunction()
