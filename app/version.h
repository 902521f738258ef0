#pragma once
// Versions of the program and of the parts that shape its results.

#include <string>
#include <utility>
#include <vector>

namespace serosa::app {

/// "0.1.0"
const char* programVersion();
/// Name and version of the compiler and of the libraries whose version may change results or files.
std::vector<std::pair<std::string, std::string>> partVersions();

} // namespace serosa::app
