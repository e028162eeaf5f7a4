# How a room of engine/ becomes a library.

# What every file of Surefield is compiled with; nothing of it reaches a program that links the library.
add_library(surefield_options INTERFACE)
target_include_directories(surefield_options INTERFACE ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/generated)
target_compile_features(surefield_options INTERFACE cxx_std_20)
target_compile_options(surefield_options INTERFACE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
                       -Wno-missing-field-initializers)
if(SUREFIELD_WARNINGS_AS_ERRORS)
  target_compile_options(surefield_options INTERFACE -Werror)
endif()
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # GCC takes for a header's what a unity file includes, and there such types should have no internal linkage.
  target_compile_options(surefield_options INTERFACE -Wno-subobject-linkage)
elseif(CMAKE_UNITY_BUILD)
  # Clang finds names of one file shadowed in another that a unity build joins to it.
  target_compile_options(surefield_options INTERFACE -Wno-shadow)
endif()
if(SUREFIELD_SANITIZERS)
  # The object-size check keeps Eigen from being inlined (12 times slower), and the address sanitizer sees the same.
  target_compile_options(surefield_options INTERFACE -fsanitize=${SUREFIELD_SANITIZERS} -fno-omit-frame-pointer
                         -fno-sanitize=object-size -fno-sanitize-recover=all)
  target_link_options(surefield_options INTERFACE -fsanitize=${SUREFIELD_SANITIZERS})
endif()

# surefield_target(<target>): the settings of all of Surefield's libraries and programs.
function(surefield_target target)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:surefield_options>)
  set_target_properties(${target} PROPERTIES CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF
                        POSITION_INDEPENDENT_CODE ON)
endfunction()

# surefield_library(<room> SOURCES <file>... [DEPENDS <target>...] [PUBLIC_HEADERS <header>...] [INTERNAL]): the library of one
# room, Surefield::<room>. DEPENDS are what its headers or those who link it statically need. A program outside includes
# the public headers as <surefield/<room>/<header>>. A room that is INTERNAL serves the command alone and is not installed.
function(surefield_library room)
  cmake_parse_arguments(ARG "INTERNAL" "" "SOURCES;DEPENDS;PUBLIC_HEADERS" ${ARGN})
  if(ARG_INTERNAL)
    add_library(surefield_${room} STATIC ${ARG_SOURCES})
  else()
    add_library(surefield_${room} ${ARG_SOURCES})
    set_property(GLOBAL APPEND PROPERTY surefield_installed surefield_${room})
  endif()
  add_library(Surefield::${room} ALIAS surefield_${room})
  surefield_target(surefield_${room})
  target_compile_features(surefield_${room} PUBLIC cxx_std_20)
  target_link_libraries(surefield_${room} PUBLIC ${ARG_DEPENDS})
  target_include_directories(surefield_${room} INTERFACE $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  set_target_properties(surefield_${room} PROPERTIES EXPORT_NAME ${room} VERSION ${PROJECT_VERSION}
                        SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} INSTALL_RPATH "$ORIGIN")
  if(SUREFIELD_FUZZERS AND room MATCHES "^(io|json|config|formats|logs|sources)$")
    target_compile_options(surefield_${room} PRIVATE -fsanitize=fuzzer-no-link)
    target_link_options(surefield_${room} INTERFACE -fsanitize=fuzzer-no-link)
  endif()
  foreach(header ${ARG_PUBLIC_HEADERS})
    surefield_public_header(${room} ${header})
  endforeach()
endfunction()

# Puts a header where programs outside find it, with its includes named as they name them.
function(surefield_public_header room header)
  if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${header})
    set(source ${CMAKE_CURRENT_SOURCE_DIR}/${header})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
  else()
    set(source ${PROJECT_BINARY_DIR}/generated/engine/${room}/${header})
  endif()
  file(READ ${source} text)
  string(REGEX MATCHALL "#include \"engine/[^\"]+" included "${text}")
  string(REPLACE "#include \"engine/" "" included "${included}")
  set_property(GLOBAL APPEND PROPERTY surefield_public_includes ${included})
  set_property(GLOBAL APPEND PROPERTY surefield_public_headers ${room}/${header})
  string(REPLACE "#include \"engine/" "#include \"surefield/" text "${text}")
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/include/surefield/${room}/${header} CONTENT "${text}" @ONLY)
endfunction()

# Ends the configuration where a public header includes one that programs outside do not get.
function(surefield_check_public_headers)
  get_property(included GLOBAL PROPERTY surefield_public_includes)
  get_property(public GLOBAL PROPERTY surefield_public_headers)
  foreach(header ${included})
    if(NOT header IN_LIST public)
      message(FATAL_ERROR "a public header includes engine/${header}, which is not public; see PUBLIC_HEADERS in engine/*/CMakeLists.txt")
    endif()
  endforeach()
endfunction()

# surefield_embed_text(<output> FILE <file> FUNCTION <name> HEADER <header>): a source that defines the function, which the
# header declares, to return the file's text.
function(surefield_embed_text output)
  cmake_parse_arguments(ARG "" "FILE;FUNCTION;HEADER" "" ${ARGN})
  set(script ${PROJECT_SOURCE_DIR}/engine/cmake/embed_text.cmake)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DFILE=${ARG_FILE} -DHEADER=${ARG_HEADER} -DFUNCTION=${ARG_FUNCTION} -DOUTPUT=${output} -P ${script}
    DEPENDS ${ARG_FILE} ${script}
    VERBATIM)
endfunction()

# surefield_embed_files(<output> FUNCTION <name> HEADER <header> FILES <pattern>...): the same for files by their names.
function(surefield_embed_files output)
  cmake_parse_arguments(ARG "" "FUNCTION;HEADER" "FILES" ${ARGN})
  set(script ${PROJECT_SOURCE_DIR}/engine/cmake/embed_files.cmake)
  file(GLOB files CONFIGURE_DEPENDS ${ARG_FILES})
  string(REPLACE ";" "," list "${files}")
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DFILES=${list} -DHEADER=${ARG_HEADER} -DFUNCTION=${ARG_FUNCTION} -DOUTPUT=${output} -P ${script}
    DEPENDS ${files} ${script}
    VERBATIM)
endfunction()
