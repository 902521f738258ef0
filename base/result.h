#pragma once
// The one must-use result type for bad input (a broken promise inside the code is SEROSA_CHECK,
// base/check.h).
//
// An Error is one line that says file, line and column (or byte), what is wrong and what to do. `serosa`
// prints it to stderr and exits with its code (ARCHITECTURE.md, exit codes).

#include "base/check.h"

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace serosa {

enum ExitCode : int {
    exitOk = 0,
    exitCheckFailed = 1,
    exitBadInput = 2,
    exitChildFailed = 3,
    exitNoBaseline = 4,
    exitNoGl = 5
};

struct Error {
    std::string message;
    int exitCode = exitBadInput;
};

/// Either a T or an Error. Reading the wrong one is a broken promise.
template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : content_(std::move(value)) {}
    Result(Error error) : content_(std::move(error)) {}

    bool ok() const { return std::holds_alternative<T>(content_); }
    explicit operator bool() const { return ok(); }

    T& value() & {
        SEROSA_CHECK(ok(), std::get<Error>(content_).message);
        return std::get<T>(content_);
    }
    const T& value() const& {
        SEROSA_CHECK(ok(), std::get<Error>(content_).message);
        return std::get<T>(content_);
    }
    T&& value() && {
        SEROSA_CHECK(ok(), std::get<Error>(content_).message);
        return std::get<T>(std::move(content_));
    }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }

    const Error& error() const {
        SEROSA_CHECK(!ok(), "error() of a result that holds a value");
        return std::get<Error>(content_);
    }

private:
    std::variant<T, Error> content_;
};

/// Success without a value, or an Error.
class [[nodiscard]] Status {
public:
    Status() = default;
    Status(Error error) : error_(std::move(error)) {}
    bool ok() const { return !error_; }
    explicit operator bool() const { return ok(); }
    const Error& error() const {
        SEROSA_CHECK(!ok(), "error() of a success");
        return *error_;
    }

private:
    std::optional<Error> error_;
};

} // namespace serosa

/// Returns the error of `expression` (a Status or Result) from the current function, if it has one.
#define SEROSA_TRY(expression)                                                                               \
    do {                                                                                                     \
        if (auto serosaTry_ = (expression); !serosaTry_.ok())                                                \
            return serosaTry_.error();                                                                       \
    } while (false)

#define SEROSA_CONCAT_(a, b) a##b
#define SEROSA_CONCAT(a, b) SEROSA_CONCAT_(a, b)
/// `SEROSA_ASSIGN(auto mesh, readMesh(path));` declares `mesh`, or returns the error.
#define SEROSA_ASSIGN(declaration, expression)                                                               \
    auto SEROSA_CONCAT(serosaResult_, __LINE__) = (expression);                                              \
    if (!SEROSA_CONCAT(serosaResult_, __LINE__).ok())                                                        \
        return SEROSA_CONCAT(serosaResult_, __LINE__).error();                                               \
    declaration = std::move(SEROSA_CONCAT(serosaResult_, __LINE__)).value()
