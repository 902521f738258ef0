#pragma once
// `serosa doctor`: what this machine's OpenGL offers, what is missing, and what to do about it.

#include <iosfwd>

namespace serosa::app {

/// Text for --help: what is checked, the environment variables, the exit codes.
const char* doctorHelp();

/// Tries every kind of context and writes a report. \return 0 if at least one works, 5 otherwise.
int runDoctor(std::ostream& out);

} // namespace serosa::app
