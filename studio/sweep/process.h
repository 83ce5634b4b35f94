#pragma once

#include <string>
#include <vector>

#include "core/model/result.h"

namespace ctpm::sweep {

struct ProcessOutput {
  int code = -1;  ///< exit code; 128 + n: signal n ended it
  std::string out, err;
  double processor_s = 0;  ///< [s]
};

/// Runs a program of the PATH and waits for its end. It inherits the file `kept`, unless that is -1, and with it its
/// lock, which then lasts as long as the last of the two processes. Error: it cannot be started.
Result<ProcessOutput> run_process(const std::vector<std::string>& command, int kept = -1);

/// A long option as a word of a command line, with its value if that is not empty.
std::string option_word(const std::string& name, const std::string& value = "");

/// Path of this program's own file.
std::string own_program();

}  // namespace ctpm::sweep
