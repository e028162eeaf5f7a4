# Writes OUTPUT, which defines the git commit of SOURCE, and touches it only when they change.
# -DSOURCE=<root of the project> -DOUTPUT=<file>
set(commit unknown)
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
  # Looking must not take git's locks: someone may be committing right now.
  execute_process(COMMAND ${CMAKE_COMMAND} -E env GIT_OPTIONAL_LOCKS=0
                          ${GIT} describe --always --dirty --abbrev=40 --exclude=*
                  WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE found RESULT_VARIABLE failed
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    set(commit ${found})
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
#include "engine/types/build_info.h"

namespace surefield {
const char* const kGitCommit = "@commit@";
}  // namespace surefield
]] @ONLY)
