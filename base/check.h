#pragma once
// SEROSA_CHECK: an assert that release builds keep. For broken promises inside the code, never for bad input.

#include <string>

namespace serosa {

/// Prints "file:line: check failed: condition: message" to stderr and aborts.
[[noreturn]] void checkFailed(const char* file, int line, const char* condition, const std::string& message);

} // namespace serosa

#define SEROSA_CHECK(condition, message)                                                                     \
    do {                                                                                                     \
        if (!(condition))                                                                                    \
            ::serosa::checkFailed(__FILE__, __LINE__, #condition, (message));                                \
    } while (false)
