/// A page of the studio without a browser.
#pragma once
#include <gtest/gtest.h>
#include <chrono>
#include <condition_variable>
#include <map>
#include <nlohmann/json.hpp>
#include "tools/studio/session/session.h"

namespace loopwright::studio {

/// Sends requests and waits for their answers.
class Page {
 public:
  explicit Page(const std::string& folder, const std::string& opened = "nominal.json")
      : session_(folder, opened, [this](int64_t, std::string text) { hear(std::move(text)); }) {}

  /// The answer of a request; fails for an error unless one is expected.
  Json ask(Json request) {
    const int64_t id = send(std::move(request));
    const Json answer = wait(id);
    EXPECT_TRUE(answer.contains("ok")) << answer.dump(1).substr(0, 2000);
    return answer.value("ok", Json::object());
  }
  int64_t send(Json request) {
    request["id"] = ++last_id_;
    session_.receive(1, request.dump());
    return last_id_;
  }
  Json wait(int64_t id) {
    std::unique_lock lock(mutex_);
    EXPECT_TRUE(heard_.wait_for(lock, std::chrono::seconds(300), [&] { return answers_.contains(id); }));
    return answers_[id];
  }
  std::vector<Json> partials() const { return partials_; }
  std::vector<Json> events() const { return events_; }
  Session& session() { return session_; }

 private:
  void hear(std::string text) {
    const Json message = Json::parse(text);
    const std::lock_guard lock(mutex_);
    if (message.contains("event")) {
      events_.push_back(message);
    } else if (message.contains("partial")) {
      partials_.push_back(message["partial"]);
    } else if (message["id"] == 0) {
      EXPECT_TRUE(message.contains("error")) << "what has no number is no request";
    } else if (!message.contains("progress")) {
      EXPECT_TRUE(answers_.emplace(message["id"].get<int64_t>(), message).second) << "answered twice";
    }
    heard_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable heard_;
  std::map<int64_t, Json> answers_;
  std::vector<Json> partials_, events_;
  int64_t last_id_ = 0;
  Session session_;
};

}  // namespace loopwright::studio
