// SPDX-License-Identifier: Apache-2.0
#include "app/result_directory.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/version.h"
#include "core/errors.h"
#include "io/atomic_file.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPart = ".part";
constexpr const char* kSummary = "summary.json";

// False for names that would lead out of the directory.
bool is_plain_name(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && fs::path(name).filename() == name;
}

// Names of the top-level files of an earlier result of ours; empty where the directory is none.
std::vector<std::string> files_of_result(const fs::path& directory) {
  std::ifstream file(directory / kSummary);
  const nlohmann::json summary = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (!summary.is_object() || summary.value("program", nlohmann::json()) != "alidade") return {};
  std::vector<std::string> names;
  for (const auto& name : summary.value("files", nlohmann::json::array()))
    if (name.is_string() && is_plain_name(name)) names.push_back(name);
  return names;
}

bool holds_only_part(const fs::path& directory) {
  return std::all_of(fs::directory_iterator(directory), {},
                     [](const fs::directory_entry& entry) { return entry.path().filename() == kPart; });
}

[[noreturn]] void refused(const fs::path& path, const std::string& operation, int error) {
  const std::string remedy = error == ENOSPC || error == EDQUOT  ? "free some space or give -o another disk"
                             : error == EACCES || error == EROFS ? "give -o a directory that you may write"
                                                                 : "";
  throw DeviceError(path.string(), operation, std::strerror(error), remedy);
}

}  // namespace

void check_result_directory(const fs::path& out) {
  if (!fs::exists(out)) return;
  const std::string remedy = "give -o a new or empty directory, or one with an earlier result of alidade";
  if (!fs::is_directory(out)) throw InputError(out.string(), 0, "is not a directory", remedy);
  if (!holds_only_part(out) && files_of_result(out).empty())
    throw InputError(out.string(), 0, "holds files that are not an alidade result", remedy);
}

ResultDirectory::ResultDirectory(fs::path out, std::string verb)
    : out_(std::move(out)), part_(out_ / kPart), verb_(std::move(verb)) {
  try {
    created_ = !fs::exists(out_);
    if (created_) fs::create_directories(out_);
    check_result_directory(out_);
    fs::remove_all(part_);  // of a run that was killed
    fs::create_directory(part_);
  } catch (const fs::filesystem_error& error) {
    refused(out_, "create the result directory", error.code().value());
  }
}

ResultDirectory::~ResultDirectory() {
  if (committed_) return;
  std::error_code ignored;
  fs::remove_all(part_, ignored);
  if (created_) fs::remove(out_, ignored);
}

fs::path ResultDirectory::path(const std::string& name) const {
  fs::path path = part_ / name;
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) refused(path.parent_path(), "create", error.value());
  return path;
}

void ResultDirectory::write_text(const std::string& name, std::string_view text) const {
  write_file(path(name), text);
}

void ResultDirectory::commit(nlohmann::json summary) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(part_))
    if (entry.path().filename() != kSummary) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  names.push_back(kSummary);
  summary["program"] = "alidade";
  summary["version"] = kVersion;
  summary["verb"] = verb_;
  summary["files"] = names;
  write_text(kSummary, summary.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  try {
    const std::vector<std::string> old_names = files_of_result(out_);
    fs::remove(out_ / kSummary);  // first out, last in
    for (const std::string& name : old_names) fs::remove_all(out_ / name);
    for (const std::string& name : names) fs::rename(part_ / name, out_ / name);
    fs::remove(part_);
  } catch (const fs::filesystem_error& error) {
    refused(out_, "move the results into place", error.code().value());
  }
  committed_ = true;
}

}  // namespace alidade
