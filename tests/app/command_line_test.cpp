// SPDX-License-Identifier: Apache-2.0
#include "app/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

class TrackCamera : public Command {
 public:
  explicit TrackCamera(CLI::App& flags) {
    flags.add_option("SOURCE", source, "images")->required();
    options_.add("gate_sigma", gate_sigma, "sigma", "gate");
    options_.add_check([this] {
      if (!(gate_sigma > 0)) throw std::invalid_argument("gate_sigma must be > 0");
    });
  }
  ExitCode run(const RunContext&) override { return ExitCode::Success; }

  std::string source;
  double gate_sigma = 3;
};

std::vector<Verb> verbs() {
  const auto make = &make_command<TrackCamera>;
  return {{"track camera", "tracks", "alidade track camera a.mp4 -o out", OutputUse::Required, make},
          {"track body", "tracks", "alidade track body a.csv -o out", OutputUse::Required, make},
          {"evaluate", "compares", "alidade evaluate a.tum", OutputUse::Optional, make},
          {"convert", "converts", "alidade convert a.yaml -o b.yaml", OutputUse::File, make}};
}

std::optional<Request> parse(CommandLine& line, std::vector<const char*> words) {
  words.insert(words.begin(), "alidade");
  return line.parse(static_cast<int>(words.size()), words.data());
}

std::string message_of(const std::vector<const char*>& words) {
  try {
    CommandLine line(verbs());
    parse(line, words);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(CommandLine, KnowsWhetherTheOutputIsAFile) {
  CommandLine directory(verbs()), file(verbs());
  EXPECT_EQ(parse(directory, {"evaluate", "a.tum", "-o", "out"})->output, OutputUse::Optional);
  EXPECT_EQ(parse(file, {"convert", "a.yaml", "-o", "b.yaml"})->output, OutputUse::File);
  EXPECT_NE(message_of({"convert", "a.yaml"}).find("--output is required"), std::string::npos);
}

TEST(CommandLine, FindsTheVerbAndItsFlags) {
  CommandLine line(verbs());
  const auto request =
      parse(line, {"track", "body", "a.csv", "-o", "out", "--seed", "5", "--gate-sigma", "2", "--quiet"});
  ASSERT_TRUE(request);
  EXPECT_EQ(request->verb, "track body");
  EXPECT_EQ(request->flags.output, "out");
  EXPECT_EQ(request->flags.seed, 5u);
  EXPECT_TRUE(request->flags.quiet);
  const auto& command = dynamic_cast<TrackCamera&>(*request->command);
  EXPECT_EQ(command.source, "a.csv");
  EXPECT_EQ(command.gate_sigma, 2.0);
}

TEST(CommandLine, TakesTheSeedFromTheConfigUnlessAFlagGivesIt) {
  const test::TemporaryDirectory directory;
  const std::string config = directory.write("c.yaml", "seed: 9\ngate_sigma: 1.5\n");
  CommandLine from_file(verbs());
  const auto request = parse(from_file, {"evaluate", "a", "--config", config.c_str()});
  EXPECT_EQ(request->flags.seed, 9u);
  EXPECT_EQ(dynamic_cast<TrackCamera&>(*request->command).gate_sigma, 1.5);
  CommandLine from_flag(verbs());
  EXPECT_EQ(parse(from_flag, {"evaluate", "a", "--seed", "3", "--config", config.c_str()})->flags.seed, 3u);
}

TEST(CommandLine, EffectiveOptionsHoldTheSeedThatIsUsed) {
  const test::TemporaryDirectory directory;
  const std::string config = directory.write("c.yaml", "seed: 9\n");
  CommandLine line(verbs());
  const auto request = parse(line, {"evaluate", "a", "--seed", "3", "--config", config.c_str()});
  EXPECT_THAT(request->command->options().to_yaml(), testing::HasSubstr("seed: 3"));
}

TEST(CommandLine, NamesTheNearestVerbAndFlag) {
  EXPECT_EQ(message_of({"trak", "camera"}), "alidade: unknown verb 'trak'; did you mean 'track'?");
  EXPECT_EQ(message_of({"track", "kamera"}), "alidade track: unknown verb 'kamera'; did you mean 'camera'?");
  EXPECT_EQ(message_of({"evaluate", "a", "--gate-sgima=2"}),
            "alidade evaluate: unknown flag '--gate-sgima'; did you mean '--gate-sigma'?");
  EXPECT_EQ(message_of({"evaluate", "a", "--xyzzy"}),
            "alidade evaluate: unknown flag '--xyzzy'; see 'alidade evaluate --help'");
}

TEST(CommandLine, SaysWhatIsMissing) {
  EXPECT_EQ(message_of({}), "alidade: a verb is missing; one of: track, evaluate, convert");
  EXPECT_EQ(message_of({"track"}), "alidade track: a verb is missing; one of: camera, body");
  EXPECT_THAT(message_of({"track", "camera", "-o", "out"}), testing::HasSubstr("SOURCE is required"));
  EXPECT_THAT(message_of({"track", "camera", "a.mp4"}), testing::HasSubstr("--output is required"));
}

TEST(CommandLine, RefusesWrongValuesInOneLine) {
  EXPECT_THAT(message_of({"evaluate", "a", "--gate-sigma", "wide"}), testing::HasSubstr("must be a finite number"));
  EXPECT_EQ(message_of({"evaluate", "a", "--gate-sigma", "-1"}), "options: gate_sigma must be > 0");
  EXPECT_THAT(message_of({"evaluate", "a", "--quiet", "--json"}), testing::HasSubstr("excludes"));
  EXPECT_THAT(message_of({"evaluate", "a", "b"}), testing::HasSubstr("b"));
}

TEST(CommandLine, HelpOfEveryVerbHasItsExample) {
  for (const Verb& verb : verbs()) {
    CommandLine line(verbs());
    const auto space = verb.name.find(' ');
    const std::string first = verb.name.substr(0, space);
    const std::string second = space == std::string::npos ? "--help" : verb.name.substr(space + 1);
    testing::internal::CaptureStdout();
    EXPECT_FALSE(parse(line, {first.c_str(), second.c_str(), "--help"}));
    EXPECT_THAT(testing::internal::GetCapturedStdout(), testing::HasSubstr(verb.example));
  }
}

}  // namespace
}  // namespace alidade
