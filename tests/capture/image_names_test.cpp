// SPDX-License-Identifier: Apache-2.0
#include "capture/image_names.h"

#include <gtest/gtest.h>

#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

TEST(ListImages, SortsThemAndLeavesTheRest) {
  const test::TemporaryDirectory folder;
  for (const char* name : {"10.jpg", "9.PNG", "notes.txt", "1.jpeg"}) folder.write(name, "");
  std::vector<std::string> names;
  for (const auto& image : list_images(folder.path())) names.push_back(image.filename());
  EXPECT_EQ(names, (std::vector<std::string>{"1.jpeg", "9.PNG", "10.jpg"}));
}

TEST(ListImages, NamesTheFolderWithoutAny) {
  const test::TemporaryDirectory folder;
  fs::create_directory(folder / "empty");
  EXPECT_EQ(test::message_of(folder.path(), [&] { list_images(folder / "empty"); }),
            "empty: holds no images; name a folder with .jpg or .png files");
  EXPECT_EQ(test::message_of(folder.path(), [&] { list_images(folder / "none"); }),
            "none: cannot be opened: No such file or directory; check the name");
}

TEST(TimesInNames, AreSecondsOrNanoseconds) {
  const std::vector<fs::path> tum{"rgb/1305031229.528748.jpg", "rgb/1305031229.564425.jpg"};
  ASSERT_TRUE(times_in_names(tum));
  EXPECT_EQ(times_in_names(tum)->at(0).time_since_epoch().count(), 1305031229528748000);
  const std::vector<fs::path> euroc{"1403636579763555584.png", "1403636579813555456.png"};
  ASSERT_TRUE(times_in_names(euroc));
  EXPECT_EQ(times_in_names(euroc)->at(1).time_since_epoch().count(), 1403636579813555456);
}

TEST(TimesInNames, AreNotThereWhereOneNameIsNoneOrTheyDoNotIncrease) {
  EXPECT_FALSE(times_in_names(std::vector<fs::path>{"000001.png", "000002.png"}));
  EXPECT_FALSE(times_in_names(std::vector<fs::path>{"frame-000001.color.jpg"}));
  EXPECT_FALSE(times_in_names(std::vector<fs::path>{"1.528748.jpg", "last.jpg"}));
  EXPECT_FALSE(times_in_names(std::vector<fs::path>{"2.528748.jpg", "1.528748.jpg"}));
  EXPECT_FALSE(times_in_names({}));
}

}  // namespace
}  // namespace alidade
