# Writes the source that defines build_commit(). A file that would not change is left alone, so that only a new commit, or
# the first edit after it, compiles anything.
#   cmake -D SOURCE=FOLDER -D OUTPUT=FILE -P write_commit.cmake
set(commit unknown)
find_program(GIT git)
if(GIT)
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --exclude * --dirty --abbrev=12
    OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(commit ${described})
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[#include "studio/version/commit.h"

namespace ctpm::version {

const char* build_commit() { return "@commit@"; }

}  // namespace ctpm::version
]] @ONLY)
