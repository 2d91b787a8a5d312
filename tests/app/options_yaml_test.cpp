// SPDX-License-Identifier: Apache-2.0
#include "app/options_yaml.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

enum class Refine { None, Local, Global };

struct Options {
  double gate_sigma = 3.0;
  int max_count = 1500;
  bool undistort = true;
  std::string dictionary = "36h11";
  Refine refine = Refine::Global;
};

struct Bound {
  Options options;
  OptionFields fields;

  Bound() {
    fields.add_choice("refine", options.refine,
                      {{"none", Refine::None}, {"local", Refine::Local}, {"global", Refine::Global}},
                      "which poses bundle adjustment touches");
    fields.add("features.max_count", options.max_count, "", "strongest keypoints kept");
    fields.add("features.undistort", options.undistort, "", "straighten first");
    fields.add("tracker.gate_sigma", options.gate_sigma, "sigma", "gate of the innovation");
    fields.add("tracker.dictionary", options.dictionary, "", "family of markers");
  }
};

std::string message_of(Bound& bound, const std::filesystem::path& path) {
  try {
    bound.fields.read(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(OptionFields, ReadSetsTheNamedFieldsOnly) {
  const test::TemporaryDirectory directory;
  Bound bound;
  bound.fields.read(
      directory.write("c.yaml", "refine: local\ntracker: {gate_sigma: 2.5}\nfeatures:\n  undistort: false\n"));
  EXPECT_EQ(bound.options.refine, Refine::Local);
  EXPECT_EQ(bound.options.gate_sigma, 2.5);
  EXPECT_FALSE(bound.options.undistort);
  EXPECT_EQ(bound.options.max_count, 1500);
}

TEST(OptionFields, YamlGivesBackTheSameValues) {
  const test::TemporaryDirectory directory;
  Bound written;
  written.options = {
      .gate_sigma = 1.0 / 3.0, .max_count = 7, .undistort = false, .dictionary = "a\"b\\: #c", .refine = Refine::None};
  Bound read;
  read.fields.read(directory.write("options.yaml", written.fields.to_yaml()));
  EXPECT_EQ(read.options.gate_sigma, written.options.gate_sigma);
  EXPECT_EQ(read.options.max_count, 7);
  EXPECT_FALSE(read.options.undistort);
  EXPECT_EQ(read.options.dictionary, written.options.dictionary);
  EXPECT_EQ(read.options.refine, Refine::None);
}

TEST(OptionFields, YamlHasSectionsUnitsAndHelp) {
  Bound bound;
  EXPECT_THAT(bound.fields.to_yaml(),
              testing::HasSubstr("tracker:\n  gate_sigma: 3  # [sigma] gate of the innovation\n"));
}

TEST(OptionFields, UnknownKeyIsNamedWithItsLineAndTheNearestOne) {
  const test::TemporaryDirectory directory;
  Bound bound;
  const auto path = directory.write("c.yaml", "refine: none\n\ntracker:\n  gate_sgima: 2\n");
  EXPECT_EQ(message_of(bound, path),
            path.string() + ":4: unknown key 'tracker.gate_sgima'; did you mean 'tracker.gate_sigma'?");
}

TEST(OptionFields, WrongKindOfValueIsNamedWithItsLine) {
  const test::TemporaryDirectory directory;
  Bound bound;
  const auto message = [&](std::string_view yaml) { return message_of(bound, directory.write("c.yaml", yaml)); };
  const std::string place = (directory / "c.yaml").string();
  EXPECT_EQ(message("features: {max_count: 1.5}\n"),
            place + ":1: key 'features.max_count' must be a whole number, got '1.5'");
  EXPECT_EQ(message("\ntracker: {gate_sigma: .nan}\n"),
            place + ":2: key 'tracker.gate_sigma' must be a finite number, got '.nan'");
  EXPECT_EQ(message("features: {undistort: yes}\n"),
            place + ":1: key 'features.undistort' must be true or false, got 'yes'");
  EXPECT_EQ(message("refine: lokal\n"), place + ":1: key 'refine' must be one of none, local, global, got 'lokal'");
  EXPECT_EQ(message("refine: [none]\n"), place + ":1: key 'refine' must hold a single value");
  EXPECT_EQ(message("refine: none\nrefine: none\n"), place + ":2: key 'refine' stands twice; keep one");
}

TEST(OptionFields, DamagedOrMissingFilesAreNamed) {
  const test::TemporaryDirectory directory;
  Bound bound;
  EXPECT_THAT(message_of(bound, directory.write("c.yaml", "refine: none\n  x: [1\n")),
              testing::StartsWith((directory / "c.yaml").string() + ":2: not YAML"));
  EXPECT_THAT(message_of(bound, directory / "absent.yaml"), testing::HasSubstr("absent.yaml: cannot be opened"));
  EXPECT_THAT(message_of(bound, directory.write("c.yaml", "- 1\n")), testing::HasSubstr(":1: must hold keys"));
  EXPECT_EQ(message_of(bound, directory.write("c.yaml", "# nothing\n")), "");
}

TEST(OptionFields, FlagsWinOverTheFile) {
  const test::TemporaryDirectory directory;
  Bound bound;
  CLI::App app;
  bound.fields.add_flags(app);
  app.parse("--tracker-gate-sigma 4 --no-features-undistort --refine none");
  bound.fields.read(directory.write(
      "c.yaml", "refine: local\ntracker: {gate_sigma: 2, dictionary: 25h9}\nfeatures: {undistort: true}\n"));
  EXPECT_EQ(bound.options.gate_sigma, 4.0);
  EXPECT_EQ(bound.options.refine, Refine::None);
  EXPECT_FALSE(bound.options.undistort);
  EXPECT_EQ(bound.options.dictionary, "25h9");
}

TEST(OptionFields, FlagOfTheWrongKindIsRefused) {
  Bound bound;
  CLI::App app;
  bound.fields.add_flags(app);
  EXPECT_THROW(app.parse("--features-max-count many"), CLI::ValidationError);
}

TEST(OptionFields, FailedCheckBecomesAnInputErrorOnItsSource) {
  Bound bound;
  bound.fields.add_check([&] {
    if (!(bound.options.gate_sigma > 0)) throw std::invalid_argument("gate_sigma must be > 0, got -1");
  });
  EXPECT_NO_THROW(bound.fields.validate("c.yaml"));
  bound.options.gate_sigma = -1;
  try {
    bound.fields.validate("c.yaml");
    FAIL() << "a negative gate was taken";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "c.yaml: gate_sigma must be > 0, got -1");
  }
}

TEST(OptionFields, RefusesTwoFieldsOfOneNameAndScatteredSections) {
  Bound bound;
  int count = 0;
  EXPECT_THROW(bound.fields.add("refine", count, "", ""), std::invalid_argument);
  EXPECT_THROW(bound.fields.add("features.more", count, "", ""), std::invalid_argument);
  EXPECT_NO_THROW(bound.fields.add("tracker.more", count, "", ""));
}

}  // namespace
}  // namespace alidade
