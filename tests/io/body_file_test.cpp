// SPDX-License-Identifier: Apache-2.0
#include "io/body_file.h"

#include <gtest/gtest.h>

#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

class BodyFile : public testing::Test {
 protected:
  std::vector<RigidBody> read(const std::string& text) { return read_bodies(folder_.write("deck.csv", text)); }
  std::string message(const std::string& text) {
    return test::message_of(folder_.path(), [&] { read(text); });
  }
  test::TemporaryDirectory folder_;
};

TEST_F(BodyFile, IsOneBodyNamedAfterTheFileWithoutNames) {
  const auto bodies = read("marker,x_m,y_m,z_m\n0,-0.015,0.0075,0\n3,0.015,-0.0075,1e-3\n");
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_EQ(bodies[0].name, "deck");
  ASSERT_EQ(bodies[0].markers.size(), 2u);
  EXPECT_EQ(bodies[0].markers[1].id, 3);
  EXPECT_EQ(bodies[0].markers[1].p_body, Eigen::Vector3d(0.015, -0.0075, 1e-3));
}

TEST_F(BodyFile, GivesBackWhatWasWritten) {
  const std::vector<RigidBody> bodies{{"left, upper", {{4, {0.1, 1.0 / 3, -2}}, {-1, {0, 0, 0}}}},
                                      {"right", {{7, {1e-17, 5, 6}}}}};
  write_bodies(folder_ / "bodies.csv", bodies);
  const auto back = read_bodies(folder_ / "bodies.csv");
  ASSERT_EQ(back.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back[i].name, bodies[i].name);
    ASSERT_EQ(back[i].markers.size(), bodies[i].markers.size());
    for (std::size_t j = 0; j < back[i].markers.size(); ++j) {
      EXPECT_EQ(back[i].markers[j].id, bodies[i].markers[j].id);
      EXPECT_EQ(back[i].markers[j].p_body, bodies[i].markers[j].p_body);
    }
  }
}

TEST_F(BodyFile, NamesWhatIsWrong) {
  EXPECT_EQ(message(""), "deck.csv: is empty; its first line must name the columns");
  EXPECT_EQ(message("marker,x_m,y_m,z_m\n"), "deck.csv: holds no markers; give each marker a row");
  EXPECT_EQ(message("marker,x_m,y_m,z\n0,1,2,3\n"), "deck.csv: has no column 'z_m'; did you mean 'x_m'?");
  EXPECT_EQ(message("marker,x_m,y_m,z_m\n0,1,nan,3\n"),
            "deck.csv:2: column 'y_m': 'nan' is not a finite number; correct it or leave the row out");
  EXPECT_EQ(message("marker,x_m,y_m,z_m\n0,1,2,3\nled,1,2,3\n"),
            "deck.csv:3: column 'marker': 'led' is not a whole number; correct it or leave the row out");
  EXPECT_EQ(message("marker,x_m,y_m,z_m\n0,1,2,3\n0,1,2,4\n"),
            "deck.csv:3: marker 0 is there twice; ids are unique among all bodies");
  EXPECT_EQ(message("body,marker,x_m,y_m,z_m\na,0,1,2,3\nb,0,1,2,4\n"),
            "deck.csv:3: marker 0 is there twice; ids are unique among all bodies");
  EXPECT_EQ(message("body,marker,x_m,y_m,z_m\n,0,1,2,3\n"),
            "deck.csv:2: the body has no name; leave out the column 'body' if there is but one");
  EXPECT_EQ(message("marker,x_m,y_m,z_m\n0,1,2\n"),
            "deck.csv:2: has 3 cells, the header names 4; correct the row or leave it out");
  EXPECT_EQ(message("marker,x_m,y_m,z_m\n9999999999,1,2,3\n"), "deck.csv:2: 9999999999 is too large for a marker's id");
}

}  // namespace
}  // namespace alidade
