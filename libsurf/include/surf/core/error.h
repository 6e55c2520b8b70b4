// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace surf {

/// Base class of the exceptions that semsurf throws. A message has three parts: the subject (a file
/// or a field), the reason, and the remedy. `what()` joins them as "subject: reason. remedy".
/// Messages put the names of fields in backticks: see surf/core/field_words.h.
class Error : public std::runtime_error {
 public:
  Error(const std::string& subject, const std::string& reason, const std::string& remedy);

  const std::string& subject() const { return subject_; }
  const std::string& reason() const { return reason_; }
  const std::string& remedy() const { return remedy_; }

 private:
  std::string subject_;
  std::string reason_;
  std::string remedy_;
};

/// A field or argument is missing, malformed or out of range. The command line exits with 2.
class UsageError : public Error {
  using Error::Error;
};

/// Data cannot be used (NaN vertices, an open mesh, an empty image). The command line exits with 3.
class InvalidInput : public Error {
  using Error::Error;
};

/// A file cannot be opened, read, parsed or written. The command line exits with 3.
class FileError : public Error {
  using Error::Error;
};

/// The request is well formed but this build or version cannot fulfil it. The command line exits
/// with 3.
class Unsupported : public Error {
  using Error::Error;
};

/// A `CancelToken` ended the work before there was a result. This is not an error of the program or
/// of the data. The command line exits with 130.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace surf
