// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace alidade {

/// Refuses (InputError) a path that is not a directory and a directory with files in it that is not an earlier result
/// of ours. Touches nothing; the shell asks before the work starts.
void check_result_directory(const std::filesystem::path& out);

/// The directory of a verb's results. Everything is written under OUT/.part and moved into OUT by commit(),
/// summary.json last: a directory with a summary.json is a complete result. Without commit (an error on the way)
/// nothing is left behind, and an earlier result in OUT is untouched.
class ResultDirectory {
 public:
  /// Creates OUT where needed. Throws as check_result_directory does, and DeviceError where the system refuses.
  /// `verb` as typed: "track camera".
  ResultDirectory(std::filesystem::path out, std::string verb);
  ~ResultDirectory();
  ResultDirectory(const ResultDirectory&) = delete;
  ResultDirectory& operator=(const ResultDirectory&) = delete;

  /// Where to write the result `name` now: OUT/.part/name. Folders in `name` are created.
  std::filesystem::path path(const std::string& name) const;

  /// Where `name` will be after commit, for messages to the user.
  std::filesystem::path final_path(const std::string& name) const { return out_ / name; }

  /// Writes a text file; DeviceError when the disk refuses a byte.
  void write_text(const std::string& name, std::string_view text) const;

  /// Replaces what an earlier result left (its own files, no others) and moves ours into place. The summary gets the
  /// entries "program", "version", "verb" and "files".
  void commit(nlohmann::json summary);

 private:
  std::filesystem::path out_;
  std::filesystem::path part_;
  std::string verb_;
  bool created_ = false;  // OUT did not exist before
  bool committed_ = false;
};

}  // namespace alidade
