/// The models of the study: diagrams/linear_motor/NAME.training.json on recordings of the identification
/// experiment, as `loopwright gp train` trains them.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>
#include "tools/gp/train.h"

namespace loopwright::paper {

/// Sizes of the training windows D1, D2, D3 around the middle of each section of constant velocity [m].
inline constexpr std::array<double, 3> window_lengths{0.125, 0.225, 0.325};

/// The training file, the recording, and the differences from the file.
struct TrainingChoice {
  std::string file;                          ///< path of NAME.training.json
  std::string recording;                     ///< path of a CSV file
  double window_length = window_lengths[1];  ///< m; 0: all of each section
  std::string kernel;                        ///< "ps"; empty: the kernel of the file
};

/// Throws InputError when file or recording are unusable.
gp::Samples samples_of(const TrainingChoice& choice);

struct StudyModel {
  std::string title;  ///< "PS, D2"
  std::string path;   ///< of the model file; empty: not written
  std::shared_ptr<const TrainedModel> trained;

  double rmse(const gp::Samples& samples) const;
  std::string hyper_parameters() const;  ///< for people
};

/// Throws InputError when file or recording are unusable.
StudyModel train_model(const TrainingChoice& choice, std::string title);

/// Interval of positions [m].
struct Stretch {
  double from = 0, to = 0;
};
/// Intervals in which a model has samples, at any velocity; ascending, disjoint.
std::vector<Stretch> trained_stretches(const StudyModel& model);

struct Models {
  std::array<StudyModel, 3> ds, ps;  ///< on D1, D2, D3
  StudyModel ps_undelayed, beyond;   ///< on D2, labels without delay
  std::vector<const StudyModel*> all() const;
};

/// The models of the training files in `diagrams` on one recording, written into `folder`.
Models train_models(const std::string& diagrams, const std::string& recording, const std::string& folder);

}  // namespace loopwright::paper
