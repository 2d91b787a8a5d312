// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_calibration_options.h"

#include <gmock/gmock.h>

#include "core/errors.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

TEST(ReceiverCalibrationOptions, AreReadFromAFile) {
  const test::TemporaryDirectory directory;
  ReceiverCalibrationChoice choice;
  OptionFields fields;
  bind(fields, choice);
  fields.read(directory.write("options.yaml",
                              "resection: {find_focal: true, search_s: 2}\ncheck: {sigmas: 6}\n"
                              "bundle: {readings_per_s: 4}\ntime_receiver: north\n"));
  EXPECT_TRUE(choice.resection.find_focal);
  EXPECT_EQ(choice.resection.search_s, 2.0);
  EXPECT_EQ(choice.checks.sigmas, 6.0);
  EXPECT_EQ(choice.bundle.readings_per_s, 4.0);
  EXPECT_EQ(choice.time_receiver, "north");
}

TEST(ReceiverCalibrationOptions, AreRefusedOutOfBounds) {
  for (const char* text : {"resection: {search_s: 0}", "check: {least_focal: 0}", "bundle: {jerk_m_s3: -1}"}) {
    const test::TemporaryDirectory directory;
    ReceiverCalibrationChoice choice;
    OptionFields fields;
    bind(fields, choice);
    fields.read(directory.write("options.yaml", text));
    EXPECT_THROW(fields.validate("options.yaml"), InputError) << text;
  }
}

}  // namespace
}  // namespace alidade
