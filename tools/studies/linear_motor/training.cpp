#include "tools/studies/linear_motor/training.h"
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>

namespace loopwright::paper {
namespace {

std::shared_ptr<const Training> load(const TrainingChoice& choice) {
  const std::string recording = std::filesystem::absolute(choice.recording).string();
  std::vector<std::pair<std::string, std::string>> set{
      {"recordings.0", recording}, {"window_length", fmt::format("{:.17g} m", choice.window_length)}};
  if (!choice.kernel.empty()) set.emplace_back("kernel", choice.kernel);
  Problems problems;
  const auto training = load_training(choice.file, set, problems);
  if (problems.has_errors()) throw InputError(std::move(problems));
  return training;
}

}  // namespace

gp::Samples samples_of(const TrainingChoice& choice) {
  Problems problems;
  const auto collected = collect_samples(*load(choice), problems);
  if (problems.has_errors()) throw InputError(std::move(problems));
  return collected->samples;
}

StudyModel train_model(const TrainingChoice& choice, std::string title) {
  Problems problems;
  StudyModel model{std::move(title), "", train(*load(choice), problems)};
  if (problems.has_errors()) throw InputError(std::move(problems));
  return model;
}

double StudyModel::rmse(const gp::Samples& samples) const {
  return score(trained->learned.model, samples).rmse;
}

std::string StudyModel::hyper_parameters() const {
  const gp::Kernel& kernel = trained->learned.model.kernel;
  const auto names = gp::parameter_names(kernel);
  const auto values = gp::parameters_of(kernel);
  std::string text;
  for (size_t i = 0; i < names.size(); ++i)
    text += fmt::format("{}{} {:.4g}", i ? ", " : "", names[i], values[i]);
  return text;
}

std::vector<Stretch> trained_stretches(const StudyModel& model) {
  std::vector<Stretch> all, joined;
  for (const auto& section : model.trained->samples->sections) all.push_back({section.low, section.high});
  std::ranges::sort(all, {}, &Stretch::from);
  for (const Stretch& stretch : all)
    if (joined.empty() || stretch.from > joined.back().to)
      joined.push_back(stretch);
    else
      joined.back().to = std::max(joined.back().to, stretch.to);
  return joined;
}

std::vector<const StudyModel*> Models::all() const {
  return {&ds[0], &ds[1], &ds[2], &ps[0], &ps[1], &ps[2], &ps_undelayed, &beyond};
}

Models train_models(const std::string& diagrams, const std::string& recording, const std::string& folder) {
  const auto trained = [&](const char* file, double window_length, const char* kernel, std::string name,
                           std::string title) {
    StudyModel model = train_model(
        {diagrams + "/" + file + ".training.json", recording, window_length, kernel}, std::move(title));
    model.path = folder + "/" + name + ".model.json";
    write_model(model.path, model.trained->learned);
    return model;
  };
  Models models;
  for (size_t k = 0; k < 3; ++k) {
    models.ds[k] =
        trained("ds", window_lengths[k], "", fmt::format("ds{}", k + 1), fmt::format("DS, D{}", k + 1));
    models.ps[k] =
        trained("ps", window_lengths[k], "", fmt::format("ps{}", k + 1), fmt::format("PS, D{}", k + 1));
  }
  const double second = window_lengths[1];
  models.ps_undelayed = trained("beyond", second, "ps", "ps_undelayed", "PS, D2, labels without delay");
  models.beyond =
      trained("beyond", second, "", "beyond", "Beyond, D2: PE(x) SE(v) + SE(v), labels without delay");
  return models;
}

}  // namespace loopwright::paper
