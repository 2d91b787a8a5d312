// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands/verbs.h"
#include "calib/boards/board_drawing.h"
#include "calib/boards/board_pdf.h"
#include "calib/boards/board_text.h"
#include "io/atomic_file.h"
#include "io/image_files.h"

namespace alidade {
namespace {

class CalibrateBoardCommand : public Command {
 public:
  explicit CalibrateBoardCommand(CLI::App& flags) {
    flags
        .add_option("BOARD", board_,
                    "such as chessboard:9x6:25mm, charuco:8x6:30mm:22mm:5X5_100 or aprilgrid:6x6:24mm:6mm")
        ->required();
    options_.add_choice("paper", paper_,
                        {{"A4", Paper::A4},
                         {"A3", Paper::A3},
                         {"A2", Paper::A2},
                         {"A1", Paper::A1},
                         {"A0", Paper::A0},
                         {"letter", Paper::Letter},
                         {"fitted", Paper::Fitted}},
                        "of a PDF; fitted: a page of the board's own size");
    options_.add("pixels_per_mm", pixels_per_mm_, "1/mm", "resolution of a PNG");
    options_.add("margin_mm", margin_mm_, "mm", "white around the board in a PNG");
    options_.add_check([this] {
      if (!(pixels_per_mm_ > 0 && pixels_per_mm_ <= 100)) {
        throw std::invalid_argument(fmt::format("pixels_per_mm must be > 0 and <= 100, got {}", pixels_per_mm_));
      }
      if (!(margin_mm_ >= 0 && margin_mm_ <= 1000)) {
        throw std::invalid_argument(fmt::format("margin_mm must be 0..1000 mm, got {}", margin_mm_));
      }
    });
  }

  ExitCode run(const RunContext& context) override {
    const Board board = parse_board(board_);
    const std::string ending = context.output.extension().string();
    if (ending == ".pdf") {
      write_file(context.output, board_pdf(board, paper_));
    } else if (ending == ".png") {
      write_image(context.output, draw_board(board, 1e3 * pixels_per_mm_, 1e-3 * margin_mm_).image);
    } else {
      throw InputError(context.output.string(), 0, "a board is written as PDF or PNG",
                       "give -o a name that ends with .pdf or .png");
    }
    context.tell(fmt::format("{} written to {}", describe(board), context.output.string()));
    context.publish({{"board", board_text(board)}, {"file", context.output.string()}});
    return ExitCode::Success;
  }

 private:
  std::string board_;
  Paper paper_ = Paper::A4;
  double pixels_per_mm_ = 10;
  double margin_mm_ = 10;
};

}  // namespace

Verb calibrate_board_verb() {
  return {"calibrate board", "a calibration board to print, to scale",
          "alidade calibrate board charuco:8x6:30mm:22mm:5X5_100 -o board.pdf", OutputUse::File,
          make_command<CalibrateBoardCommand>};
}

}  // namespace alidade
