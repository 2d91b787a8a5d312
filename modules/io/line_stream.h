// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

namespace alidade {

/// A line of a stream that says something.
struct StreamLine {
  int number = 0;         ///< from 1
  std::string_view text;  ///< without its end (LF or CRLF); valid until the next line is taken
  bool has_end = true;    ///< false for a last line without a line break
};

/// The lines of a text of any length, in bounded memory: of a file, or of standard input ("-"), where a line is given
/// out as soon as its end has come.
class LineStream {
 public:
  /// Throws InputError where the file cannot be opened.
  explicit LineStream(const std::filesystem::path& path, std::stop_token stop = {});
  ~LineStream();
  LineStream(const LineStream&) = delete;
  LineStream& operator=(const LineStream&) = delete;

  /// The next line that is neither blank nor a comment (#), waiting for it if need be; empty at the end, and once a
  /// stop is requested. Throws InputError where reading fails or a line is longer than 1 MB.
  std::optional<StreamLine> next();

  /// Bytes of the lines given out so far, with those passed over between them.
  std::int64_t bytes() const { return read_ - static_cast<std::int64_t>(end_ - begin_); }

  /// What messages call the stream: its path, or "standard input".
  const std::string& name() const { return name_; }

 private:
  bool refill();

  std::string name_;
  std::stop_token stop_;
  int descriptor_ = -1;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // of what is read and not yet given out
  std::int64_t read_ = 0;            // bytes
  int number_ = 0;
  bool at_end_ = false;
};

}  // namespace alidade
