/// Exceptions for faulty input and a failing outside world; docs/errors.md lists the codes.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace meshwind {

/// An error with a stable code, the place it concerns, and one line of words that ends in the
/// remedy. Outcomes that a planner may expect (a course that slips, a point out of reach) are never
/// errors.
class Error : public std::runtime_error {
public:
    /// \param code stable identifier, e.g. "mesh.not_orientable"
    /// \param place file, file:line, or file plus JSON pointer; empty when there is none
    /// \param message one line without a trailing full stop: what is wrong and how to mend it
    Error(std::string code, std::string place, const std::string& message)
        : std::runtime_error(place.empty() ? message : place + ": " + message),
          code_(std::move(code)),
          place_(std::move(place)),
          words_(message) {}

    [[nodiscard]] const std::string& code() const { return code_; }
    [[nodiscard]] const std::string& place() const { return place_; }
    [[nodiscard]] const std::string& words() const { return words_; }  ///< what() without place

private:
    std::string code_;
    std::string place_;
    std::string words_;
};

/// The user's data or request is unusable (exit code 2).
class InputError : public Error {
    using Error::Error;
};

/// A file could not be read or written (exit code 2).
class IoError : public Error {
    using Error::Error;
};

/// An algorithm could not reach its stated accuracy on valid input (exit code 3).
class NumericalError : public Error {
    using Error::Error;
};

}  // namespace meshwind
