# The rules of `cmake --install`: libraries, public headers, the package that find_package(Surefield) reads, the program.
include(CMakePackageConfigHelpers)
get_property(installed GLOBAL PROPERTY surefield_installed)
list(TRANSFORM installed REPLACE "^surefield_" "" OUTPUT_VARIABLE surefield_components)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Surefield)

install(TARGETS ${installed} EXPORT SurefieldTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
get_property(headers GLOBAL PROPERTY surefield_public_headers)
foreach(header ${headers})
  get_filename_component(room ${header} DIRECTORY)
  install(FILES ${PROJECT_BINARY_DIR}/include/surefield/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/surefield/${room})
endforeach()
install(EXPORT SurefieldTargets NAMESPACE Surefield:: DESTINATION ${package_folder})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/SurefieldConfig.cmake.in
  ${PROJECT_BINARY_DIR}/SurefieldConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/SurefieldConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/SurefieldConfig.cmake ${PROJECT_BINARY_DIR}/SurefieldConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/SurefieldDependencies.cmake ${CMAKE_CURRENT_LIST_DIR}/SurefieldRooms.cmake
        DESTINATION ${package_folder})
if(TARGET surefield)
  install(TARGETS surefield RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
